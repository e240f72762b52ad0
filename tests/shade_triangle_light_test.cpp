// Gouraud and flat: light that surfaces of primary rays carry, made once a triangle, against light made for each surface.
#include <gtest/gtest.h>

#include "support/surface_scenes.h"
#include "support/test_surfaces.h"

namespace spanray {
namespace {

constexpr int kCount = 1301;  // more than planes are set up for at once

TestRadiance shade(const Frame& frame, const HitBatch& hits, const SurfaceBatch& surfaces, const std::vector<uint32_t>& lit) {
  TestRadiance radiance(surfaces.count);
  shade_ambient(frame, surfaces, radiance.at().p);
  for (int l = 0; l < static_cast<int>(frame.scene->lights.size()); ++l)
    shade_light(frame, surfaces, hits, l, l % 2 == 0 ? nullptr : lit.data(), radiance.at().p);
  return radiance;
}

// Triangles of all sizes and three without area, all materials, six lights.
std::unique_ptr<TestFrame> lit_frame(TestRandom& random, Shading shading, HitBatch& hits) {
  SceneData scene = random_surface_scene(31, 60);
  scene.lights = make_lit_scene(random, 1).lights;
  for (uint32_t i = 0; i < 3; ++i) {
    const Triangle& t = scene.triangles[7 * i];
    for (int k = 0; k < 3; ++k) scene.vertices[t.vertex[2]].position[k] = scene.vertices[t.vertex[i == 0 ? 0 : 1]].position[k];
  }
  auto t = full_frame(std::move(scene), random_camera(random, 3), 512, 512);
  t->frame.settings.shading = shading;
  t->frame.plan.bump = t->frame.plan.lifted_rays = false;
  random_primary_hits(t->frame, random, kCount, hits);
  for (const size_t miss : {50u, 1020u, 1023u, 1024u, 1040u}) hits.primitive[miss] = kNoPrimitive;
  return t;
}

bool without_area(uint32_t primitive) { return primitive % 7 == 0 && primitive < 21; }

class CarriedLight : public testing::TestWithParam<Shading> {};

TEST_P(CarriedLight, IsWhatEachSurfaceWouldGet) {
  TestRandom random(35);
  HitBatch hits;
  auto t = lit_frame(random, GetParam(), hits);
  Frame& frame = t->frame;
  for (Material& m : t->scene.materials) m.map_shininess = -1;
  frame.plan.maps &= ~static_cast<uint32_t>(kMapShininess);
  std::vector<uint32_t> lit(kCount / 32 + 2);
  for (uint32_t& word : lit) word = random.bits();
  for (const bool specular : {true, false}) {
    frame.plan.specular = specular;
    frame.isa = Isa::kScalar;
    SurfaceBatch surfaces, bare;
    resolve_surfaces(frame, hits, surfaces);
    copy_surfaces(surfaces, 0, kCount, bare);
    ASSERT_EQ(surfaces.lights, 6);
    ASSERT_EQ(bare.lights, 0);
    const TestRadiance want = shade(frame, hits, bare, lit);
    int bright = 0, bright_without_area = 0;
    for (int i = 0; i < kCount; ++i) {
      const bool lights = want.channel[0][static_cast<size_t>(i)] > surfaces.ambient[0][i] + surfaces.emission[0][i] + 0.05f;
      (without_area(hits.primitive[static_cast<size_t>(i)]) ? bright_without_area : bright) += lights;
    }
    EXPECT_GT(bright, kCount / 4);
    EXPECT_GT(bright_without_area, 5);
    for (const Isa isa : supported_isas()) {
      frame.isa = isa;
      resolve_surfaces(frame, hits, surfaces);
      EXPECT_TRUE(shade(frame, hits, surfaces, lit) == want) << isa_name(isa);
      frame.plan.views = frame.plan.normals = frame.plan.weights = false;  // nobody reads them
      resolve_surfaces(frame, hits, surfaces);
      EXPECT_TRUE(shade(frame, hits, surfaces, lit) == want) << isa_name(isa);
      frame.plan.views = frame.plan.normals = frame.plan.weights = true;
      for (int first = 1290; first > 0; first -= 43) {  // of any batch
        HitBatch part;
        for (int i = first; i < first + 11; ++i) add_hit(part, hits.pixel[static_cast<size_t>(i)], 0, hits.primitive[static_cast<size_t>(i)]);
        resolve_surfaces(frame, part, bare);
        for (int k = 0; k < 6 * 11 * (specular ? 2 : 1); ++k) {
          const int l = k % 6, i = k / 6 % 11, factor = k / 66;
          const float *const one = bare.triangle_light(l, factor) + i, *const other = surfaces.triangle_light(l, factor) + first + i;
          ASSERT_TRUE(surfaces.valid[first + i] == 0 || std::memcmp(one, other, 4) == 0) << isa_name(isa);
        }
      }
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Shading, CarriedLight, testing::Values(Shading::kFlat, Shading::kGouraud));

TEST(TriangleLight, OnlyWhereTheTriangleDecides) {
  TestRandom random(33);
  const auto lights = [&](Shading shading, const auto& change) {
    HitBatch hits;
    auto t = lit_frame(random, shading, hits);
    RayBatch rays;
    change(t->frame.plan, hits, rays);
    SurfaceBatch surfaces;
    hits.resize(hits.rays != nullptr ? 0 : hits.count, hits.rays != nullptr);
    resolve_surfaces(t->frame, hits, surfaces);
    EXPECT_EQ(surfaces.triangle_light(0, 0) != nullptr, surfaces.lights > 0);
    return surfaces.lights;
  };
  const auto nothing = [](PlanFlags&, HitBatch&, RayBatch&) {};
  const auto bounced = [](PlanFlags&, HitBatch& hits, RayBatch& rays) { hits.rays = &rays; };
  const auto matt = [](PlanFlags& plan, HitBatch&, RayBatch&) { plan.specular = false; };
  EXPECT_EQ(lights(Shading::kPhong, nothing), 0);
  EXPECT_EQ(lights(Shading::kGouraud, nothing), 6);
  EXPECT_EQ(lights(Shading::kGouraud, bounced), 0);
  EXPECT_EQ(lights(Shading::kFlat, nothing), 0) << "a map says how sharp its highlights are, pixel by pixel";
  EXPECT_EQ(lights(Shading::kFlat, matt), 6);
  EXPECT_EQ(lights(Shading::kFlat, bounced), 0);
}

}  // namespace
}  // namespace spanray
