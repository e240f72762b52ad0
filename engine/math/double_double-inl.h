// math/double_double.h in lanes: its operations in its order, so its bits. Included once a target.
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

struct DD64 { F64 hi, lo; };  // DoubleDouble

HWY_INLINE DD64 two_sum(F64 a, F64 b) {
  const F64 sum = a + b, other = sum - a;
  return {sum, (a - (sum - other)) + (b - other)};
}

HWY_INLINE DD64 two_product(F64 a, F64 b) {
  const F64 split = f64(0x1p27 + 1);
  const F64 a_big = split * a, a_hi = a_big - (a_big - a), a_lo = a - a_hi;
  const F64 b_big = split * b, b_hi = b_big - (b_big - b), b_lo = b - b_hi;
  const F64 product = a * b;
  return {product, ((a_hi * b_hi - product) + a_hi * b_lo + a_lo * b_hi) + a_lo * b_lo};
}

HWY_INLINE DD64 operator+(const DD64& a, const DD64& b) {
  const DD64 sum = two_sum(a.hi, b.hi);
  return two_sum(sum.hi, sum.lo + (a.lo + b.lo));
}
HWY_INLINE DD64 operator-(const DD64& a) { return {-a.hi, -a.lo}; }

HWY_INLINE DD64 difference_of_products(const DD64& a, const DD64& b, const DD64& c, const DD64& d) {
  const DD64 ab = two_product(a.hi, b.hi), cd = two_product(c.hi, d.hi), difference = two_sum(ab.hi, -cd.hi);
  const F64 low = (a.hi * b.lo + a.lo * b.hi) - (c.hi * d.lo + c.lo * d.hi);
  return two_sum(difference.hi, difference.lo + ((ab.lo - cd.lo) + low));
}

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
