// Perturbed normals: height maps, normal maps, and where they must change nothing.
#include <gtest/gtest.h>

#include "scene/height_rows.h"
#include "support/surface_scenes.h"
#include "support/texture_probe.h"

namespace spanray {
namespace {

// A height ramp: dx, dy units of 1/65535 a texel to the right and *down*.
int32_t add_slope(SceneData& scene, int size, int dx, int dy) {
  return add_texture(scene, size, size, [&](int x, int y) {
    const auto v = static_cast<uint16_t>(x * dx + y * dy);
    return Texel{v, v, v, v};
  });
}

void resolve_unbumped(Frame& frame, const HitBatch& hits, SurfaceBatch& out) {
  frame.plan.bump = false;
  resolve_surfaces(frame, hits, out);
  frame.plan.bump = true;
}

Real3 unit(Real3 v) { return v * (1 / length_real(v)); }

TEST(ShadeBump, SlopeIsHeightPerTexelTimesMultiplier) {
  for (const float bm : {0.5f, 1.0f, -3.0f})
    for (const auto& [sx, sy] : {std::pair{1.0f, 1.0f}, {-1.0f, 1.0f}, {1.0f, -1.0f}}) {
      TextureProbe probe([&, sx = sx, sy = sy](SceneData& scene, Material& m) {
        m.map_bump = add_slope(scene, 64, 700, -300 + 64 * 5);
        TextureUse& use = scene.texture_uses[0];
        use.bump_multiplier = bm, use.gain = 20, use.scale[0] = sx, use.scale[1] = sy;
      });
      TestRandom random(1);
      for (int i = 0; i < 200; ++i) probe.add(random.uniform(0.1, 0.9), random.uniform(0.1, 0.9));  // away from the wrap
      for (const Isa isa : supported_isas()) {
        const SurfaceBatch& s = probe.run(isa);
        // n - bm (dh/ds T + dh/dt B); T = +x, B = +y of the probe, mirrored with the use; rows go down, t goes up.
        const double slope_s = 700.0 / 65535 * 20 * static_cast<double>(bm), slope_t = -20.0 / 65535 * 20 * static_cast<double>(bm);
        const Real3 want = unit({-slope_s * static_cast<double>(sx), -slope_t * static_cast<double>(sy), 1});
        for (int i = 0; i < s.count; ++i) ASSERT_LE(length_real(real3(s.normal, i) - want), 1e-5L) << i;
      }
    }
}

TEST(ShadeBump, CoarserLevelsKeepTheSlope) {
  TextureProbe probe([](SceneData& scene, Material& m) {
    m.map_bump = add_slope(scene, 256, 100, 150);
    scene.texture_uses[0].gain = 100;
  });
  for (const double texels : {0.5, 1.0, 2.0, 3.0, 4.0, 8.0, 11.0}) probe.add(0.5, 0.5, texels / 256, texels / 256);
  const Real3 want = unit({-100.0 * 100 / 65535, 150.0 * 100 / 65535, 1});
  for (const Filter filter : {Filter::kNearest, Filter::kBilinear, Filter::kTrilinear}) {
    probe.frame().settings.filter = filter;
    const SurfaceBatch& s = probe.run();
    for (int i = 0; i < s.count; ++i) EXPECT_LE(length_real(real3(s.normal, i) - want), 2e-3L) << i;
  }
}

// A rotated, mirrored, sheared mapping: the bumped normal must tilt against the world gradient of the height.
TEST(ShadeBump, TiltsAwayFromTheGradientWhateverTheMapping) {
  TestRandom random(2);
  for (int n = 0; n < 50; ++n) {
    const auto uv = [&] { return glm::dvec2(random.uniform(0.2, 0.8), random.uniform(0.2, 0.8)); };
    const glm::dvec2 a = uv(), b = uv(), c = uv();
    if (std::fabs((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)) < 0.05) continue;
    SceneData scene = make_test_scene({with_uv(soup_triangle({-1, -1, 0.2}, {1, -0.8, -0.3}, {0, 1, 0.1}), a, b, c)});
    scene.materials[0].map_bump = add_slope(scene, 64, 500, 0);  // rises with u only
    scene.texture_uses[0].gain = 10;
    auto t = make_test_frame(std::move(scene), Camera{}, test_settings(64, 64));
    plan_all(t->frame);
    HitBatch hits;
    add_hit(hits, pack_pixel(32, 32), 0, 0);
    SurfaceBatch s;
    resolve_surfaces(t->frame, hits, s);
    // Gradient of u in the plane of the triangle: g . e1 = du1, g . e2 = du2, g . n = 0.
    const Real3 e1 = oracle_vertex(t->scene, 0, 1) - oracle_vertex(t->scene, 0, 0), e2 = oracle_vertex(t->scene, 0, 2) - oracle_vertex(t->scene, 0, 0);
    const auto u = [&](int i) { return static_cast<Real>(t->scene.vertices[t->scene.triangles[0].vertex[i]].uv[0]); };
    const Real3 normal = cross_real(e1, e2);
    const Real3 g = unit(cross_real(e2, normal) * (u(1) - u(0)) + cross_real(normal, e1) * (u(2) - u(0)));
    const Real3 want = unit(real3(s.geometric_normal, 0) - g * (500.0L / 65535 * 10));
    EXPECT_LE(length_real(real3(s.normal, 0) - want), 1e-5L) << n;
  }
}

TEST(ShadeBump, NormalMapIsInTangentSpaceWithYUp) {
  const auto texel = [](int r, int g, int b) { return Texel{static_cast<uint16_t>(r * 257), static_cast<uint16_t>(g * 257), static_cast<uint16_t>(b * 257), 65535}; };
  struct Case { int r, g, b; Real3 want; };
  for (const Case& c : {Case{128, 128, 255, {0, 0, 1}}, Case{192, 128, 255, unit({64.0L / 127, 0, 1})}, Case{128, 192, 255, unit({0, 64.0L / 127, 1})},
                        Case{64, 100, 200, unit({-64.0L / 127, -28.0L / 127, 72.0L / 127})}}) {
    TextureProbe probe([&](SceneData& scene, Material& m) {
      m.map_normal = add_texture(scene, 8, 8, [&](int, int) { return texel(c.r, c.g, c.b); });
    });
    probe.add(0.3, 0.4);
    const SurfaceBatch& s = probe.run();
    EXPECT_LE(length_real(real3(s.normal, 0) - c.want), 1e-6L) << c.r << " " << c.g << " " << c.b;
    if (c.r == 128 && c.g == 128) {
      EXPECT_EQ(s.normal[2][0], 1);  // flat is exactly flat
    }
  }
}

// The loader lets height maps that are gray name one channel (scene_material_test.cpp): the same bits, less to read.
TEST(ShadeBump, OneChannelOfGrayIsItsLuminance) {
  TestRandom random(77);
  auto t = full_frame(random_surface_scene(78, 60), random_camera(random, 3), 512, 512);
  const int32_t gray = add_texture(t->scene, 64, 64, [&](int, int) {
    const auto v = static_cast<uint16_t>(random.bits() >> 16);
    return Texel{v, v, v, 65535};
  });
  for (Material& m : t->scene.materials) m.map_bump = gray, m.map_normal = -1;
  find_material_flags(*t);
  HitBatch hits;
  random_primary_hits(t->frame, random, 1000, hits);
  for (const Isa isa : supported_isas()) {
    t->frame.isa = isa;
    SurfaceBatch luminance, flat, one;
    resolve_surfaces(t->frame, hits, luminance);
    resolve_unbumped(t->frame, hits, flat);
    for (const int32_t channel : {0, 1, 2, 4}) {
      t->scene.texture_uses[static_cast<size_t>(gray)].channel = channel;
      resolve_surfaces(t->frame, hits, one);
      int bent = 0;
      for (int i = 0; i < hits.count; ++i)
        for (int k = 0; k < 3; ++k) {
          ASSERT_EQ(bits_of(one.normal[k][i]), bits_of(luminance.normal[k][i])) << isa_name(isa) << " " << channel;
          bent += one.normal[k][i] != flat.normal[k][i];
        }
      EXPECT_GT(bent, 1000);
    }
    t->scene.texture_uses[static_cast<size_t>(gray)].channel = -1;
  }
}

// Rows of heights are a faster way to the same texels, around the ends of rows and on levels of one texel, too; also where lanes of
// one vector have different maps, or one that has no rows (clamped, or by its luminance).
TEST(ShadeBump, RowsOfHeightsChangeNoBit) {
  TestRandom random(79);
  auto t = full_frame(random_surface_scene(80, 60), random_camera(random, 3), 512, 512);
  SceneData& scene = t->scene;
  const auto noise = [&](int, int) { return noise_texel(random); };
  int32_t use[5];
  const int size[5][2] = {{32, 8}, {2, 64}, {1, 1}, {16, 16}, {16, 16}};
  for (int k = 0; k < 5; ++k) use[k] = add_texture(scene, size[k][0], size[k][1], noise);
  const auto of = [&](int k) -> TextureUse& { return scene.texture_uses[static_cast<size_t>(use[k])]; };
  of(0).channel = 0, of(1).channel = 3, of(2).channel = 1, of(3).channel = 2, of(3).clamp = 1;
  for (int maps = 3; maps <= 5; ++maps) {  // all in rows; some clamped; some by luminance
    for (size_t m = 0; m < scene.materials.size(); ++m)
      scene.materials[m].map_bump = use[m % static_cast<size_t>(maps)], scene.materials[m].map_normal = -1;
    find_material_flags(*t);
    HitBatch hits;
    random_primary_hits(t->frame, random, 1000, hits);
    for (const Isa isa : supported_isas()) {
      t->frame.isa = isa;
      SurfaceBatch flat, texels, rows;
      scene.height_rows.clear();
      resolve_unbumped(t->frame, hits, flat);
      resolve_surfaces(t->frame, hits, texels);
      make_height_rows(scene);
      ASSERT_EQ(scene.height_rows.size(), scene.texture_uses.size());
      for (int k = 0; k < 5; ++k) ASSERT_EQ(scene.height_rows[static_cast<size_t>(use[k])].offset[0] >= 0, k < 3);
      resolve_surfaces(t->frame, hits, rows);
      int bent = 0;
      for (int i = 0; i < hits.count; ++i) {
        ASSERT_EQ(surface_difference(texels, i, rows, i), "") << isa_name(isa) << " " << maps << " " << i;
        bent += bits_of(rows.normal[0][i]) != bits_of(flat.normal[0][i]);
      }
      EXPECT_GT(bent, 400);
    }
  }
}

}  // namespace
}  // namespace spanray
