// Coverage and depth at every sample of every pattern, against exact integers and the plane in double.
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "raster/fixed_point.h"
#include "support/coverage_oracle.h"
#include "support/random.h"
#include "support/raster_front_end.h"

namespace spanray {
namespace {

constexpr int kPatterns[] = {4, 8, 16};
constexpr int kWidth = 200, kHeight = 70;  // 4 x 2 tiles

Camera camera_at(const glm::dvec3& eye, const glm::dvec3& target) {
  Camera c;
  for (int k = 0; k < 3; ++k) c.eye[k] = eye[k], c.target[k] = target[k];
  return c;
}

int128 sample_x(const SamplePlaces& s, int place, int column) { return int128{column} * 256 + 128 + s.offset_x_24_8[place]; }
int128 sample_y(const SamplePlaces& s, int place, int row) { return int128{row} * 256 + 128 + s.offset_y_24_8[place]; }

TEST(Samples, PatternsSpreadOverThePixel) {
  for (const int count : kPatterns) {
    const SamplePlaces s = make_sample_places(count);
    ASSERT_EQ(s.count, count);
    ASSERT_EQ(s.end() - s.first(), count);
    EXPECT_EQ(s.offset_x_24_8[0], 0);
    EXPECT_EQ(s.offset_y_24_8[0], 0);
    std::set<int> columns, rows;
    int64_t nearest = 1 << 30;
    for (int place = s.first(); place < s.end(); ++place) {
      const int64_t x = s.offset_x_24_8[place], y = s.offset_y_24_8[place];
      EXPECT_TRUE(x % 16 == 0 && y % 16 == 0 && x >= -128 && x < 128 && y >= -128 && y < 128) << "inside the pixel, on the grid";
      EXPECT_EQ(s.x[place], 0.5 + static_cast<double>(x) / 256);
      EXPECT_EQ(s.y[place], 0.5 + static_cast<double>(y) / 256);
      EXPECT_TRUE(x >= s.left && x <= s.right && y >= s.top && y <= s.bottom);
      columns.insert(static_cast<int>((x + 128) * count / 256)), rows.insert(static_cast<int>((y + 128) * count / 256));
      nearest = std::min(nearest, x * x + y * y);
    }
    // One sample in every column and row of a count x count grid: edges near the axes get all the steps there are.
    EXPECT_EQ(columns.size(), static_cast<size_t>(count));
    EXPECT_EQ(rows.size(), static_cast<size_t>(count));
    const int64_t x0 = s.offset_x_24_8[s.first()], y0 = s.offset_y_24_8[s.first()];
    EXPECT_EQ(x0 * x0 + y0 * y0, nearest) << "sample 0 is the one nearest the center";
  }
}

// One screen triangle, binned and drawn at every sample, on every instruction set.
void expect_oracle(const ScreenTriangle& t, int samples, int64_t& covered) {
  const auto f = make_test_frame(make_test_scene({soup_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}, {Material{}}), camera_at({0, 0, 3}, {0, 0, 0}), test_settings(kWidth, kHeight));
  f->frame.places = make_sample_places(samples);
  TileBins bins;
  bins.chunks.resize(1);
  const SamplePlaces& s = f->frame.places;
  const auto [x_min, x_max] = std::minmax({t.x_24_8[0], t.x_24_8[1], t.x_24_8[2]});
  const auto [y_min, y_max] = std::minmax({t.y_24_8[0], t.y_24_8[1], t.y_24_8[2]});
  const int x0 = std::max(first_center(x_min - s.right), 0), x1 = std::min(first_center(x_max - s.left), kWidth);
  const int y0 = std::max(first_center(y_min - s.bottom), 0), y1 = std::min(first_center(y_max - s.top), kHeight);
  if (x0 < x1 && y0 < y1) {  // else no sample lies in its box, and clipping drops it
    const auto tile_of = [](int pixel) { return static_cast<uint32_t>(pixel / kTileSize); };
    bins.chunks[0].triangles.push_back(t);
    bins.chunks[0].tile_box.push_back(pack_tile_box(tile_of(x0), tile_of(x1 - 1), tile_of(y0), tile_of(y1 - 1)));
  }
  bin_triangles(f->frame, bins);
  for (int place = f->frame.places.first(); place < f->frame.places.end(); ++place) {
    std::vector<Picture> pictures;
    for (const Isa isa : supported_isas()) {
      f->frame.isa = isa;
      pictures.push_back(rasterize(f->frame, bins, place));
    }
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const bool want = oracle_covers_point(t.x_24_8, t.y_24_8, sample_x(f->frame.places, place, x), sample_y(f->frame.places, place, y));
        covered += want;
        for (const Picture& p : pictures)
          ASSERT_EQ(p.id(x, y) == 0, want) << samples << " samples, place " << place << ", pixel " << x << "," << y << ": ("
              << t.x_24_8[0] << "," << t.y_24_8[0] << ") (" << t.x_24_8[1] << "," << t.y_24_8[1] << ") (" << t.x_24_8[2] << "," << t.y_24_8[2] << ")";
      }
  }
}

TEST(Samples, R1_CoverageEqualsExactIntegers) {
  TestRandom random(41);
  int64_t covered = 0;
  for (const int samples : kPatterns)
    for (int n = 0; n < 80; ++n) {
      // Tiny, middling, larger than the picture, out to the ends of the guard band; every other one on the grid of the samples. Every
      // fifth has its corners at those of tiles: what reaches into a tile there may cover samples only, and no center.
      const int32_t size[] = {200, 3000, 40000, kGuardBandPixels * 256};
      const int32_t grid = n % 8 < 4 ? 16 : 1;
      const bool at_tile_corners = n % 5 == 0;
      const int32_t reach = at_tile_corners ? 200 : size[n % 4];
      ScreenTriangle t{};
      const int32_t cx = random.between(0, kWidth * 256), cy = random.between(0, kHeight * 256);
      const auto near = [&](int32_t c) {
        return std::clamp<int32_t>((c + random.between(-reach, reach)) / grid * grid, -kGuardBandPixels * 256, kGuardBandPixels * 256);
      };
      for (int i = 0; i < 3; ++i) {
        t.x_24_8[i] = near(at_tile_corners ? random.between(0, 3) * kTileSize * 256 : cx);
        t.y_24_8[i] = near(at_tile_corners ? random.between(0, 1) * kTileSize * 256 : cy);
      }
      t.depth_min = t.depth_max = 0.5f, t.depth0 = 0.5;
      ASSERT_NO_FATAL_FAILURE(expect_oracle(t, samples, covered));
    }
  EXPECT_GT(covered, 100000);
}

TEST(Samples, R7_TinyTrianglesBetweenTheCentersAreSeen) {
  TestRandom random(42);
  std::vector<SoupTriangle> soup;
  for (int n = 0; n < 250; ++n) {
    const glm::dvec3 c(random.uniform(-1, 1), random.uniform(-0.7, 0.7), 0);
    const auto near = [&] { return c + glm::dvec3(random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02), 0); };
    const glm::dvec3 a = near(), b = near(), d = near();
    soup.push_back(soup_triangle(a, b, d));
  }
  for (const int samples : kPatterns) {
    const auto f = make_test_frame(make_test_scene(soup, {Material{}}), camera_at({0, 0, 3}, {0, 0, 0}), test_settings(66, 50));
    f->frame.places = make_sample_places(samples);
    const FrontEnd front = run_front_end(f->frame);
    int only_between = 0;
    std::set<uint32_t> at_center;
    for (const uint32_t id : rasterize(f->frame, front.bins).primitive) at_center.insert(id);
    for (int place = f->frame.places.first(); place < f->frame.places.end(); ++place) {
      const Picture p = rasterize(f->frame, front.bins, place);
      for (int y = 0; y < p.height; ++y)
        for (int x = 0; x < p.width; ++x) {
          bool want = false;
          for (const Triangle& t : f->scene.triangles) {
            int32_t px[3], py[3];
            for (int i = 0; i < 3; ++i) px[i] = front.vertices.x_24_8[t.vertex[i]], py[i] = front.vertices.y_24_8[t.vertex[i]];
            want = want || oracle_covers_point(px, py, sample_x(f->frame.places, place, x), sample_y(f->frame.places, place, y));
          }
          ASSERT_EQ(p.id(x, y) != kNoPrimitive, want) << samples << " samples, place " << place << ", pixel " << x << "," << y;
          only_between += want && !at_center.contains(p.id(x, y));
        }
    }
    EXPECT_GT(only_between, 20) << "triangles that cover no center must be among them";
  }
}

