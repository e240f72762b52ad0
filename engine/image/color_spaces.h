// Color spaces of the metrics, in double. Not of the renderer: no pixel of a frame comes from here (that is math/color.h).
// Source: IEC 61966-2-1 (sRGB); CIE 15 (L*a*b*); Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images", 3.1
//         (YCxCz, after Kolpatzik and Bouman 1995), with the white of linear RGB (1, 1, 1).
#pragma once
#include <cmath>

namespace spanray {

struct Color3 { double x = 0, y = 0, z = 0; };

// [0, 1] to [0, 1], either way.
inline double srgb_from_linear(double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055; }
inline double linear_from_srgb_exact(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

// The sRGB primaries and D65 in ratios of whole numbers: rows sum to the white point, and the inverse below is exact to rounding.
inline constexpr double kXyzFromRgb[3][3] = {
    {10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
    {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
    {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};
inline constexpr double kWhite[3] = {kXyzFromRgb[0][0] + kXyzFromRgb[0][1] + kXyzFromRgb[0][2],
                                     kXyzFromRgb[1][0] + kXyzFromRgb[1][1] + kXyzFromRgb[1][2],
                                     kXyzFromRgb[2][0] + kXyzFromRgb[2][1] + kXyzFromRgb[2][2]};

inline Color3 xyz_from_rgb(const Color3& c) {
  const auto row = [&](int i) { return kXyzFromRgb[i][0] * c.x + kXyzFromRgb[i][1] * c.y + kXyzFromRgb[i][2] * c.z; };
  return {row(0), row(1), row(2)};
}

// By Cramer's rule: no second table that could disagree with the first.
inline Color3 rgb_from_xyz(const Color3& c) {
  const auto& m = kXyzFromRgb;
  const auto minor = [&](int i, int j) {  // cofactor of entry (i, j)
    const int a = (i + 1) % 3, b = (i + 2) % 3, p = (j + 1) % 3, q = (j + 2) % 3;
    return m[a][p] * m[b][q] - m[a][q] * m[b][p];
  };
  const double det = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
  const auto column = [&](int j) { return (minor(0, j) * c.x + minor(1, j) * c.y + minor(2, j) * c.z) / det; };
  return {column(0), column(1), column(2)};
}

inline Color3 ycxcz_from_xyz(const Color3& c) {
  const double x = c.x / kWhite[0], y = c.y / kWhite[1], z = c.z / kWhite[2];
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}
inline Color3 xyz_from_ycxcz(const Color3& c) {
  const double y = (c.x + 16) / 116;
  return {(y + c.y / 500) * kWhite[0], y * kWhite[1], (y - c.z / 200) * kWhite[2]};
}

inline Color3 lab_from_xyz(const Color3& c) {
  const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : t * (841.0 / 108) + 4.0 / 29; };
  const double x = f(c.x / kWhite[0]), y = f(c.y / kWhite[1]), z = f(c.z / kWhite[2]);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

}  // namespace spanray
