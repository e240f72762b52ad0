// One random triangle at a time through rasterize_tile, alone in its tile, against exact integers: coverage of every walker.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>

#include "raster/fixed_point.h"
#include "support/coverage_oracle.h"
#include "support/random.h"
#include "support/raster_front_end.h"

namespace spanray {

using TileRows = std::array<uint64_t, kTileSize>;  // a bit a pixel

// Edge functions in 64-bit integers (|e| < 2^51), stepped from pixel to pixel; the rule is that of oracle_covers_point.
inline TileRows oracle_rows(const ScreenTriangle& t, const TileGrid& grid, int tile, int32_t offset_x, int32_t offset_y) {
  TileRows rows{};
  int64_t x[3], y[3];
  for (int i = 0; i < 3; ++i) x[i] = t.x_24_8[i], y[i] = t.y_24_8[i];
  const int64_t area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  if (area == 0) return rows;
  if (area < 0) std::swap(x[1], x[2]), std::swap(y[1], y[2]);
  const auto [x_min, x_max] = std::minmax({x[0], x[1], x[2]});
  const auto [y_min, y_max] = std::minmax({y[0], y[1], y[2]});
  const int64_t first_x = std::max<int64_t>(grid.x0(tile), x_min / 256 - 2), end_x = std::min<int64_t>(grid.x1(tile), x_max / 256 + 2);
  const int64_t first_y = std::max<int64_t>(grid.y0(tile), y_min / 256 - 2), end_y = std::min<int64_t>(grid.y1(tile), y_max / 256 + 2);
  int64_t dx[3], dy[3], least[3];
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    dx[a] = x[b] - x[a], dy[a] = y[b] - y[a];
    least[a] = dy[a] < 0 || (dy[a] == 0 && dx[a] > 0) ? 0 : 1;  // left and top edges own their centers
  }
  for (int64_t py = first_y; py < end_y; ++py)
    for (int64_t px = first_x; px < end_x; ++px) {
      bool inside = true;
      for (int a = 0; a < 3; ++a)
        inside &= dx[a] * (py * 256 + 128 + offset_y - y[a]) - dy[a] * (px * 256 + 128 + offset_x - x[a]) >= least[a];
      rows[static_cast<size_t>(py - grid.y0(tile))] |= uint64_t{inside} << (px - grid.x0(tile));
    }
  return rows;
}

// Around the tile: specks, slivers, edges through pixel centers, along axes, across it, up to the guard band.
inline ScreenTriangle fuzzed_triangle(TestRandom& random, const TileGrid& grid, int tile) {
  ScreenTriangle t{};
  constexpr int kSizes[] = {40, 200, 700, 1500, 4000, 9000, 17000, 60000, 1 << 20, 2 * kMax_24_8};
  const int kind = random.below(16), size = kSizes[kind < 9 ? random.below(5) : random.below(10)];
  const int snap = std::array<int, 6>{1, 1, 1, 16, 128, 256}[static_cast<size_t>(random.below(6))];
  const int center_x = grid.x0(tile) * 256 + random.between(-2000, kTileSize * 256 + 2000);
  const int center_y = grid.y0(tile) * 256 + random.between(-2000, kTileSize * 256 + 2000);
  const auto limit = [](int64_t v) { return static_cast<int32_t>(std::clamp<int64_t>(v, -kMax_24_8, kMax_24_8)); };
  for (int i = 0; i < 3; ++i) {
    int64_t x = center_x + random.between(-size / 2, size / 2), y = center_y + random.between(-size / 2, size / 2);
    if (snap > 1) x = x / snap * snap + (snap > 16 ? 128 : 0), y = y / snap * snap + (snap > 16 ? 128 : 0);
    t.x_24_8[i] = limit(x), t.y_24_8[i] = limit(y);
  }
  if (kind == 3) t.x_24_8[2] = limit(t.x_24_8[0] + random.between(-2, 2)), t.y_24_8[2] = limit(t.y_24_8[0] + random.between(-2, 2));
  if (kind == 4) t.y_24_8[1] = t.y_24_8[0];
  if (kind == 5) t.x_24_8[1] = t.x_24_8[0];
  if (kind == 6) {  // (nearly) collinear
    const double s = random.uniform(-1, 2);
    t.x_24_8[2] = limit(t.x_24_8[0] + static_cast<int64_t>(s * (t.x_24_8[1] - t.x_24_8[0])));
    t.y_24_8[2] = limit(t.y_24_8[0] + static_cast<int64_t>(s * (t.y_24_8[1] - t.y_24_8[0])));
  }
  t.depth0 = 0.5, t.depth_min = 0.25f, t.depth_max = 0.75f;
  return t;
}