TEST(Samples, R2_NoSampleOfASheetIsCoveredTwiceOrNever) {
  constexpr int kSide = 24;
  TestRandom random(43);
  glm::dvec3 p[kSide + 1][kSide + 1];
  for (int j = 0; j <= kSide; ++j)
    for (int i = 0; i <= kSide; ++i) {
      const bool rim = i == 0 || j == 0 || i == kSide || j == kSide;
      const double jitter = rim ? 0 : 0.06;  // a quarter of a cell: no cell folds over
      p[j][i] = {-3 + 6.0 * i / kSide + random.uniform(-jitter, jitter), -3 + 6.0 * j / kSide + random.uniform(-jitter, jitter), 0};
    }
  std::vector<SoupTriangle> soup;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      soup.push_back(soup_triangle(p[j][i], p[j][i + 1], p[j + 1][i + 1]));
      soup.push_back(soup_triangle(p[j + 1][i + 1], p[j + 1][i], p[j][i]));
    }
  for (const Isa isa : supported_isas())
    for (const int samples : kPatterns) {
      const auto f = make_test_frame(make_test_scene(soup, {translucent_material()}), camera_at({0.1, 0.05, 3}, {0, 0, 0}), test_settings(150, 130, isa));
      f->frame.places = make_sample_places(samples);
      const FrontEnd front = run_front_end(f->frame);
      for (int place = f->frame.places.first(); place < f->frame.places.end(); ++place)
        for (const int count : count_fragments(f->frame, front.bins, place)) ASSERT_EQ(count, 1) << samples << " samples, place " << place;
    }
}

