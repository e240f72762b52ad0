// Tiles, bins and what a tile sees.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/aligned.h"

namespace spanray {

inline constexpr int kCellSize = 16;  // of the squares of a tile whose pixels are shaded one after the other
inline constexpr uint32_t kCellMask = ~(uint32_t{kCellSize - 1} * 0x10001u);  // of a pixel: x and y of its cell
inline constexpr int kTileSize = 64;  // pixels; depth and id of a tile (32 KB) fit the first-level cache
inline constexpr int kTilePixels = kTileSize * kTileSize;

struct TileGrid {
  int width = 0, height = 0, columns = 0, rows = 0;
  TileGrid() = default;
  TileGrid(int w, int h) : width(w), height(h), columns((w + kTileSize - 1) / kTileSize), rows((h + kTileSize - 1) / kTileSize) {}
  int count() const { return columns * rows; }
  int x0(int tile) const { return tile % columns * kTileSize; }
  int y0(int tile) const { return tile / columns * kTileSize; }
  int x1(int tile) const { return std::min(x0(tile) + kTileSize, width); }
  int y1(int tile) const { return std::min(y0(tile) + kTileSize, height); }
};

// Vertices after the transform stage, one entry a scene vertex. Positions in homogeneous pixels (frame/rays.h), in double.
struct ScreenVertices {
  AlignedBuffer<double> x, y, w;          // X, Y, W; pixel = X / W, Y / W
  AlignedBuffer<int32_t> x_24_8, y_24_8;  // snapped pixel position; only valid where outcode == 0
  AlignedBuffer<uint16_t> outcode;        // kOut* bits
  size_t memory_bytes() const { return x.bytes() + y.bytes() + w.bytes() + x_24_8.bytes() + y_24_8.bytes() + outcode.bytes(); }
};
enum Outcode : uint16_t {
  kOutNear = 1,                                                       // w < near
  kOutLeft = 2, kOutRight = 4, kOutTop = 8, kOutBottom = 16,          // outside the guard band: must be clipped
  kOffLeft = 32, kOffRight = 64, kOffTop = 128, kOffBottom = 256,     // outside the picture (only culls)
  kOutInvalid = 512,                                                  // not finite: its triangles are dropped and counted
  kOutClipMask = kOutNear | kOutLeft | kOutRight | kOutTop | kOutBottom | kOutInvalid,
};
inline constexpr int32_t kGuardBandPixels = 1 << 15;  // |pixel coordinate| <= this after clipping
inline constexpr int kSubpixelBits = 8;

// A triangle (or a piece of a clipped one) ready for scan conversion: one cache line.
// Depth plane: depth(x, y) = depth0 + x * depth_dx + y * depth_dy at pixel position (x, y), in double, from the *unsnapped original*
// triangle, so all pieces of a clipped triangle share it bit for bit; then clamped to [depth_min, depth_max].
struct alignas(64) ScreenTriangle {
  int32_t x_24_8[3], y_24_8[3];  // any winding: coverage does not depend on it
  uint32_t primitive;            // index into SceneData::triangles
  uint32_t flags;                // MaterialFlags of the primitive
  float depth_min, depth_max;
  double depth0, depth_dx, depth_dy;
};
static_assert(sizeof(ScreenTriangle) == 64);

// First and last column and row of the tiles that a triangle's bounding box meets, a byte each: a picture has at most 256 either way.
inline uint32_t pack_tile_box(uint32_t column0, uint32_t column1, uint32_t row0, uint32_t row1) {
  return column0 | column1 << 8 | row0 << 16 | row1 << 24;
}

// What one task of the front end made from a range of primitives, in order of primitives. Reading the chunks in order, a
// tile sees its triangles in order of their ids: ties in depth go to the lowest without any comparison of ids.
struct BinChunk {
  AlignedBuffer<ScreenTriangle> triangles;
  AlignedBuffer<uint32_t> tile_box;                       // by triangle: pack_tile_box
  bool has_translucent = false;
  std::vector<uint32_t> opaque_start, translucent_start;  // per tile, prefix sums, size tiles + 1
  AlignedBuffer<uint32_t> opaque, translucent;            // indices into triangles, by tile
};
struct TileBins {
  TileGrid grid;
  std::vector<BinChunk> chunks;
  size_t memory_bytes() const {
    size_t bytes = 0;
    for (const BinChunk& c : chunks)
      bytes += c.triangles.bytes() + c.tile_box.bytes() + c.opaque.bytes() + c.translucent.bytes() +
               (c.opaque_start.capacity() + c.translucent_start.capacity()) * sizeof(uint32_t);
    return bytes;
  }
};

// How full the vectors of a kernel were: lanes that it computed, and those of them that were of use.
struct LaneCounts {
  uint64_t computed = 0, used = 0;
  void add(const LaneCounts& other) { computed += other.computed, used += other.used; }
};

// The visibility buffer of one tile: row-major kTileSize x kTileSize, also where the picture ends inside the tile.
struct TileHits {
  alignas(64) uint32_t primitive[kTilePixels];  // kNoPrimitive: background
  alignas(64) float depth[kTilePixels];         // 0: background
  uint64_t triangles, triangles_hidden, passed;  // what it took: FrameCounts
  LaneCounts walker_lanes, packet_lanes;
};

// Translucent candidates of a tile or a ray batch, unordered: shading orders them. `ray` as in HitBatch, `pixel` packed.
struct FragmentList {
  AlignedBuffer<uint32_t> pixel, ray, primitive;
  void clear() { pixel.clear(), ray.clear(), primitive.clear(); }
  size_t memory_bytes() const { return pixel.bytes() + ray.bytes() + primitive.bytes(); }
};

}  // namespace spanray
