// Trigonometry in double without libm: the second half of elementary.h.
#include <cmath>
#include <cstdint>
#include <limits>

#include "math/elementary.h"

namespace spanray {
namespace {

// pi / 2 in three pieces of 33 bits (k times a piece is exact for |k| < 2^20) and the rest.
constexpr double kHalfPi[4] = {0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2e0p-69, 0x1.b839a252049c1p-104};

// hi + lo = a - b exactly (Knuth's TwoSum).
void two_difference(double a, double b, double* hi, double* lo) {
  const double s = a - b;
  const double bb = a - s;
  const double aa = s + bb;
  *hi = s;
  *lo = (a - aa) + (bb - b);
}

// Taylor: sin(x) = x + x^3 (kSine[0] + kSine[1] x^2 + ...), cos(x) = 1 - x^2 / 2 + x^4 (kCosine[0] + ...).
constexpr double kSine[] = {-1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880, -1.0 / 39916800, 1.0 / 6227020800.0,
                            -1.0 / 1307674368000.0, 1.0 / 355687428096000.0, -1.0 / 121645100408832000.0};
constexpr double kCosine[] = {1.0 / 24, -1.0 / 720, 1.0 / 40320, -1.0 / 3628800, 1.0 / 479001600, -1.0 / 87178291200.0,
                              1.0 / 20922789888000.0, -1.0 / 6402373705728000.0};

template <int n> double polynomial(const double (&coefficient)[n], double z) {
  double p = coefficient[n - 1];
  for (int i = n - 2; i >= 0; --i) p = p * z + coefficient[i];
  return p;
}

// atan(y / x) for 0 <= y <= x, x > 0, both far from overflow and underflow.
// Source: atan(q) = atan(c) + atan((q - c) / (1 + q c)), c the nearest multiple of 1/8; |(q - c) / (1 + q c)| <= 1/16, where the
// Taylor series to t^13 leaves 2^-63.
double atan_octant(double y, double x) {
  static constexpr double kAtan[] = {0,                  0.12435499454676144, 0.24497866312686414, 0.35877067027057225, 0.4636476090008061,
                                     0.5585993153435624, 0.6435011087932844,  0.7188299996216245,  0.7853981633974483};  // of i / 8
  static constexpr double kSeries[] = {-1.0 / 3, 1.0 / 5, -1.0 / 7, 1.0 / 9, -1.0 / 11, 1.0 / 13};
  const double eighth = std::floor(y / x * 8 + 0.5), c = eighth * 0.125;
  const double t = (y - c * x) / (x + c * y), z = t * t;
  return kAtan[static_cast<int>(eighth)] + (t + t * z * polynomial(kSeries, z));
}

}  // namespace

// Source: Cody and Waite 1980, "Software Manual for the Elementary Functions", ch. 8; the Taylor series to x^19 and x^18 leave
// less than 2^-60 on |x| <= pi / 4.
void sin_cos(double x, double* sine, double* cosine) {
  if (!(std::fabs(x) <= 1e6)) {
    *sine = *cosine = std::numeric_limits<double>::quiet_NaN();
    return;
  }
  const double k = std::floor(x * (2.0 / kPi) + 0.5);
  double hi, lo, lo2;
  two_difference(x - k * kHalfPi[0], k * kHalfPi[1], &hi, &lo);
  two_difference(hi, k * kHalfPi[2], &hi, &lo2);
  lo += lo2 - k * kHalfPi[3];

  const double z = hi * hi;
  const double sin_r = hi + (hi * z * polynomial(kSine, z) + lo * (1.0 - 0.5 * z));
  const double half = 0.5 * z, one = 1.0 - half;
  const double cos_r = one + (((1.0 - one) - half) + (z * z * polynomial(kCosine, z) - hi * lo));
  switch (static_cast<int64_t>(k) & 3) {
    case 0: *sine = sin_r, *cosine = cos_r; break;
    case 1: *sine = cos_r, *cosine = -sin_r; break;
    case 2: *sine = -sin_r, *cosine = -cos_r; break;
    default: *sine = -cos_r, *cosine = sin_r; break;
  }
}

double tan_(double x) {
  double sine, cosine;
  sin_cos(x, &sine, &cosine);
  return sine / cosine;
}

double atan2_(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return std::numeric_limits<double>::quiet_NaN();
  double ax = std::fabs(x), ay = std::fabs(y);
  if (std::isinf(ax) || std::isinf(ay)) ax = std::isinf(ax) ? 1 : 0, ay = std::isinf(ay) ? 1 : 0;
  const double largest = ax > ay ? ax : ay;
  if (largest == 0) return 0;
  if (largest > 0x1p1000) ax *= 0x1p-100, ay *= 0x1p-100;
  if (largest < 0x1p-800) ax *= 0x1p300, ay *= 0x1p300;
  double angle = ay <= ax ? atan_octant(ay, ax) : kPi / 2 - atan_octant(ax, ay);
  if (x < 0) angle = kPi - angle;
  return y < 0 ? -angle : angle;
}

double acos_(double x) {
  if (std::isnan(x)) return x;
  const double c = x < -1 ? -1 : x > 1 ? 1 : x;
  return atan2_(std::sqrt((1 - c) * (1 + c)), c);
}

}  // namespace spanray