TEST(Samples, D1_DepthIsThatOfTheSample) {
  const std::vector<SoupTriangle> soup = {soup_triangle({-40, -1, 30}, {40, -1, 30}, {0, -1, -3000})};
  for (const int samples : kPatterns) {
    const auto f = make_test_frame(make_test_scene(soup, {Material{}}), camera_at({0, 0, 20}, {0, 0, 0}), test_settings(90, 70));
    f->frame.places = make_sample_places(samples);
    const FrontEnd front = run_front_end(f->frame);
    const PrimaryRays& rays = f->frame.primary;
    int seen = 0;
    for (int place = f->frame.places.first(); place < f->frame.places.end(); ++place) {
      const Picture p = rasterize(f->frame, front.bins, place);
      for (int y = 0; y < p.height; ++y)
        for (int x = 0; x < p.width; ++x) {
          if (p.id(x, y) == kNoPrimitive) continue;
          const glm::dvec3 d = rays.corner + rays.step_x * (x + f->frame.places.x[place]) + rays.step_y * (y + f->frame.places.y[place]);
          const double t = (-1 - rays.eye.y) / d.y;  // the plane y = -1
          ASSERT_NEAR(p.z(x, y) / (rays.near_plane / t), 1, 3e-7) << samples << " samples, place " << place << ", pixel " << x << "," << y;
          ++seen;
        }
    }
    EXPECT_GT(seen, 1000 * samples);
  }
}

}  // namespace
}  // namespace spanray
