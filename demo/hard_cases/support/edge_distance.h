// How near a place in the picture is to the edges of a triangle.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "frame/primary_rays.h"
#include "math/vec.h"
#include "scene/scene_data.h"

namespace spanray {

// Snapping moves an edge by at most sqrt(2)/512 pixel; the rest pays for rays rounded to float.
inline constexpr double kEdgePixels = 1.0 / 256;

inline glm::dvec3 vertex_position(const SceneData& scene, const Triangle& t, int i) {
  const float* p = scene.vertices[t.vertex[i]].position;
  return {p[0], p[1], p[2]};
}

// Distance in pixels from (x, y) to the nearest of a triangle's (infinite) edge lines; linear edge functions, so
// vertices behind the eye are no special case.
inline double edge_distance(const SceneData& scene, const PrimaryRays& rays, uint32_t primitive, double x, double y) {
  const Triangle& t = scene.triangles[primitive];
  const glm::dvec3 d = rays.corner + rays.step_x * x + rays.step_y * y;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 n = cross3(vertex_position(scene, t, i) - rays.eye, vertex_position(scene, t, (i + 1) % 3) - rays.eye);
    const double gradient = std::hypot(dot3(rays.step_x, n), dot3(rays.step_y, n));
    if (gradient > 0) least = std::min(least, std::fabs(dot3(d, n)) / gradient);
  }
  return least;
}

}  // namespace spanray
