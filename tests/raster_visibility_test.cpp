// What each pixel sees, from world triangles to the visibility buffer.
#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "support/random.h"
#include "support/raster_front_end.h"

namespace spanray {
namespace {

Camera camera_at(const glm::dvec3& eye, const glm::dvec3& target, double near_plane = 0.01) {
  Camera c;
  for (int k = 0; k < 3; ++k) c.eye[k] = eye[k], c.target[k] = target[k];
  c.near_plane = near_plane;
  return c;
}

// Random triangles of all sizes around the origin, some behind a camera at (0, 0, 3).
std::vector<SoupTriangle> random_soup(uint32_t seed, int n, int materials = 1) {
  TestRandom random(seed);
  std::vector<SoupTriangle> soup;
  for (int i = 0; i < n; ++i) {
    const glm::dvec3 center{random.uniform(-3, 3), random.uniform(-2, 2), random.uniform(-4, 4)};
    const double size = std::exp(random.uniform(-5, 2));
    glm::dvec3 p[3];
    for (glm::dvec3& q : p) q = center + glm::dvec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
    soup.push_back(soup_triangle(p[0], p[1], p[2], static_cast<uint32_t>(random.below(materials))));
  }
  return soup;
}

uint32_t accept_checker(const Frame&, uint32_t primitive, int x0, int y, uint32_t candidates, int) {
  uint32_t bits = 0;
  for (int i = 0; i < 32; ++i) bits |= static_cast<uint32_t>((x0 + i + y + static_cast<int>(primitive)) & 1) << i;
  (void)candidates;  // more bits than asked for are ignored
  return bits;
}

Material material_with(MaterialTransparency transparency) {
  Material m;
  m.transparency = static_cast<int32_t>(transparency);
  m.opacity = 0.5f;  // what is wholly opaque has nothing to ask accept(hit)
  return m;
}

bool same(const Picture& a, const Picture& b) {
  return a.primitive == b.primitive && std::memcmp(a.depth.data(), b.depth.data(), a.depth.size() * sizeof(float)) == 0;
}

TEST(RasterVisibility, R17_OneResultForAllInstructionSetsThreadsAndFloatModes) {
  const SceneData scene = make_test_scene(random_soup(17, 5000, 3), {Material{}, material_with(MaterialTransparency::kMask), translucent_material()});
  Picture first;
  std::vector<std::pair<uint32_t, uint32_t>> first_fragments;
  for (const Isa isa : supported_isas())
    for (const int threads : {1, 2, 7})
      for (const bool poisoned : {false, true}) {
        SceneData copy = make_test_scene(random_soup(17, 5000, 3), scene.materials);
        const auto t = make_test_frame(std::move(copy), camera_at({0, 0, 3}, {0.1, 0.2, 0}), test_settings(200, 150, isa, threads));
        t->frame.accept_row = accept_checker;
        const unsigned before = _mm_getcsr();
        if (poisoned) _mm_setcsr(before | 0x8040 | 0x6000);  // flush to zero, denormals are zero, round toward zero
        const FrontEnd front = run_front_end(t->frame);
        const Picture p = rasterize(t->frame, front.bins);
        _mm_setcsr(before);
        const FragmentList list = all_fragments(t->frame, front.bins);
        std::vector<std::pair<uint32_t, uint32_t>> fragments;
        for (size_t i = 0; i < list.pixel.size(); ++i) fragments.emplace_back(list.primitive[i], list.pixel[i]);
        std::sort(fragments.begin(), fragments.end());
        if (first.width == 0) {
          first = p;
          first_fragments = fragments;
          EXPECT_GT(front.counts.triangles_clipped, 50u);
          EXPECT_GT(fragments.size(), 1000u);
        }
        ASSERT_TRUE(same(p, first)) << isa_name(isa) << " " << threads << " " << poisoned;
        ASSERT_TRUE(fragments == first_fragments) << isa_name(isa) << " " << threads << " " << poisoned;
      }
}

TEST(RasterVisibility, R7_SubPixelMeshCoversEveryPixelOnce) {
  // A jittered grid with a third of a pixel between vertices, 216,000 triangles, larger than the picture.
  constexpr int kCells = 330;
  TestRandom random(7);
  std::vector<glm::dvec3> grid;
  const Camera camera = camera_at({0, 0, 1}, {0, 0, 0});
  const double extent = std::tan(22.5 * 3.14159265358979 / 180) * 1.03, step = 2 * extent / kCells;
  for (int j = 0; j <= kCells; ++j)
    for (int i = 0; i <= kCells; ++i)
      grid.emplace_back(-extent + (i + random.uniform(-0.2, 0.2)) * step, -extent + (j + random.uniform(-0.2, 0.2)) * step, 0);
  std::vector<SoupTriangle> soup;
  const auto at = [&](int i, int j) { return grid[static_cast<size_t>(j * (kCells + 1) + i)]; };
  for (int j = 0; j < kCells; ++j)
    for (int i = 0; i < kCells; ++i) {
      soup.push_back(soup_triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1)));
      soup.push_back(soup_triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1)));
    }
  for (const Isa isa : supported_isas()) {
    const auto t = make_test_frame(make_test_scene(soup, {translucent_material()}), camera, test_settings(107, 107, isa));
    const FrontEnd front = run_front_end(t->frame);
    const std::vector<int> count = count_fragments(t->frame, front.bins);
    for (size_t i = 0; i < count.size(); ++i) ASSERT_EQ(count[i], 1) << i % 107 << "," << i / 107;
    EXPECT_EQ(front.counts.triangles_in, front.counts.triangles_drawn + front.counts.triangles_culled());
  }
}

