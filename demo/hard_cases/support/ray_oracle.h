// Which triangle each primary ray hits, by brute force in double; says where rounding of the raster path may decide otherwise.
#pragma once
#include <cmath>
#include <limits>

#include "frame/frame.h"

namespace spanray {

struct PixelOracleHit {
  uint32_t primitive = kNoPrimitive;
  double t = std::numeric_limits<double>::infinity();  // view depth
  bool doubtful = false;  // within `margin` pixels of an edge that matters, or another surface at nearly the same depth
};

inline PixelOracleHit oracle_hit(const Frame& frame, int x, int y, double margin = 0.01) {
  const PrimaryRays& r = frame.primary;
  const glm::dvec3 d = r.corner + (x + 0.5) * r.step_x + (y + 0.5) * r.step_y;
  PixelOracleHit hit;
  double second = std::numeric_limits<double>::infinity(), doubtful_t = second;
  for (uint32_t id = 0; id < frame.scene->triangles.size(); ++id) {
    const Triangle& triangle = frame.scene->triangles[id];
    glm::dvec3 v[3];
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) v[i][k] = frame.scene->vertices[triangle.vertex[i]].position[k] - r.eye[k];
    const glm::dvec3 n = cross3(v[1] - v[0], v[2] - v[0]);
    const double volume = dot3(v[0], n), t = volume / dot3(d, n);
    if (!(t > r.near_plane * (1 - 1e-9)) || !std::isfinite(t)) continue;
    double distance = std::numeric_limits<double>::infinity();  // to the nearest edge in pixels; negative outside
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 edge = cross3(v[(i + 1) % 3], v[(i + 2) % 3]);
      const double slope = std::hypot(dot3(r.step_x, edge), dot3(r.step_y, edge));
      distance = std::min(distance, dot3(d, edge) * (volume > 0 ? 1 : -1) / slope);
    }
    if (!(distance > -margin)) continue;
    if (distance < margin || t < r.near_plane * (1 + 1e-6)) doubtful_t = std::min(doubtful_t, t);
    if (t < hit.t) {
      second = hit.t;
      hit.t = t, hit.primitive = id;
    } else {
      second = std::min(second, t);
    }
  }
  const double limit = hit.t * (1 + 1e-6);
  hit.doubtful = (std::isfinite(doubtful_t) && doubtful_t <= limit) || (std::isfinite(second) && second <= limit);
  return hit;
}

}  // namespace spanray