// Every instruction set, and both ways through the rasterizer: opaque (by size) and masked (always the walker of large ones).
inline void fuzz_walkers(uint32_t seed, int triangles, int samples) {
  std::printf("seed %u\n", seed);
  std::fflush(stdout);
  TestRandom random(seed);
  const auto t = make_test_frame(make_test_scene({soup_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}), Camera(), test_settings(150, 141));
  Frame& frame = t->frame;
  frame.places = make_sample_places(samples);
  frame.accept_row = [](const Frame&, uint32_t, int, int, uint32_t candidates, int) { return candidates; };
  TileBins bins;
  bins.grid = frame.grid;
  bins.chunks.resize(1);
  BinChunk& chunk = bins.chunks[0];
  chunk.triangles.resize(1), chunk.opaque.resize(1);
  chunk.opaque[0] = 0;
  const auto hits = std::make_unique<TileHits>();
  const std::vector<Isa> isas = supported_isas();
  int64_t covered = 0;
  for (int n = 0; n < triangles; ++n) {
    const int tile = random.below(frame.grid.count()), place = frame.places.first() + random.below(samples);
    ScreenTriangle& triangle = chunk.triangles[0];
    triangle = fuzzed_triangle(random, frame.grid, tile);
    triangle.flags = random.below(4) == 0 ? uint32_t{kMaterialMasked} : 0u;
    chunk.opaque_start.assign(static_cast<size_t>(frame.grid.count()) + 1, 0);
    std::fill(chunk.opaque_start.begin() + tile + 1, chunk.opaque_start.end(), 1);
    const TileRows want = oracle_rows(triangle, frame.grid, tile, frame.places.offset_x_24_8[place], frame.places.offset_y_24_8[place]);
    for (const Isa isa : isas) {
      frame.isa = isa;
      rasterize_tile(frame, bins, tile, *hits, place);
      int wrong = 0;
      for (size_t row = 0; row < kTileSize; ++row) {
        uint64_t got = 0;
        const uint32_t* const ids = hits->primitive + row * kTileSize;
        if (want[row] == 0) {  // most rows
          uint32_t every = kNoPrimitive;
          for (size_t column = 0; column < kTileSize; ++column) every &= ids[column];
          wrong += every != kNoPrimitive;
          continue;
        }
        for (size_t column = 0; column < kTileSize; ++column) got |= uint64_t{ids[column] == 0} << column;
        wrong += __builtin_popcountll(got ^ want[row]);
        covered += __builtin_popcountll(got);
      }
      ASSERT_EQ(wrong, 0) << "triangle " << n << " on " << isa_name(isa) << ": (" << triangle.x_24_8[0] << "," << triangle.y_24_8[0] << ") ("
                          << triangle.x_24_8[1] << "," << triangle.y_24_8[1] << ") (" << triangle.x_24_8[2] << "," << triangle.y_24_8[2]
                          << ") tile " << tile << " place " << place << (triangle.flags ? " masked" : "");
    }
  }
  EXPECT_GT(covered, int64_t{triangles} * static_cast<int64_t>(isas.size()) * 20);
}

}  // namespace spanray