TEST(RasterVisibility, R16_SmallOddAndThinPictures) {
  const int size[][2] = {{1, 1}, {1, 200}, {200, 1}, {63, 65}, {129, 3}, {64, 64}};
  const std::vector<SoupTriangle> wall = {soup_triangle({-500, -500, 0}, {500, -500, 0}, {500, 500, 0}),
                                          soup_triangle({-500, -500, 0}, {500, 500, 0}, {-500, 500, 0})};
  for (const auto& s : size)
    for (const Isa isa : supported_isas()) {
      const auto t = make_test_frame(make_test_scene(wall), camera_at({0.3, 0.2, 2}, {0.3, 0.2, 0}), test_settings(s[0], s[1], isa));
      const Picture p = rasterize(t->frame);
      for (const uint32_t id : p.primitive) ASSERT_NE(id, kNoPrimitive);
      for (const float z : p.depth) ASSERT_NEAR(z, 0.005, 1e-8);
    }
}

TEST(RasterVisibility, D1_PairsAMillionthApartAreInOrder) {
  TestRandom random(1);
  for (double z = 1e-3; z <= 1.1e6; z *= 10)
    for (int n = 0; n < 8; ++n) {
      // Tilted, crossing the whole view; the nearer is 1e-6 nearer along every ray. Double coordinates become floats: scale exactly.
      const double near_scale = 1 - 1e-6, tilt_x = random.uniform(-0.3, 0.3), tilt_y = random.uniform(-0.3, 0.3);
      const auto corner = [&](double x, double y, double scale) { return glm::dvec3(x, y, -1 + x * tilt_x + y * tilt_y) * (z * scale); };
      std::vector<SoupTriangle> soup;
      for (const double scale : {1.0, near_scale, 1.0})
        soup.push_back(soup_triangle(corner(-3, -1, scale), corner(3, -1, scale), corner(0, 2, scale)));
      const auto t = make_test_frame(make_test_scene(soup), camera_at({0, 0, 0}, {0, 0, -1}, 1e-4), test_settings(70, 70));
      const Picture p = rasterize(t->frame);
      int seen = 0;
      for (const uint32_t id : p.primitive) {
        if (id == kNoPrimitive) continue;
        ASSERT_EQ(id, 1u) << z;
        ++seen;
      }
      ASSERT_GT(seen, 2000);
    }
}

