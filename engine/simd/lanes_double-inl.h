// Doubles in lanes, and what floats need of them: F64, and the fused multiply-add of machines that have none.
// Included by simd/lanes-inl.h only.
#if defined(SPANRAY_LANES_DOUBLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_LANES_DOUBLE_INL_H_
#undef SPANRAY_LANES_DOUBLE_INL_H_
#else
#define SPANRAY_LANES_DOUBLE_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// kLanes doubles, as kHalves vectors; lane i of F32 corresponds to lane i of F64.
struct F64 {
  hn::Vec<DD> v[kHalves];
  static HWY_INLINE F64 load(const double* p) {
    F64 r;
    for (int h = 0; h < kHalves; ++h) r.v[h] = hn::LoadU(DD(), p + h * (kLanes / kHalves));
    return r;
  }
  HWY_INLINE void store(double* p) const {
    for (int h = 0; h < kHalves; ++h) hn::StoreU(v[h], DD(), p + h * (kLanes / kHalves));
  }
};
HWY_INLINE F64 f64(double x) {
  F64 r;
  for (int h = 0; h < kHalves; ++h) r.v[h] = hn::Set(DD(), x);
  return r;
}

HWY_INLINE F64 operator+(F64 a, F64 b) { F64 r; for (int h = 0; h < kHalves; ++h) r.v[h] = hn::Add(a.v[h], b.v[h]); return r; }
HWY_INLINE F64 operator-(F64 a, F64 b) { F64 r; for (int h = 0; h < kHalves; ++h) r.v[h] = hn::Sub(a.v[h], b.v[h]); return r; }
HWY_INLINE F64 operator*(F64 a, F64 b) { F64 r; for (int h = 0; h < kHalves; ++h) r.v[h] = hn::Mul(a.v[h], b.v[h]); return r; }
HWY_INLINE F64 operator/(F64 a, F64 b) { F64 r; for (int h = 0; h < kHalves; ++h) r.v[h] = hn::Div(a.v[h], b.v[h]); return r; }
HWY_INLINE F64 sqrt_(F64 a) { F64 r; for (int h = 0; h < kHalves; ++h) r.v[h] = hn::Sqrt(a.v[h]); return r; }
HWY_INLINE F64 abs_(F64 a) { F64 r; for (int h = 0; h < kHalves; ++h) r.v[h] = hn::Abs(a.v[h]); return r; }
HWY_INLINE F64 operator-(F64 a) { F64 r; for (int h = 0; h < kHalves; ++h) r.v[h] = hn::Xor(a.v[h], hn::Set(DD(), -0.0)); return r; }
// a < b ? yes : no, lane by lane (NaN: no).
HWY_INLINE F64 select_lt(F64 a, F64 b, F64 yes, F64 no) {
  F64 r;
  for (int h = 0; h < kHalves; ++h) r.v[h] = hn::IfThenElse(hn::Lt(a.v[h], b.v[h]), yes.v[h], no.v[h]);
  return r;
}
HWY_INLINE F64 select_eq(F64 a, F64 b, F64 yes, F64 no) {
  F64 r;
  for (int h = 0; h < kHalves; ++h) r.v[h] = hn::IfThenElse(hn::Eq(a.v[h], b.v[h]), yes.v[h], no.v[h]);
  return r;
}
HWY_INLINE F64 select(Mask m, F64 yes, F64 no) {
  F64 r;
#if HWY_TARGET == HWY_SCALAR
  r.v[0] = any(m) ? yes.v[0] : no.v[0];
#else
  const auto bits = hn::VecFromMask(DI(), hn::RebindMask(DI(), m.m));
  r.v[0] = hn::IfThenElse(hn::MaskFromVec(hn::BitCast(DD(), hn::PromoteTo(DDI(), hn::LowerHalf(DHI(), bits)))), yes.v[0], no.v[0]);
  r.v[1] = hn::IfThenElse(hn::MaskFromVec(hn::BitCast(DD(), hn::PromoteTo(DDI(), hn::UpperHalf(DHI(), bits)))), yes.v[1], no.v[1]);
#endif
  return r;
}
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR
HWY_INLINE F64 min_(F64 a, F64 b) { F64 r; for (int h = 0; h < kHalves; ++h) r.v[h] = hn::Min(a.v[h], b.v[h]); return r; }
HWY_INLINE F64 max_(F64 a, F64 b) { F64 r; for (int h = 0; h < kHalves; ++h) r.v[h] = hn::Max(a.v[h], b.v[h]); return r; }
#else
HWY_INLINE F64 min_(F64 a, F64 b) { return select_lt(a, b, a, b); }
HWY_INLINE F64 max_(F64 a, F64 b) { return select_lt(b, a, a, b); }
#endif

