// Radiance of primary hits in one go (shade/direct.h) against the way through stored surfaces: the same bits.
#include <gtest/gtest.h>

#include "shade/direct.h"
#include "shade/surface_kernels.h"
#include "spanray/render.h"
#include "support/sample_pictures.h"
#include "support/scene_files.h"
#include "support/surface_scenes.h"
#include "support/test_surfaces.h"

namespace spanray {
namespace {

constexpr int kCount = 1301;  // more than planes are set up for at once, and no whole number of vectors

class Direct : public testing::TestWithParam<Shading> {};

// Triangles of all sizes, three without area, misses alone and in runs of whole vectors, textures, height maps, all kinds of light.
TEST_P(Direct, IsTheWayThroughSurfaces) {
  TestRandom random(41);
  SceneData scene = random_surface_scene(42, 60);
  scene.lights = make_lit_scene(random, 1).lights;
  for (uint32_t i = 0; i < 3; ++i) {
    const Triangle& t = scene.triangles[7 * i];
    for (int k = 0; k < 3; ++k) scene.vertices[t.vertex[2]].position[k] = scene.vertices[t.vertex[i == 0 ? 0 : 1]].position[k];
  }
  for (int k = 0; k < 3; ++k) scene.background[k] = 0.1f + 0.2f * static_cast<float>(k);
  auto t = full_frame(std::move(scene), random_camera(random, 3), 512, 512);
  Frame& frame = t->frame;
  frame.settings.shading = GetParam();
  frame.plan.lifted_rays = frame.plan.bounces = frame.plan.shadow_rays = false;
  if (GetParam() != Shading::kPhong) frame.plan.bump = false;
  for (Material& m : t->scene.materials) m.map_shininess = GetParam() == Shading::kFlat ? -1 : m.map_shininess;
  HitBatch hits;
  random_primary_hits(frame, random, kCount, hits);
  for (int i = 0; i < kCount; ++i)
    if (i % 97 == 50 || (i >= 200 && i < 300) || i == 1023 || i == 1024) hits.primitive[static_cast<size_t>(i)] = kNoPrimitive;
  AlignedBuffer<float> planes;
  for (const bool specular : {true, false})
    for (const bool textures : {true, false})
      for (const Isa isa : supported_isas()) {
        frame.isa = isa, frame.plan.specular = specular, frame.plan.textures = textures;
        SurfaceBatch surfaces;
        resolve_surfaces(frame, hits, surfaces);
        TestRadiance want(kCount), got(kCount + 64);
        shade_ambient(frame, surfaces, want.at().p);
        for (int l = 0; l < static_cast<int>(frame.scene->lights.size()); ++l) shade_light(frame, surfaces, hits, l, nullptr, want.at().p);
        const DirectCounts counts = shade_direct(frame, hits, planes, got.at().p);
        int lit = 0, found = 0;
        for (size_t i = 0; i < kCount; ++i)
          for (size_t c = 0; c < 3; ++c) {
            const bool hit = hits.primitive[i] != kNoPrimitive;
            const float expected = hit ? want.channel[c][i] : frame.scene->background[c];
            ASSERT_EQ(std::memcmp(&expected, &got.channel[c][i], 4), 0) << isa_name(isa) << " entry " << i << " channel " << c;
            found += hit && c == 0, lit += hit && expected > surfaces.ambient[c][static_cast<int>(i)] + 0.01f;
          }
        EXPECT_EQ(counts.surface_lanes.used, static_cast<uint64_t>(found));
        EXPECT_GT(lit, kCount);
      }
}
INSTANTIATE_TEST_SUITE_P(Shading, Direct, testing::Values(Shading::kFlat, Shading::kGouraud, Shading::kPhong));

uint64_t count(const FrameStats& stats, const std::string& name) {
  for (const auto& [of, value] : stats.counts)
    if (of == name) return value;
  ADD_FAILURE() << "no count " << name;
  return 0;
}

// Whoever asks for normals or coordinates gets surfaces stored, and the same colors.
TEST(DirectFrames, SameColorsWhetherSurfacesAreStoredOrNot) {
  for (const char* name : {"hall", "columns"}) {
    Result<LoadedScene> loaded = load_scene(std::string(SPANRAY_SOURCE_DIR) + "/assets/" + name + ".toml");
    ASSERT_TRUE(loaded) << loaded.error().to_string();
    Settings settings = loaded.value().scene.settings();
    settings.width = 203, settings.height = 117, settings.shadows = Shadows::kNone, settings.reflections = Reflections::kNone;
    for (const Shading shading : {Shading::kFlat, Shading::kGouraud, Shading::kPhong})
      for (const int samples : {1, 4}) {
        settings.shading = shading, settings.samples = samples;
        Framebuffer direct, stored;
        FrameRequest request;
        request.radiance = true;
        Renderer renderer;
        const auto first = renderer.render(loaded.value().scene, loaded.value().scene.cameras()[0], settings, direct, request);
        request.normal = true;
        const auto second = renderer.render(loaded.value().scene, loaded.value().scene.cameras()[0], settings, stored, request);
        ASSERT_TRUE(first && second);
        EXPECT_TRUE(direct.color.rgba == stored.color.rgba && direct.radiance == stored.radiance) << name;
        for (const char* what : {"pixels_covered", "surfaces_shaded", "triangles_drawn"}) EXPECT_EQ(count(first.value(), what), count(second.value(), what));
      }
  }
}

}  // namespace
}  // namespace spanray
