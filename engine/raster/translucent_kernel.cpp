// Translucent fragments of a tile.
#include <algorithm>
#include <cstdint>
#include <cstring>

#include "frame/frame.h"
#include "raster/fixed_point.h"
#include "raster/raster.h"
#include "raster/visibility_kernel.h"
#include "simd/dispatch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/translucent_kernel.cpp"
#include "hwy/foreach_target.h"
#include "simd/lanes-inl.h"
#include "raster/accept-inl.h"
#include "raster/tile_depth-inl.h"
#include "raster/walk_columns-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// One bit a pixel of the tile that the current primitive has had a fragment in: where snapping makes the outline of a clipped
// triangle cross itself, its pieces overlap.
struct SeenPixels {
  uint32_t primitive = kNoPrimitive;
  uint64_t row[kTileSize];

  void start(uint32_t p) {
    if (p == primitive) return;
    primitive = p;
    std::memset(row, 0, sizeof row);
  }
  // Returns the bits not seen before, of pixels from (column, y) on.
  uint32_t add(int column, int y, uint32_t bits) {
    uint64_t& seen = row[y];
    const uint32_t fresh = bits & ~static_cast<uint32_t>(seen >> column);
    seen |= uint64_t{bits} << column;
    return fresh;
  }
};

HWY_INLINE void append_fragments(uint32_t bits, int x, int y, uint32_t primitive, FragmentList& out) {
  for (; bits != 0; bits &= bits - 1) {
    out.pixel.push_back(pack_pixel(static_cast<uint32_t>(x + __builtin_ctz(bits)), static_cast<uint32_t>(y)));
    out.ray.push_back(0);
    out.primitive.push_back(primitive);
  }
}

// The triangles of a tile, kLanes set up at once, drawn one after the other: in order of primitives.
void rasterize_translucent(const Frame& frame, const TileBins& bins, int tile, const TileHits& opaque, FragmentList& out, int place) {
  const TileFrame view = tile_frame(frame, tile, place);
  WalkSetups setups;
  SeenPixels seen;
  for (const BinChunk& chunk : bins.chunks) {
    const uint32_t begin = chunk.translucent_start[static_cast<size_t>(tile)], end = chunk.translucent_start[static_cast<size_t>(tile) + 1];
    const ScreenTriangle* const triangles = chunk.triangles.data();
    for (uint32_t i = begin; i < end; i += kLanes) {
      alignas(64) uint32_t listed[kLanes];
      for (uint32_t k = 0; k < kLanes; ++k) listed[k] = chunk.translucent[std::min(i + k, end - 1)];
      const I32 index = I32::load(listed), zero = I32::zero();
      const CornerLanes corners = load_corners(view, triangles, index);
      const BoxLanes box = box_of(view, corners);
      const Mask live = first_lanes(static_cast<int>(end - i)) & (box.x1 > box.x0) & (box.y1 > box.y0);
      if (!any(live)) continue;
      setup_walk(corners, box, load_depth(view, triangles, index), setups);
      const I32 word = index * i32(kTriangleWords);
      gather(&triangles->primitive, word).store(setups.primitive);
      const uint32_t masked = to_bits((gather(&triangles->flags, word) & i32(int32_t{kMaterialMasked})) != zero);
      for (uint32_t left = to_bits(live); left != 0; left &= left - 1) {
        const int k = __builtin_ctz(left);
        const uint32_t primitive = setups.primitive[k];
        seen.start(primitive);
        walk_columns<false>(view, setups, k, TileDepth::kAllBlocks, [&](int column, int row, Mask inside, F32 depth) HWY_ATTR {
          Mask visible = inside & (depth >= F32::load(opaque.depth + row * kTileSize + column));
          if ((masked >> k & 1u) != 0) visible = ask_accept(frame, primitive, view.x + column, view.y + row, visible, place);
          const uint32_t bits = to_bits(visible);
          if (bits != 0) append_fragments(seen.add(column, row, bits), view.x + column, view.y + row, primitive, out);
        });
      }
    }
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {

const RasterizeTranslucentFn kRasterizeTranslucent[kIsaCount] = SPANRAY_KERNEL_TABLE(rasterize_translucent);

void rasterize_translucent(const Frame& frame, const TileBins& bins, int tile, const TileHits& opaque, FragmentList& out, int place) {
  kRasterizeTranslucent[isa_index(frame.isa)](frame, bins, tile, opaque, out, place);
}

}  // namespace spanray
#endif
