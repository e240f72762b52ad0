// Lane value types over Google Highway: F32, I32 and Mask here, F64 in simd/lanes_double-inl.h. kLanes lanes each: 16 (AVX-512), 8
// (AVX2), 4 (SSE4), 1 (scalar). Included once per target, inside a *_kernel.cpp (see simd/dispatch.h). Every operation gives the same bits on
// every target: min, max, rounding, conversion and fused multiply-add are our own (docs/decisions/0001-lanes.md).
#if defined(SPANRAY_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_LANES_INL_H_
#undef SPANRAY_LANES_INL_H_
#else
#define SPANRAY_LANES_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<DF>;
#if HWY_TARGET == HWY_SCALAR
using DD = hn::Rebind<double, DF>;  // one lane either way
using DHF = DF;
#else
using DD = hn::Repartition<double, DF>;  // half as many lanes: F64 holds two vectors
using DHF = hn::Half<DF>;
#endif
using DDI = hn::RebindToSigned<DD>;
using DHI = hn::RebindToSigned<DHF>;
inline constexpr int kLanes = static_cast<int>(HWY_LANES(float));
inline constexpr int kHalves = HWY_TARGET == HWY_SCALAR ? 1 : 2;

struct Mask { hn::Mask<DF> m; };
struct F32 {
  hn::Vec<DF> v;
  static HWY_INLINE F32 load(const float* p) { return {hn::LoadU(DF(), p)}; }
  static HWY_INLINE F32 zero() { return {hn::Zero(DF())}; }
  HWY_INLINE void store(float* p) const { hn::StoreU(v, DF(), p); }
};
struct I32 {
  hn::Vec<DI> v;
  static HWY_INLINE I32 load(const int32_t* p) { return {hn::LoadU(DI(), p)}; }
  static HWY_INLINE I32 load(const uint32_t* p) { return load(reinterpret_cast<const int32_t*>(p)); }
  static HWY_INLINE I32 zero() { return {hn::Zero(DI())}; }
  HWY_INLINE void store(int32_t* p) const { hn::StoreU(v, DI(), p); }
  HWY_INLINE void store(uint32_t* p) const { store(reinterpret_cast<int32_t*>(p)); }
};
// ---- construction --------------------------------------------------------------------------------------------------
HWY_INLINE F32 f32(float x) { return {hn::Set(DF(), x)}; }
HWY_INLINE I32 i32(int32_t x) { return {hn::Set(DI(), x)}; }
HWY_INLINE I32 i32(uint32_t x) { return {hn::Set(DI(), static_cast<int32_t>(x))}; }
HWY_INLINE float min_of_lanes(F32 a) { return hn::GetLane(hn::MinOfLanes(DF(), a.v)); }  // no NaN
HWY_INLINE int32_t min_of_lanes(I32 a) { return hn::GetLane(hn::MinOfLanes(DI(), a.v)); }
HWY_INLINE int32_t first_lane(I32 a) { return hn::GetLane(a.v); }
// first, first + 1, ... Not Highway's Iota: it (1.0.3) writes the lanes one by one and reads them back as a vector, which stalls.
HWY_INLINE I32 lane_iota(int32_t first = 0) {
  alignas(64) static constexpr int32_t kLane[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  return {hn::Add(hn::Load(DI(), kLane), hn::Set(DI(), first))};
}

// ---- bits ----------------------------------------------------------------------------------------------------------
HWY_INLINE I32 bits_of(F32 a) { return {hn::BitCast(DI(), a.v)}; }
HWY_INLINE F32 float_from_bits(I32 a) { return {hn::BitCast(DF(), a.v)}; }

// ---- float arithmetic: exactly one IEEE operation each ---------------------------------------------------------------
HWY_INLINE F32 operator+(F32 a, F32 b) { return {hn::Add(a.v, b.v)}; }
HWY_INLINE F32 operator-(F32 a, F32 b) { return {hn::Sub(a.v, b.v)}; }
HWY_INLINE F32 operator*(F32 a, F32 b) { return {hn::Mul(a.v, b.v)}; }
HWY_INLINE F32 operator/(F32 a, F32 b) { return {hn::Div(a.v, b.v)}; }
HWY_INLINE F32 operator-(F32 a) { return {hn::Xor(a.v, hn::Set(DF(), -0.0f))}; }
HWY_INLINE F32& operator+=(F32& a, F32 b) { return a = a + b; }
HWY_INLINE F32 abs_(F32 a) { return {hn::And(a.v, hn::BitCast(DF(), hn::Set(DI(), 0x7fffffff)))}; }
HWY_INLINE F32 sqrt_(F32 a) { return {hn::Sqrt(a.v)}; }
// Magnitude of a, sign of b.
HWY_INLINE F32 copysign_(F32 a, F32 b) {
  const auto sign = hn::Set(DF(), -0.0f);
  return {hn::Or(hn::AndNot(sign, a.v), hn::And(sign, b.v))};
}

HWY_INLINE Mask operator<(F32 a, F32 b) { return {hn::Lt(a.v, b.v)}; }
HWY_INLINE Mask operator<=(F32 a, F32 b) { return {hn::Le(a.v, b.v)}; }
HWY_INLINE Mask operator>(F32 a, F32 b) { return {hn::Gt(a.v, b.v)}; }
HWY_INLINE Mask operator>=(F32 a, F32 b) { return {hn::Ge(a.v, b.v)}; }
HWY_INLINE Mask operator==(F32 a, F32 b) { return {hn::Eq(a.v, b.v)}; }

// ---- masks ---------------------------------------------------------------------------------------------------------
HWY_INLINE Mask operator&(Mask a, Mask b) { return {hn::And(a.m, b.m)}; }
HWY_INLINE Mask operator|(Mask a, Mask b) { return {hn::Or(a.m, b.m)}; }
HWY_INLINE Mask operator!(Mask a) { return {hn::Not(a.m)}; }
HWY_INLINE Mask and_not(Mask a, Mask b) { return {hn::AndNot(a.m, b.m)}; }  // !a & b
HWY_INLINE bool any(Mask a) { return !hn::AllFalse(DF(), a.m); }
HWY_INLINE bool all(Mask a) { return hn::AllTrue(DF(), a.m); }
HWY_INLINE int count(Mask a) { return static_cast<int>(hn::CountTrue(DF(), a.m)); }
// Bit i is lane i; bits past kLanes are 0, and ignored by mask_from_bits.
HWY_INLINE uint32_t to_bits(Mask a) {
  alignas(16) uint8_t bytes[16];
  hn::StoreMaskBits(DF(), a.m, bytes);
  uint32_t bits = 0;
  std::memcpy(&bits, bytes, (kLanes + 7) / 8);  // just what was stored: a wider load would wait for it to reach memory
  return bits & ((1u << kLanes) - 1);
}
HWY_INLINE Mask mask_from_bits(uint32_t bits) {
  alignas(16) uint8_t bytes[16] = {};
  std::memcpy(bytes, &bits, 4);
  return {hn::LoadMaskBits(DF(), bytes)};
}
// The first n lanes; none for n <= 0, all from kLanes up.
HWY_INLINE Mask first_lanes(int n) { return {hn::FirstN(DF(), n < 0 ? 0 : n < kLanes ? static_cast<size_t>(n) : size_t{kLanes})}; }

HWY_INLINE F32 select(Mask m, F32 yes, F32 no) { return {hn::IfThenElse(m.m, yes.v, no.v)}; }
HWY_INLINE I32 select(Mask m, I32 yes, I32 no) { return {hn::IfThenElse(hn::RebindMask(DI(), m.m), yes.v, no.v)}; }

// b if a is NaN, and b if both are zeros: the x86 rule. There it is one instruction; elsewhere it is written out.
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR
HWY_INLINE F32 min_(F32 a, F32 b) { return {hn::Min(a.v, b.v)}; }
HWY_INLINE F32 max_(F32 a, F32 b) { return {hn::Max(a.v, b.v)}; }
#else
HWY_INLINE F32 min_(F32 a, F32 b) { return select(a < b, a, b); }
HWY_INLINE F32 max_(F32 a, F32 b) { return select(a > b, a, b); }
#endif
HWY_INLINE F32 clamp_(F32 x, F32 low, F32 high) { return min_(max_(x, low), high); }  // NaN -> low

// ---- integers (two's complement, wrapping) -----------------------------------------------------------------------------
HWY_INLINE I32 operator+(I32 a, I32 b) { return {hn::Add(a.v, b.v)}; }
HWY_INLINE I32 operator-(I32 a, I32 b) { return {hn::Sub(a.v, b.v)}; }
HWY_INLINE I32 operator*(I32 a, I32 b) { return {hn::Mul(a.v, b.v)}; }
HWY_INLINE I32 operator&(I32 a, I32 b) { return {hn::And(a.v, b.v)}; }
HWY_INLINE I32 operator|(I32 a, I32 b) { return {hn::Or(a.v, b.v)}; }
HWY_INLINE I32 operator^(I32 a, I32 b) { return {hn::Xor(a.v, b.v)}; }
template <int kBits> HWY_INLINE I32 shift_left(I32 a) { return {hn::ShiftLeft<kBits>(a.v)}; }
template <int kBits> HWY_INLINE I32 shift_right(I32 a) { return {hn::ShiftRight<kBits>(a.v)}; }  // arithmetic
template <int kBits> HWY_INLINE I32 shift_right_logical(I32 a) {
  const hn::RebindToUnsigned<DI> du;
  return {hn::BitCast(DI(), hn::ShiftRight<kBits>(hn::BitCast(du, a.v)))};
}
// a >> bits, arithmetic, lane by lane; bits in [0, 31].
HWY_INLINE I32 shift_right_by(I32 a, I32 bits) { return {hn::Shr(a.v, bits.v)}; }
HWY_INLINE Mask operator==(I32 a, I32 b) { return {hn::RebindMask(DF(), hn::Eq(a.v, b.v))}; }
HWY_INLINE Mask operator!=(I32 a, I32 b) { return !(a == b); }
HWY_INLINE Mask operator<(I32 a, I32 b) { return {hn::RebindMask(DF(), hn::Lt(a.v, b.v))}; }
// table[index] for a table of kLanes words.
HWY_INLINE I32 lookup(const uint32_t* table, I32 index) {
  const I32 words = {hn::LoadU(DI(), reinterpret_cast<const int32_t*>(table))};
  return {hn::TableLookupLanes(words.v, hn::IndicesFromVec(DI(), index.v))};
}
#if HWY_TARGET == HWY_AVX3  // Highway 1.0.3 has no permutation of two vectors
inline constexpr bool kHasLookup32 = true;
// The low five bits of `index` choose among the lanes of `low`, then those of `high`.
HWY_INLINE F32 lookup32(F32 low, F32 high, I32 index) { return {hn::Vec<DF>{_mm512_permutex2var_ps(low.v.raw, index.v.raw, high.v.raw)}}; }
#else
inline constexpr bool kHasLookup32 = false;
HWY_INLINE F32 lookup32(F32 low, F32, I32) { return low; }  // nobody asks
#endif
// The words as unsigned numbers: the smaller, and a < b.
HWY_INLINE I32 min_unsigned(I32 a, I32 b) {
  const hn::RebindToUnsigned<DI> du;
  return {hn::BitCast(DI(), hn::Min(hn::BitCast(du, a.v), hn::BitCast(du, b.v)))};
}
HWY_INLINE Mask less_unsigned(I32 a, I32 b) {
  const hn::RebindToUnsigned<DI> du;
  return {hn::RebindMask(DF(), hn::Lt(hn::BitCast(du, a.v), hn::BitCast(du, b.v)))};
}
HWY_INLINE Mask operator>(I32 a, I32 b) { return {hn::RebindMask(DF(), hn::Gt(a.v, b.v))}; }
HWY_INLINE I32 min_(I32 a, I32 b) { return {hn::Min(a.v, b.v)}; }
HWY_INLINE I32 max_(I32 a, I32 b) { return {hn::Max(a.v, b.v)}; }

// ---- conversion ------------------------------------------------------------------------------------------------------
HWY_INLINE F32 to_f32(I32 a) { return {hn::ConvertTo(DF(), a.v)}; }  // round to nearest even
// Truncates toward zero; saturates to +-2147483520; NaN -> -2147483520.
HWY_INLINE I32 to_i32(F32 a) {
  return {hn::ConvertTo(DI(), clamp_(a, f32(-2147483520.0f), f32(2147483520.0f)).v)};
}
// Truncates toward zero; |a| < 2^31.
HWY_INLINE I32 to_i32_small(F32 a) { return {hn::ConvertTo(DI(), a.v)}; }
// Nearest integer, halves to even; |a| <= 2^22, anything for others. The sum's last place is worth 1: it rounds there.
HWY_INLINE I32 nearest_i32_small(F32 a) { return bits_of(a + f32(12582912.0f)) - i32(0x4b400000); }  // 1.5 * 2^23
// Largest integer <= a; |a| < 2^31.
HWY_INLINE I32 floor_i32_small(F32 a) {
  const I32 t = to_i32_small(a);
  return t - select(to_f32(t) > a, i32(1), i32(0));
}
// Largest integer <= a, for |a| < 2^31; larger magnitudes return a itself; NaN -> NaN; the sign of a zero is +.
HWY_INLINE F32 floor_(F32 a) {
  const F32 t = to_f32(to_i32(a));
  const F32 r = select(t > a, t - f32(1.0f), t);
  return select(abs_(a) < f32(2147483520.0f), r, a);
}
// Nearest integer, halves up (floor(a + 1/2) computed without double rounding), as I32; saturates as to_i32.
HWY_INLINE I32 round_i32(F32 a) {
  const F32 f = floor_(a);
  return to_i32(select(a - f >= f32(0.5f), f + f32(1.0f), f));
}

// ---- memory ------------------------------------------------------------------------------------------------------------
// base[index]: index in elements, any lane may be read: mask bad lanes to a safe index first.
HWY_INLINE F32 gather(const float* base, I32 index) { return {hn::GatherIndex(DF(), base, index.v)}; }
HWY_INLINE I32 gather(const int32_t* base, I32 index) { return {hn::GatherIndex(DI(), base, index.v)}; }
HWY_INLINE I32 gather(const uint32_t* base, I32 index) {
  return gather(reinterpret_cast<const int32_t*>(base), index);
}

// The lanes of `m`, packed, to p[0 .. count(m)); writes a whole vector. Returns count(m).
HWY_INLINE int compress_store(I32 a, Mask m, int32_t* p) {
  hn::StoreU(hn::Compress(a.v, hn::RebindMask(DI(), m.m)), DI(), p);
  return count(m);
}
HWY_INLINE int compress_store(I32 a, Mask m, uint32_t* p) { return compress_store(a, m, reinterpret_cast<int32_t*>(p)); }
HWY_INLINE int compress_store(F32 a, Mask m, float* p) {
  hn::StoreU(hn::Compress(a.v, m.m), DF(), p);
  return count(m);
}

// Lane i of `m` is p[k], where k counts the lanes of m before it; other lanes are anything. Reads a whole vector.
HWY_INLINE I32 expand_load(const uint32_t* p, Mask m) {
#if HWY_TARGET == HWY_AVX3  // Highway 1.0.3 has no Expand
  return {hn::Vec<DI>{_mm512_maskz_expand_epi32(m.m.raw, I32::load(p).v.raw)}};
#else
  alignas(64) int32_t rank[kLanes];
  const uint32_t bits = to_bits(m);
  int32_t before = 0;
  for (int i = 0; i < kLanes; ++i) rank[i] = before, before += static_cast<int32_t>(bits >> i & 1);
  return lookup(p, select(m, I32::load(rank), I32::zero()));
#endif
}

// The two halves of 64-bit word `index` of base, which stand kBytes from one another.
struct WordPair { I32 low, high; };
template <int kBytes> HWY_INLINE WordPair gather_pair(const void* base, I32 index) {
#if HWY_TARGET == HWY_SCALAR
  int32_t p[2];
  std::memcpy(p, static_cast<const char*>(base) + kBytes * static_cast<ptrdiff_t>(hn::GetLane(index.v)), sizeof p);
  return {{hn::Set(DI(), p[0])}, {hn::Set(DI(), p[1])}};
#else
  const int64_t* const words = static_cast<const int64_t*>(base);
  const auto half = [&](auto half_index) HWY_ATTR {
#if HWY_TARGET == HWY_AVX3  // Highway gathers 64-bit words by 64-bit indices: widening them costs as much as a third of the gather
    return hn::BitCast(DI(), hn::Vec<DDI>{_mm512_i32gather_epi64(half_index.raw, words, kBytes)});
#elif HWY_TARGET == HWY_AVX2
    return hn::BitCast(DI(), hn::Vec<DDI>{_mm256_i32gather_epi64(reinterpret_cast<const long long*>(words), half_index.raw, kBytes)});
#else
    constexpr int kShift = kBytes == 8 ? 3 : 1;
    static_assert(kBytes == 1 << kShift);
    return hn::BitCast(DI(), hn::GatherOffset(DDI(), words, hn::ShiftLeft<kShift>(hn::PromoteTo(DDI(), half_index))));
#endif
  };
  const auto a = half(hn::LowerHalf(DHI(), index.v)), b = half(hn::UpperHalf(DHI(), index.v));
  return {{hn::ConcatEven(DI(), b, a)}, {hn::ConcatOdd(DI(), b, a)}};
#endif
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#include "simd/lanes_double-inl.h"

#endif  // SPANRAY_LANES_INL_H_