// Half: the tag of half a vector of V.
template <class Half, class V> HWY_INLINE F64 promote(V v) {
  F64 r;
#if HWY_TARGET == HWY_SCALAR
  r.v[0] = hn::PromoteTo(DD(), v);
#else
  r.v[0] = hn::PromoteTo(DD(), hn::LowerHalf(Half(), v));
  r.v[1] = hn::PromoteTo(DD(), hn::UpperHalf(Half(), v));
#endif
  return r;
}
HWY_INLINE F64 to_f64(F32 a) { return promote<DHF>(a.v); }
HWY_INLINE F64 to_f64(I32 a) { return promote<DHI>(a.v); }  // exact
HWY_INLINE F32 to_f32(F64 a) {  // round to nearest even; overflow to infinity
#if HWY_TARGET == HWY_SCALAR
  return {hn::Set(DF(), static_cast<float>(hn::GetLane(a.v[0])))};  // Highway's scalar DemoteTo saturates instead
#else
  return {hn::Combine(DF(), hn::DemoteTo(DHF(), a.v[1]), hn::DemoteTo(DHF(), a.v[0]))};
#endif
}
// Truncates toward zero; saturates to +-2147483647; NaN -> -2147483647.
HWY_INLINE I32 to_i32(F64 a) {
  const F64 c = min_(max_(a, f64(-2147483647.0)), f64(2147483647.0));
#if HWY_TARGET == HWY_SCALAR
  return {hn::DemoteTo(DI(), c.v[0])};
#else
  return {hn::Combine(DI(), hn::DemoteTo(DHI(), c.v[1]), hn::DemoteTo(DHI(), c.v[0]))};
#endif
}
// Smallest integer >= a, for |a| < 2^31 - 1; saturates as to_i32.
HWY_INLINE I32 ceil_i32(F64 a) {
  const F64 t = to_f64(to_i32(a));
  return to_i32(select_lt(t, a, t + f64(1.0), t));
}
// Nearest integer, halves to even, for |a| < 2^31; anything for others. The sum's last place is worth 1: it rounds there.
HWY_INLINE I32 nearest_i32_small(F64 a) {
  const F64 sum = a + f64(6755399441055744.0);  // 1.5 * 2^52
#if HWY_TARGET == HWY_SCALAR
  return {hn::Set(DI(), static_cast<int32_t>(hn::GetLane(hn::BitCast(DDI(), sum.v[0]))))};
#else
  return {hn::ConcatEven(DI(), hn::BitCast(DI(), sum.v[1]), hn::BitCast(DI(), sum.v[0]))};
#endif
}
// Nearest integer, halves up; saturates as to_i32, NaN -> -2147483646. No double rounding: a - floor(a) is exact or above 1/2.
HWY_INLINE I32 round_i32(F64 a) {
  const F64 t = to_f64(to_i32(a));
  const F64 floor = select_lt(a, t, t - f64(1.0), t);
  return to_i32(select_lt(a - floor, f64(0.5), floor, floor + f64(1.0)));
}
// Bit i: a < b in lane i.
HWY_INLINE uint32_t bits_less(F64 a, F64 b) {
  constexpr int kPart = kLanes / kHalves;
  uint32_t bits = 0;
  for (int h = 0; h < kHalves; ++h) {
    uint8_t bytes[8];
    hn::StoreMaskBits(DD(), hn::Lt(a.v[h], b.v[h]), bytes);
    bits |= (bytes[0] & ((1u << kPart) - 1)) << (h * kPart);
  }
  return bits;
}
HWY_INLINE Mask operator<(F64 a, F64 b) { return to_f32(select_lt(a, b, f64(1.0), f64(0.0))) > F32::zero(); }
HWY_INLINE Mask operator>(F64 a, F64 b) { return b < a; }
HWY_INLINE Mask operator==(F64 a, F64 b) { return to_f32(select_eq(a, b, f64(1.0), f64(0.0))) > F32::zero(); }

