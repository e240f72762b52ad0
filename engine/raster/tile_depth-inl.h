// Hierarchical z of one tile: what lies behind everything in a block need not be drawn there. Included once per target.
#if defined(SPANRAY_TILE_DEPTH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_TILE_DEPTH_INL_H_
#undef SPANRAY_TILE_DEPTH_INL_H_
#else
#define SPANRAY_TILE_DEPTH_INL_H_
#endif

#include <algorithm>

#include "raster/walk_setup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// The farthest depth of each 16 x 16 block, and of each quarter of the tile. A lower bound: depths only grow.
class TileDepth {
 public:
  static constexpr int kBlock = 16, kPerSide = kTileSize / kBlock, kBlocks = kPerSide * kPerSide;
  static constexpr uint32_t kAllBlocks = (1u << kBlocks) - 1;

  // Blocks outside of the picture hide everything.
  void clear(const TileFrame& tile) {
    std::fill_n(farthest_, kBlocks + 4, 0.0f);
    for (int b = 0; b < kBlocks; ++b)
      if (b % kPerSide * kBlock >= tile.columns || b / kPerSide * kBlock >= tile.rows) farthest_[b] = 1.0f;
  }

  // Reads the blocks in `changed` anew; bit y * kPerSide + x is block (x, y).
  void refresh(const float* depth, const TileFrame& tile, uint32_t changed) {
    for (uint32_t left = changed; left != 0; left &= left - 1) {
      const int b = __builtin_ctz(left);
      farthest_[b] = block(depth, tile, b % kPerSide, b / kPerSide, farthest_[b]);
    }
    for (int q = 0; q < 4; ++q) {
      const float* const f = farthest_ + (q / 2) * 2 * kPerSide + (q % 2) * 2;
      farthest_[kBlocks + q] = std::min({f[0], f[1], f[kPerSide], f[kPerSide + 1]});
    }
  }

  // The blocks that columns [x0, x1) and rows [y0, y1) meet.
  static uint32_t blocks_of(int x0, int x1, int y0, int y1) {
    const uint32_t columns = (2u << ((x1 - 1) >> 4)) - (1u << (x0 >> 4));
    uint32_t bits = 0;
    for (int y = y0 >> 4; y <= (y1 - 1) >> 4; ++y) bits |= columns << (y * kPerSide);
    return bits;
  }

  // Lanes whose box may show a pixel of depth `nearest`; equal depth may. Boxes without pixels give anything.
  HWY_INLINE Mask may_show(const BoxLanes& box, F32 nearest) const {
    const Mask small = (box.x1 - box.x0 < i32(kBlock + 2)) & (box.y1 - box.y0 < i32(kBlock + 2));
    // A box this small meets at most two blocks either way; any box meets at most two quarters.
    const I32 shift = select(small, i32(4), i32(5)), stride = select(small, i32(kPerSide), i32(2));
    const I32 base = select(small, I32::zero(), i32(kBlocks));
    const I32 last = i32(kTileSize - 1), one = i32(1);
    const auto at = [&](I32 v, I32 limit) HWY_ATTR { return shift_right_by(max_(min_(v, limit), I32::zero()), shift); };
    const I32 left = at(box.x0, last), right = at(box.x1 - one, last);
    const I32 top = at(box.y0, last) * stride + base, bottom = at(box.y1 - one, last) * stride + base;
    const F32 f = min_(min_(gather(farthest_, top + left), gather(farthest_, top + right)),
                       min_(gather(farthest_, bottom + left), gather(farthest_, bottom + right)));
    return nearest >= f;
  }

  // Blocks in which pixels of the box of triangle i may show. Blocks outside of the box give anything.
  HWY_INLINE uint32_t blocks_that_show(const TileFrame& tile, const WalkSetups& s, int i) const {
    const F64 depth0 = f64(s.depth0[i]), dx = f64(s.depth_dx[i]), dy = f64(s.depth_dy[i]);
    const bool right = s.depth_dx[i] > 0, down = s.depth_dy[i] > 0;  // where the nearest pixel of a block lies, as in nearest_depth
    uint32_t bits = 0;
    for (int b = 0; b < kBlocks; b += kLanes) {
      const I32 block = lane_iota(b), left = shift_left<4>(block & i32(kPerSide - 1)), top = shift_left<4>(shift_right<2>(block));
      const I32 x = right ? min_(left + i32(kBlock - 1), i32(s.x1[i] - 1)) : max_(left, i32(s.x0[i]));
      const I32 y = down ? min_(top + i32(kBlock - 1), i32(s.y1[i] - 1)) : max_(top, i32(s.y0[i]));
      const F64 depth = (depth0 + (to_f64(y) + f64(tile.y + 0.5)) * dy) + (to_f64(x) + f64(tile.x + 0.5)) * dx;
      bits |= to_bits(bound_of(to_f32(depth), f32(s.depth_min[i]), f32(s.depth_max[i])) >= F32::load(farthest_ + b)) << b;
    }
    return bits;
  }

 private:
  // Pixels past the end of the picture do not count. before: what it was. As depths only grow, one pixel as far as that tells all; most
  // often it is of the background.
  static HWY_INLINE float block(const float* depth, const TileFrame& tile, int bx, int by, float before) {
    const int x0 = bx * kBlock, y0 = by * kBlock, y1 = std::min(y0 + kBlock, tile.rows);
    const F32 nearest = f32(1.0f);
    F32 least = nearest;
    for (int x = x0; x < x0 + kBlock; x += kLanes) {
      const Mask in_picture = lane_iota(x) < i32(tile.columns);
      for (int y = y0; y < y1; ++y) {
        const F32 row = select(in_picture, F32::load(depth + y * kTileSize + x), nearest);
        if (any(row <= f32(before))) return before;
        least = min_(least, row);
      }
    }
    return min_of_lanes(least);
  }

  alignas(64) float farthest_[kBlocks + 16];
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_TILE_DEPTH_INL_H_
