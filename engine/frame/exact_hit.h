// What a hit of an exact primitive (sphere, plane) is: one function for both visibility engines, and for shading, which finds
// the hit again.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "frame/frame.h"
#include "math/line_sphere.h"
#include "scene/coplanar.h"

namespace spanray {

// One ray, in double: hits count at t_min < t <= t_max, in units of the direction.
struct ExactRay {
  glm::dvec3 origin{0}, direction{0};
  double t_min = 0, t_max = std::numeric_limits<double>::infinity();
  uint32_t from =
      kNoPrimitive;         // what the ray leaves: a sphere is met again only from within, on its other side, a plane never
  bool front_only = false;  // faces seen from behind are culled: of spheres from within
};

template <class S> glm::dvec3 center_of(const S& s) { return {s.center[0], s.center[1], s.center[2]}; }

// The primary ray through (x, y), in pixels. As everywhere, t is its view depth.
inline ExactRay primary_exact_ray(const Frame& frame, double x, double y) {
  const PrimaryRays& p = frame.primary;
  ExactRay ray;
  ray.origin = p.eye, ray.direction = p.corner + p.step_x * x + p.step_y * y, ray.t_min = p.near_plane;
  ray.front_only = frame.settings.culling == Culling::kBack;
  return ray;
}

// The first hit, whatever t_max: infinity if there is none.
struct ExactHitAt {
  double t = std::numeric_limits<double>::infinity();
  bool front = true;  // the ray comes from the front of a plane, from outside of a sphere
};

// Contract: t as of cross_sphere(); strictly beyond t_min. A ray that leaves the sphere and starts outside never meets it
//           again, whatever its direction; one that starts inside meets the far side.
inline ExactHitAt first_hit(const ExactRay& ray, const Sphere& sphere, uint32_t primitive) {
  SphereCrossing cross;
  if (!cross_sphere(ray.origin - center_of(sphere), ray.direction, static_cast<double>(sphere.radius), cross)) return {};
  if (primitive == ray.from && cross.outside > 0) return {};
  if (cross.enter > ray.t_min) return {cross.enter, true};
  if (!ray.front_only && cross.leave > ray.t_min) return {cross.leave, false};
  return {};
}

// Planes end where coordinates do: a hit lies no farther than this from the ray's origin, along each axis.
inline constexpr double kFarthestHit = 1e30;

// The same of a plane, for rays that leave something else, of one origin, and so of one height over it (math/line_plane.h).
inline ExactHitAt first_hit(const ExactRay& ray, const Plane& plane, double height) {
  if (ray.front_only && height < 0) return {};
  const double t = cross_plane(height, slope_over(normal_of(plane), ray.direction));
  const glm::dvec3& d = ray.direction;
  const bool near = t * std::max({std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)}) <= kFarthestHit;
  return t > ray.t_min && near ? ExactHitAt{t, height > 0} : ExactHitAt{};
}
// Contract: t as of cross_plane(). A ray that leaves the plane never meets it again.
inline ExactHitAt first_hit(const ExactRay& ray, const Plane& plane, uint32_t primitive) {
  if (primitive == ray.from || surely_leaves(normal_of(plane), point_of(plane), ray.origin, ray.direction)) return {};
  return first_hit(ray, plane, height_over(normal_of(plane), point_of(plane), ray.origin));
}

// Of any of them.
inline ExactHitAt first_hit(const ExactRay& ray, const SceneData& scene, uint32_t primitive) {
  return scene.is_sphere(primitive) ? first_hit(ray, scene.sphere(primitive), primitive)
                                    : first_hit(ray, scene.plane(primitive), primitive);
}

// Of a triangle and an exact primitive that one ray meets at these t: does it show the triangle? Ties go to triangles, and so
// does a plane in which the triangle lies, whatever rounding makes of the two t.
inline bool shows_triangle(const SceneData& scene, uint32_t triangle, double triangle_t, uint32_t exact, double exact_t) {
  constexpr double kRounding = 0x1p-12;  // far more than both are off by: it only spares lies_in()
  if (triangle_t <= exact_t) return true;
  return scene.is_plane(exact) && triangle_t <= exact_t * (1 + kRounding) &&
         lies_in(scene, scene.triangles[triangle], scene.plane(exact));
}

}  // namespace spanray
