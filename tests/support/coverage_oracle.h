// Coverage by edge functions in 128-bit integers, pixel by pixel: slow, obvious, and unlike the engine's.
#pragma once
#include <cstdint>

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

}  // namespace spanray
