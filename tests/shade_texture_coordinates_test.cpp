// Where textures are read: level of detail, huge and negative coordinates, perspective, options of a use.
#include <gtest/gtest.h>

#include "support/surface_scenes.h"
#include "support/texture_probe.h"

namespace spanray {
namespace {

// A ramp over 4096 texels turns the sample into the coordinate that was read.
int32_t add_ramp(SceneData& scene) {
  return add_texture(scene, 4096, 1, [](int x, int) { const auto v = static_cast<uint16_t>(16 * x); return Texel{v, v, v, v}; });
}
double texel_read(float value) { return value * 65535.0 / 16 + 0.5; }

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
