// At most eight float lanes, for data that comes in eights (children of a BVH node): kLanes8 is 8 on AVX2 and AVX-512, 4 on SSE4,
// 1 on scalar; loops over eights run in steps of it. Included like simd/lanes-inl.h.
#if defined(SPANRAY_LANES8_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_LANES8_INL_H_
#undef SPANRAY_LANES8_INL_H_
#else
#define SPANRAY_LANES8_INL_H_
#endif

#include <cstdint>

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace hn8 = hwy::HWY_NAMESPACE;

using D8 = hn8::CappedTag<float, 8>;
inline constexpr int kLanes8 = static_cast<int>(HWY_LANES(float) < 8 ? HWY_LANES(float) : 8);

struct Mask8 { hn8::Mask<D8> m; };
struct F8 {
  hn8::Vec<D8> v;
  static HWY_INLINE F8 load(const float* p) { return {hn8::LoadU(D8(), p)}; }
  HWY_INLINE void store(float* p) const { hn8::StoreU(v, D8(), p); }
};
HWY_INLINE F8 f8(float x) { return {hn8::Set(D8(), x)}; }
HWY_INLINE F8 operator+(F8 a, F8 b) { return {hn8::Add(a.v, b.v)}; }
HWY_INLINE F8 operator-(F8 a, F8 b) { return {hn8::Sub(a.v, b.v)}; }
HWY_INLINE F8 operator*(F8 a, F8 b) { return {hn8::Mul(a.v, b.v)}; }
HWY_INLINE F8 operator/(F8 a, F8 b) { return {hn8::Div(a.v, b.v)}; }
HWY_INLINE F8 operator-(F8 a) { return {hn8::Xor(a.v, hn8::Set(D8(), -0.0f))}; }
HWY_INLINE F8 abs_(F8 a) { return {hn8::Abs(a.v)}; }
HWY_INLINE Mask8 operator<(F8 a, F8 b) { return {hn8::Lt(a.v, b.v)}; }
HWY_INLINE Mask8 operator<=(F8 a, F8 b) { return {hn8::Le(a.v, b.v)}; }
HWY_INLINE Mask8 operator>(F8 a, F8 b) { return {hn8::Gt(a.v, b.v)}; }
HWY_INLINE Mask8 operator&(Mask8 a, Mask8 b) { return {hn8::And(a.m, b.m)}; }
HWY_INLINE Mask8 operator|(Mask8 a, Mask8 b) { return {hn8::Or(a.m, b.m)}; }
// The machine's own: b if a is NaN, on every target; either zero if both are zeros. For culling only (DESIGN 3, rule 6).
HWY_INLINE F8 cull_min(F8 a, F8 b) { return {hn8::Min(a.v, b.v)}; }
HWY_INLINE F8 cull_max(F8 a, F8 b) { return {hn8::Max(a.v, b.v)}; }
HWY_INLINE F8 select(Mask8 m, F8 a, F8 b) { return {hn8::IfThenElse(m.m, a.v, b.v)}; }
// One or two roundings, as the machine has it; for culling only.
HWY_INLINE F8 cull_mul_add(F8 a, F8 b, F8 c) { return {hn8::MulAdd(a.v, b.v, c.v)}; }
HWY_INLINE F8 cull_neg_mul_add(F8 a, F8 b, F8 c) { return {hn8::NegMulAdd(a.v, b.v, c.v)}; }
// Bit i tells whether words[i] is x, for eight words.
HWY_INLINE uint32_t words_equal(const uint32_t* words, uint32_t x) {
  const hn8::RebindToUnsigned<D8> du;
  uint32_t bits = 0;
  for (int s = 0; s < 8; s += kLanes8) {
    uint8_t bytes[8];
    hn8::StoreMaskBits(du, hn8::Eq(hn8::LoadU(du, words + s), hn8::Set(du, x)), bytes);
    bits |= (bytes[0] & ((1u << kLanes8) - 1)) << s;
  }
  return bits;
}
// The words of the lanes in m, side by side; up to kLanes8 words are written. Returns how many count.
HWY_INLINE int store_chosen(const uint32_t* words, Mask8 m, uint32_t* out) {
  const hn8::RebindToUnsigned<D8> du;
  hn8::StoreU(hn8::Compress(hn8::LoadU(du, words), hn8::RebindMask(du, m.m)), du, out);
  return static_cast<int>(hn8::CountTrue(D8(), m.m));
}
// Bit i is lane i.
HWY_INLINE uint32_t to_bits(Mask8 a) {
  uint8_t bytes[8];
  hn8::StoreMaskBits(D8(), a.m, bytes);
  return bytes[0] & ((1u << kLanes8) - 1);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_LANES8_INL_H_
