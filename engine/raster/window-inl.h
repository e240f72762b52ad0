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
  Window(const Frame& frame, int tile, int place, TileHits& out) : frame_(frame), tile_(tile_frame(frame, tile, place)), place_(place), out_(out) {
    tile_depth_.clear(tile_);
  }
  HWY_INLINE void add(const ScreenTriangle& t) {
    std::memcpy(&triangles_[count_], &t, sizeof t);
    if (++count_ == kRoom) draw();
  }
  void draw() {
    if (count_ == 0) return;
    out_.triangles += static_cast<uint64_t>(count_);
    classify();
    sort_by_depth(large_);
    draw_walked<false, false>(large_);
    if (small_.count > 0) {
      refresh_if(1);
      sort_by_depth(small_);
      draw_walked<true, false>(small_);
    }
    if (tiny_.count > 0) {
      refresh_if(1);
      draw_tiny();
    }
    if (masked_.count > 0) {
      refresh_if(1);
      draw_walked<false, true>(masked_);
    }
    count_ = 0;
  }

 private:
  static constexpr int kRoom = 256;
  static constexpr int kRefreshPixels = kTilePixels / 2;  // of boxes drawn since the last refresh

  // Indices of triangles, with room for whole vectors.
  struct List {
    int count = 0;
    alignas(64) int32_t index[kRoom + 16];
    HWY_INLINE void add(I32 i, Mask m) { count += compress_store(i, m, index + count); }
    // The next vector; lanes past the end repeat some triangle.
    HWY_INLINE I32 load(int i, Mask valid) const { return select(valid, I32::load(index + i), I32::zero()); }
  };

  void classify() {
    large_.count = small_.count = tiny_.count = masked_.count = 0;
    for (int i = 0; i < count_; i += kLanes) {
      const I32 index = min_(lane_iota(i), i32(count_ - 1)), word = index * i32(kTriangleWords);
      const CornerLanes c = load_corners(tile_, triangles_, index);
      const BoxLanes box = box_of(tile_, c);
      const F32 nearest = gather(&triangles_->depth_max, word);
      const I32 w = box.x1 - box.x0, h = box.y1 - box.y0, zero = I32::zero();
      Mask live = first_lanes(count_ - i) & (w > zero) & (h > zero);
      if (tile_depth_known_) live = drop_hidden(live, box, nearest);
      box.pack().store(box_ + i);
      nearest.store(nearest_ + i);
      const Mask masked = (gather(&triangles_->flags, word) & i32(int32_t{kMaterialMasked})) != zero;
      const Mask tiny = (w * h < i32(kPacketPixels + 1)) & has_tiny_extent(c);
      const Mask opaque = and_not(masked, live);
      const Mask small = (w < i32(kSmallColumns + 1)) & (h < i32(kSmallRows + 1));
      masked_.add(index, live & masked);
      tiny_.add(index, opaque & tiny);
      small_.add(index, and_not(tiny, opaque & small));
      large_.add(index, and_not(tiny | small, opaque));
    }
  }

  HWY_INLINE Mask drop_hidden(Mask candidates, const BoxLanes& box, F32 nearest) {
    const Mask live = candidates & tile_depth_.may_show(box, nearest);
    out_.triangles_hidden += static_cast<uint64_t>(count(candidates) - count(live));
    return live;
  }

  // Near ones first, by a coarse logarithm of their depth in this tile. Bits of positive floats are in order of their values.
  void sort_by_depth(List& list) {
    const int n = list.count;
    if (n < 2) return;
    constexpr int kBuckets = 32;
    alignas(64) uint32_t key[kRoom + 16];
    for (int i = 0; i < n; i += kLanes) {
      const I32 index = list.load(i, first_lanes(n - i));
      bits_of(nearest_depth(tile_, load_depth(tile_, triangles_, index), BoxLanes::unpack(gather(box_, index)))).store(key + i);
    }
    uint32_t low = ~0u, high = 0;
    for (int i = 0; i < n; ++i) low = std::min(low, key[i]), high = std::max(high, key[i]);
    int shift = 0;
    while ((high - low) >> shift >= kBuckets) ++shift;
    int start[kBuckets + 1] = {};
    for (int i = 0; i < n; ++i) ++start[((high - key[i]) >> shift) + 1];
    for (int b = 0; b < kBuckets; ++b) start[b + 1] += start[b];
    int32_t sorted[kRoom];
    for (int i = 0; i < n; ++i) sorted[start[(high - key[i]) >> shift]++] = list.index[i];
    std::memcpy(list.index, sorted, static_cast<size_t>(n) * 4);
  }

  void refresh_if(int pixels) {
    if (stale_pixels_ < pixels) return;
    tile_depth_.refresh(out_.depth, tile_, stale_blocks_);
    tile_depth_known_ = true;
    stale_pixels_ = 0, stale_blocks_ = 0;
  }

  template <bool kSmall, bool kMasked> void draw_walked(const List& list) {
    WalkSetups setups;
    for (int i = 0; i < list.count; i += kLanes) {
      refresh_if(kRefreshPixels);
      const Mask valid = first_lanes(list.count - i);
      const I32 index = list.load(i, valid);
      const BoxLanes box = BoxLanes::unpack(gather(box_, index));
      const DepthLanes depth = load_depth(tile_, triangles_, index);
      const Mask live = drop_hidden(valid, box, nearest_depth(tile_, depth, box));
      uint32_t bits = to_bits(live);
      if (bits == 0) continue;
      setup_walk(load_corners(tile_, triangles_, index), box, depth, setups);
      gather(&triangles_->primitive, index * i32(kTriangleWords)).store(setups.primitive);
      for (; bits != 0; bits &= bits - 1) {
        const int k = __builtin_ctz(bits);
        const int w = setups.x1[k] - setups.x0[k], h = setups.y1[k] - setups.y0[k];
        // Boxes of one block or so have just been tested.
        const bool wide = !kSmall && (w > TileDepth::kBlock || h > TileDepth::kBlock);
        if (wide) refresh_if(kRefreshPixels);  // the first of a vector may hide all others
        uint32_t blocks = TileDepth::blocks_of(setups.x0[k], setups.x1[k], setups.y0[k], setups.y1[k]);
        if (wide && tile_depth_known_) blocks &= tile_depth_.blocks_that_show(tile_, setups, k);
        out_.triangles_hidden += blocks == 0;
        if (blocks == 0) continue;
        walk<kSmall, kMasked>(setups, k, blocks);
        stale_pixels_ += w * h;
        stale_blocks_ |= blocks;
      }
    }
  }

  // Nearer, or as near and of a lower id. Bits of floats that are not negative are in order of their values.
  static HWY_INLINE Mask wins(F32 depth, I32 primitive, F32 stored, I32 owner) {
    return bits_of(depth) > bits_of(stored) - select(less_unsigned(primitive, owner), i32(1), I32::zero());
  }

  template <bool kSmall, bool kMasked> HWY_NOINLINE void walk(const WalkSetups& setups, int k, uint32_t blocks) {
    const I32 primitive = i32(setups.primitive[k]);
    float* const depths = out_.depth;  // no members: stores into the tile might change them
    uint32_t* const owners = out_.primitive;
    int passed = 0, vectors = 0;
    walk_columns<kSmall>(tile_, setups, k, blocks, [&](int column, int row, Mask inside, F32 depth) HWY_ATTR {
      ++vectors;
      const int offset = row * kTileSize + column;
      const F32 stored = F32::load(depths + offset);
      const I32 owner = I32::load(owners + offset);
      Mask visible = inside & wins(depth, primitive, stored, owner);
      if (kMasked) {
        visible = ask_accept(frame_, setups.primitive[k], tile_.x + column, tile_.y + row, visible, place_);
        if (!any(visible)) return;
      }
      passed += count(visible);
      select(visible, depth, stored).store(depths + offset);
      select(visible, primitive, owner).store(owners + offset);
    });
    out_.passed += static_cast<uint64_t>(passed);
    out_.walker_lanes.add({static_cast<uint64_t>(vectors) * kLanes, static_cast<uint64_t>(passed)});
  }

  void draw_tiny() {
    if (tile_depth_known_) cull_tiny();
    PacketFragments fragments;
    for (int i = 0; i < tiny_.count; i += kLanes) {
      const Mask valid = first_lanes(tiny_.count - i);
      const I32 index = tiny_.load(i, valid);
      fragments.count = fragments.steps = 0;
      walk_packet(tile_, load_corners(tile_, triangles_, index), BoxLanes::unpack(gather(box_, index)),
                  load_depth(tile_, triangles_, index), gather(&triangles_->primitive, index * i32(kTriangleWords)), valid, fragments);
      out_.packet_lanes.add({static_cast<uint64_t>(fragments.steps) * kLanes, static_cast<uint64_t>(fragments.count)});
      drain(fragments);
    }
  }

  void cull_tiny() {
    int kept = 0;
    for (int i = 0; i < tiny_.count; i += kLanes) {
      const Mask valid = first_lanes(tiny_.count - i);
      const I32 index = tiny_.load(i, valid);
      const Mask live = drop_hidden(valid, BoxLanes::unpack(gather(box_, index)), gather(nearest_, index));
      kept += compress_store(index, live, tiny_.index + kept);
    }
    tiny_.count = kept;
  }

  void drain(const PacketFragments& f) {
    int passed = 0;
    for (int i = 0; i < f.count; ++i) {
      const int offset = f.offset[i];
      const uint32_t primitive = static_cast<uint32_t>(f.primitive[i]), owner = out_.primitive[offset];
      const float depth = f.depth[i], stored = out_.depth[offset];
      const bool visible = (depth > stored) | ((depth == stored) & (primitive < owner));
      passed += visible;
      out_.depth[offset] = visible ? depth : stored;
      out_.primitive[offset] = visible ? primitive : owner;
    }
    out_.passed += static_cast<uint64_t>(passed);
    stale_pixels_ += f.count;
    stale_blocks_ = TileDepth::kAllBlocks;
  }

  const Frame& frame_;
  const TileFrame tile_;
  const int place_;
  TileHits& out_;
  TileDepth tile_depth_;
  bool tile_depth_known_ = false;
  uint32_t stale_blocks_ = 0;
  int stale_pixels_ = 0, count_ = 0;
  List large_, small_, tiny_, masked_;
  alignas(64) int32_t box_[kRoom + 16];
  alignas(64) float nearest_[kRoom + 16];  // depth_max
  alignas(64) ScreenTriangle triangles_[kRoom];
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_WINDOW_INL_H_
