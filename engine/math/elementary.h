// Elementary functions in double for everything outside kernels (cameras, crease angles, generators): the same bits on every
// machine, no libm but sqrt. Bounds are stated at each function and measured by tests/math_elementary_test.cpp.
#pragma once

namespace spanray {

inline constexpr double kPi = 3.14159265358979323846;

// Sine and cosine of x radians, |x| <= 1e6; absolute error <= 2^-52. NaN or larger |x| gives NaN.
void sin_cos(double x, double* sine, double* cosine);
double tan_(double x);               // relative error <= 4 ulp where |cos x| > 1e-8
double exp2_(double x);              // error <= 1.5 ulp, gradual underflow included; 0 below -1075, infinity from 1024
double log2_(double x);              // error <= 2 ulp, or 2^-52 absolute; 0 -> -infinity, negative -> NaN
// base >= 0 (negative: NaN); relative error <= 2^-41 while |exponent * log2(base)| <= 1022, beyond it underflow and overflow;
// pow_(x, 0) = pow_(1, y) = 1, pow_(0, y > 0) = 0, pow_(0, y < 0) = infinity.
double pow_(double base, double exponent);
double acos_(double x);              // x clamped to [-1, 1]; absolute error <= 2^-50; NaN -> NaN
// absolute error <= 2^-50; in [-pi, pi]; atan2_(+-0, +-0) = 0, and the sign of a zero y does not count: atan2_(-0, -1) = pi.
double atan2_(double y, double x);

}  // namespace spanray
