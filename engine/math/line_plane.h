// Where a line meets a plane, in plain IEEE doubles: one function for both visibility engines, shading and questions.
#pragma once
#include <cmath>
#include <limits>

#include "math/double_double.h"
#include "math/vec.h"

namespace spanray {

// dot(normal, v + rest), or 0 where rounding could have made the sign.
// Input:    |rest| <= 2^-53 |v| by coordinates; products 0 or of sizes 2^-900 to 2^900.
// Contract: products are exact and summed in twice the precision, so the sign is right, and what cancels down to 2^-46 of the
//           largest product is off by 1 ulp at most. Scaling v and rest by a power of two changes no bit.
inline double along_normal(const glm::dvec3& normal, const glm::dvec3& v, const glm::dvec3& rest) {
  // Along an axis nothing cancels, and most planes are floors and walls.
  if ((normal.x == 0) + (normal.y == 0) + (normal.z == 0) == 2) return dot3(normal, v) + dot3(normal, rest);
  const DoubleDouble sum = two_product(normal.x, v.x) + two_product(normal.y, v.y) + two_product(normal.z, v.z) +
                           DoubleDouble{normal.x * rest.x + normal.y * rest.y + normal.z * rest.z, 0};
  const double all = std::fabs(normal.x * v.x) + std::fabs(normal.y * v.y) + std::fabs(normal.z * v.z);
  return std::fabs(sum.hi) > 0x1p-96 * all ? sum.hi : 0;
}

// How far a place is in front of the plane through `point`, times the length of its normal: < 0 behind it, 0 on it. The
// difference of the two places is exact.
inline double height_over(const glm::dvec3& normal, const glm::dvec3& point, const glm::dvec3& place) {
  glm::dvec3 v, rest;
  for (int k = 0; k < 3; ++k) {
    const DoubleDouble difference = two_sum(place[k], -point[k]);
    v[k] = difference.hi, rest[k] = difference.lo;
  }
  return along_normal(normal, v, rest);
}

// How fast a ray rises over the plane: the height that it gains in a length of its direction; 0 along the plane.
inline double slope_over(const glm::dvec3& normal, const glm::dvec3& direction) {
  return along_normal(normal, direction, glm::dvec3(0));
}

// Whether a ray surely never meets the plane: what most rays that leave something do, told in a few operations. Contract: true
// only if height and slope have the same sign.
inline bool surely_leaves(const glm::dvec3& normal, const glm::dvec3& point, const glm::dvec3& origin,
                          const glm::dvec3& direction) {
  constexpr double kRounding = 0x1p-49;
  const glm::dvec3 v = origin - point;
  const double hx = normal.x * v.x, hy = normal.y * v.y, hz = normal.z * v.z;
  const double sx = normal.x * direction.x, sy = normal.y * direction.y, sz = normal.z * direction.z;
  const double height_error = kRounding * (std::fabs(hx) + std::fabs(hy) + std::fabs(hz));
  const double slope_error = kRounding * (std::fabs(sx) + std::fabs(sy) + std::fabs(sz));
  const double height = hx + hy + hz, slope = sx + sy + sz;
  return (height > height_error && slope > slope_error) || (height < -height_error && slope < -slope_error);
}

// t of the meeting, in lengths of the direction; infinity for lines that run along the plane, or away from it, and for those
// that start on it. Contract: t > 0, off by 3 ulp at most unless height or slope cancels beyond 2^-46 of what it is made from.
inline double cross_plane(double height, double slope) {
  const bool towards = (height > 0 && slope < 0) || (height < 0 && slope > 0);
  return towards ? -height / slope : std::numeric_limits<double>::infinity();
}

}  // namespace spanray
