// exp2, log2 and pow for lanes: the same bits on every target, no libm. The first two are computed in double, so that a float result is
// off by hardly more than its own rounding; no stage asks for them now, they stand for formulas to come. Include after
// simd/lanes-inl.h's own includes, inside a *_kernel.cpp (simd/dispatch.h).
#if defined(SPANRAY_ELEMENTARY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_ELEMENTARY_INL_H_
#undef SPANRAY_ELEMENTARY_INL_H_
#else
#define SPANRAY_ELEMENTARY_INL_H_
#endif

#include "simd/lanes64-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// log2 of positive normal doubles. Relative error <= 2^-44.8.
// Source:   x = 2^k m, m in [sqrt(1/2), sqrt(2)); log2(m) = s P(s^2), s = (m - 1) / (m + 1) (the series of atanh, as in
//           Tang 1990); P by our own Remez iteration, relative error 2^-45.1.
// Contract: exactly 0 for x = 1, and no cancellation around it.
HWY_INLINE F64 log2_normal(F64 x) {
  const int64_t sqrt_half = 0x3fe6a09e667f3bcd, bias = int64_t{1023} << 52;
  const I64 bits = bits_of(x);
  // Biased exponent of x / sqrt(1/2): positive for every float, so that a logical shift will do.
  const I64 exponent = shift_right_logical<52>(bits - i64(sqrt_half - bias));
  const F64 m = double_from_bits(bits - shift_left<52>(exponent) + i64(bias));
  // 2^52 + exponent, written as bits, is that very double: the conversion from integer, exact.
  const F64 k = double_from_bits(exponent | i64(0x4330000000000000)) - f64(4503599627370496.0 + 1023.0);
  const F64 s = (m - f64(1.0)) / (m + f64(1.0));
  const F64 z = s * s;
  F64 p = f64(0x1.21b0eab01337fp-2);
  p = p * z + f64(0x1.4795562fb9504p-2);
  p = p * z + f64(0x1.a61a2ec9f9af8p-2);
  p = p * z + f64(0x1.2776c2933e31cp-1);
  p = p * z + f64(0x1.ec709dc53c678p-1);
  p = p * z + f64(0x1.71547652b8251p+1);
  return k + s * p;
}

// 2^x for |x| <= 1000. Relative error <= 2^-40.2.
// Source:   x = k + r, |r| <= 1/2; 2^r by a polynomial of degree 8 from our own Remez iteration; 2^k in the exponent bits.
HWY_INLINE F64 exp2_bounded(F64 x) {
  const F64 shifter = f64(6755399441055744.0);  // 1.5 * 2^52: adding it rounds to an integer, left in the low bits
  const F64 shifted = x + shifter;
  const F64 r = x - (shifted - shifter);
  F64 p = f64(0x1.61afcad90244fp-20);
  p = p * r + f64(0x1.00dad2179cca2p-16);
  p = p * r + f64(0x1.430acca6a0d3ep-13);
  p = p * r + f64(0x1.5d874838b75e2p-10);
  p = p * r + f64(0x1.3b2ab5c5279d6p-7);
  p = p * r + f64(0x1.c6b08dd46cdf1p-5);
  p = p * r + f64(0x1.ebfbdff9319eap-3);
  p = p * r + f64(0x1.62e42fef86160p-1);
  p = p * r + f64(0x1.ffffffffff7a3p-1);
  return double_from_bits(bits_of(p) + shift_left<52>(bits_of(shifted)));
}

// To [-200, 200], beyond which every float result is 0 or infinity; NaN -> -200.
HWY_INLINE F64 clamp_exponent(F64 x) { return min_(max_(x, f64(-200.0)), f64(200.0)); }

// 2^x. Input: any. Error <= 0.5001 ulp, subnormal results included; 0 below -150, infinity from 128; NaN -> 0.
HWY_INLINE F32 exp2_(F32 x) { return to_f32(exp2_bounded(clamp_exponent(to_f64(x)))); }

// Base-2 logarithm. Input: any. Error <= 0.5001 ulp; +-0 -> -infinity; +infinity -> +infinity; negative or NaN -> NaN.
HWY_INLINE F32 log2_(F32 x) {
  const F32 infinity = float_from_bits(i32(0x7f800000));
  F32 r = to_f32(log2_normal(to_f64(x)));
  r = select(x == infinity, x, r);
  r = select(x == F32::zero(), -infinity, r);
  return select(x >= F32::zero(), r, float_from_bits(i32(0x7fc00000)));
}

