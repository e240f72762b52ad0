#pragma once
#include "math/vec.h"
#include "spanray/camera.h"

namespace spanray {

inline Camera camera_at(const glm::dvec3& eye, const glm::dvec3& target, double near_plane = 0.01, const glm::dvec3& up = {0, 1, 0}) {
  Camera c;
  for (int k = 0; k < 3; ++k) c.eye[k] = eye[k], c.target[k] = target[k], c.up[k] = up[k];
  c.near_plane = near_plane;
  return c;
}

}  // namespace spanray
