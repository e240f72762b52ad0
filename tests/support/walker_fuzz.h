// One random triangle at a time through rasterize_tile, alone in its tile, against exact integers: coverage of every walker.
#pragma once
#include <gtest/gtest.h>

#include <cstdio>

#include "support/fuzzed_triangle.h"
#include "support/tile_probe.h"

namespace spanray {

// Every instruction set, and both ways through the rasterizer: opaque (by size) and masked (always the walker of large ones).
inline void fuzz_walkers(uint32_t seed, int triangles, int samples) {
  std::printf("seed %u\n", seed);
  std::fflush(stdout);
  TestRandom random(seed);
  TileProbe probe(150, 141, samples);
  Frame& frame = probe.frame();
  const std::vector<Isa> isas = supported_isas();
  int64_t covered = 0;
  for (int n = 0; n < triangles; ++n) {
    const int tile = random.below(frame.grid.count()), place = frame.places.first() + random.below(samples);
    ScreenTriangle triangle = fuzzed_triangle(random, frame.grid, tile);
    triangle.flags = random.below(4) == 0 ? uint32_t{kMaterialMasked} : 0u;
    const TileRows want = oracle_rows(triangle, frame.grid, tile, frame.places.offset_x_24_8[place], frame.places.offset_y_24_8[place]);
    for (const Isa isa : isas) {
      frame.isa = isa;
      const TileRows got = probe.rows(triangle, tile, place);
      covered += count_bits(got);
      ASSERT_EQ(count_differences(got, want), 0)
          << "triangle " << n << " on " << isa_name(isa) << ": (" << triangle.x_24_8[0] << "," << triangle.y_24_8[0] << ") ("
          << triangle.x_24_8[1] << "," << triangle.y_24_8[1] << ") (" << triangle.x_24_8[2] << "," << triangle.y_24_8[2] << ") tile "
          << tile << " place " << place << (triangle.flags ? " masked" : "");
    }
  }
  EXPECT_GT(covered, int64_t{triangles} * static_cast<int64_t>(isas.size()) * 20);
}

}  // namespace spanray
