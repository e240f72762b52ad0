// Screen triangles -> lists by tile, chunk by chunk.
#include <algorithm>

#include "raster/fixed_point.h"
#include "raster/raster.h"

namespace spanray {
namespace {

// True if samples of the tile may lie inside: tests each edge at the corner of the samples' bounds that lies farthest inside it.
// Exact integers, boundaries count as inside.
class EdgeTest {
 public:
  EdgeTest(const ScreenTriangle& t, const SamplePlaces& samples) : t_(t), samples_(samples) {
    const int64_t area = int64_t{t.x_24_8[1] - t.x_24_8[0]} * (t.y_24_8[2] - t.y_24_8[0]) -
                         int64_t{t.x_24_8[2] - t.x_24_8[0]} * (t.y_24_8[1] - t.y_24_8[0]);
    sign_ = area < 0 ? -1 : 1;
  }
  bool may_cover(const TileGrid& grid, int tile) const {
    const int64_t left = center(grid.x0(tile)) + samples_.left, right = center(grid.x1(tile) - 1) + samples_.right;
    const int64_t top = center(grid.y0(tile)) + samples_.top, bottom = center(grid.y1(tile) - 1) + samples_.bottom;
    for (int a = 0; a < 3; ++a) {
      const int b = a == 2 ? 0 : a + 1;
      const int64_t dx = int64_t{t_.x_24_8[b] - t_.x_24_8[a]} * sign_, dy = int64_t{t_.y_24_8[b] - t_.y_24_8[a]} * sign_;
      const int64_t x = dy > 0 ? left : right, y = dx > 0 ? bottom : top;
      if (dx * (y - t_.y_24_8[a]) - dy * (x - t_.x_24_8[a]) < 0) return false;
    }
    return true;
  }

 private:
  static int64_t center(int pixel) { return int64_t{pixel} * kSubpixels + kSubpixels / 2; }
  const ScreenTriangle& t_;
  const SamplePlaces& samples_;
  int sign_;
};

struct TileRange { int column0, column1, row0, row1; };  // half-open

TileRange tiles_of(const ScreenTriangle& t, const TileGrid& grid, const SamplePlaces& s) {
  const auto [x_min, x_max] = std::minmax({t.x_24_8[0], t.x_24_8[1], t.x_24_8[2]});
  const auto [y_min, y_max] = std::minmax({t.y_24_8[0], t.y_24_8[1], t.y_24_8[2]});
  const auto last = [](int32_t coordinate, int size) { return (std::min(first_center(coordinate), size) + kTileSize - 1) / kTileSize; };
  return {std::max(first_center(x_min - s.right), 0) / kTileSize, last(x_max - s.left, grid.width),
          std::max(first_center(y_min - s.bottom), 0) / kTileSize, last(y_max - s.top, grid.height)};
}

struct Entry { uint32_t tile, triangle; };

// Stable counting sort of entries by tile.
void sort_by_tile(const AlignedBuffer<Entry>& entries, int tiles, std::vector<uint32_t>& start, AlignedBuffer<uint32_t>& list) {
  start.assign(static_cast<size_t>(tiles) + 1, 0);
  for (const Entry& e : entries) ++start[e.tile + 1];
  for (size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  list.resize(entries.size());
  for (const Entry& e : entries) list[start[e.tile]++] = e.triangle;
  // Each start has moved on to the next one's place.
  for (size_t i = start.size() - 1; i > 0; --i) start[i] = start[i - 1];
  start[0] = 0;
}

void bin_chunk(const TileGrid& grid, const SamplePlaces& samples, BinChunk& chunk) {
  constexpr int kFewTiles = 4;  // up to so many the edge test costs more than it saves
  AlignedBuffer<Entry> opaque, translucent;
  for (uint32_t i = 0; i < chunk.triangles.size(); ++i) {
    const ScreenTriangle& t = chunk.triangles[i];
    const TileRange r = tiles_of(t, grid, samples);
    AlignedBuffer<Entry>& entries = (t.flags & kMaterialTranslucent) ? translucent : opaque;
    const bool test = (r.column1 - r.column0) * (r.row1 - r.row0) > kFewTiles;
    const EdgeTest edges(t, samples);
    for (int row = r.row0; row < r.row1; ++row)
      for (int column = r.column0; column < r.column1; ++column) {
        const int tile = row * grid.columns + column;
        if (!test || edges.may_cover(grid, tile)) entries.push_back({static_cast<uint32_t>(tile), i});
      }
  }
  sort_by_tile(opaque, grid.count(), chunk.opaque_start, chunk.opaque);
  sort_by_tile(translucent, grid.count(), chunk.translucent_start, chunk.translucent);
}

}  // namespace

void bin_triangles(const Frame& frame, TileBins& bins) {
  bins.grid = frame.grid;
  frame.parallel->for_each(bins.chunks.size(), [&](size_t i, int) { bin_chunk(frame.grid, frame.places, bins.chunks[i]); });
}

}  // namespace spanray
