#include "raster/depth_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spanray {

// The ray eye + t * direction(x, y) meets the triangle's plane at 1 / t = dot(direction, N) / dot(v0 - eye, N), which is linear in
// the pixel since direction is; depth = near / t.
// Source:   Olano and Greer 1997, "Triangle Scan Conversion using 2D Homogeneous Coordinates".
// Input:    the unsnapped world triangle, in its canonical vertex order.
// Contract: a function of positions and camera alone: coplanar copies of a triangle, and all pieces of a clipped one, get the
//           same bits. Edge-on (no volume between eye and triangle): the constant plane of its farthest vertex.
DepthPlane make_depth_plane(const Frame& frame, const Triangle& t, const double view_depth[3]) {
  const PrimaryRays& primary = frame.primary;
  DepthPlane plane{0, 0, 0, 1, 0};
  for (int i = 0; i < 3; ++i) {
    const bool behind_near = !(view_depth[i] > primary.near_plane);
    const float depth = behind_near ? 1.0f : static_cast<float>(primary.near_plane / view_depth[i]);
    plane.min = std::min(plane.min, depth);
    plane.max = std::max(plane.max, depth);
  }
  // However far, a surface lies in front of the background, whose depth is 0.
  plane.min = std::max(plane.min, std::numeric_limits<float>::denorm_min());
  plane.max = std::max(plane.max, plane.min);

  glm::dvec3 v[3];
  for (int i = 0; i < 3; ++i) {
    const float* p = frame.scene->vertices[t.vertex[i]].position;
    v[i] = {p[0], p[1], p[2]};
  }
  const glm::dvec3 normal = cross3(v[1] - v[0], v[2] - v[0]);
  const double scale = primary.near_plane / dot3(v[0] - primary.eye, normal);
  plane.depth0 = dot3(primary.corner, normal) * scale;
  plane.dx = dot3(primary.step_x, normal) * scale;
  plane.dy = dot3(primary.step_y, normal) * scale;
  if (!std::isfinite(plane.depth0) || !std::isfinite(plane.dx) || !std::isfinite(plane.dy)) {
    plane.depth0 = plane.min;
    plane.dx = plane.dy = 0;
  }
  return plane;
}

}  // namespace spanray
