// One screen triangle at a time through rasterize_tile, alone in its tile.
#pragma once
#include <algorithm>
#include <memory>
#include <vector>

#include "support/coverage_oracle.h"
#include "support/raster_front_end.h"

namespace spanray {

class TileProbe {
 public:
  TileProbe(int width, int height, int samples = 1)
      : test_(make_test_frame(make_test_scene({soup_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}), Camera(), test_settings(width, height))),
        hits_(std::make_unique<TileHits>()) {
    frame().places = make_sample_places(samples);
    frame().accept_row = [](const Frame&, uint32_t, int, int, uint32_t candidates, int) { return candidates; };
    bins_.grid = frame().grid;
    bins_.chunks.resize(1);
    BinChunk& chunk = bins_.chunks[0];
    chunk.triangles.resize(1), chunk.opaque.resize(1);
    chunk.opaque[0] = 0;
    chunk.opaque_start.assign(static_cast<size_t>(grid().count()) + 1, 0);
  }
  Frame& frame() { return test_->frame; }
  const TileGrid& grid() const { return test_->frame.grid; }

  // The pixels of `tile` that the triangle covers at one place; its primitive must be 0.
  TileRows rows(const ScreenTriangle& triangle, int tile, int place = 0) {
    BinChunk& chunk = bins_.chunks[0];
    chunk.triangles[0] = triangle;
    if (tile != tile_) {
      tile_ = tile;
      const auto start = chunk.opaque_start.begin() + tile + 1;
      std::fill(chunk.opaque_start.begin(), start, 0), std::fill(start, chunk.opaque_start.end(), 1);
    }
    rasterize_tile(frame(), bins_, tile, *hits_, place);
    TileRows rows{};
    for (size_t row = 0; row < kTileSize; ++row) {
      const uint32_t* const ids = hits_->primitive + row * kTileSize;
      uint32_t every = kNoPrimitive;
      for (size_t column = 0; column < kTileSize; ++column) every &= ids[column];
      if (every == kNoPrimitive) continue;  // most rows
      for (size_t column = 0; column < kTileSize; ++column) rows[row] |= uint64_t{ids[column] == 0} << column;
    }
    return rows;
  }

  // +1 in every pixel of the picture that the triangle covers at its center.
  void add(const ScreenTriangle& triangle, std::vector<int>& count) {
    count.resize(static_cast<size_t>(grid().width) * static_cast<size_t>(grid().height));
    for (int tile = 0; tile < grid().count(); ++tile) {
      const TileRows covered = rows(triangle, tile);
      for (int y = grid().y0(tile); y < grid().y1(tile); ++y)
        for (int x = grid().x0(tile); x < grid().x1(tile); ++x)
          count[static_cast<size_t>(y * grid().width + x)] += (covered[static_cast<size_t>(y - grid().y0(tile))] >> (x - grid().x0(tile)) & 1) != 0;
    }
  }

 private:
  std::unique_ptr<TestFrame> test_;
  std::unique_ptr<TileHits> hits_;
  TileBins bins_;
  int tile_ = -1;
};

inline int count_bits(const TileRows& rows) {
  int n = 0;
  for (const uint64_t row : rows) n += __builtin_popcountll(row);
  return n;
}
inline int count_differences(const TileRows& a, const TileRows& b) {
  int n = 0;
  for (size_t i = 0; i < a.size(); ++i) n += __builtin_popcountll(a[i] ^ b[i]);
  return n;
}

}  // namespace spanray
