// A window of the triangles of a tile: sorted by size and depth, culled by hierarchical z, drawn. Included once per target.
#if defined(SPANRAY_WINDOW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_WINDOW_INL_H_
#undef SPANRAY_WINDOW_INL_H_
#else
#define SPANRAY_WINDOW_INL_H_
#endif

#include <algorithm>
#include <cstring>

#include "raster/accept-inl.h"
#include "raster/tile_depth-inl.h"
#include "raster/walk_columns-inl.h"
#include "raster/walk_packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// Triangles are drawn in an order that pays: large ones first, from front to back, then tiny ones, then masked ones, which ask for
// each pixel that is not hidden yet. The result does not depend on it: a fragment wins if it is nearer, or as near and of a lower id.
class Window {
 public:
  Window(const Frame& frame, int tile, int place, TileHits& out) : frame_(frame), tile_(frame, tile, place), place_(place), out_(out) {
    tile_depth_.clear();
  }
  HWY_INLINE void add(const ScreenTriangle& t) {
    std::memcpy(&triangles_[count_], &t, sizeof t);
    if (++count_ == kRoom) draw();
  }
  void draw() {
    if (count_ == 0) return;
    classify();
    sort_by_depth(large_, large_count_);
    draw_walked(large_, large_count_, false);
    if (tiny_count_ > 0) {
      refresh_if(1);
      draw_tiny();
    }
    if (masked_count_ > 0) {
      refresh_if(1);
      draw_walked(masked_, masked_count_, true);
    }
    count_ = 0;
  }

 private:
  static constexpr int kRoom = 256;
  static constexpr int kRefreshPixels = kTilePixels / 2;  // of boxes drawn since the last refresh

  void classify() {
    large_count_ = tiny_count_ = masked_count_ = 0;
    for (int i = 0; i < count_; i += kLanes) {
      const I32 index = min_(lane_iota(i), i32(count_ - 1)), word = index * i32(kTriangleWords);
      const CornerLanes c = load_corners(tile_, triangles_, index);
      const BoxLanes box = box_of(tile_, c);
      const F32 nearest = gather(&triangles_->depth_max, word);
      const I32 w = box.x1 - box.x0, h = box.y1 - box.y0, zero = I32::zero();
      Mask live = first_lanes(count_ - i) & (w > zero) & (h > zero);
      if (tile_depth_known_) live = live & tile_depth_.may_show(box, nearest);
      box.pack().store(box_ + i);
      nearest.store(nearest_ + i);
      const I32 extent = max_(greatest(c.x) - least(c.x), greatest(c.y) - least(c.y));
      const Mask masked = (gather(&triangles_->flags, word) & i32(int32_t{kMaterialMasked})) != zero;
      const Mask tiny = (w * h < i32(kPacketPixels + 1)) & (extent < i32(kPacketExtent));
      const Mask opaque = and_not(masked, live);
      masked_count_ += compress_store(index, live & masked, masked_ + masked_count_);
      tiny_count_ += compress_store(index, opaque & tiny, tiny_ + tiny_count_);
      large_count_ += compress_store(index, and_not(tiny, opaque), large_ + large_count_);
    }
  }

  // Near ones first, by a coarse logarithm of their depth. Bits of positive floats are in order of their values.
  void sort_by_depth(int32_t* list, int n) {
    if (n < 2) return;
    constexpr int kBuckets = 32;
    uint32_t low = ~0u, high = 0;
    uint32_t* const key = sort_key_;
    for (int i = 0; i < n; ++i) {
      std::memcpy(&key[i], &nearest_[list[i]], 4);
      low = std::min(low, key[i]), high = std::max(high, key[i]);
    }
    int shift = 0;
    while ((high - low) >> shift >= kBuckets) ++shift;
    int start[kBuckets + 1] = {};
    for (int i = 0; i < n; ++i) ++start[((high - key[i]) >> shift) + 1];
    for (int b = 0; b < kBuckets; ++b) start[b + 1] += start[b];
    int32_t sorted[kRoom];
    for (int i = 0; i < n; ++i) sorted[start[(high - key[i]) >> shift]++] = list[i];
    std::memcpy(list, sorted, static_cast<size_t>(n) * 4);
  }

  void refresh_if(int pixels) {
    if (stale_pixels_ < pixels) return;
    tile_depth_.refresh(out_.depth, tile_);
    tile_depth_known_ = true;
    stale_pixels_ = 0;
  }