// base[index], as gather of floats.
HWY_INLINE F64 gather(const double* base, I32 index) {
  F64 r;
#if HWY_TARGET == HWY_SCALAR
  r.v[0] = hn::Set(DD(), base[hn::GetLane(index.v)]);
#else
  const DDI di;
  r.v[0] = hn::GatherIndex(DD(), base, hn::PromoteTo(di, hn::LowerHalf(DHI(), index.v)));
  r.v[1] = hn::GatherIndex(DD(), base, hn::PromoteTo(di, hn::UpperHalf(DHI(), index.v)));
#endif
  return r;
}

// ---- fused multiply-add ----------------------------------------------------------------------------------------------
// a * b + c with one rounding, on every target. Where the machine has no fma: the product is exact in double, the sum is
// rounded to odd, and rounding that to float is then correct (Boldo and Melquiond 2008, "Emulation of FMA and
// Correctly Rounded Sums: Proved Algorithms Using Rounding to Odd").
#if HWY_NATIVE_FMA
HWY_INLINE F32 mul_add(F32 a, F32 b, F32 c) { return {hn::MulAdd(a.v, b.v, c.v)}; }
#else
HWY_INLINE F32 mul_add(F32 a, F32 b, F32 c) {
  const F64 p = to_f64(a) * to_f64(b);
  const F64 cd = to_f64(c);
  const F64 s = p + cd;
  const F64 bb = s - p;
  const F64 error = (p - (s - bb)) + (cd - bb);  // TwoSum: s + error = p + c exactly; NaN where s is not finite
  F64 odd;
  for (int h = 0; h < kHalves; ++h) {
    const DD d;
    const DDI di;
    const auto bits = hn::BitCast(di, s.v[h]);
    const auto zero = hn::Zero(d);
    // Inexact: the error is an ordered nonzero. Infinite or NaN sums have a NaN error and stay as they are.
    const auto inexact = hn::Or(hn::Lt(error.v[h], zero), hn::Gt(error.v[h], zero));
    const auto even = hn::Eq(hn::And(bits, hn::Set(di, 1)), hn::Zero(di));
    // Toward the error: away from zero in the bits if the signs agree, else toward zero.
    const auto same_sign = hn::Gt(hn::Mul(hn::CopySign(hn::Set(d, 1.0), error.v[h]), hn::CopySign(hn::Set(d, 1.0), s.v[h])), zero);
    const auto step = hn::IfThenElse(hn::RebindMask(di, same_sign), hn::Set(di, 1), hn::Set(di, -1));
    const auto moved = hn::Add(bits, step);
    const auto use = hn::And(hn::RebindMask(di, inexact), even);
    odd.v[h] = hn::BitCast(d, hn::IfThenElse(use, moved, bits));
  }
  return to_f32(odd);
}
#endif
// c - a * b with one rounding.
HWY_INLINE F32 neg_mul_add(F32 a, F32 b, F32 c) { return mul_add(-a, b, c); }

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_LANES_DOUBLE_INL_H_
