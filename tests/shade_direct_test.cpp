// Radiance of primary hits in one go (shade/direct.h) against the way through stored surfaces: the same bits.
#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "scene/height_rows.h"
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

// The colors of the way through stored surfaces.
TestRadiance radiance_of_surfaces(const Frame& frame, const HitBatch& hits, SurfaceBatch& surfaces) {
  TestRadiance radiance(hits.count);
  resolve_surfaces(frame, hits, surfaces);
  shade_ambient(frame, surfaces, radiance.at().p);
  for (int l = 0; l < static_cast<int>(frame.scene->lights.size()); ++l)
    shade_light(frame, surfaces, hits, l, nullptr, radiance.at().p);
  return radiance;
}

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
  AlignedBuffer<float> planes, t_of_hits(kCount);
  for (const bool specular : {true, false})
    for (const bool textures : {true, false})
      for (const Isa isa : supported_isas()) {
        frame.isa = isa, frame.plan.specular = specular, frame.plan.textures = textures, frame.plan.depths = specular;
        t_of_hits[0] = -1;
        SurfaceBatch surfaces;
        const TestRadiance want = radiance_of_surfaces(frame, hits, surfaces);
        TestRadiance got(kCount + 64);
        const DirectCounts counts = shade_direct(frame, hits, planes, got.at().p, t_of_hits.data());
        int lit = 0, found = 0;
        for (size_t i = 0; i < kCount; ++i)
          for (size_t c = 0; c < 3; ++c) {
            const bool hit = hits.primitive[i] != kNoPrimitive;
            const float expected = hit ? want.channel[c][i] : frame.scene->background[c];
            ASSERT_EQ(std::memcmp(&expected, &got.channel[c][i], 4), 0) << isa_name(isa) << " entry " << i << " channel " << c;
            if (c == 0 && specular) {
              ASSERT_EQ(t_of_hits[i], hit ? surfaces.t[i] : std::numeric_limits<float>::infinity()) << isa_name(isa) << " entry " << i;
            }
            found += hit && c == 0, lit += hit && expected > surfaces.ambient[c][static_cast<int>(i)] + 0.01f;
          }
        EXPECT_EQ(t_of_hits[0] == -1, !specular);
        EXPECT_EQ(counts.surface_lanes.used, static_cast<uint64_t>(found));
        EXPECT_GT(lit, kCount);
      }
}
INSTANTIATE_TEST_SUITE_P(Shading, Direct, testing::Values(Shading::kFlat, Shading::kGouraud, Shading::kPhong));

// Tilted triangles over the whole picture, one behind the other, each of a material of its own: textures of all shapes and
// scales of uv, as one and as several maps.
SceneData layers_of_textures(TestRandom& random) {
  struct Shape { int width, height; double uv; };
  constexpr Shape kShapes[] = {{64, 64, 1},    {64, 64, 0.02}, {37, 5, 3},     {1, 1, 1},
                                  {1, 128, 0.4}, {256, 2, 9},    {64, 32, 300}, {64, 64, 40}};
  std::vector<Material> materials(std::size(kShapes));
  std::vector<SoupTriangle> soup;
  for (size_t i = 0; i < std::size(kShapes); ++i) {
    Material& m = materials[i];
    for (float* color : {m.ambient, m.diffuse, m.specular, m.emission})
      for (int k = 0; k < 3; ++k) color[k] = static_cast<float>(random.uniform(0.2, 1));
    m.shininess = 5;
    const double z = -static_cast<double>(i), uv = kShapes[i].uv;
    SoupTriangle t = soup_triangle({-20, -20, z - 12}, {30, -20, z + 1}, {-20, 30, z - 3}, static_cast<uint32_t>(i));
    soup.push_back(with_uv(t, glm::dvec2(-uv, 0.3 * uv), {uv, uv}, {0.1 * uv, -2 * uv}));
  }
  SceneData scene = make_test_scene(soup, materials);
  for (size_t i = 0; i < std::size(kShapes); ++i) {
    const auto noise = [&](int, int) { return noise_texel(random); };
    const auto add = [&] { return add_texture(scene, kShapes[i].width, kShapes[i].height, noise); };
    Material& m = scene.materials[i];
    m.map_diffuse = add();
    if (i % 3 == 0) m.map_specular = add(), m.map_emission = m.map_diffuse;
    if (i % 3 == 1) m.map_ambient = add();
    if (i % 4 == 3) continue;
    m.map_bump = i % 4 == 2 ? m.map_diffuse : add();
    TextureUse& heights = scene.texture_uses[static_cast<size_t>(m.map_bump)];
    heights.channel = static_cast<int32_t>(i % 3), heights.bump_multiplier = 1.5f;
  }
  return scene;
}

