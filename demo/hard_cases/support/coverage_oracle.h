// Coverage by edge functions in 128-bit integers, pixel by pixel: slow, obvious, and unlike the engine's.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "frame/tiles.h"

namespace spanray {

__extension__ typedef __int128 int128;

// True if a point lies inside the triangle by the top-left rule (D3D11.3 specification, 3.4.2).
inline bool oracle_covers_point(const int32_t x_24_8[3], const int32_t y_24_8[3], int128 px, int128 py) {
  int128 x[3], y[3];
  for (int i = 0; i < 3; ++i) x[i] = x_24_8[i], y[i] = y_24_8[i];
  const int128 area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  if (area == 0) return false;
  if (area < 0) {
    const int128 tx = x[1], ty = y[1];
    x[1] = x[2], y[1] = y[2], x[2] = tx, y[2] = ty;
  }
  // y points down and the area is positive: the inside is to the right of an edge that goes up, below one that goes right.
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    const int128 dx = x[b] - x[a], dy = y[b] - y[a];
    const int128 e = dx * (py - y[a]) - dy * (px - x[a]);
    const bool left = dy < 0, top = dy == 0 && dx > 0;
    if (e < 0 || (e == 0 && !left && !top)) return false;
  }
  return true;
}
// True if the center of pixel (column, row) does.
inline bool oracle_covers(const int32_t x_24_8[3], const int32_t y_24_8[3], int column, int row) {
  return oracle_covers_point(x_24_8, y_24_8, int128{column} * 256 + 128, int128{row} * 256 + 128);
}
inline bool oracle_covers(const ScreenTriangle& t, int column, int row) { return oracle_covers(t.x_24_8, t.y_24_8, column, row); }

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

}  // namespace spanray
