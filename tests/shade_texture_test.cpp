// Texture sampling through whole surfaces: filters, orientation, maps of a material.
// Where they read: shade_texture_coordinates_test.cpp.
#include <gtest/gtest.h>

#include "math/color.h"
#include "support/surface_scenes.h"
#include "support/texture_probe.h"

namespace spanray {
namespace {

// Bilinear by definition, in long double, weights not quantised.
Real bilinear_oracle(const SceneData& scene, const Texture& t, bool clamp, Real u, Real v) {
  const auto texel = [&](Real fx, Real fy) {
    int x = static_cast<int>(fx), y = static_cast<int>(fy);
    const auto wrap = [&](int i, int n) { return clamp ? std::min(std::max(i, 0), n - 1) : ((i % n) + n) % n; };
    x = wrap(x, t.width), y = wrap(y, t.height);
    return static_cast<Real>(scene.texels[static_cast<size_t>(t.offset[0] + y * t.width + x)].r) / 65535;
  };
  if (clamp) u = std::min(std::max(u, Real(0)), Real(1)), v = std::min(std::max(v, Real(0)), Real(1));
  const Real x = u * t.width - Real(0.5), y = (1 - v) * t.height - Real(0.5);
  const Real x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
  return (texel(x0, y0) * (1 - fx) + texel(x0 + 1, y0) * fx) * (1 - fy) + (texel(x0, y0 + 1) * (1 - fx) + texel(x0 + 1, y0 + 1) * fx) * fy;
}

TEST(ShadeTexture, BilinearFollowsTheDefinitionWithinTheWeightStep) {
  TestRandom random(2);
  for (const auto& [w, h] : {std::pair{64, 64}, {128, 2}, {1, 8}, {1, 1}, {5, 3}, {3, 7}})
    for (const int clamp : {0, 1}) {
      TextureProbe probe([&, w = w, h = h](SceneData& scene, Material& m) {
        m.map_diffuse = add_texture(scene, w, h, [&](int, int) { return noise_texel(random); });
        TextureUse& use = scene.texture_uses.back();
        use.clamp = clamp, use.scale[0] = 1.7f, use.scale[1] = -0.6f, use.offset[0] = 0.3f, use.offset[1] = -0.1f;
      });
      probe.frame().settings.filter = Filter::kBilinear;
      for (int i = 0; i < 500; ++i) probe.add(random.uniform(-3.9, 1.9), random.uniform(-3.9, 1.9));
      const SurfaceBatch& s = probe.run();
      for (int i = 0; i < s.count; ++i) {
        const OracleRay r = oracle_ray(probe.rays(), i);
        const Real u = r.origin.x * Real(1.7f) + Real(0.3f), v = r.origin.y * Real(-0.6f) + Real(-0.1f);
        const Real want = bilinear_oracle(probe.scene(), probe.scene().textures[0], clamp != 0, u, v);
        ASSERT_NEAR(s.diffuse[0][i], static_cast<double>(want), 1.0 / 256 + 1e-5) << w << "x" << h << " " << clamp << " " << i;
      }
    }
}

TEST(ShadeTexture, I3_ConstantTextureIsExactlyConstant) {
  for (const uint16_t value : {uint16_t{0}, uint16_t{1}, uint16_t{12345}, uint16_t{65535}}) {
    TextureProbe probe([&](SceneData& scene, Material& m) {
      m.map_diffuse = add_texture(scene, 64, 32, [&](int, int) { return Texel{value, value, value, value}; });
    });
    TestRandom random(3);
    for (int i = 0; i < 1000; ++i)
      probe.add(random.uniform(-3, 1.9), random.uniform(-3, 1.9), random.uniform(0, 0.3), random.uniform(0, 0.3));
    for (const Filter filter : kFilters) {
      probe.frame().settings.filter = filter;
      const SurfaceBatch& s = probe.run();
      for (int i = 0; i < s.count; ++i) ASSERT_EQ(s.diffuse[0][i], static_cast<float>(value) * (1.0f / 65535)) << value;
    }
  }
  EXPECT_EQ(65535 * (1.0f / 65535), 1.0f);
}

TEST(ShadeTexture, VIsUpAndUIsRight) {
  TextureProbe probe([](SceneData& scene, Material& m) {
    m.map_diffuse = add_texture(scene, 2, 2, [](int x, int y) { return Texel{static_cast<uint16_t>(x * 65535), static_cast<uint16_t>(y * 65535), 0, 0}; });
  });
  probe.add(0.25, 0.25), probe.add(0.75, 0.75);
  probe.frame().settings.filter = Filter::kNearest;
  const SurfaceBatch& s = probe.run();
  EXPECT_EQ(s.diffuse[0][0], 0);
    EXPECT_EQ(s.diffuse[1][0], 1);  // v = 0 is the last row stored
  EXPECT_EQ(s.diffuse[0][1], 1);
    EXPECT_EQ(s.diffuse[1][1], 0);
}

TEST(ShadeTexture, MapsScaleTheirFields) {
  const auto gray = [](uint16_t v) { return [v](int, int) { return Texel{v, v, v, v}; }; };
  TextureProbe probe([&](SceneData& scene, Material& m) {
    m.map_diffuse = add_texture(scene, 4, 4, gray(6553)), m.map_specular = add_texture(scene, 4, 4, gray(13107));
    m.map_shininess = add_texture(scene, 4, 4, gray(19660)), m.map_emission = add_texture(scene, 4, 4, gray(26214));
    m.map_opacity = add_texture(scene, 4, 4, gray(32767)), m.map_ambient = -1;
    m.opacity = 0.5f;
    TextureUse& use = scene.texture_uses[static_cast<size_t>(m.map_emission)];
    use.base = 0.5f, use.gain = 2;
  });
  probe.add(0.3, 0.3);
  {
    const SurfaceBatch& s = probe.run();
    EXPECT_NEAR(s.diffuse[0][0], 0.1, 1e-4);
    EXPECT_NEAR(s.ambient[1][0], 0.1, 1e-4);
    EXPECT_NEAR(s.specular[2][0], 0.2, 1e-4);
    EXPECT_NEAR(s.mirror[0][0], 0.2, 1e-4);
    EXPECT_NEAR(s.shininess[0], 30, 1e-2);
    EXPECT_NEAR(s.emission[0][0], 0.5 + 2 * 0.4, 1e-4);
    EXPECT_NEAR(s.opacity[0], 0.25, 1e-4);
  }
  probe.scene().materials[0].map_ambient = probe.scene().materials[0].map_opacity;
  EXPECT_NEAR(probe.run().ambient[0][0], 0.5, 1e-4);
  probe.frame().plan.textures = false;
  const SurfaceBatch& s = probe.run();
  EXPECT_EQ(s.diffuse[0][0], 1);
    EXPECT_EQ(s.ambient[0][0], 1);
    EXPECT_EQ(s.shininess[0], 100);
}

TEST(ShadeTexture, ChannelsOfScalarMaps) {
  TextureProbe probe([](SceneData& scene, Material& m) {
    m.map_shininess = add_texture(scene, 2, 2, [](int, int) { return Texel{6554, 13107, 26214, 52428}; });
  });
  probe.add(0.3, 0.3);
  const double want[] = {0.2126 * 0.1 + 0.7152 * 0.2 + 0.0722 * 0.4, 0.1, 0.2, 0.4, 0.8, 0.2126 * 0.1 + 0.7152 * 0.2 + 0.0722 * 0.4};
  for (int channel = -1; channel <= 4; ++channel) {
    probe.scene().texture_uses[0].channel = channel;
    EXPECT_NEAR(probe.run().shininess[0], 100 * want[channel + 1], 2e-3) << channel;
  }
}

}  // namespace
}  // namespace spanray
