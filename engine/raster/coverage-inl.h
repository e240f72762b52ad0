// Exact ends of the rows of a triangle. Included once per target, inside a *_kernel.cpp, after simd/lanes-inl.h.
#if defined(SPANRAY_COVERAGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_COVERAGE_INL_H_
#undef SPANRAY_COVERAGE_INL_H_
#else
#define SPANRAY_COVERAGE_INL_H_
#endif

#include "raster/fixed_point.h"
#include "simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// Where the line through two corners crosses rows, in pixels: x + slope * (row - y); kLanes lines. All but the slope are exact.
// x is moved right by half a pixel, and left by 2^-33: see first_pixel.
struct EdgeLines { F64 x, y, slope; };

// From corner a down to corner b, in 24.8.
HWY_INLINE EdgeLines edge_lines(I32 xa, I32 ya, I32 xb, I32 yb) {
  constexpr double kUnit = 1.0 / kSubpixels, kBias = 0x1p-33;
  return {to_f64(xa) * f64(kUnit) - f64(kBias), to_f64(ya - i32(kSubpixels / 2)) * f64(kUnit),
          to_f64(xb - xa) / to_f64(max_(yb - ya, i32(1)))};
}

// The first pixel whose center lies on the edge or to its right: ceil(c), where c is where the edge crosses the row, counted from
// the center of pixel 0.
// Source:   top-left rule: D3D11.3 functional specification 3.4.2. A center on a left edge is inside, on a right edge outside;
//           rows are top <= y < bottom, which is the rule for horizontal edges.
// Input:    24.8 corners, |x|, |y| <= 2^23 + 2^7 (the guard band, and half a pixel for the offset of a sample), counted from the picture's
//           or a tile's upper left corner.
// Contract: exact, in rows that the edge meets, for corners |x|, |y| < 2^24 that are at most 2^24 apart. Proof: c is a multiple of
//           1 / (256 dy) >= 2^-32. slope * (row - y) is at most 2^16; its factor row - y is exact, the slope and the product
//           are rounded once each (fused or not), and the sum, below 2^17, once more: the result is off by less than 2^-34. Added to
//           c, 1/2 - 2^-33 puts integers below the middle between two integers and all others at least as far above the next one,
//           by more than that error: the nearest integer is ceil(c). So the left edge of a row is the one with the smaller
//           crossing, and ceilings keep order: neither winding nor order of corners matters.
HWY_INLINE I32 first_pixel(F64 x, F64 y, F64 slope, F64 row) { return nearest_i32_small(x + slope * (row - y)); }

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_COVERAGE_INL_H_