// 2^(exponent (log2(base) - octaves_less)), the exponent of 2 held in [-200, 200], of a positive normal base: the core of pow_, in float.
// Source:   log2(1 + f) = f P(f), P of degree 8, relative error 2^-25.2; 2^r, |r| <= 1/2, by degree 6, relative error 2^-29: both by our
//           own Remez iteration. The logarithm is accurate to a few ulp near base = 1 too, where highlights are.
HWY_INLINE F32 pow_of_normal(F32 base, I32 octaves_less, F32 exponent) {
  const I32 bits = bits_of(base);
  const I32 octave = shift_right<23>(bits - i32(0x3f3504f3));  // of base / sqrt(1/2)
  const F32 f = float_from_bits(bits - shift_left<23>(octave)) - f32(1.0f);
  const auto line = [](float a, float b, F32 x) HWY_ATTR { return mul_add(f32(a), x, f32(b)); };
  // Pairs of terms (Estrin 1960): what waits for what is half as long as one after the other.
  const F32 f2 = f * f, f4 = f2 * f2;
  const F32 low = mul_add(line(-0x1.715c4ep-2f, 0x1.ec73d6p-2f, f), f2, line(-0x1.715470p-1f, 0x1.715476p+0f, f));
  const F32 high = mul_add(line(-0x1.a87d0ap-3f, 0x1.b9c91ap-3f, f), f2, line(-0x1.e95be6p-3f, 0x1.26d384p-2f, f));
  const F32 p = mul_add(mul_add(f32(0x1.01b6dap-3f), f4, high), f4, low);
  const F32 log2 = mul_add(p, f, to_f32(octave - octaves_less));

  const F32 x = min_(max_(log2 * exponent, f32(-200.0f)), f32(200.0f));  // NaN -> -200
  const I32 whole = nearest_i32_small(x), half = shift_right<1>(whole);
  const F32 r = x - to_f32(whole);
  const F32 r2 = r * r;
  const F32 end = mul_add(f32(0x1.41d332p-13f), r2, line(0x1.5f456ap-10f, 0x1.3b2dbcp-7f, r));
  const F32 fraction = mul_add(end, r2 * r2, mul_add(line(0x1.c6aed4p-5f, 0x1.ebfbdap-3f, r), r2, line(0x1.62e430p-1f, 1.0f, r)));
  // Two powers of two, both normal: the second product rounds once, to a subnormal number or to infinity.
  const auto power_of_two = [](I32 n) HWY_ATTR { return float_from_bits(shift_left<23>(n + i32(127))); };
  return fraction * power_of_two(half) * power_of_two(whole - half);
}

// base^exponent, in float. Input: base >= 0, any exponent. With r the result,
// error <= 2.5 (1 + |log2(r)|) ulp of the exact result, gradual underflow included.
// Contract: pow(x, 0) = 1 for every x, also 0; pow(0, n > 0) = 0; pow(0, n < 0) = infinity; pow(1, n) = 1; never NaN.
//           A base that is negative or NaN counts as 0, an infinite one as 2^128. A NaN exponent, or an infinite one of
//           base 1, gives 0.
HWY_INLINE F32 pow_(F32 base, F32 exponent) {
  const F32 zero = F32::zero(), one = f32(1.0f), infinity = float_from_bits(i32(0x7f800000));
  const Mask subnormal = base < f32(0x1p-126f);
  const F32 power = pow_of_normal(select(subnormal, base * f32(0x1p24f), base), select(subnormal, i32(24), i32(0)), exponent);
  const F32 positive = select(base > zero, power, select(exponent < zero, infinity, zero));
  return select(exponent == zero, one, positive);
}

// pow_ for highlights, where it costs most: base in [0, 1], exponent in [0, 1e4]. The same bits but for a base below 2^-126, which counts as
// that, and base 0, which gives 0 also for exponent 0.
HWY_INLINE F32 highlight_pow_(F32 base, F32 exponent) {
  return select(base > F32::zero(), pow_of_normal(max_(base, f32(0x1p-126f)), I32::zero(), exponent), F32::zero());
}

// base^exponent for highlights, with fewer terms and no special cases. Input: base in [0, 1], exponent in [0, 1e4].
// Relative error <= 2^-9.1 (1 + |log2(r)| / 7) of results r >= 2^-64; what is smaller gives at most 2^-63.
// Source:   as pow_; P of degree 3, relative error 2^-11.4; 2^r by degree 2, relative error 2^-9.1.
// Contract: the error of the logarithm is relative: an absolute one, as of reading it from the bits of the base, would be
//           magnified by the exponent, near base = 1 too, where highlights are. pow(1, n) and pow(x, 0) err like all others; a
//           base below 2^-126, and 0, counts as about 2^-127. No result is subnormal, nor any product of one with what a
//           highlight is multiplied by: those cost more than the whole power.
HWY_INLINE F32 fast_pow_(F32 base, F32 exponent) {
  const F32 one = f32(1.0f);
  const I32 bits = bits_of(base), octave = shift_right<23>(bits - i32(0x3f3504f3));  // of base / sqrt(1/2)
  const F32 f = float_from_bits(bits - shift_left<23>(octave)) - one, f2 = f * f;
  const auto line = [](float a, float b, F32 x) HWY_ATTR { return mul_add(f32(a), x, f32(b)); };
  const F32 p = mul_add(line(-0x1.4fa324p-2f, 0x1.05c58ap-1f, f), f2, line(-0x1.72d70cp-1f, 0x1.7138a2p+0f, f));
  const F32 x = max_(mul_add(p, f, to_f32(octave)) * exponent, f32(-64.0f));
  const I32 whole = nearest_i32_small(x);
  const F32 r = x - to_f32(whole);
  const F32 fraction = mul_add(line(0x1.e84d6ep-3f, 0x1.682a56p-1f, r), r, f32(0x1.001d0ap+0f));
  return fraction * float_from_bits(shift_left<23>(whole + i32(127)));
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_ELEMENTARY_INL_H_
