// The visibility buffer of a tile: nearest opaque primitive and depth of each pixel.
#include <algorithm>
#include <cstdint>
#include <cstring>

#include "frame/frame.h"
#include "raster/fixed_point.h"
#include "raster/raster.h"
#include "raster/visibility_kernel.h"
#include "simd/dispatch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/visibility_kernel.cpp"
#include "hwy/foreach_target.h"
#include "simd/lanes-inl.h"
#include "raster/window-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// Nearest primitive of each pixel; of equal depths the lowest id, in whatever order triangles are drawn.
// Source:   visibility buffer: Burns and Hunt 2013, JCGT 2(2).
void rasterize_tile(const Frame& frame, const TileBins& bins, int tile, TileHits& out, int place) {
  std::fill_n(out.primitive, kTilePixels, kNoPrimitive);
  std::fill_n(out.depth, kTilePixels, 0.0f);
  out.triangles = out.triangles_hidden = out.passed = 0;
  out.walker_lanes = out.packet_lanes = {};
  Window window(frame, tile, place, out);
  for (const BinChunk& chunk : bins.chunks) {
    const uint32_t end = chunk.opaque_start[static_cast<size_t>(tile) + 1];
    for (uint32_t i = chunk.opaque_start[static_cast<size_t>(tile)]; i < end; ++i) window.add(chunk.triangles[chunk.opaque[i]]);
  }
  window.draw();
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {

const RasterizeTileFn kRasterizeTile[kIsaCount] = SPANRAY_KERNEL_TABLE(rasterize_tile);

void rasterize_tile(const Frame& frame, const TileBins& bins, int tile, TileHits& out, int place) {
  kRasterizeTile[isa_index(frame.isa)](frame, bins, tile, out, place);
}

}  // namespace spanray
#endif