TEST(RasterVisibility, D2_CoplanarCopiesBelongToTheLowestId) {
  std::vector<SoupTriangle> soup = random_soup(2, 300);
  const size_t n = soup.size();
  for (size_t i = 0; i < n; ++i) {
    SoupTriangle copy = soup[i];  // corners rotated or mirrored
    std::swap(copy.corner[0], copy.corner[1 + i % 2]);
    if (i % 3 == 0) std::swap(copy.corner[1], copy.corner[2]);
    soup.push_back(copy);
  }
  const auto t = make_test_frame(make_test_scene(soup), camera_at({0, 0, 3}, {0, 0, 0}), test_settings(160, 120));
  const Picture p = rasterize(t->frame);
  int seen = 0;
  for (const uint32_t id : p.primitive)
    if (id != kNoPrimitive) {
      ASSERT_LT(id, n);
      ++seen;
    }
  EXPECT_GT(seen, 10000);
}

TEST(RasterVisibility, D4_DepthStaysWithinTheVerticesRange) {
  TestRandom random(4);
  int seen = 0;
  for (int n = 0; n < 400; ++n) {
    // A blade seen (nearly) edge-on: all three corners close to a plane through the eye.
    const glm::dvec3 eye{0.5, 0.25, 3}, u{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), -1}, v{random.uniform(-1, 1), random.uniform(-1, 1), 0};
    glm::dvec3 p[3];
    for (glm::dvec3& q : p) {
      const double w = random.uniform(1, 5), side = random.uniform(-0.3, 0.3), off = n % 4 == 0 ? 0 : random.uniform(-1e-2, 1e-2) / (1 + n % 9);
      q = eye + u * w + v * side * w + glm::dvec3(v.y, -v.x, 0.0) * off;
    }
    const auto t = make_test_frame(make_test_scene({soup_triangle(p[0], p[1], p[2])}), camera_at(eye, {0.5, 0.25, 0}), test_settings(300, 300));
    float low = 1, high = 0;
    for (const Vertex& vertex : t->scene.vertices) {
      const float z = static_cast<float>(0.01 / (eye.z - static_cast<double>(vertex.position[2])));
      low = std::min(low, z), high = std::max(high, z);
    }
    for (const float z : rasterize(t->frame).depth) {
      if (z == 0) continue;
      ASSERT_TRUE(z >= low && z <= high) << n << " " << z << " " << low << " " << high;
      ++seen;
    }
  }
  EXPECT_GT(seen, 1000);
}

TEST(RasterVisibility, D5_CrossingPlanesMeetWithinAPixelOfTheLine) {
  // Two walls through the y axis, at -3 and turned by +-0.5: left of the axis one is nearer, right of it the other.
  std::vector<SoupTriangle> soup;
  for (const double slope : {0.5, -0.5})
    soup.push_back(soup_triangle({-40, -40, -3 - 0.01 * 40 * slope}, {40, -40, -3 + 0.01 * 40 * slope}, {0, 80, -3}));
  const auto t = make_test_frame(make_test_scene(soup), camera_at({0, 0, 0}, {0, 0, -1}), test_settings(201, 101));
  const Picture p = rasterize(t->frame);
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x)
      if (std::abs(x - 100) > 1) { ASSERT_EQ(p.id(x, y), x > 100 ? 0u : 1u) << x << "," << y; }
}

// Depth against the exact ray, for whole scenes of pixels.
TEST(RasterVisibility, DepthIsThatOfTheRayAndTheOriginalTriangle) {
  const auto t = make_test_frame(make_test_scene(random_soup(3, 1000)), camera_at({0, 0, 3}, {0.1, 0.2, 0}), test_settings(160, 120));
  const Picture p = rasterize(t->frame);
  const PrimaryRays& r = t->frame.primary;
  int seen = 0;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) {
      if (p.id(x, y) == kNoPrimitive) continue;
      glm::dvec3 v[3];
      const Triangle& tri = t->scene.triangles[p.id(x, y)];
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) v[i][k] = t->scene.vertices[tri.vertex[i]].position[k];
      const glm::dvec3 n = cross3(v[1] - v[0], v[2] - v[0]), d = r.corner + (x + 0.5) * r.step_x + (y + 0.5) * r.step_y;
      double w[3];
      for (int i = 0; i < 3; ++i) w[i] = dot3(r.forward, v[i] - r.eye);
      const double low = r.near_plane / std::max({w[0], w[1], w[2]}), want = r.near_plane * dot3(d, n) / dot3(v[0] - r.eye, n);
      if (want < low || want > 1) continue;  // clamped
      ASSERT_NEAR(p.z(x, y) / want, 1, 3e-7) << x << "," << y;
      ++seen;
    }
  EXPECT_GT(seen, 10000);
}

