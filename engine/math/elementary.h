// Elementary functions in double for everything outside kernels (cameras, crease angles, generators): the same bits on every
// machine, no libm but sqrt. Bounds are stated at each function and measured by tests/math_elementary_test.cpp.
#pragma once

namespace spanray {

inline constexpr double kPi = 3.14159265358979323846;

// Sine and cosine of x radians, |x| <= 1e6; absolute error <= 2^-52. NaN or larger |x| gives NaN.
void sin_cos(double x, double* sine, double* cosine);
double tan_(double x);               // relative error <= 4 ulp where |cos x| > 1e-8
double exp2_(double x);              // relative error <= 2 ulp; 0 below -1074, infinity from 1024
double log2_(double x);              // error <= 2 ulp (or 2^-52 absolute near 1); -inf at 0, NaN below
double pow_(double base, double exponent);  // base >= 0; relative error <= 2^-40 for |exponent * log2(base)| < 1024; pow(0,0) = 1
double acos_(double x);              // x clamped to [-1, 1]; absolute error <= 2^-48
double atan2_(double y, double x);   // absolute error <= 2^-48; atan2_(0, 0) = 0

}  // namespace spanray
