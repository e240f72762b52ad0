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

// From (x, y) down to (x + dx, y + dy), dy >= 0.
struct DownEdge { double x, y, dx, dy; };
HWY_INLINE DownEdge down_edge(const ScreenTriangle& t, int a, int b) {
  return {static_cast<double>(t.x_24_8[a]), static_cast<double>(t.y_24_8[a]), static_cast<double>(t.x_24_8[b] - t.x_24_8[a]),
          static_cast<double>(t.y_24_8[b] - t.y_24_8[a])};
}

// ceil((crossing - 128) / 256): the first pixel whose center lies on the edge or to its right, at centers of height `row`.
HWY_INLINE I32 first_pixel(F64 x, F64 y, F64 dx, F64 dy, F64 row, F64 low, F64 high) {
  const F64 numerator = (x - f64(kSubpixels / 2)) * dy + (row - y) * dx;
  return ceil_i32(min_(max_(numerator / (f64(kSubpixels) * dy), low), high));
}

// Spans of a triangle in rows [y_begin, y_end), at most kTileSize, cut to columns [x_low, x_high].
// Source:   top-left rule: D3D11.3 functional specification 3.4.2. A center on a left edge is inside, on a right edge outside;
//           rows are top <= y < bottom, which is the rule for horizontal edges.
// Input:    24.8 corners, |x|, |y| <= 2^23 + 2^7 (the guard band, and half a pixel for the offset of a sample), |dx|, |dy| <= 2^24,
//           in any order and winding.
// Contract: exact. Proof: dx, dy, x, row are integers, |dx|, dy <= 2^24, |x|, |row| <= 2^23 + 2^8. The products are below 2^49 and
//           their sum below 2^50: exact in double; so is 256 dy. In a row that an edge meets, its crossing lies between its
//           end points, so the quotient is at most 2^15 + 1 and its division rounds by at most 2^-38. If the true quotient is an
//           integer, the division is exact. If not, it is at least 1 / (256 dy) >= 2^-32 away from any integer, so rounding reaches none.
//           Either way the ceiling is right, and clamping to integers commutes with it. The left edge of a row is the
//           one with the smaller crossing, and ceilings keep order: neither winding nor order of corners matters.
HWY_INLINE void scan_triangle(const ScreenTriangle& t, int y_begin, int y_end, int x_low, int x_high, RowSpans& spans) {
  int top = 0, middle = 1, bottom = 2;
  if (t.y_24_8[top] > t.y_24_8[middle]) std::swap(top, middle);
  if (t.y_24_8[middle] > t.y_24_8[bottom]) std::swap(middle, bottom);
  if (t.y_24_8[top] > t.y_24_8[middle]) std::swap(top, middle);
  spans.first = std::max(y_begin, first_center(t.y_24_8[top]));
  spans.count = std::max(0, std::min(y_end, first_center(t.y_24_8[bottom])) - spans.first);

  const DownEdge whole = down_edge(t, top, bottom), upper = down_edge(t, top, middle), lower = down_edge(t, middle, bottom);
  const F64 low = f64(x_low), high = f64(x_high), turn = f64(t.y_24_8[middle]);
  for (int k = 0; k < spans.count; k += kLanes) {
    const F64 row = to_f64(lane_iota(spans.first + k)) * f64(kSubpixels) + f64(kSubpixels / 2);
    const auto pick = [&](double above, double below) HWY_ATTR { return select_lt(row, turn, f64(above), f64(below)); };
    const I32 a = first_pixel(f64(whole.x), f64(whole.y), f64(whole.dx), f64(whole.dy), row, low, high);
    const I32 b = first_pixel(pick(upper.x, lower.x), pick(upper.y, lower.y), pick(upper.dx, lower.dx),
                              pick(upper.dy, lower.dy), row, low, high);
    min_(a, b).store(spans.x0 + k);
    max_(a, b).store(spans.x1 + k);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_COVERAGE_INL_H_
