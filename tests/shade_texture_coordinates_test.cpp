// Where textures are read: level of detail, huge and negative coordinates, perspective, options of a use.
#include <gtest/gtest.h>

#include "support/surface_scenes.h"
#include "support/texture_probe.h"

namespace spanray {
namespace {

TEST(ShadeTextureCoordinates, I6_LevelOfDetailFollowsLog2AndIsMonotoneAndClamped) {
  constexpr int kStep = 4096;
  TextureProbe probe([](SceneData& scene, Material& m) {
    m.map_diffuse = add_texture(scene, 1024, 1024, [](int, int) { return Texel{0, 0, 0, 0}; });
    fill_levels(scene, [](int k) { return static_cast<uint16_t>(k * kStep); });
  });
  std::vector<double> sizes;
  for (int i = -600; i <= 3000; ++i) sizes.push_back(std::pow(2.0, i / 200.0));
  for (const double texels : sizes) probe.add(0.3, 0.4, texels / 1024, texels / 4096);
  for (const double texels : sizes) probe.add(0.3, 0.4, texels / 4096, texels / 1024);
  for (const Filter filter : kFilters) {
    probe.frame().settings.filter = filter;
    const SurfaceBatch& s = probe.run();
    const int n = static_cast<int>(sizes.size());
    for (int i = 0; i < n; ++i) {
      const double level = s.diffuse[0][i] * 65535.0 / kStep, want = std::min(std::max(std::log2(sizes[static_cast<size_t>(i)]), 0.0), 10.0);
      ASSERT_EQ(s.diffuse[0][i], s.diffuse[0][n + i]);
      if (i > 0) {
        ASSERT_GE(s.diffuse[0][i], s.diffuse[0][i - 1]);
      }
      if (filter == Filter::kTrilinear)
        ASSERT_NEAR(level, want, 0.6 / 256);
      else
        ASSERT_NEAR(level, want, 0.5 + 0.6 / 256);
    }
  }
}

TEST(ShadeTextureCoordinates, I6_InfiniteAndNanFootprintsGiveTheLastLevel) {
  TextureProbe probe([](SceneData& scene, Material& m) {
    m.map_diffuse = add_texture(scene, 64, 64, [](int, int) { return Texel{0, 0, 0, 0}; });
    fill_levels(scene, [](int k) { return static_cast<uint16_t>(k * 1000); });
  });
  for (const double step : {1e10, 1e30, static_cast<double>(INFINITY), static_cast<double>(NAN)})
    probe.add(0.3, 0.4, step, 0), probe.add(0.3, 0.4, 0, -step);
  for (const Isa isa : supported_isas()) {
    const SurfaceBatch& s = probe.run(isa);
    for (int i = 0; i < s.count; ++i) EXPECT_NEAR(s.diffuse[0][i], 6000.0 / 65535, 1e-6) << i;
  }
}

TEST(ShadeTextureCoordinates, I6_GroundPlaneToTheHorizon) {
  Material m;
  m.diffuse[0] = m.diffuse[1] = m.diffuse[2] = 1;
  SoupTriangle tri = with_uv(soup_triangle({-1e6, 0, 1e6}, {1e6, 0, 1e6}, {0, 0, -1e6}), {-1e6, -1e6}, {1e6, -1e6}, {0, 1e6});
  SceneData scene = make_test_scene({tri}, {m});
  scene.materials[0].map_diffuse = add_texture(scene, 256, 256, [](int, int) { return Texel{0, 0, 0, 0}; });
  fill_levels(scene, [](int k) { return static_cast<uint16_t>(k * 4096); });
  Camera camera;
  camera.eye[1] = camera.target[1] = 1;
  camera.target[2] = -1;
  auto t = make_test_frame(std::move(scene), camera, test_settings(512, 512));
  plan_all(t->frame);
  HitBatch hits;
  for (uint32_t y = 512; y-- > 250;) add_hit(hits, pack_pixel(256, y), 0, 0);  // up to the horizon at 256, and past it
  for (const Isa isa : supported_isas()) {
    t->frame.isa = isa;
    SurfaceBatch s;
    resolve_surfaces(t->frame, hits, s);
    for (int i = 0; i < s.count; ++i) {
      ASSERT_TRUE(std::isfinite(s.diffuse[0][i]));
      if (i > 0 && i < 256) {
        ASSERT_GE(s.diffuse[0][i], s.diffuse[0][i - 1]) << i;
      }
    }
    EXPECT_EQ(s.diffuse[0][255], 8 * 4096 * (1.0f / 65535));
    EXPECT_LT(s.diffuse[0][0], 4096 * 2.0f / 65535);
  }
}

// A ramp over 4096 texels turns the sample into the coordinate that was read.
int32_t add_ramp(SceneData& scene) {
  return add_texture(scene, 4096, 1, [](int x, int) { const auto v = static_cast<uint16_t>(16 * x); return Texel{v, v, v, v}; });
}
double texel_read(float value) { return value * 65535.0 / 16 + 0.5; }

TEST(ShadeTextureCoordinates, I7_HugeUv) {
  TestRandom random(4);
  for (const double scale : {1e3, 1e4, 1e5, 1e6, 1e7}) {
    TextureProbe probe([](SceneData& scene, Material& m) { m.map_diffuse = add_ramp(scene); }, scale);
    probe.frame().settings.filter = Filter::kBilinear;
    for (int i = 0; i < 1000; ++i) probe.add(random.uniform(-3.9, 1.9), random.uniform(-3.9, 1.9));
    const SurfaceBatch& s = probe.run();
    int checked = 0;
    for (int i = 0; i < s.count; ++i) {
      const OracleHit hit = oracle_hit(probe.scene(), 0, oracle_ray(probe.rays(), i));
      Real uv[2];
      oracle_uv(probe.scene(), 0, hit.b, uv);
      const double texel = static_cast<double>((uv[0] - std::floor(uv[0])) * 4096);
      if (texel < 2 || texel > 4094) continue;  // the jump of the ramp
      ++checked;
      const double ulp = std::ldexp(1.0, std::ilogb(static_cast<double>(uv[0])) - 23);
      ASSERT_NEAR(texel_read(s.diffuse[0][i]), texel, ulp * 4096 + 1.0 / 256) << scale;
    }
    EXPECT_GT(checked, 900);
  }
}

TEST(ShadeTextureCoordinates, I7_NeverOutOfBounds) {
  for (const auto& [w, h] : {std::pair{1, 1}, {2, 1}, {64, 32}, {1, 256}}) {
    TextureProbe probe([&, w = w, h = h](SceneData& scene, Material& m) {
      const auto guard = [&] { add_texture(scene, 64, 64, [](int, int) { return Texel{65535, 65535, 65535, 65535}; }); };
      guard();
      m.map_diffuse = add_texture(scene, w, h, [](int, int) { return Texel{1000, 1000, 1000, 1000}; });
      guard();
    });
    for (const double x : {0.0, 1.0, -1.0, 0.5, 1 - 1e-9, -1e-9, 1e-30, -1e-30, -3.9, 1.9})
      for (const double y : {0.0, 1.0, -1.0, 1 - 1e-9, -1e-9, 0.3})
        for (const double step : {0.0, 1e-3, 1.0, 1e9}) probe.add(x, y, step, step);
    TextureUse& use = probe.scene().texture_uses[1];
    for (const Isa isa : supported_isas())
      for (const Filter filter : kFilters)
        for (const int clamp : {0, 1})
          for (const float scale : {1.0f, -1.0f, 1e7f, 1e20f, 3e38f, INFINITY, NAN}) {
            use.scale[0] = scale, use.scale[1] = -scale, use.clamp = clamp, use.offset[0] = scale > 1e30f ? -scale : 0;
            probe.frame().settings.filter = filter;
            const SurfaceBatch& s = probe.run(isa);
            for (int i = 0; i < s.count; ++i) ASSERT_EQ(s.diffuse[0][i], 1000 * (1.0f / 65535)) << w << "x" << h << " " << scale << " " << i;
          }
  }
}

TEST(ShadeTextureCoordinates, I7_OneIsZero) {
  TextureProbe probe([](SceneData& scene, Material& m) {
    TestRandom random(5);
    m.map_diffuse = add_texture(scene, 64, 64, [&](int, int) { return noise_texel(random); });
  });
  for (const double x : {0.0, 1.0, -1.0, -2.0}) probe.add(x, 0.37), probe.add(0.37, x);
  for (const Filter filter : kFilters) {
    probe.frame().settings.filter = filter;
    const SurfaceBatch& s = probe.run();
    for (int i = 2; i < s.count; ++i) EXPECT_EQ(s.diffuse[0][i], s.diffuse[0][i & 1]) << i;
  }
}

TEST(ShadeTextureCoordinates, I1_RatioOfAMillionReadsTheRightTexel) {
  Material m;
  m.diffuse[0] = m.diffuse[1] = m.diffuse[2] = 1;
  SoupTriangle tri = with_uv(soup_triangle({-0.7, -0.4, -1}, {6e5, -5e5, -1e6}, {-2e3, 5e5, -1e6}), {0, 0}, {1, 0}, {0.3, 1});
  SceneData scene = make_test_scene({tri}, {m});
  scene.materials[0].map_diffuse = add_ramp(scene);
  auto t = make_test_frame(std::move(scene), Camera{}, test_settings(16, 16));
  plan_all(t->frame);
  t->frame.settings.filter = Filter::kBilinear;
  TestRandom random(6);
  RayBatch rays;  // without differentials: level 0 throughout
  HitBatch hits;
  for (int i = 0; i < 4000; ++i) {
    const glm::dvec3 p = point_on(t->scene, 0, random);
    add_hit(hits, 0, static_cast<uint32_t>(add_ray(rays, {0, 0, 0}, p * (1 / -p.z))), 0);
  }
  hits.rays = &rays;
  SurfaceBatch s;
  resolve_surfaces(t->frame, hits, s);
  for (int i = 0; i < s.count; ++i) {
    const OracleHit hit = oracle_hit(t->scene, 0, oracle_ray(rays, i));
    Real uv[2];
    oracle_uv(t->scene, 0, hit.b, uv);
    if (!hit.inside || uv[0] < 1e-3L || uv[0] > 0.999L) continue;
    ASSERT_NEAR(texel_read(s.diffuse[0][i]), static_cast<double>(uv[0] * 4096), 1.0 / 256) << i;
  }
}

// What lanes beside it do with their coordinates changes no bit of a sample.
TEST(ShadeTextureCoordinates, NeighboursWithOptionsChangeNothing) {
  TestRandom random(31);
  std::vector<Material> materials(4);
  std::vector<SoupTriangle> soup;  // a texel of the plain map a pixel, and v = 0 in the middle
  for (uint32_t i = 0; i < 4; ++i)
    soup.push_back(with_uv(soup_triangle({-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, i), {-2, -0.03}, {2, -0.03}, {-2, 0.03}));
  SceneData scene = make_test_scene(soup, materials);
  const auto noise = [&](int, int) { return noise_texel(random); };
  const int32_t scaled = add_texture(scene, 16, 16, noise), clamped = add_texture(scene, 16, 16, noise);
  scene.texture_uses[static_cast<size_t>(scaled)].scale[1] = -3, scene.texture_uses[static_cast<size_t>(clamped)].clamp = 1;
  const int32_t plain = add_texture(scene, 4, 4096, noise);
  scene.materials[0].map_diffuse = plain, scene.materials[1].map_diffuse = scaled, scene.materials[2].map_diffuse = clamped;
  Camera camera;
  camera.eye[2] = 3;
  auto t = full_frame(std::move(scene), camera, 512, 512);
  t->frame.settings.filter = Filter::kBilinear;
  HitBatch alone, beside;
  for (uint32_t y = 180; y < 330; ++y)
    for (uint32_t x = 180; x < 330; ++x) {
      add_hit(alone, pack_pixel(x, y), 0, 0);
      add_hit(beside, pack_pixel(x, y), 0, 0), add_hit(beside, pack_pixel(x, y), 0, 1 + (x + y) % 3);
    }
  for (const Isa isa : supported_isas()) {
    t->frame.isa = isa;
    SurfaceBatch a, b;
    resolve_surfaces(t->frame, alone, a);
    resolve_surfaces(t->frame, beside, b);
    for (int i = 0; i < alone.count; ++i)
      for (int k = 0; k < 3; ++k) ASSERT_EQ(bits_of(a.diffuse[k][i]), bits_of(b.diffuse[k][2 * i])) << isa_name(isa) << " " << i;
  }
}

}  // namespace
}  // namespace spanray
