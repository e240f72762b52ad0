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

struct Run { uint32_t tile, first, length; };  // triangles first, first + 1, ...

// The entries of one chunk on their way into lists by tile. Kept by a worker from chunk to chunk. Runs, because small triangles that
// are neighbours in a mesh often fall into one tile.
struct EntryList {
  AlignedBuffer<Run> runs;
  size_t count = 0;

  void start(std::vector<uint32_t>& tile_start, int tiles) {
    count = 0;
    tile_start.assign(static_cast<size_t>(tiles) + 1, 0);
  }
  void make_room(size_t n) {
    if (count + n > runs.size()) runs.resize(2 * (count + n) + 4096);
  }
  void add(uint32_t tile, uint32_t first, uint32_t length, uint32_t* tile_count) {
    runs[count++] = {tile, first, length};
    tile_count[tile] += length;
  }
  // Stable counting sort by tile. In: start[tile + 1] counts the tile's entries. Out: list[start[tile] .. start[tile + 1]).
  void sort(std::vector<uint32_t>& start, AlignedBuffer<uint32_t>& list) {
    for (size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
    list.resize(start.back());
    for (const Run* run = runs.data(); run < runs.data() + count; ++run) {
      uint32_t* const to = list.data() + start[run->tile];
      for (uint32_t k = 0; k < run->length; ++k) to[k] = run->first + k;
      start[run->tile] += run->length;
    }
    // Each start has moved on to the next one's place.
    for (size_t i = start.size() - 1; i > 0; --i) start[i] = start[i - 1];
    start[0] = 0;
  }
};

void bin_chunk(const TileGrid& grid, const SamplePlaces& samples, BinChunk& chunk, EntryList& opaque, EntryList& translucent) {
  constexpr uint32_t kFewTiles = 4;  // up to so many the edge test, and reading the triangle for it, costs more than it saves
  opaque.start(chunk.opaque_start, grid.count());
  translucent.start(chunk.translucent_start, grid.count());
  const uint32_t columns = static_cast<uint32_t>(grid.columns);
  const uint32_t* const tile_box = chunk.tile_box.data();
  const uint32_t triangles = static_cast<uint32_t>(chunk.triangles.size());
  for (uint32_t i = 0; i < triangles; ++i) {
    const uint32_t box = tile_box[i];
    const uint32_t column0 = box & 255, column1 = box >> 8 & 255, row0 = box >> 16 & 255, row1 = box >> 24;
    const bool blended = chunk.has_translucent && (chunk.triangles[i].flags & kMaterialTranslucent) != 0;
    EntryList& list = blended ? translucent : opaque;
    uint32_t* const tile_count = (blended ? chunk.translucent_start : chunk.opaque_start).data() + 1;
    const uint32_t tiles = (column1 - column0 + 1) * (row1 - row0 + 1);
    list.make_room(tiles);
    if (tiles == 1) {
      const uint32_t first = i;
      while (!chunk.has_translucent && i + 1 < triangles && tile_box[i + 1] == box) ++i;
      list.add(row0 * columns + column0, first, i + 1 - first, tile_count);
      continue;
    }
    const auto each_tile = [&](const auto& visit) {
      for (uint32_t row = row0; row <= row1; ++row)
        for (uint32_t column = column0; column <= column1; ++column) visit(row * columns + column);
    };
    if (tiles <= kFewTiles) {
      each_tile([&](uint32_t tile) { list.add(tile, i, 1, tile_count); });
      continue;
    }
    const EdgeTest edges(chunk.triangles[i], samples);
    each_tile([&](uint32_t tile) {
      if (edges.may_cover(grid, static_cast<int>(tile))) list.add(tile, i, 1, tile_count);
    });
  }
  opaque.sort(chunk.opaque_start, chunk.opaque);
  translucent.sort(chunk.translucent_start, chunk.translucent);
}

}  // namespace

void bin_triangles(const Frame& frame, TileBins& bins) {
  bins.grid = frame.grid;
  struct Scratch { EntryList opaque, translucent; };
  std::vector<Scratch> scratch(static_cast<size_t>(frame.parallel->threads()));
  frame.parallel->for_each(bins.chunks.size(), [&](size_t i, int worker) {
    Scratch& s = scratch[static_cast<size_t>(worker)];
    bin_chunk(frame.grid, frame.places, bins.chunks[i], s.opaque, s.translucent);
  });
}

}  // namespace spanray
