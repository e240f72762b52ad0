// When a moving sphere meets triangles, by another way than the engine's: in extended precision, as the entry of its center into the union
// of a plate, three cylinders and three balls (Eberly, "Intersection of Moving Sphere and Triangle"). And plain distances.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "support/bvh_oracle.h"

namespace spanray {

using Long3 = glm::vec<3, long double>;

struct LongTriangle {
  Long3 v[3];
  LongTriangle(const SceneData& scene, uint32_t primitive) {
    for (int i = 0; i < 3; ++i) v[i] = Long3(scene_vertex(scene, primitive, i));
  }
};

inline long double oracle_distance(const LongTriangle& t, const Long3& p) {
  const Long3 n = cross3(t.v[1] - t.v[0], t.v[2] - t.v[0]);
  const long double area = length3(n);
  bool inside = area > 0;
  long double best = std::numeric_limits<long double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const Long3 a = t.v[i], e = t.v[(i + 1) % 3] - a;
    const long double square = dot3(e, e), s = square > 0 ? std::clamp(dot3(p - a, e) / square, 0.0L, 1.0L) : 0.0L;
    best = std::min(best, length3(p - a - e * s));
    inside = inside && dot3(cross3(e, p - a), n) >= 0;
  }
  return inside ? std::min(best, std::fabs(dot3(n, p - t.v[0])) / area) : best;
}

inline long double mesh_distance(const SceneData& scene, const Long3& p) {
  long double best = std::numeric_limits<long double>::infinity();
  for (uint32_t i = 0; i < scene.triangles.size(); ++i) best = std::min(best, oracle_distance(LongTriangle(scene, i), p));
  return best;
}

// The smaller root of a t^2 + 2 b t + c, where it is not negative; infinity if there is none.
inline long double first_root(long double a, long double b, long double c) {
  const long double inside = b * b - a * c;
  if (!(a > 0) || inside < 0) return std::numeric_limits<long double>::infinity();
  const long double t = b < 0 ? c / (std::sqrt(inside) - b) : (-b - std::sqrt(inside)) / a;
  return t >= 0 ? t : std::numeric_limits<long double>::infinity();
}

// In parts of the motion, 0 to 1; infinity if never. The sphere begins outside.
inline long double oracle_contact(const LongTriangle& t, const Long3& start, const Long3& motion, long double radius) {
  long double best = std::numeric_limits<long double>::infinity();
  const Long3 n = cross3(t.v[1] - t.v[0], t.v[2] - t.v[0]);
  const long double area = length3(n), speed = area > 0 ? dot3(n, motion) / area : 0;
  const long double height = area > 0 ? dot3(n, start - t.v[0]) / area : 0;
  for (const long double side : {radius, -radius}) {
    const long double time = speed != 0 ? (side - height) / speed : -1;
    if (!(time >= 0) || area == 0) continue;
    const Long3 p = start + motion * time;
    bool inside = true;
    for (int i = 0; i < 3; ++i) inside = inside && dot3(cross3(t.v[(i + 1) % 3] - t.v[i], p - t.v[i]), n) >= 0;
    if (inside) best = std::min(best, time);
  }
  for (int i = 0; i < 3; ++i) {
    const Long3 from = start - t.v[i], edge = t.v[(i + 1) % 3] - t.v[i];
    best = std::min(best, first_root(dot3(motion, motion), dot3(from, motion), dot3(from, from) - radius * radius));
    const long double square = dot3(edge, edge);
    if (square == 0) continue;
    const Long3 across = motion - edge * (dot3(motion, edge) / square), aside = from - edge * (dot3(from, edge) / square);
    const long double time = first_root(dot3(across, across), dot3(aside, across), dot3(aside, aside) - radius * radius);
    const long double along = dot3(from + motion * time, edge) / square;
    if (along >= 0 && along <= 1) best = std::min(best, time);
  }
  return best <= 1 ? best : std::numeric_limits<long double>::infinity();
}

}  // namespace spanray