TEST(RasterVisibility, MaskedPrimitivesDrawWhatIsAccepted) {
  std::vector<SoupTriangle> soup = {soup_triangle({-9, -9, 0}, {9, -9, 0}, {0, 15, 0}, 0), soup_triangle({-9, -9, -1}, {9, -9, -1}, {0, 15, -1}, 1)};
  for (const Isa isa : supported_isas()) {
    const auto t = make_test_frame(make_test_scene(soup, {material_with(MaterialTransparency::kScreenDoor), Material{}}), camera_at({0, 0, 3}, {0, 0, 0}), test_settings(70, 67, isa));
    t->frame.accept_row = accept_checker;
    const Picture p = rasterize(t->frame);
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x) ASSERT_EQ(p.id(x, y), (x + y) & 1 ? 0u : 1u) << x << "," << y;
  }
}

TEST(RasterVisibility, TranslucentFragmentsLieInFrontOfTheOpaque) {
  // Layers at z = 1 (translucent), 0 (opaque), 0 (the same place, translucent), -1 (hidden, translucent).
  std::vector<SoupTriangle> soup;
  for (const auto& [z, material] : std::vector<std::pair<double, uint32_t>>{{1, 1}, {0, 0}, {0, 1}, {-1, 1}})
    soup.push_back(soup_triangle({-9, -9, z}, {9, -9, z}, {0, 15, z}, material));
  for (const Isa isa : supported_isas()) {
    const auto t = make_test_frame(make_test_scene(soup, {Material{}, translucent_material()}), camera_at({0, 0, 3}, {0, 0, 0}), test_settings(70, 67, isa));
    const FrontEnd front = run_front_end(t->frame);
    const FragmentList list = all_fragments(t->frame, front.bins);
    int count[4] = {};
    for (const uint32_t primitive : list.primitive) ++count[primitive];
    EXPECT_EQ(count[0], 70 * 67);
    EXPECT_EQ(count[1], 0);
    EXPECT_EQ(count[2], 70 * 67);  // equal depth passes
    EXPECT_EQ(count[3], 0);
    EXPECT_EQ(list.ray.size(), list.pixel.size());
    const Picture p = rasterize(t->frame, front.bins);
    for (const uint32_t id : p.primitive) ASSERT_EQ(id, 1u);
  }
}

TEST(RasterVisibility, BackFacesAreCulledOnDemand) {
  const std::vector<SoupTriangle> soup = {soup_triangle({-9, -9, 0}, {0, 15, 0}, {9, -9, 0}), soup_triangle({-9, -9, -1}, {9, -9, -1}, {0, 15, -1}),
                                          soup_triangle({0, -9, 1}, {0, 15, 1}, {0, 0, -9})};
  for (const Culling culling : {Culling::kNone, Culling::kBack}) {
    Settings settings = test_settings(64, 64);
    settings.culling = culling;
    const auto t = make_test_frame(make_test_scene(soup), camera_at({0, 0, 3}, {0, 0, 0}), settings);
    FrontEnd front = run_front_end(t->frame);
    const Picture p = rasterize(t->frame, front.bins);
    for (const uint32_t id : p.primitive) ASSERT_EQ(id, culling == Culling::kNone ? 0u : 1u);
    EXPECT_EQ(front.counts.triangles_culled(), culling == Culling::kNone ? 1u : 2u);
  }
}

}  // namespace
}  // namespace spanray
