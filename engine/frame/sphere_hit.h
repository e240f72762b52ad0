// What a hit of a sphere is: one function for both visibility engines, and for shading, which finds the hit again.
#pragma once
#include <cstdint>
#include <limits>

#include "frame/frame.h"
#include "math/line_sphere.h"

namespace spanray {

// One ray, in double: hits count at t_min < t <= t_max, in units of the direction.
struct SphereRay {
  glm::dvec3 origin{0}, direction{0};
  double t_min = 0, t_max = std::numeric_limits<double>::infinity();
  uint32_t from = kNoPrimitive;  // the sphere that the ray leaves: met again only from the inside, on its other side
  bool front_only = false;       // only where rays enter a sphere: faces seen from the inside are culled
};

inline glm::dvec3 center_of(const Sphere& s) { return {s.center[0], s.center[1], s.center[2]}; }

// The primary ray through (x, y), in pixels. As everywhere, t is its view depth.
inline SphereRay primary_sphere_ray(const Frame& frame, double x, double y) {
  const PrimaryRays& p = frame.primary;
  SphereRay ray;
  ray.origin = p.eye, ray.direction = p.corner + p.step_x * x + p.step_y * y, ray.t_min = p.near_plane;
  ray.front_only = frame.settings.culling == Culling::kBack;
  return ray;
}

// The first hit, whatever t_max: infinity if there is none. entering: the ray comes from outside.
// Contract: t as of cross_sphere(); strictly beyond t_min. A ray that leaves the sphere and starts outside never meets it
//           again, whatever its direction; one that starts inside meets the far side.
struct SphereHitAt {
  double t = std::numeric_limits<double>::infinity();
  bool entering = true;
};
inline SphereHitAt first_hit(const SphereRay& ray, const Sphere& sphere, uint32_t primitive) {
  SphereCrossing cross;
  if (!cross_sphere(ray.origin - center_of(sphere), ray.direction, static_cast<double>(sphere.radius), cross)) return {};
  if (primitive == ray.from && cross.outside > 0) return {};
  if (cross.enter > ray.t_min) return {cross.enter, true};
  if (!ray.front_only && cross.leave > ray.t_min) return {cross.leave, false};
  return {};
}

}  // namespace spanray
