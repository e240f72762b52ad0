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
#include "raster/coverage-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// Walks the covered pixels of one triangle in one tile, a vector of columns at a time, rows from top to bottom.
// Contract: the depth of pixel (x, y) is ((depth0 + (y + 1/2) dy) + (x + 1/2) dx) in double, rounded to float, clamped to the
//           triangle's range: absolute coordinates, so its bits depend on neither tile, span, lane nor instruction set.
// visit(offset, x, y, inside, depth): lanes are the pixels at offset + lane of the tile, which are (x + lane, y) of the picture.
template <class Visit>
HWY_INLINE void walk_triangle(const TileGrid& grid, int tile, const ScreenTriangle& t, RowSpans& spans, const Visit& visit) {
  const int tile_x = grid.x0(tile), tile_y = grid.y0(tile);
  scan_triangle(t, tile_y, grid.y1(tile), tile_x, grid.x1(tile), spans);
  // What the column adds, for each vector of the tile that the triangle may touch: computed once for all rows.
  F64 column_depth[kTileSize / kLanes];
  int low = grid.x1(tile), high = tile_x;
  for (int k = 0; k < spans.count; ++k) low = std::min(low, spans.x0[k]), high = std::max(high, spans.x1[k]);
  for (int x = low & -kLanes; x < high; x += kLanes)
    column_depth[(x - tile_x) / kLanes] = (to_f64(lane_iota(x)) + f64(0.5)) * f64(t.depth_dx);
  const F32 depth_min = f32(t.depth_min), depth_max = f32(t.depth_max);
  for (int k = 0; k < spans.count; ++k) {
    const int x0 = spans.x0[k], x1 = spans.x1[k], y = spans.first + k;
    const F64 row_depth = f64(t.depth0 + (y + 0.5) * t.depth_dy);
    const int row_offset = (y - tile_y) * kTileSize - tile_x;
    const I32 begin = i32(x0), length = i32(x1 - x0);
    // Vectors are aligned to the tile, so that none reaches past the end of its arrays.
    for (int x = x0 & -kLanes; x < x1; x += kLanes) {
      const Mask inside = less_unsigned(lane_iota(x) - begin, length);
      const F64 depth = row_depth + column_depth[(x - tile_x) / kLanes];
      visit(row_offset + x, x, y, inside, clamp_(to_f32(depth), depth_min, depth_max));
    }
  }
}

// The triangle as it is, or moved by the negated offset of a place other than the center: what it covers and how deep it is at
// pixel centers is then what it covers and how deep it is at that place.
HWY_INLINE const ScreenTriangle& seen_from(const SamplePlaces& places, int place, const ScreenTriangle& t, ScreenTriangle& moved) {
  if (place == 0) return t;
  moved = t;
  const int32_t dx = places.offset_x_24_8[place], dy = places.offset_y_24_8[place];
  for (int i = 0; i < 3; ++i) moved.x_24_8[i] -= dx, moved.y_24_8[i] -= dy;
  moved.depth0 = t.depth0 + dx * (1.0 / kSubpixels) * t.depth_dx + dy * (1.0 / kSubpixels) * t.depth_dy;
  return moved;
}

// One bit a pixel of the tile that the current primitive has had a fragment in: where snapping makes the outline of a clipped
// triangle cross itself, its pieces overlap.
struct SeenPixels {
  uint32_t primitive = kNoPrimitive;
  uint32_t row[kTilePixels / 32];

  void start(uint32_t p) {
    if (p == primitive) return;
    primitive = p;
    std::memset(row, 0, sizeof row);
  }
  // Returns the bits not seen before. offset: a multiple of kLanes.
  uint32_t add(int offset, uint32_t bits) {
    uint32_t& word = row[offset / 32];
    const uint32_t fresh = bits & ~(word >> (offset % 32));
    word |= bits << (offset % 32);
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

void rasterize_translucent(const Frame& frame, const TileBins& bins, int tile, const TileHits& opaque, FragmentList& out, int place) {
  RowSpans spans;
  ScreenTriangle moved;
  SeenPixels seen;
  for (const BinChunk& chunk : bins.chunks) {
    const uint32_t end = chunk.translucent_start[static_cast<size_t>(tile) + 1];
    for (uint32_t i = chunk.translucent_start[static_cast<size_t>(tile)]; i < end; ++i) {
      const ScreenTriangle& t = seen_from(frame.places, place, chunk.triangles[chunk.translucent[i]], moved);
      seen.start(t.primitive);
      walk_triangle(frame.grid, tile, t, spans, [&](int offset, int x, int y, Mask inside, F32 depth) HWY_ATTR {
        Mask visible = inside & (depth >= F32::load(opaque.depth + offset));
        if (t.flags & kMaterialMasked) visible = ask_accept(frame, t.primitive, x, y, visible, place);
        const uint32_t bits = to_bits(visible);
        if (bits != 0) append_fragments(seen.add(offset, bits), x, y, t.primitive, out);
      });
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
