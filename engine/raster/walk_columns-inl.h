// Walker for triangles of any size: columns of the tile, one vector wide, each over the rows that have pixels there.
// Included once per target.
#if defined(SPANRAY_WALK_COLUMNS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_WALK_COLUMNS_INL_H_
#undef SPANRAY_WALK_COLUMNS_INL_H_
#else
#define SPANRAY_WALK_COLUMNS_INL_H_
#endif

#include <algorithm>

#include "raster/walk_setup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// Triangles within so many columns and rows need no loops over either.
constexpr int kSmallColumns = std::max(kLanes, 8), kSmallRows = kLanes;

// Columns [begin, begin + length) of each row of one triangle, and what the row adds to its depth.
struct WalkRows {
  alignas(64) int32_t begin[kTileSize + 16], length[kTileSize + 16];
  alignas(64) double depth[kTileSize + 16];
};

HWY_INLINE I32 first_pixel(const WalkSetups::Line& line, int i, F64 row) {
  return first_pixel(f64(line.x[i]), f64(line.y[i]), f64(line.slope[i]), row);
}

// Returns the rows that have pixels, a bit each. Exact: first_pixel. kSmall: at most kSmallRows rows.
template <bool kSmall>
HWY_INLINE uint64_t scan_rows(const WalkSetups& s, int i, double center_y, WalkRows& rows) {
  const I32 low = i32(s.x0[i]), high = i32(s.x1[i]), turn = i32(s.turn[i]), end = i32(s.y1[i]);
  const int count = kSmall ? kLanes : s.y1[i] - s.y0[i];
  uint64_t filled = 0;
  for (int k = 0; k < count; k += kLanes) {
    const I32 index = lane_iota(s.y0[i] + k);
    const F64 row = to_f64(index);
    const I32 a = first_pixel(s.whole, i, row);
    const I32 b = select(index < turn, first_pixel(s.upper, i, row), first_pixel(s.lower, i, row));
    const I32 left = max_(min_(a, b), low), right = min_(max_(a, b), high);
    left.store(rows.begin + k);
    (right - left).store(rows.length + k);
    (f64(s.depth0[i]) + (row + f64(center_y)) * f64(s.depth_dy[i])).store(rows.depth + k);
    filled |= uint64_t{to_bits((left < right) & (index < end))} << k;
  }
  return filled;
}

// Of the filled rows, those that have pixels in columns [column, column + width).
HWY_INLINE uint64_t rows_of_column(const WalkRows& rows, int count, uint64_t filled, int column, int width) {
  uint64_t touched = 0;
  for (int k = 0; k < count; k += kLanes) {
    const I32 begin = I32::load(rows.begin + k), end = begin + I32::load(rows.length + k);
    touched |= uint64_t{to_bits((begin < i32(column + width)) & (end > i32(column)))} << k;
  }
  return touched & filled;
}

// The rows of the blocks (raster/tile_depth-inl.h) that show, in columns [column, column + width), width <= 16.
HWY_INLINE uint64_t rows_that_show(uint32_t blocks, int column, int width) {
  const uint32_t shown = (blocks >> (column >> 4) | blocks >> ((column + width - 1) >> 4)) & 0x1111u;
  const uint64_t first = (shown & 1u) | uint64_t{shown & 0x10u} << 12 | uint64_t{shown & 0x100u} << 24 | uint64_t{shown & 0x1000u} << 36;
  return first * 0xffff;
}

// Calls visit(column, row, inside, depth) for vectors of pixels (column + lane, row) of the tile, where bits of `blocks` are set. No
// vector reaches past a row. Columns of narrow triangles begin with them, others are multiples of kLanes.
template <bool kSmall, class Visit>
HWY_INLINE void walk_columns(const TileFrame& tile, const WalkSetups& s, int i, uint32_t blocks,
                             const Visit& visit) {
  constexpr int kWidth = kSmallColumns;
  WalkRows rows;
  const uint64_t filled = scan_rows<kSmall>(s, i, tile.y + 0.5, rows);
  const int y0 = s.y0[i], count = s.y1[i] - y0, x1 = s.x1[i];
  const bool one_column = kSmall || x1 - s.x0[i] <= kWidth;
  const int first_column = one_column ? std::min(s.x0[i], kTileSize - kWidth) : s.x0[i] & -kWidth;
  const F32 depth_min = f32(s.depth_min[i]), depth_max = f32(s.depth_max[i]);
  for (int column = first_column; column < x1; column += kWidth) {  // once if it is small
    uint64_t touched = one_column ? filled : rows_of_column(rows, count, filled, column, kWidth);
    if (!kSmall) touched &= rows_that_show(blocks, column, kWidth) >> y0;
    for (int x = column; x < column + kWidth; x += kLanes) {
      const I32 index = lane_iota(x);
      const F64 column_depth = (to_f64(index) + f64(tile.x + 0.5)) * f64(s.depth_dx[i]);
      for (uint64_t left = touched; left != 0; left &= left - 1) {
        const int k = __builtin_ctzll(left);
        const Mask inside = less_unsigned(index - i32(rows.begin[k]), i32(rows.length[k]));
        visit(x, y0 + k, inside, clamp_(to_f32(f64(rows.depth[k]) + column_depth), depth_min, depth_max));
      }
    }
    if (kSmall) return;
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_WALK_COLUMNS_INL_H_
