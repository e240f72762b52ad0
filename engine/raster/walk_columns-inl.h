// Walker for triangles of any size: columns of the tile, one vector wide, each from its first row to its last without branches.
// Included once per target.
#if defined(SPANRAY_WALK_COLUMNS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_WALK_COLUMNS_INL_H_
#undef SPANRAY_WALK_COLUMNS_INL_H_
#else
#define SPANRAY_WALK_COLUMNS_INL_H_
#endif

#include <algorithm>
#include <utility>

#include "raster/coverage-inl.h"
#include "raster/setup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// What the walker reads of kLanes triangles, one entry each.
struct alignas(64) WalkSetups {
  static constexpr int kRoom = 16;
  struct Line { double x[kRoom], y[kRoom], slope[kRoom]; };  // EdgeLine, from the tile's upper left corner
  Line whole, upper, lower;
  double depth0[kRoom], depth_dx[kRoom], depth_dy[kRoom];
  int32_t x0[kRoom], x1[kRoom], y0[kRoom], y1[kRoom];
  int32_t turn[kRoom];  // the first row of the lower edge
  float depth_min[kRoom], depth_max[kRoom];
  uint32_t primitive[kRoom];
};

HWY_INLINE void store_line(I32 x0, I32 y0, I32 x1, I32 y1, WalkSetups::Line& line) {
  constexpr double kUnit = 1.0 / kSubpixels, kBias = 0x1p-33;  // as edge_line
  (to_f64(x0) * f64(kUnit) - f64(kBias)).store(line.x);
  (to_f64(y0 - i32(kSubpixels / 2)) * f64(kUnit)).store(line.y);
  (to_f64(x1 - x0) / to_f64(max_(y1 - y0, i32(1)))).store(line.slope);
}

HWY_INLINE void order_by_row(I32& xa, I32& ya, I32& xb, I32& yb) {
  const Mask swap = ya > yb;
  const I32 x = select(swap, xb, xa), y = select(swap, yb, ya);
  xb = select(swap, xa, xb), yb = select(swap, ya, yb);
  xa = x, ya = y;
}

HWY_INLINE void setup_walk(CornerLanes c, const BoxLanes& box, const DepthLanes& depth, WalkSetups& out) {
  order_by_row(c.x[0], c.y[0], c.x[1], c.y[1]);
  order_by_row(c.x[1], c.y[1], c.x[2], c.y[2]);
  order_by_row(c.x[0], c.y[0], c.x[1], c.y[1]);
  store_line(c.x[0], c.y[0], c.x[2], c.y[2], out.whole);
  store_line(c.x[0], c.y[0], c.x[1], c.y[1], out.upper);
  store_line(c.x[1], c.y[1], c.x[2], c.y[2], out.lower);
  first_centers(c.y[1]).store(out.turn);
  box.x0.store(out.x0), box.x1.store(out.x1), box.y0.store(out.y0), box.y1.store(out.y1);
  depth.depth0.store(out.depth0), depth.dx.store(out.depth_dx), depth.dy.store(out.depth_dy);
  depth.min.store(out.depth_min), depth.max.store(out.depth_max);
}

// Columns [begin, begin + length) of each row of one triangle, and what the row adds to its depth.
struct WalkRows {
  alignas(64) int32_t begin[kTileSize + 16], length[kTileSize + 16];
  alignas(64) double depth[kTileSize + 16];
};

HWY_INLINE I32 first_pixel(const WalkSetups::Line& line, int i, F64 row) {
  return first_pixel(f64(line.x[i]), f64(line.y[i]), f64(line.slope[i]), row);
}

// The contract is that of scan_triangle.
HWY_INLINE void scan_rows(const WalkSetups& s, int i, double center_y, WalkRows& rows) {
  const I32 low = i32(s.x0[i]), high = i32(s.x1[i]), turn = i32(s.turn[i]);
  const int count = s.y1[i] - s.y0[i];
  for (int k = 0; k < count; k += kLanes) {
    const I32 index = lane_iota(s.y0[i] + k);
    const F64 row = to_f64(index);
    const I32 a = first_pixel(s.whole, i, row);
    const I32 b = select(index < turn, first_pixel(s.upper, i, row), first_pixel(s.lower, i, row));
    const I32 left = max_(min_(a, b), low), right = min_(max_(a, b), high);
    left.store(rows.begin + k);
    max_(right - left, I32::zero()).store(rows.length + k);
    (f64(s.depth0[i]) + (row + f64(center_y)) * f64(s.depth_dy[i])).store(rows.depth + k);
  }
}

// Rows [first, last) of `count` that have pixels in columns [column, column + width), and perhaps some without.
struct RowRange { int first, last; };
HWY_INLINE RowRange rows_of_column(const WalkRows& rows, int count, int column, int width) {
  uint64_t touched = 0;
  for (int k = 0; k < count; k += kLanes) {
    const I32 begin = I32::load(rows.begin + k), end = begin + I32::load(rows.length + k);
    touched |= uint64_t{to_bits((begin < i32(column + width)) & (end > i32(column)))} << k;
  }
  if (count < 64) touched &= (uint64_t{1} << count) - 1;
  if (touched == 0) return {0, 0};
  return {__builtin_ctzll(touched), 64 - __builtin_clzll(touched)};
}

// Calls visit(column, row, inside, depth) for vectors of pixels (column + lane, row) of the tile. Columns are multiples of kLanes,
// so that no vector reaches past a row.
template <class Visit>
HWY_INLINE void walk_columns(const TileFrame& tile, const WalkSetups& s, int i, const Visit& visit) {
  constexpr int kWidth = std::max(kLanes, 8);
  WalkRows rows;
  scan_rows(s, i, tile.y + 0.5, rows);
  const int y0 = s.y0[i], count = s.y1[i] - y0, x1 = s.x1[i];
  const int first_column = s.x0[i] & -kWidth;
  const bool one_column = x1 - first_column <= kWidth;
  const F32 depth_min = f32(s.depth_min[i]), depth_max = f32(s.depth_max[i]);
  for (int column = first_column; column < x1; column += kWidth) {
    const RowRange range = one_column ? RowRange{0, count} : rows_of_column(rows, count, column, kWidth);
    for (int x = column; x < column + kWidth; x += kLanes) {
      const I32 index = lane_iota(x);
      const F64 column_depth = (to_f64(index) + f64(tile.x + 0.5)) * f64(s.depth_dx[i]);
      for (int k = range.first; k < range.last; ++k) {
        const Mask inside = less_unsigned(index - i32(rows.begin[k]), i32(rows.length[k]));
        visit(x, y0 + k, inside, clamp_(to_f32(f64(rows.depth[k]) + column_depth), depth_min, depth_max));
      }
    }
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_WALK_COLUMNS_INL_H_
