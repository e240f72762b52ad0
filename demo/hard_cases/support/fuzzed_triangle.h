// Random screen triangles of every awkward kind.
#pragma once
#include <algorithm>
#include <array>

#include "frame/tiles.h"
#include "raster/fixed_point.h"
#include "support/random.h"

namespace spanray {

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

}  // namespace spanray
