// Who is right where two tracers disagree? Every triangle, in extended precision.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "support/bvh_oracle.h"

namespace spanray {

// What brute force knows of one ray: the nearest triangle that it certainly hits, and what it may be said to hit.
class RayJudge {
 public:
  static constexpr long double kTie = 1e-6L;  // relative distances that count as one
  // Within this of an edge, as the sine of an angle, inside and outside are not told apart by a test in double.
  static constexpr long double kDoubt = 1e-14L;
  using V = glm::vec<3, long double>;

  RayJudge(const SceneData& scene, const RayBatch& rays, int i)
      : scene_(scene), origin_(ray_origin(rays, i)), direction_(ray_direction(rays, i)),
        t_max_(static_cast<long double>(rays.t_max[static_cast<size_t>(i)])) {
    const glm::dvec3 o = ray_origin(rays, i), d = normalize3(ray_direction(rays, i), glm::dvec3(0, 0, 1));
    for (uint32_t p = 0; p < scene.triangles.size(); ++p)
      if (near_line(p, o, d)) add(p);
  }

  // t: of the tracer's hit, where it gives one; infinity for none.
  bool closest_is_right(uint32_t primitive) const {
    if (primitive == kNoPrimitive) return !certainly_hits();
    const Hit h = hit(primitive);
    return h.possible && h.earliest <= t_max_ * (1 + kTie) && h.earliest <= certain_ * (1 + kTie);
  }
  bool any_is_right(bool found) const {
    return found ? std::isfinite(possible_) && possible_ <= t_max_ * (1 + kTie) : !certainly_hits();
  }

 private:
  static constexpr long double kEdgeOn = 1e-9L;  // the sine of the angle to the plane: distances have lost their digits

  bool certainly_hits() const { return std::isfinite(certain_) && certain_ <= t_max_ * (1 - kTie); }

  struct Hit {
    bool possible = false, certain = false;
    long double earliest = 0, t = 0;  // earliest: of the doubtful
  };

  // In double, generously: does the line pass the ball around the triangle?
  bool near_line(uint32_t p, const glm::dvec3& o, const glm::dvec3& d) const {
    const glm::dvec3 a = scene_vertex(scene_, p, 0);
    const glm::dvec3 b = scene_vertex(scene_, p, 1) - a, c = scene_vertex(scene_, p, 2) - a;
    const double square = std::max(dot3(b, b), dot3(c, c));
    const glm::dvec3 across = cross3(a - o, d);
    return dot3(across, across) <= 1.001 * square + 1e-9 * dot3(a - o, a - o);
  }

  Hit hit(uint32_t p) const {
    V v[3];
    for (int i = 0; i < 3; ++i) v[i] = V(scene_vertex(scene_, p, i)) - origin_;
    bool positive = false, negative = false, doubtful = false;
    long double reach = 0, first = std::numeric_limits<long double>::infinity();
    const long double length = length3(direction_);
    for (int i = 0; i < 3; ++i) {
      const V &a = v[(i + 1) % 3], &b = v[(i + 2) % 3];
      const long double e = dot3(direction_, cross3(a, b)), size = length * length3(a) * length3(b);
      if (!(std::fabs(e) > kDoubt * size)) doubtful = true;
      else (e > 0 ? positive : negative) = true;
      reach = std::max(reach, length3(v[i]) / length);
      first = std::min(first, dot3(v[i], direction_) / (length * length));
    }
    Hit h;
    if (positive && negative) return h;
    const V n = cross3(v[1] - v[0], v[2] - v[0]);
    const long double along = dot3(n, direction_), area = length3(n);
    const bool edge_on = !(std::fabs(along) > kEdgeOn * area * length);
    h.t = along != 0 ? dot3(n, v[0]) / along : first;
    h.earliest = edge_on ? first : h.t;
    const long double rounding = 1e-12L * reach;  // at the origin itself nobody can tell
    h.possible = (edge_on ? reach : h.t) > -rounding;
    h.certain = !doubtful && !edge_on && h.t > rounding;
    return h;
  }

  void add(uint32_t p) {
    const Hit h = hit(p);
    if (h.certain) certain_ = std::min(certain_, h.t);
    if (h.possible) possible_ = std::min(possible_, h.earliest);
  }

  const SceneData& scene_;
  V origin_, direction_;
  long double t_max_;
  long double certain_ = std::numeric_limits<long double>::infinity(), possible_ = certain_;
};

}  // namespace spanray
