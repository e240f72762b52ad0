// The pieces of clipped polygons. What clipping promises of edges, eyes and bad vertices: demo/hard_cases/clipping.cpp (R3, R9 to R14).
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "raster/clip_polygon.h"
#include "support/camera_at.h"
#include "support/coverage_oracle.h"
#include "support/random.h"
#include "support/raster_front_end.h"

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

// Corners anywhere on a coarse grid, so that edges cross, touch and repeat, and points of the row lie on them.
TEST(RasterClip, RunsAreWhereAPolygonWindsAsItsArea) {
  TestRandom random(15);
  int inside = 0, reversed = 0;
  for (int n = 0; n < 4000; ++n) {
    SnappedPoint p[kMaxClipVertices];
    const int size = random.between(3, kMaxClipVertices), corner = random.between(-20, 20) * 400000;
    for (int i = 0; i < size; ++i) p[i] = {corner + random.between(-9, 9), random.between(-9, 9)};
    const auto area2 = [&](int i) {
      const SnappedPoint &a = p[0], &b = p[i - 1], &c = p[i];
      return (b.x_24_8 - a.x_24_8) * (c.y_24_8 - a.y_24_8) - (c.x_24_8 - a.x_24_8) * (b.y_24_8 - a.y_24_8);
    };
    int whole = 0;
    for (int i = 2; i < size; ++i) whole += area2(i);
    for (int y = -10; y <= 10; ++y) {
      RowRun run[kMaxClipVertices / 2];
      SnappedPoint cover[kMaxClipVertices / 2][3];
      const int runs = inside_runs(p, size, y, run);
      for (int k = 0; k < runs; ++k) triangle_of_run(run[k], y, cover[k]);
      for (int row = y - 1; row <= y + 1; ++row)
        for (int x = corner - 10; x <= corner + 10; ++x) {
          int winding = 0, covered = 0;
          const auto covers = [&](const SnappedPoint& a, const SnappedPoint& b, const SnappedPoint& c) {
            const int32_t xs[3] = {a.x_24_8, b.x_24_8, c.x_24_8}, ys[3] = {a.y_24_8, b.y_24_8, c.y_24_8};
            return oracle_covers_point(xs, ys, x, row);
          };
          for (int i = 2; i < size; ++i) winding += (area2(i) < 0 ? -1 : 1) * covers(p[0], p[i - 1], p[i]);
          for (int k = 0; k < runs; ++k) covered += covers(cover[k][0], cover[k][1], cover[k][2]);
          const bool want = row == y && (whole < 0 ? -winding : winding) > 0;
          ASSERT_EQ(covered, want) << "polygon " << n << " at " << x << ", " << row;
          inside += want, reversed += row == y && (whole < 0 ? -winding : winding) < 0;
        }
    }
  }
  EXPECT_GT(inside, 100000);
  EXPECT_GT(reversed, 10000);
}

// Two triangles of a mesh at the near plane, in homogeneous pixels, as R3 met them (view 195). Of the second, which shares the
// first's edge from corner 1 to 2, a corner is cut off within 1/256 pixel: snapped, what remains is (29684, 13285),
// (28975, 14914), (28460, 15582), (29684, 13286), whose first edge crosses its third one. The center of pixel (113, 56) lies on
// the third.
TEST(RasterClip, PolygonThatSnappingFoldsIsDrawnOnce) {
  constexpr double kNear = 0x1.2386e192141b2p+4;
  constexpr HomogeneousPoint kCorner[] = {{0x1.fa2f4a37950d7p+10, 0x1.bc6197994ea14p+9, 0x1.19d2c3374ac38p+4},
                                          {0x1.080f1917d737ap+11, 0x1.d890915e3e61cp+9, 0x1.23791c0cb4e2ap+4},
                                          {0x1.1a601faa8fb9ep+11, 0x1.3535d6bc29903p+10, 0x1.451e723e8ee97p+4},
                                          {0x1.1809395f9cd65p+11, 0x1.2047e66825c18p+10, 0x1.3cb316c34c7eap+4}};
  constexpr int kOf[2][3] = {{0, 1, 2}, {1, 3, 2}};
  // What the first leaves, and the second's polygon in signed triangles, the third negative.
  constexpr int32_t kX[3][3] = {{29684, 28460, 29186}, {29684, 28975, 28460}, {29684, 28460, 29684}};
  constexpr int32_t kY[3][3] = {{13286, 15582, 13583}, {13285, 14914, 15582}, {13285, 15582, 13286}};
  int drawn = 0;
  for (const auto& [samples, width] : {std::pair{1, 180}, {1, 114}, {4, 180}, {8, 114}, {16, 114}}) {  // 114 cuts it
    const std::vector<SoupTriangle> soup = {soup_triangle({0, 0, -20}, {1, 0, -20}, {0, 1, -20}),  // for the depth alone
                                            soup_triangle({0, 0, -21}, {1, 0, -21}, {0, 1, -21})};
    const Camera camera = camera_at({0, 0, 0}, {0, 0, -1});
    const auto t = make_test_frame(make_test_scene(soup, {translucent_material()}), camera, test_settings(width, 140));
    t->frame.places = make_sample_places(samples);
    t->frame.primary.near_plane = kNear;
    FrontEnd front;
    transform_vertices(t->frame, front.vertices);
    for (uint32_t i = 0; i < 6; ++i) {
      const uint32_t v = t->scene.triangles[i / 3].vertex[i % 3];
      const HomogeneousPoint& p = kCorner[kOf[i / 3][i % 3]];
      front.vertices.x[v] = p.x, front.vertices.y[v] = p.y, front.vertices.w[v] = p.w;
      front.vertices.outcode[v] = p.w < kNear ? kOutNear : 0;
    }
    clip_triangles(t->frame, front.vertices, front.bins, front.counts);
    bin_triangles(t->frame, front.bins);
    ASSERT_EQ(front.counts.triangles_clipped, 2u);
    const SamplePlaces& places = t->frame.places;
    for (int place = places.first(); place < places.end(); ++place) {
      const std::vector<int> count = count_fragments(t->frame, front.bins, place);
      for (int i = 0; i < width * 140; ++i) {
        const int32_t px = i % width * 256 + 128 + places.offset_x_24_8[place];
        const int32_t py = i / width * 256 + 128 + places.offset_y_24_8[place];
        int want = 0;  // how often both polygons wind around the sample
        for (int k = 0; k < 3; ++k) want += (k == 2 ? -1 : 1) * oracle_covers_point(kX[k], kY[k], px, py);
        ASSERT_EQ(count[static_cast<size_t>(i)], want) << "pixel " << i % width << ", " << i / width << ", place " << place;
        drawn += want;
      }
    }
  }
  EXPECT_GT(drawn, 30 * 6);
}

}  // namespace
}  // namespace spanray
