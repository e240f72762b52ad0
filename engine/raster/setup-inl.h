// Screen triangles in lanes: what the walkers need to know, kLanes triangles at a time. Included once per target.
#if defined(SPANRAY_SETUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_SETUP_INL_H_
#undef SPANRAY_SETUP_INL_H_
#else
#define SPANRAY_SETUP_INL_H_
#endif

#include "frame/frame.h"
#include "raster/fixed_point.h"
#include "simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// The tile that is drawn, seen at one place of its pixels (frame/samples.h). Rows and columns count from its first pixel.
struct TileFrame {
  int x, y, columns, rows;             // first pixel in the picture, and how many of them lie in it
  int32_t offset_x = 0, offset_y = 0;  // of the place from the center, in 24.8
};
HWY_INLINE TileFrame tile_frame(const Frame& frame, int tile, int place) {
  const int x = frame.grid.x0(tile), y = frame.grid.y0(tile);
  return {x, y, frame.grid.x1(tile) - x, frame.grid.y1(tile) - y, frame.places.offset_x_24_8[place], frame.places.offset_y_24_8[place]};
}

// 24.8, from the tile's upper left corner, moved by the negated offset of the place: what the triangle covers at centers is then what
// it covers at the place.
struct CornerLanes { I32 x[3], y[3]; };

constexpr int kTriangleWords = sizeof(ScreenTriangle) / 4;

HWY_INLINE CornerLanes load_corners(const TileFrame& tile, const ScreenTriangle* triangles, I32 index) {
  const I32 word = index * i32(kTriangleWords);
  const I32 x0 = i32(tile.x * kSubpixels + tile.offset_x), y0 = i32(tile.y * kSubpixels + tile.offset_y);
  CornerLanes c;
  for (int i = 0; i < 3; ++i) {
    c.x[i] = gather(triangles->x_24_8 + i, word) - x0;
    c.y[i] = gather(triangles->y_24_8 + i, word) - y0;
  }
  return c;
}

HWY_INLINE I32 first_centers(I32 x_24_8) { return shift_right<kSubpixelBits>(x_24_8 + i32(kSubpixels / 2 - 1)); }
HWY_INLINE I32 least(const I32 v[3]) { return min_(min_(v[0], v[1]), v[2]); }
HWY_INLINE I32 greatest(const I32 v[3]) { return max_(max_(v[0], v[1]), v[2]); }

// Pixels of the tile whose centers lie in the bounding box: columns [x0, x1), rows [y0, y1), each 0 to kTileSize.
struct BoxLanes {
  I32 x0, x1, y0, y1;
  // Four bytes in a word: a window keeps the boxes of all its triangles.
  HWY_INLINE I32 pack() const { return x0 | shift_left<8>(x1) | shift_left<16>(y0) | shift_left<24>(y1); }
  static HWY_INLINE BoxLanes unpack(I32 word) {
    const I32 byte = i32(0xff);
    return {word & byte, shift_right_logical<8>(word) & byte, shift_right_logical<16>(word) & byte, shift_right_logical<24>(word)};
  }
};
HWY_INLINE BoxLanes box_of(const TileFrame& tile, const CornerLanes& c) {
  return {max_(first_centers(least(c.x)), I32::zero()), min_(first_centers(greatest(c.x)), i32(tile.columns)),
          max_(first_centers(least(c.y)), I32::zero()), min_(first_centers(greatest(c.y)), i32(tile.rows))};
}

struct DepthLanes {
  F64 depth0, dx, dy;
  F32 min, max;
};
HWY_INLINE DepthLanes load_depth(const TileFrame& tile, const ScreenTriangle* triangles, I32 index) {
  const I32 word = index * i32(kTriangleWords), pair = index * i32(kTriangleWords / 2);
  const F64 dx = gather(&triangles->depth_dx, pair), dy = gather(&triangles->depth_dy, pair);
  const F64 moved = gather(&triangles->depth0, pair) + f64(tile.offset_x * (1.0 / kSubpixels)) * dx + f64(tile.offset_y * (1.0 / kSubpixels)) * dy;
  return {moved, dx, dy, gather(&triangles->depth_min, word), gather(&triangles->depth_max, word)};
}
// Contract: the depth of pixel (x, y) is ((depth0 + (y + 1/2) dy) + (x + 1/2) dx) in double, rounded to float, clamped to the
//           triangle's range: absolute coordinates, so its bits depend on neither tile, span, lane nor instruction set.
HWY_INLINE F32 depth_at(const DepthLanes& d, F64 center_x, F64 center_y) {
  return clamp_(to_f32((d.depth0 + center_y * d.dy) + center_x * d.dx), d.min, d.max);
}
// As the clamp of depth_at, but where sums overflowed to NaN it is the greatest depth that there is.
HWY_INLINE F32 bound_of(F32 depth, F32 depth_min, F32 depth_max) { return max_(min_(depth, depth_max), depth_min); }
// The greatest depth of any pixel of the box. Every operation of depth_at is monotone in x and in y, so a corner has it, bit for bit.
HWY_INLINE F32 nearest_depth(const TileFrame& tile, const DepthLanes& d, const BoxLanes& box) {
  const F64 zero = f64(0.0), one = f64(1.0), x = f64(tile.x + 0.5), y = f64(tile.y + 0.5);
  const F64 corner_x = select_lt(zero, d.dx, to_f64(box.x1) - one, to_f64(box.x0)) + x;
  const F64 corner_y = select_lt(zero, d.dy, to_f64(box.y1) - one, to_f64(box.y0)) + y;
  return bound_of(to_f32((d.depth0 + corner_y * d.dy) + corner_x * d.dx), d.min, d.max);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_SETUP_INL_H_
