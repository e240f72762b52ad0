// math/double_double.h in lanes. Included once a target.
#if defined(SPANRAY_DOUBLE_DOUBLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_DOUBLE_DOUBLE_INL_H_
#undef SPANRAY_DOUBLE_DOUBLE_INL_H_
#else
#define SPANRAY_DOUBLE_DOUBLE_INL_H_
#endif

#include "simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

namespace double_double {
using Number = F64;
HWY_INLINE F64 number(double x) { return f64(x); }
#define SPANRAY_DOUBLE_DOUBLE HWY_INLINE
#include "math/double_double.inl"
}  // namespace double_double
using double_double::difference_of_products, double_double::two_product, double_double::two_sum;
using DD64 = double_double::DoubleDouble;

// Vectors of lanes: dot3() of math/vec.h, and the same of exact products, in twice the precision.
HWY_INLINE F64 dot3(const F64 (&a)[3], const F64 (&b)[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
HWY_INLINE DD64 dot3_exact(const F64 (&a)[3], const F64 (&b)[3]) {
  return two_product(a[0], b[0]) + two_product(a[1], b[1]) + two_product(a[2], b[2]);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_DOUBLE_DOUBLE_INL_H_
