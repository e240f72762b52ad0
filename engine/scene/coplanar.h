// Does a triangle of a scene lie wholly in a plane of it?
#pragma once
#include "math/line_plane.h"
#include "scene/scene_data.h"

namespace spanray {

inline glm::dvec3 normal_of(const Plane& p) { return {p.normal[0], p.normal[1], p.normal[2]}; }
inline glm::dvec3 point_of(const Plane& p) { return {p.point[0], p.point[1], p.point[2]}; }

// Contract: exact, unless coordinates differ by more than 2^40 in size.
inline bool lies_in(const SceneData& scene, const Triangle& triangle, const Plane& plane) {
  for (const uint32_t v : triangle.vertex) {
    const float* p = scene.vertices[v].position;
    if (height_over(normal_of(plane), point_of(plane), {p[0], p[1], p[2]}) != 0) return false;
  }
  return true;
}

}  // namespace spanray