  void draw_walked(const int32_t* list, int n, bool masked) {
    WalkSetups setups;
    for (int i = 0; i < n; i += kLanes) {
      refresh_if(kRefreshPixels);
      const Mask valid = first_lanes(n - i);
      const I32 index = select(valid, I32::load(list + i), I32::zero());
      const BoxLanes box = BoxLanes::unpack(gather(box_, index));
      const DepthLanes depth = load_depth(tile_, triangles_, index);
      const Mask live = valid & tile_depth_.may_show(box, nearest_depth(tile_, depth, box));
      uint32_t bits = to_bits(live);
      if (bits == 0) continue;
      setup_walk(load_corners(tile_, triangles_, index), box, depth, setups);
      gather(&triangles_->primitive, index * i32(kTriangleWords)).store(setups.primitive);
      for (; bits != 0; bits &= bits - 1) {
        const int k = __builtin_ctz(bits);
        if (masked)
          walk_masked(setups, k);
        else
          walk_opaque(setups, k);
        stale_pixels_ += (setups.x1[k] - setups.x0[k]) * (setups.y1[k] - setups.y0[k]);
      }
    }
  }

  void walk_opaque(const WalkSetups& setups, int k) {
    const I32 primitive = i32(setups.primitive[k]);
    walk_columns(tile_, setups, k, [&](int column, int row, Mask inside, F32 depth) HWY_ATTR {
      const int offset = row * kTileSize + column;
      const F32 stored = F32::load(out_.depth + offset);
      const I32 owner = I32::load(out_.primitive + offset);
      const Mask visible = inside & ((depth > stored) | ((depth == stored) & less_unsigned(primitive, owner)));
      select(visible, depth, stored).store(out_.depth + offset);
      select(visible, primitive, owner).store(out_.primitive + offset);
    });
  }

  void walk_masked(const WalkSetups& setups, int k) {
    const I32 primitive = i32(setups.primitive[k]);
    walk_columns(tile_, setups, k, [&](int column, int row, Mask inside, F32 depth) HWY_ATTR {
      const int offset = row * kTileSize + column;
      const F32 stored = F32::load(out_.depth + offset);
      const I32 owner = I32::load(out_.primitive + offset);
      Mask visible = inside & ((depth > stored) | ((depth == stored) & less_unsigned(primitive, owner)));
      visible = ask_accept(frame_, setups.primitive[k], tile_.x + column, tile_.y + row, visible, place_);
      if (!any(visible)) return;
      select(visible, depth, stored).store(out_.depth + offset);
      select(visible, primitive, owner).store(out_.primitive + offset);
    });
  }

  void draw_tiny() {
    if (tile_depth_known_) cull_tiny();
    PacketFragments fragments;
    for (int i = 0; i < tiny_count_; i += kLanes) {
      const Mask valid = first_lanes(tiny_count_ - i);
      const I32 index = select(valid, I32::load(tiny_ + i), I32::zero());
      fragments.count = 0;
      walk_packet(tile_, load_corners(tile_, triangles_, index), BoxLanes::unpack(gather(box_, index)),
                  load_depth(tile_, triangles_, index), gather(&triangles_->primitive, index * i32(kTriangleWords)), valid, fragments);
      drain(fragments);
    }
  }

  void cull_tiny() {
    int kept = 0;
    for (int i = 0; i < tiny_count_; i += kLanes) {
      const Mask valid = first_lanes(tiny_count_ - i);
      const I32 index = select(valid, I32::load(tiny_ + i), I32::zero());
      const Mask live = valid & tile_depth_.may_show(BoxLanes::unpack(gather(box_, index)), gather(nearest_, index));
      kept += compress_store(index, live, tiny_ + kept);
    }
    tiny_count_ = kept;
  }

  void drain(const PacketFragments& f) {
    for (int i = 0; i < f.count; ++i) {
      const int offset = f.offset[i];
      const uint32_t primitive = static_cast<uint32_t>(f.primitive[i]), owner = out_.primitive[offset];
      const float depth = f.depth[i], stored = out_.depth[offset];
      const bool visible = (depth > stored) | ((depth == stored) & (primitive < owner));
      out_.depth[offset] = visible ? depth : stored;
      out_.primitive[offset] = visible ? primitive : owner;
    }
    stale_pixels_ += f.count;
  }

  const Frame& frame_;
  const TileFrame tile_;
  const int place_;
  TileHits& out_;
  TileDepth tile_depth_;
  bool tile_depth_known_ = false;
  int stale_pixels_ = 0, count_ = 0, large_count_ = 0, tiny_count_ = 0, masked_count_ = 0;
  // Lists of indices and what belongs to a triangle, with room for whole vectors.
  alignas(64) int32_t large_[kRoom + 16], tiny_[kRoom + 16], masked_[kRoom + 16], box_[kRoom + 16];
  alignas(64) float nearest_[kRoom + 16];
  alignas(64) uint32_t sort_key_[kRoom];
  alignas(64) ScreenTriangle triangles_[kRoom];
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_WINDOW_INL_H_