// The colors of the way through surfaces of vectors that see many materials each: entries far apart stand side by side.
TestRadiance radiance_lane_by_lane(Frame& frame, const HitBatch& hits) {
  constexpr int kApart = 64;
  HitBatch mixed;
  std::vector<int> from;
  for (int first = 0; first < kApart; ++first)
    for (int i = first; i < hits.count; i += kApart) {
      from.push_back(i);
      add_hit(mixed, hits.pixel[static_cast<size_t>(i)], 0, hits.primitive[static_cast<size_t>(i)]);
    }
  mixed.rays = nullptr;
  frame.isa = supported_isas().back();
  SurfaceBatch surfaces;
  const TestRadiance of_mixed = radiance_of_surfaces(frame, mixed, surfaces);
  TestRadiance radiance(hits.count);
  for (size_t i = 0; i < from.size(); ++i)
    for (size_t c = 0; c < 3; ++c) radiance.channel[c][static_cast<size_t>(from[i])] = of_mixed.channel[c][i];
  return radiance;
}

// Textures that whole vectors read, against the same bits read lane by lane: as they are, and with each option of a use.
TEST(DirectTextures, AreThoseReadLaneByLane) {
  TestRandom random(43);
  SceneData scene = layers_of_textures(random);
  scene.lights = make_lit_scene(random, 1).lights;
  const uint32_t layers = static_cast<uint32_t>(scene.triangles.size());
  Camera camera;
  camera.eye[0] = camera.eye[1] = 0, camera.eye[2] = 4, camera.target[0] = camera.target[1] = camera.target[2] = 0;
  auto t = full_frame(std::move(scene), camera, 512, 512);
  Frame& frame = t->frame;
  frame.plan.lifted_rays = frame.plan.bounces = frame.plan.shadow_rays = false;
  HitBatch hits;
  for (int run = 0; run < 40; ++run) {  // a triangle each, now and then ending within a vector, in blocks of 4 x 4
    const uint32_t x0 = random.bits() % 500, y0 = random.bits() % 500, triangle = static_cast<uint32_t>(run) % layers;
    for (uint32_t i = 0; i < (run % 5 == 4 ? 40u : 64u); ++i)
      add_hit(hits, pack_pixel(x0 + i % 4 + i / 32 * 4, y0 + i / 4 % 8), 0, i == 37 ? kNoPrimitive : triangle);
  }
  hits.rays = nullptr;
  AlignedBuffer<float> planes, t_of_hits(static_cast<size_t>(hits.count));
  SurfaceBatch surfaces;
  using Change = void (*)(TextureUse&);
  constexpr Change kChanges[] = {
      [](TextureUse&) {},          [](TextureUse& u) { u.scale[0] = 2; },   [](TextureUse& u) { u.scale[1] = 2; },
      [](TextureUse& u) { u.offset[0] = 0.3f; }, [](TextureUse& u) { u.offset[1] = 0.3f; }, [](TextureUse& u) { u.clamp = 1; },
      [](TextureUse& u) { u.gain = 0.5f; }, [](TextureUse& u) { u.base = 0.1f; },
      [](TextureUse& u) { u.channel = -1; }, [](TextureUse& u) { u.bump_multiplier = 0.5f; }};
  TestRadiance plain(hits.count);
  for (const Change& change : kChanges)
    for (const Filter filter : {Filter::kNearest, Filter::kBilinear, Filter::kTrilinear}) {
      const std::vector<TextureUse> uses = t->scene.texture_uses;
      for (TextureUse& u : t->scene.texture_uses) change(u);
      make_height_rows(t->scene);
      frame.settings.filter = filter;
      const TestRadiance want = radiance_lane_by_lane(frame, hits);
      for (const Isa isa : supported_isas()) {
        frame.isa = isa;
        TestRadiance direct(hits.count + 64);
        shade_direct(frame, hits, planes, direct.at().p, t_of_hits.data());
        const TestRadiance stored = radiance_of_surfaces(frame, hits, surfaces);
        for (size_t i = 0; i < static_cast<size_t>(hits.count); ++i)
          for (size_t c = 0; c < 3 && hits.primitive[i] != kNoPrimitive; ++c)
            for (const TestRadiance* got : {&std::as_const(direct), &stored})
              ASSERT_EQ(std::memcmp(&want.channel[c][i], &got->channel[c][i], 4), 0)
                  << isa_name(isa) << " change " << &change - kChanges << " filter " << static_cast<int>(filter) << " entry " << i;
      }
      t->scene.texture_uses = uses;
      if (filter != Filter::kTrilinear) continue;
      if (&change == kChanges) plain = want;
      EXPECT_EQ(plain == want, &change == kChanges) << "change " << &change - kChanges;
    }
}

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
        request.radiance = request.depth = true;
        Renderer renderer;
        const auto first = renderer.render(loaded.value().scene, loaded.value().scene.cameras()[0], settings, direct, request);
        request.normal = true;
        const auto second = renderer.render(loaded.value().scene, loaded.value().scene.cameras()[0], settings, stored, request);
        ASSERT_TRUE(first && second);
        EXPECT_TRUE(direct.color.rgba == stored.color.rgba && direct.radiance == stored.radiance && direct.depth == stored.depth) << name;
        for (const char* what : {"pixels_covered", "surfaces_shaded", "triangles_drawn"}) EXPECT_EQ(count(first.value(), what), count(second.value(), what));
      }
  }
}

}  // namespace
}  // namespace spanray
