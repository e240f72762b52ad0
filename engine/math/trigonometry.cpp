// Sine, cosine and tangent in double without libm: Cody-Waite reduction, Taylor polynomials.
#include <cmath>
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
  double s = 0, c = 0;  // (sin(hi) - hi) / hi^3 and (cos(hi) - 1 + z / 2) / z^2
  for (int n = 19; n >= 3; n -= 2) {
    double factorial = 1;
    for (int i = 2; i <= n; ++i) factorial *= i;
    s = s * z + ((n & 2) ? -1.0 : 1.0) / factorial;
  }
  for (int n = 18; n >= 4; n -= 2) {
    double factorial = 1;
    for (int i = 2; i <= n; ++i) factorial *= i;
    c = c * z + ((n & 2) ? -1.0 : 1.0) / factorial;
  }
  const double sin_r = hi + (hi * z * s + lo * (1.0 - 0.5 * z));
  const double half = 0.5 * z, one = 1.0 - half;
  const double cos_r = one + (((1.0 - one) - half) + (z * z * c - hi * lo));
  switch (static_cast<long long>(k) & 3) {
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

}  // namespace spanray
