// Where a line meets a sphere, in plain IEEE doubles: one function for both visibility engines, shading and questions.
#pragma once
#include <cmath>

#include "math/double_double.h"
#include "math/vec.h"

namespace spanray {

// Of origin + t * direction against a sphere; t counts in units of the direction.
struct SphereCrossing {
  double enter = 0, leave = 0;  // enter <= leave, of any sign; tangents have both at one place, up to rounding
  double outside = 0;           // the sign is that of |origin - center| - radius: > 0 outside, 0 on the sphere, < 0 inside
};

// False if the line passes the sphere by. A line that touches it meets it.
// Source:   a t^2 - 2 b t + c = 0 with a = |d|^2, b = -f.d, c = |f|^2 - r^2. Haines, Guenther, Akenine-Moeller 2019,
//           "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems 7: roots as q / a and c / q, so that
//           nothing cancels; q = b + sign(b) sqrt(b^2 - a c). What cancels within c and b^2 - a c does so in numbers of twice
//           the precision, where that chapter takes the distance of line and center.
// Input:    from_center: f, the origin less the center. All finite, the direction not zero; |f|, r <= 2^110, r > 0, |d| in
//           2^-149 .. 2^128.
// Contract: hits and misses are told apart unless the line passes within 2^-50 radius of a tangent, for |f| <= 2^25 radius.
//           t is off by 4 ulp at most, but near tangents; the sign of `outside` is right. Scaling all lengths by a power of
//           two changes no bit of t.
inline bool cross_sphere(const glm::dvec3& from_center, const glm::dvec3& direction, double radius, SphereCrossing& out) {
  const glm::dvec3 &f = from_center, &d = direction;
  const double a1 = dot3(d, d), b1 = dot3(f, d), f1 = dot3(f, f), r1 = radius * radius;
  // Each of the three is off by less than 2^-51 of the sum of what it is made from.
  const double scale = a1 * (f1 + r1);
  if (b1 * b1 - a1 * (f1 - r1) < -0x1p-48 * scale) return false;
  const auto dot = [](const glm::dvec3& u, const glm::dvec3& v) {
    return two_product(u.x, v.x) + two_product(u.y, v.y) + two_product(u.z, v.z);
  };
  const DoubleDouble a = dot(d, d), b = -dot(f, d), c = dot(f, f) + two_product(radius, -radius);
  const DoubleDouble square = difference_of_products(b, b, a, c);
  if (square.hi < 0) return false;
  const double root = std::sqrt(square.hi), q = b.hi < 0 ? b.hi - root : b.hi + root;
  // q is 0 where the line touches the sphere at the origin.
  const double far = q / a.hi, near = q != 0 ? c.hi / q : 0;
  out = {b.hi < 0 ? far : near, b.hi < 0 ? near : far, c.hi};
  return true;
}

}  // namespace spanray
