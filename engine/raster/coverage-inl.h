// Exact scan conversion of one screen triangle. Included once per target, inside a *_kernel.cpp, after simd/lanes-inl.h.
#if defined(SPANRAY_COVERAGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_COVERAGE_INL_H_
#undef SPANRAY_COVERAGE_INL_H_
#else
#define SPANRAY_COVERAGE_INL_H_
#endif

#include <algorithm>

#include "frame/tiles.h"
#include "raster/fixed_point.h"
#include "simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// Pixels [x0[k], x1[k]) of row `first + k`, k < count; empty where x0 >= x1. Room for whole vectors of rows.
struct RowSpans {
  int first = 0, count = 0;
  alignas(64) int32_t x0[kTileSize + 16], x1[kTileSize + 16];
};

// Where the line through two corners crosses a row, in pixels: x + slope * (row - y). All but the slope are exact.
// x is moved right by half a pixel, and left by 2^-33: see first_pixel.
struct EdgeLine { double x, y, slope; };
HWY_INLINE EdgeLine edge_line(const ScreenTriangle& t, int a, int b) {
  constexpr double kUnit = 1.0 / kSubpixels, kBias = 0x1p-33;
  return {t.x_24_8[a] * kUnit - kBias, (t.y_24_8[a] - kSubpixels / 2) * kUnit,
          static_cast<double>(t.x_24_8[b] - t.x_24_8[a]) / std::max(t.y_24_8[b] - t.y_24_8[a], 1)};
}

// The first pixel whose center lies on the edge or to its right: ceil(c), where c is where the edge crosses the row, counted from
// the center of pixel 0.
// Contract: exact, in rows that the edge meets, for corners |x|, |y| < 2^24 that are at most 2^24 apart. Proof: c is a multiple of
//           1 / (256 dy) >= 2^-32. slope * (row - y) is at most 2^16; its factor row - y is exact, the slope and the product
//           are rounded once each (fused or not), and the sum, below 2^17, once more: the result is off by less than 2^-34. Added to
//           c, 1/2 - 2^-33 puts integers below the middle between two integers and all others at least as far above the next one,
//           by more than that error: the nearest integer is ceil(c).
HWY_INLINE I32 first_pixel(F64 x, F64 y, F64 slope, F64 row) { return nearest_i32_small(x + slope * (row - y)); }

// Spans of a triangle in rows [y_begin, y_end), at most kTileSize, cut to columns [x_low, x_high].
// Source:   top-left rule: D3D11.3 functional specification 3.4.2. A center on a left edge is inside, on a right edge outside;
//           rows are top <= y < bottom, which is the rule for horizontal edges.
// Input:    24.8 corners, |x|, |y| <= 2^23 + 2^7 (the guard band, and half a pixel for the offset of a sample), in any order and winding.
// Contract: exact (first_pixel). The left edge of a row is the one with the smaller crossing, and ceilings keep order: neither
//           winding nor order of corners matters.
HWY_INLINE void scan_triangle(const ScreenTriangle& t, int y_begin, int y_end, int x_low, int x_high, RowSpans& spans) {
  int top = 0, middle = 1, bottom = 2;
  if (t.y_24_8[top] > t.y_24_8[middle]) std::swap(top, middle);
  if (t.y_24_8[middle] > t.y_24_8[bottom]) std::swap(middle, bottom);
  if (t.y_24_8[top] > t.y_24_8[middle]) std::swap(top, middle);
  spans.first = std::max(y_begin, first_center(t.y_24_8[top]));
  spans.count = std::max(0, std::min(y_end, first_center(t.y_24_8[bottom])) - spans.first);

  const EdgeLine whole = edge_line(t, top, bottom), upper = edge_line(t, top, middle), lower = edge_line(t, middle, bottom);
  const I32 low = i32(x_low), high = i32(x_high), turn = i32(first_center(t.y_24_8[middle]));
  for (int k = 0; k < spans.count; k += kLanes) {
    const I32 index = lane_iota(spans.first + k);
    const F64 row = to_f64(index);
    const I32 a = first_pixel(f64(whole.x), f64(whole.y), f64(whole.slope), row);
    const I32 b = select(index < turn, first_pixel(f64(upper.x), f64(upper.y), f64(upper.slope), row),
                         first_pixel(f64(lower.x), f64(lower.y), f64(lower.slope), row));
    min_(max_(min_(a, b), low), high).store(spans.x0 + k);
    min_(max_(max_(a, b), low), high).store(spans.x1 + k);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_COVERAGE_INL_H_
