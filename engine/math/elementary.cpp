// Powers and logarithms in double without libm. trigonometry.cpp has the other half of elementary.h.
#include "math/elementary.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace spanray {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

double power_of_two(int k) { return std::bit_cast<double>(static_cast<uint64_t>(k + 1023) << 52); }  // -1022 <= k <= 1023

}  // namespace

// Source: x = k + r, |r| <= 1/2; the Taylor series of 2^r to r^13 leaves 2^-57.
double exp2_(double x) {
  if (std::isnan(x)) return x;
  if (x >= 1024) return kInfinity;
  if (x < -1075) return 0;
  static constexpr double kSeries[] = {6.931471805599453e-1,  2.4022650695910072e-1,  5.550410866482158e-2,  9.618129107628477e-3,
                                       1.3333558146428443e-3, 1.540353039338161e-4,   1.5252733804059841e-5, 1.321548679014431e-6,
                                       1.01780860092397e-7,   7.054911620801123e-9,   4.4455382718708116e-10, 2.5678435993488206e-11,
                                       1.3691488853904128e-12};  // ln(2)^n / n!, n = 1, 2, ...
  const double k = std::floor(x + 0.5), r = x - k;
  double p = 0;
  for (int n = 12; n >= 0; --n) p = p * r + kSeries[n];
  p = 1 + p * r;
  // In two steps, since 2^k itself may be subnormal: the first product is exact.
  const int whole = static_cast<int>(k), half = whole / 2;
  return p * power_of_two(half) * power_of_two(whole - half);
}

// Source: x = 2^k m, m in [sqrt(1/2), sqrt(2)); log2(m) = 2 / ln(2) * atanh(s), s = (m - 1) / (m + 1), |s| <= 0.1716; the series
// to s^21 leaves 2^-60.
double log2_(double x) {
  if (std::isnan(x) || x < 0) return kNotANumber;
  if (x == 0) return -kInfinity;
  if (x == kInfinity) return x;
  int k = 0;
  if (x < 0x1p-1022) x *= 0x1p54, k = -54;
  constexpr uint64_t kSqrtHalf = 0x3fe6a09e667f3bcd, kOne = uint64_t{1023} << 52;
  const uint64_t bits = std::bit_cast<uint64_t>(x);
  const uint64_t exponent = (bits - kSqrtHalf + kOne) >> 52;
  k += static_cast<int>(exponent) - 1023;
  const double m = std::bit_cast<double>(bits - (exponent << 52) + kOne);
  static constexpr double kSeries[] = {2.8853900817779268,  0.9617966939259756,  0.5770780163555853,  0.4121985831111324,
                                       0.3205988979753252,  0.2623081892525388,  0.22195308321368667, 0.19235933878519512,
                                       0.16972882833987804, 0.15186263588304877, 0.1373995277037108};  // 2 / ln(2) / (2 n + 1)
  const double s = (m - 1) / (m + 1), z = s * s;
  double p = 0;
  for (int n = 10; n >= 1; --n) p = p * z + kSeries[n];
  return k + (s * kSeries[0] + s * (z * p));
}

double pow_(double base, double exponent) {
  if (exponent == 0) return 1;
  if (std::isnan(exponent) || !(base >= 0)) return kNotANumber;
  if (base == 1) return 1;
  return exp2_(exponent * log2_(base));  // 0 and infinity follow from log2
}

}  // namespace spanray
