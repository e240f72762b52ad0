// The pieces of clipped polygons. What clipping promises of edges, eyes and bad vertices: demo/hard_cases/clipping.cpp (R3, R9 to R14).
#include <gtest/gtest.h>

#include <cmath>

#include "raster/clip_polygon.h"
#include "support/random.h"

namespace spanray {
namespace {

TEST(RasterClip, PiecesCoverADentedPolygonWithoutOverlap) {
  TestRandom random(14);
  for (int n = 0; n < 5000; ++n) {
    // Corners in order of angle around an inner point: simple, seldom convex.
    SnappedPoint p[kMaxClipVertices];
    const int size = random.between(3, kMaxClipVertices);
    for (int i = 0; i < size; ++i) {
      const double angle = (i + random.uniform(0, 0.45)) * 2 * 3.14159265358979 / size, radius = random.uniform(n % 2 ? 50 : 5000, 6000);
      p[i] = {static_cast<int32_t>(radius * std::cos(angle)), static_cast<int32_t>(radius * std::sin(angle))};
    }
    const auto area2 = [&](int a, int b, int c) {
      return int64_t{p[b].x_24_8 - p[a].x_24_8} * (p[c].y_24_8 - p[a].y_24_8) - int64_t{p[c].x_24_8 - p[a].x_24_8} * (p[b].y_24_8 - p[a].y_24_8);
    };
    int64_t whole = 0, sum = 0;
    for (int i = 2; i < size; ++i) whole += area2(0, i - 1, i);
    uint8_t piece[kMaxClipVertices - 2][3];
    const int pieces = triangulate(p, size, piece);
    for (int i = 0; i < pieces; ++i) sum += std::abs(area2(piece[i][0], piece[i][1], piece[i][2]));
    ASSERT_EQ(sum, std::abs(whole)) << n;
  }
}

}  // namespace
}  // namespace spanray
