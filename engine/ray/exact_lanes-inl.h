// first_hit() of frame/exact_hit.h for kLanes rays and one sphere or plane: lanes are rays. Included once a target.
// Contract: the bits of first_hit(). Plain doubles say first what bounds on their error leave no doubt about; where rays are
//           left, its operations are done in its order.
#if defined(SPANRAY_EXACT_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_EXACT_LANES_INL_H_
#undef SPANRAY_EXACT_LANES_INL_H_
#else
#define SPANRAY_EXACT_LANES_INL_H_
#endif

#include <cstdint>
#include <limits>

#include "frame/exact_hit.h"
#include "math/double_double-inl.h"
#include "ray/sphere_tree.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// ExactRay, of kLanes rays.
struct ExactRays {
  F64 origin[3], direction[3], length_square;  // of the direction
  F64 t_min, t_max;  // of the closest hit: t_max is that of the best so far
  bool front_only;
};
// hit: at t, t_min < t <= t_max, t not infinite. sure: also hit; at which t was not asked.
struct ExactLaneHits { F64 t; uint32_t hit, sure; };

// Of `rays`; those of `leaving` leave this sphere.
// kAny: t does not matter, and t_min is 0, front_only false.
// Contract: c1 tells outside from inside (|f|^2 - r^2), square1 lines that meet the sphere from those that pass it by; both are
//           off by less than 2^-50 of the sum of what they are made from.
template <bool kAny>
HWY_INLINE ExactLaneHits first_hit_lanes(const ExactRays& ray, const TreeSphere& s, uint32_t leaving, uint32_t rays) {
  constexpr double kRounding = 0x1p-48;  // as in cross_sphere()
  const F64 r = f64(static_cast<double>(s.radius)), zero = f64(0.0);
  F64 f[3];
  for (int k = 0; k < 3; ++k) f[k] = ray.origin[k] - f64(static_cast<double>(s.center[k]));
  const F64 b1 = dot3(f, ray.direction), f1 = dot3(f, f), r1 = r * r, c1 = f1 - r1, c_error = f64(kRounding) * (f1 + r1);
  const F64 square1 = b1 * b1 - ray.length_square * c1, square_error = ray.length_square * c_error;
  ExactLaneHits out{zero, rays & ~bits_less(square1, -square_error), 0};
  // Who comes from outside and moves away, or leaves the sphere, never meets it: b1^2 >= a c1 of lines that meet it, so the sign
  // of their b1 is sure.
  const uint32_t outside = bits_less(c_error, c1);
  out.hit &= ~(outside & (leaving | bits_less(zero, b1)));
  // Who comes from outside and surely meets it, does so 2^-25 of the way before the place nearest to the center.
  if constexpr (kAny)
    out.sure = out.hit & outside & bits_less(square_error, square1) & bits_less(-b1, ray.length_square * ray.t_max);
  out.hit &= ~out.sure;
  if (out.hit == 0) return out;

  const DD64 a = dot3_exact(ray.direction, ray.direction), b = -dot3_exact(f, ray.direction);
  const DD64 c = dot3_exact(f, f) + two_product(r, -r), square = difference_of_products(b, b, a, c);
  const F64 root = sqrt_(square.hi), q = select_lt(b.hi, zero, b.hi - root, b.hi + root);
  const F64 far = q / a.hi, near = select_eq(q, zero, zero, c.hi / q);
  const F64 enter = select_lt(b.hi, zero, far, near), leave = select_lt(b.hi, zero, near, far);
  const uint32_t enters = bits_less(ray.t_min, enter), leaves = ray.front_only ? 0 : bits_less(ray.t_min, leave);
  out.t = select_lt(ray.t_min, enter, enter, leave);
  out.hit &= ~bits_less(square.hi, zero) & ~(leaving & bits_less(zero, c.hi)) & (enters | leaves);
  out.hit &= ~bits_less(ray.t_max, out.t) & bits_less(out.t, f64(std::numeric_limits<double>::infinity()));
  return out;
}

// along_normal() of math/line_plane.h.
HWY_INLINE F64 along_normal(const glm::dvec3& normal, const F64 (&v)[3], const F64 (&rest)[3]) {
  const F64 n[3] = {f64(normal.x), f64(normal.y), f64(normal.z)};
  if ((normal.x == 0) + (normal.y == 0) + (normal.z == 0) == 2) return dot3(n, v) + dot3(n, rest);
  const DD64 sum = dot3_exact(n, v) + DD64{dot3(n, rest), f64(0.0)};
  const F64 all = abs_(n[0] * v[0]) + abs_(n[1] * v[1]) + abs_(n[2] * v[2]);
  return select_lt(f64(0x1p-96) * all, abs_(sum.hi), sum.hi, f64(0.0));
}

// surely_leaves() of math/line_plane.h.
HWY_INLINE uint32_t surely_leave(const ExactRays& ray, const glm::dvec3& normal, const glm::dvec3& point) {
  F64 height = f64(0.0), slope = height, height_sum = height, slope_sum = height;
  for (int k = 0; k < 3; ++k) {
    const F64 h = f64(normal[k]) * (ray.origin[k] - f64(point[k])), s = f64(normal[k]) * ray.direction[k];
    height = height + h, slope = slope + s, height_sum = height_sum + abs_(h), slope_sum = slope_sum + abs_(s);
  }
  const F64 height_error = f64(0x1p-49) * height_sum, slope_error = f64(0x1p-49) * slope_sum;
  return (bits_less(height_error, height) & bits_less(slope_error, slope)) |
         (bits_less(height, -height_error) & bits_less(slope, -slope_error));
}

// Of `rays`; those of `leaving` leave this plane.
HWY_INLINE ExactLaneHits first_hit_lanes(const ExactRays& ray, const Plane& plane, uint32_t leaving, uint32_t rays) {
  const glm::dvec3 normal = normal_of(plane), point = point_of(plane);
  const F64 zero = f64(0.0);
  ExactLaneHits out{zero, rays & ~leaving, 0};
  if (out.hit != 0) out.hit &= ~surely_leave(ray, normal, point);
  if (out.hit == 0) return out;

  F64 v[3], rest[3], most = zero;
  const F64 none[3] = {zero, zero, zero};
  for (int k = 0; k < 3; ++k) {
    const DD64 difference = two_sum(ray.origin[k], f64(-point[k]));
    v[k] = difference.hi, rest[k] = difference.lo;
    most = max_(most, abs_(ray.direction[k]));
  }
  const F64 height = along_normal(normal, v, rest), slope = along_normal(normal, ray.direction, none);
  const uint32_t above = bits_less(zero, height), below = bits_less(height, zero);
  out.t = -height / slope;
  out.hit &= (above & bits_less(slope, zero)) | ((ray.front_only ? 0 : below) & bits_less(zero, slope));
  out.hit &= bits_less(ray.t_min, out.t) & ~bits_less(ray.t_max, out.t) & ~bits_less(f64(kFarthestHit), out.t * most);
  return out;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_EXACT_LANES_INL_H_
