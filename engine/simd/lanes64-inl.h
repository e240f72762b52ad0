// 64-bit integer lanes: the bits of doubles, to take exponents apart and build them. Included like simd/lanes-inl.h.
#if defined(SPANRAY_LANES64_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_LANES64_INL_H_
#undef SPANRAY_LANES64_INL_H_
#else
#define SPANRAY_LANES64_INL_H_
#endif

#include "simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// kLanes 64-bit integers (two's complement, wrapping); lane i corresponds to lane i of F64.
struct I64 {
  hn::Vec<DDI> v[kHalves];
};
HWY_INLINE I64 i64(int64_t x) { I64 r; for (int h = 0; h < kHalves; ++h) r.v[h] = hn::Set(DDI(), x); return r; }
HWY_INLINE I64 bits_of(F64 a) { I64 r; for (int h = 0; h < kHalves; ++h) r.v[h] = hn::BitCast(DDI(), a.v[h]); return r; }
HWY_INLINE F64 double_from_bits(I64 a) { F64 r; for (int h = 0; h < kHalves; ++h) r.v[h] = hn::BitCast(DD(), a.v[h]); return r; }
HWY_INLINE I64 operator+(I64 a, I64 b) { I64 r; for (int h = 0; h < kHalves; ++h) r.v[h] = hn::Add(a.v[h], b.v[h]); return r; }
HWY_INLINE I64 operator-(I64 a, I64 b) { I64 r; for (int h = 0; h < kHalves; ++h) r.v[h] = hn::Sub(a.v[h], b.v[h]); return r; }
HWY_INLINE I64 operator&(I64 a, I64 b) { I64 r; for (int h = 0; h < kHalves; ++h) r.v[h] = hn::And(a.v[h], b.v[h]); return r; }
HWY_INLINE I64 operator|(I64 a, I64 b) { I64 r; for (int h = 0; h < kHalves; ++h) r.v[h] = hn::Or(a.v[h], b.v[h]); return r; }
template <int kBits> HWY_INLINE I64 shift_left(I64 a) {
  I64 r;
  for (int h = 0; h < kHalves; ++h) r.v[h] = hn::ShiftLeft<kBits>(a.v[h]);
  return r;
}
template <int kBits> HWY_INLINE I64 shift_right_logical(I64 a) {
  const hn::RebindToUnsigned<DDI> du;
  I64 r;
  for (int h = 0; h < kHalves; ++h) r.v[h] = hn::BitCast(DDI(), hn::ShiftRight<kBits>(hn::BitCast(du, a.v[h])));
  return r;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_LANES64_INL_H_
