// What each pixel sees, from world triangles to the visibility buffer. Also: demo/hard_cases/meshes.cpp, demo/hard_cases/depth.cpp.
#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "support/camera_at.h"
#include "support/raster_front_end.h"
#include "support/raster_soup.h"

namespace spanray {
namespace {

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

// Small triangles side by side in two tiles, in threes of one kind: neighbours in the list of a scene, of one tile, of two lists.
TEST(RasterVisibility, BinsKeepTheOrderAndTellTranslucentTrianglesFromOthers) {
  std::vector<SoupTriangle> soup;
  for (int i = 0; i < 120; ++i) {
    const double x = i < 60 ? -0.9 : 0.4, y = -1 + 0.03 * (i % 60);
    soup.push_back(soup_triangle({x, y, 0}, {x + 0.1, y, 0}, {x, y + 0.1, 0}, i / 3 % 2 == 0 ? 0 : 1));
  }
  const auto t = make_test_frame(make_test_scene(soup, {Material{}, translucent_material()}), camera_at({0, 0, 3}, {0, 0, 0}), test_settings(128, 64));
  const FrontEnd front = run_front_end(t->frame);
  ASSERT_EQ(front.counts.triangles_drawn, 120u);
  ASSERT_EQ(front.bins.chunks.size(), 1u);
  const BinChunk& chunk = front.bins.chunks[0];
  for (uint32_t tile = 0; tile < 2; ++tile) {
    std::vector<uint32_t> expected[2];
    for (uint32_t i = 60 * tile; i < 60 * tile + 60; ++i) expected[i / 3 % 2].push_back(i);
    const auto list = [&](const AlignedBuffer<uint32_t>& of, const std::vector<uint32_t>& start) {
      return std::vector<uint32_t>(of.data() + start[tile], of.data() + start[tile + 1]);
    };
    EXPECT_EQ(list(chunk.opaque, chunk.opaque_start), expected[0]) << tile;
    EXPECT_EQ(list(chunk.translucent, chunk.translucent_start), expected[1]) << tile;
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
