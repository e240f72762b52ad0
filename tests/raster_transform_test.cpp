// The transform kernel against scalar double, on every instruction set; binning against brute force.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "raster/fixed_point.h"
#include "support/coverage_oracle.h"
#include "support/random.h"
#include "support/raster_front_end.h"

namespace spanray {
namespace {

std::vector<SoupTriangle> points(uint32_t seed, int n) {
  TestRandom random(seed);
  std::vector<SoupTriangle> soup;
  for (int i = 0; i < n; ++i) {
    const double size = std::exp(random.uniform(-3, i % 3 ? 3 : 60));
    glm::dvec3 p[3];
    for (glm::dvec3& q : p) q = {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
    soup.push_back(soup_triangle(p[0], p[1], p[2]));
  }
  return soup;
}

uint16_t scalar_outcode(const Frame& f, double x, double y, double w) {
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(w)) return kOutInvalid;
  const double guard = 32768 * w, right = f.grid.width * w, bottom = f.grid.height * w;
  return static_cast<uint16_t>((w < f.primary.near_plane ? kOutNear : 0) | (x < -guard ? kOutLeft : 0) | (x > guard ? kOutRight : 0) |
                               (y < -guard ? kOutTop : 0) | (y > guard ? kOutBottom : 0) | (x < 0 ? kOffLeft : 0) |
                               (x > right ? kOffRight : 0) | (y < 0 ? kOffTop : 0) | (y > bottom ? kOffBottom : 0));
}

TEST(RasterTransform, SameBitsAsScalarDouble) {
  for (const Isa isa : supported_isas()) {
    const auto t = make_test_frame(make_test_scene(points(1, 9001)), Camera{}, test_settings(321, 123, isa, 2));
    t->scene.vertices[17].position[1] = std::nanf("");
    t->scene.vertices[t->scene.vertices.size() - 1].position[2] = -INFINITY;
    ScreenVertices s;
    transform_vertices(t->frame, s);
    ASSERT_EQ(s.x.size(), t->scene.vertices.size());
    int snapped = 0, invalid = 0;
    for (size_t i = 0; i < s.x.size(); ++i) {
      const float* p = t->scene.vertices[i].position;
      const glm::dvec3 v = glm::dvec3(p[0], p[1], p[2]) - t->frame.primary.eye;
      const double x = dot3(t->frame.primary.pixel_row_x, v), y = dot3(t->frame.primary.pixel_row_y, v), w = dot3(t->frame.primary.forward, v);
      const uint16_t code = scalar_outcode(t->frame, x, y, w);
      ASSERT_EQ(s.outcode[i], code) << i;
      invalid += code == kOutInvalid;
      if (code == kOutInvalid) continue;
      ASSERT_EQ(0, std::memcmp(&x, &s.x[i], 8)) << i;
      ASSERT_EQ(0, std::memcmp(&y, &s.y[i], 8)) << i;
      ASSERT_EQ(0, std::memcmp(&w, &s.w[i], 8)) << i;
      if (code & kOutClipMask) continue;
      ++snapped;
      ASSERT_EQ(s.x_24_8[i], snap_24_8(x / w)) << i;
      ASSERT_EQ(s.y_24_8[i], snap_24_8(y / w)) << i;
    }
    EXPECT_EQ(invalid, 2);
    EXPECT_GT(snapped, 1000);
  }
}

TEST(RasterTransform, SnappingRoundsHalvesUp) {
  EXPECT_EQ(snap_24_8(0.5 / 256), 1);
  EXPECT_EQ(snap_24_8(-0.5 / 256), 0);
  EXPECT_EQ(snap_24_8(-1.5 / 256), -1);
  EXPECT_EQ(snap_24_8(0.49999999999999994 / 256), 0);
  EXPECT_EQ(snap_24_8(32768), kMax_24_8);
  EXPECT_EQ(snap_24_8(-32768.001), -kMax_24_8);
  EXPECT_EQ(first_center(128), 0);
  EXPECT_EQ(first_center(129), 1);
  EXPECT_EQ(first_center(-128), -1);
  EXPECT_EQ(first_center(-127), 0);
}

TEST(RasterTransform, TilesLieWhereSnappedVerticesAre) {
  // One unit is one pixel: corners on halves of 1/256 pixel reach the kernel exactly.
  const auto t = make_test_frame(make_test_scene({soup_triangle({0, 0, 0}, {0.5 / 256, 3, 0}, {-0.5 / 256, 1.5 / 256, 0})}), Camera{}, test_settings(64, 64));
  PrimaryRays& r = t->frame.primary;
  r.eye = {0, 0, 1}, r.pixel_row_x = {1, 0, 0}, r.pixel_row_y = {0, 1, 0}, r.forward = {0, 0, -1};
  for (const Isa isa : supported_isas()) {
    t->frame.isa = isa;
    ScreenVertices s;
    transform_vertices(t->frame, s);
    for (size_t i = 0; i < 3; ++i) {
      const float* p = t->scene.vertices[i].position;
      EXPECT_EQ(s.x_24_8[i], static_cast<int32_t>(std::floor(p[0] * 256 + 0.5f)));
      EXPECT_EQ(s.y_24_8[i], static_cast<int32_t>(std::floor(p[1] * 256 + 0.5f)));
    }
  }
}

TEST(RasterBin, EveryTileListsWhatCoversIt) {
  const auto t = make_test_frame(make_test_scene(points(2, 600)), Camera{}, test_settings(330, 200));
  const FrontEnd front = run_front_end(t->frame);
  const TileGrid& grid = t->frame.grid;
  size_t entries = 0, all = 0;
  for (const BinChunk& chunk : front.bins.chunks) {
    ASSERT_EQ(chunk.opaque_start.size(), static_cast<size_t>(grid.count()) + 1);
    all += chunk.triangles.size() * static_cast<size_t>(grid.count());
    entries += chunk.opaque.size();
    for (int tile = 0; tile < grid.count(); ++tile) {
      const uint32_t begin = chunk.opaque_start[static_cast<size_t>(tile)], end = chunk.opaque_start[static_cast<size_t>(tile) + 1];
      for (uint32_t i = begin + 1; i < end; ++i) ASSERT_LT(chunk.opaque[i - 1], chunk.opaque[i]);
      for (uint32_t k = 0; k < chunk.triangles.size(); ++k) {
        if (std::binary_search(chunk.opaque.begin() + begin, chunk.opaque.begin() + end, k)) continue;
        for (int y = grid.y0(tile); y < grid.y1(tile); y += 3)
          for (int x = grid.x0(tile); x < grid.x1(tile); ++x) ASSERT_FALSE(oracle_covers(chunk.triangles[k], x, y));
      }
    }
  }
  EXPECT_GT(entries, 100u);
  EXPECT_LT(entries, all / 2);
}

TEST(RasterBin, ChunksDoNotDependOnThreads) {
  size_t chunks[3];
  for (int i = 0; i < 3; ++i) {
    const int threads[] = {1, 2, 7};
    const auto t = make_test_frame(make_test_scene(points(3, 9000)), Camera{}, test_settings(64, 64, Isa::kAuto, threads[i]));
    chunks[i] = run_front_end(t->frame).bins.chunks.size();
  }
  EXPECT_GT(chunks[0], 1u);
  EXPECT_EQ(chunks[0], chunks[1]);
  EXPECT_EQ(chunks[0], chunks[2]);
}

TEST(RasterBin, EmptySceneIsAnEmptyPicture) {
  for (const Isa isa : supported_isas()) {
    const auto t = make_test_frame(make_test_scene({}), Camera{}, test_settings(65, 3, isa));
    for (const uint32_t id : rasterize(t->frame).primitive) ASSERT_EQ(id, kNoPrimitive);
  }
}

}  // namespace
}  // namespace spanray
