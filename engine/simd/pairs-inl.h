// Two times eight float lanes in one vector, where a vector has sixteen: two rays against eight boxes. Included like simd/lanes-inl.h.
#if defined(SPANRAY_PAIRS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_PAIRS_INL_H_
#undef SPANRAY_PAIRS_INL_H_
#else
#define SPANRAY_PAIRS_INL_H_
#endif

#include "simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

#if HWY_TARGET == HWY_AVX3
inline constexpr bool kHasPairs = true;
// Eight floats in the lower half, and again in the upper one.
HWY_INLINE F32 twice(const float* p) { return {hn::Vec<DF>{_mm512_broadcast_f32x8(_mm256_loadu_ps(p))}}; }
// a in the lower half, b in the upper one.
HWY_INLINE F32 halves(const float& a, const float& b) {
  return {hn::Vec<DF>{_mm512_mask_broadcastss_ps(_mm512_set1_ps(a), 0xff00, _mm_load_ss(&b))}};
}
#else  // nobody asks
inline constexpr bool kHasPairs = false;
HWY_INLINE F32 twice(const float* p) { return f32(*p); }
HWY_INLINE F32 halves(const float& a, const float&) { return f32(a); }
#endif

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_PAIRS_INL_H_
