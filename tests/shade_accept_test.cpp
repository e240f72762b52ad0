// accept(hit): alpha masks and screen-door, the same for rows of pixels and for rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>

#include "frame/transparency.h"
#include "support/quad_frame.h"

namespace spanray {
namespace {

TEST(ShadeAccept, T4_MorePixelsForMoreOpacityAndTheSameForEveryObject) {
  auto t = quad_frame(material_of_kind(MaterialTransparency::kScreenDoor, 0));
  uint32_t before[8] = {};
  for (int n = 0; n <= 64; ++n) {
    t->scene.materials[0].opacity = static_cast<float>(n) / 64;
    for (int y = 0; y < 8; ++y) {
      const uint32_t now = accept_row(t->frame, 0, 0, y, 0xffffffffu);
      EXPECT_EQ(now & before[y], before[y]) << "a pixel once accepted stays accepted";
      EXPECT_EQ(now, accept_row(t->frame, 1, 0, y, 0xffffffffu)) << "the pattern knows no primitive";
      before[y] = now;
    }
  }
}

TEST(ShadeAccept, ScreenDoorAtHalfIsACheckerboard) {
  auto t = quad_frame(material_of_kind(MaterialTransparency::kScreenDoor, 0.5f));
  for (int y = 0; y < 8; ++y) EXPECT_EQ(accept_row(t->frame, 0, 0, y, 0xffu), y % 2 ? 0xaau : 0x55u) << y;
}

void checker_mask(SceneData& scene, Material& m) {
  m.map_opacity = add_texture(scene, 4, 4, [](int x, int y) {
    const uint16_t v = (x + y) % 2 ? 65535 : 0;
    return Texel{v, v, v, v};
  });
}

TEST(ShadeAccept, MaskCutsOutAtOneHalf) {
  auto t = quad_frame(material_of_kind(MaterialTransparency::kMask, 1), checker_mask);
  for (const Isa isa : supported_isas())
    for (const Filter filter : {Filter::kNearest, Filter::kBilinear, Filter::kTrilinear}) {
      t->frame.isa = isa, t->frame.settings.filter = filter;
      int accepted = 0, checked = 0;
      for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; x += 32) {
          const uint32_t bits = accept_row(t->frame, 0, x, y, 0xffffffffu);
          for (int i = 0; i < 32; ++i) {
            const OracleHit h = oracle_hit(t->scene, 0, oracle_primary(t->frame, pack_pixel(static_cast<uint32_t>(x + i), static_cast<uint32_t>(y))));
            Real uv[2];
            oracle_uv(t->scene, 0, h.b, uv);
            const Real s = uv[0] * 4 - std::floor(uv[0] * 4), r = uv[1] * 4 - std::floor(uv[1] * 4);
            if (!h.inside || std::min(std::min(s, 1 - s), std::min(r, 1 - r)) < 0.02L) continue;  // the boundary itself
            // Row 0 is on top: four rows, so (row) and (3 - row) differ in parity.
            const bool opaque = (static_cast<int>(std::floor(uv[0] * 4)) + 3 - static_cast<int>(std::floor(uv[1] * 4))) % 2 != 0;
            ASSERT_EQ((bits >> i & 1) != 0, opaque) << x + i << " " << y;
            accepted += opaque, ++checked;
          }
        }
      EXPECT_GT(checked, 5000);
      EXPECT_NEAR(accepted, checked / 2, checked / 10);
    }
}

TEST(ShadeAccept, OpacityTimesMapDecides) {
  const auto gray = [](uint16_t v) { return [v](SceneData& scene, Material& m) { m.map_opacity = add_texture(scene, 4, 4, [v](int, int) { return Texel{v, v, v, v}; }); }; };
  EXPECT_EQ(accept_row(quad_frame(material_of_kind(MaterialTransparency::kMask, 1), gray(128 * 257))->frame, 0, 40, 60, 0xffffu), 0xffffu);
  EXPECT_EQ(accept_row(quad_frame(material_of_kind(MaterialTransparency::kMask, 1), gray(127 * 257))->frame, 0, 40, 60, 0xffffu), 0u);
  EXPECT_EQ(accept_row(quad_frame(material_of_kind(MaterialTransparency::kMask, 0.9f), gray(128 * 257))->frame, 0, 40, 60, 0xffffu), 0u);
  auto t = quad_frame(material_of_kind(MaterialTransparency::kMask, 0.9f), gray(128 * 257));
  t->frame.settings.transparency = Transparency::kNone;  // opacity is ignored, the cut-out stays
  EXPECT_EQ(accept_row(t->frame, 0, 40, 60, 0xffffu), 0xffffu);
}

// Rows and rays of the same pixels, for every kind, instruction set and split into rows.
TEST(ShadeAccept, RowsAndPrimaryRaysAgreeBitForBit) {
  TestRandom random(1);
  for (const MaterialTransparency kind : {MaterialTransparency::kMask, MaterialTransparency::kScreenDoor}) {
    auto t = quad_frame(material_of_kind(kind, 0.8f), [&](SceneData& scene, Material& m) {
      m.map_opacity = add_texture(scene, 64, 64, [&](int, int) { return noise_texel(random); });
    });
    RayBatch rays;
    rays.primary = true;
    for (uint32_t y = 0; y < 128; y += 9)
      for (uint32_t x = 0; x < 128; ++x) {
        const glm::dvec3 d = t->frame.primary.corner + t->frame.primary.step_x * (x + 0.5) + t->frame.primary.step_y * (y + 0.5);
        add_ray(rays, t->frame.primary.eye + d * t->frame.primary.near_plane, d, pack_pixel(x, y));
      }
    std::vector<uint32_t> want;
    int accepted = 0;
    for (const Isa isa : supported_isas()) {
      t->frame.isa = isa;
      for (int i = 0; i < rays.count; ++i) {
        const int x = static_cast<int>(rays.pixel[static_cast<size_t>(i)] & 0xffff), y = static_cast<int>(rays.pixel[static_cast<size_t>(i)] >> 16);
        for (const uint32_t primitive : {0u, 1u}) {
          const uint32_t bit = accept_row(t->frame, primitive, x, y, 1u);
          ASSERT_EQ(bit, accept_rays(t->frame, rays, i, primitive, 1u)) << x << " " << y;
          accepted += static_cast<int>(bit);
          if (x % 32 == 0) {
            const uint32_t row = accept_row(t->frame, primitive, x, y, 0xffffffffu);
            ASSERT_EQ(row & 0x0ff0f00fu, accept_row(t->frame, primitive, x, y, 0x0ff0f00fu)) << "candidates only select";
            want.push_back(row);
          }
        }
      }
    }
    EXPECT_GT(accepted, 0);
    const size_t each = want.size() / supported_isas().size();
    for (size_t i = each; i < want.size(); ++i) ASSERT_EQ(want[i], want[i % each]);
  }
}

TEST(ShadeAccept, OtherRaysUseTheMaskOfThePixelThatStartedThem) {
  auto t = quad_frame(material_of_kind(MaterialTransparency::kScreenDoor, 0.3f));
  RayBatch rays;
  for (uint32_t y = 0; y < 8; ++y)
    for (uint32_t x = 0; x < 8; ++x) add_ray(rays, {3, 2, 1}, {0.1, 0.2, -1}, pack_pixel(x, y));
  int count = 0;
  for (int i = 0; i < 64; ++i) {
    const bool accepted = accept_rays(t->frame, rays, i, 0, 1u) != 0;
    EXPECT_EQ(accepted, (accept_row(t->frame, 0, i % 8, i / 8, 1u) & 1u) != 0);
    count += accepted;
  }
  EXPECT_EQ(count, 19);  // round(0.3 * 64)
}

// Rays of one batch, asked one by one and up to 32 at once, with the last of them at the end of the batch.
TEST(ShadeAccept, RaysTogetherAnswerAsEachAlone) {
  TestRandom random(7);
  for (const MaterialTransparency kind : {MaterialTransparency::kMask, MaterialTransparency::kScreenDoor}) {
    auto t = quad_frame(material_of_kind(kind, 0.8f), [&](SceneData& scene, Material& m) {
      m.map_opacity = add_texture(scene, 64, 64, [&](int, int) { return noise_texel(random); });
    });
    RayBatch rays;
    for (int i = 0; i < 1003; ++i) {
      const glm::dvec3 origin(random.uniform(-1, 1), random.uniform(-1, 1), 1);
      const glm::dvec3 direction(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), -1);
      add_ray(rays, origin, direction, pack_pixel(static_cast<uint32_t>(random.below(128)), static_cast<uint32_t>(random.below(128))));
    }
    int accepted = 0, refused = 0;
    for (const Isa isa : supported_isas()) {
      t->frame.isa = isa;
      for (int first = 0; first < rays.count; first += 29) {
        const int n = std::min(32, rays.count - first);
        const uint32_t wanted = random.bits() & ~0u >> (32 - n);
        uint32_t alone = 0;
        for (int i = 0; i < n; ++i)
          if ((wanted >> i & 1) != 0) alone |= accept_rays(t->frame, rays, first + i, 1, 1u) << i;
        ASSERT_EQ(accept_rays(t->frame, rays, first, 1, wanted), alone) << isa_name(isa) << " from ray " << first;
        accepted += std::popcount(alone), refused += std::popcount(wanted & ~alone);
      }
    }
    EXPECT_GT(accepted, 100);
    EXPECT_GT(refused, 100);
  }
}

TEST(FrameTransparency, SettingsOverrideMaterials) {
  using M = MaterialTransparency;
  struct Case { M own; float opacity; bool map; M scene, none, alpha, door; };
  const Case cases[] = {
      {M::kOpaque, 1, false, M::kOpaque, M::kOpaque, M::kOpaque, M::kOpaque},
      {M::kAlpha, 1, false, M::kOpaque, M::kOpaque, M::kOpaque, M::kOpaque},
      {M::kAlpha, 0.5f, false, M::kAlpha, M::kOpaque, M::kAlpha, M::kScreenDoor},
      {M::kScreenDoor, 0.5f, false, M::kScreenDoor, M::kOpaque, M::kAlpha, M::kScreenDoor},
      {M::kMask, 1, true, M::kMask, M::kMask, M::kMask, M::kMask},
      {M::kMask, 0.5f, true, M::kMask, M::kMask, M::kAlpha, M::kScreenDoor},
      {M::kAlpha, 1, true, M::kAlpha, M::kMask, M::kAlpha, M::kScreenDoor},
  };
  for (const Case& c : cases) {
    Material m = material_of_kind(c.own, c.opacity);
    m.map_opacity = c.map ? 0 : -1;
    Settings s;
    const auto under = [&](Transparency t) { s.transparency = t; return effective_transparency(m, s); };
    EXPECT_EQ(under(Transparency::kScene), c.scene);
    EXPECT_EQ(under(Transparency::kNone), c.none);
    EXPECT_EQ(under(Transparency::kAlpha), c.alpha);
    EXPECT_EQ(material_flags(m, s) & (kMaterialMasked | kMaterialTranslucent),
              c.alpha == M::kAlpha ? kMaterialTranslucent : c.alpha == M::kOpaque ? 0u : kMaterialMasked);
    EXPECT_EQ(under(Transparency::kScreenDoor), c.door);
  }
}

TEST(FrameTransparency, FlagsSayWhichMaterialsHaveMaps) {
  const auto maps_of = [](const Material& m) { return material_flags(m, Settings()) & (kMaterialMapped | kMaterialBumped); };
  EXPECT_EQ(maps_of(Material()), 0u);
  int32_t Material::*const colors[] = {&Material::map_ambient,  &Material::map_diffuse,  &Material::map_specular,
                                       &Material::map_shininess, &Material::map_emission, &Material::map_opacity};
  for (int32_t Material::*const map : colors) {
    Material m;
    m.*map = 0;
    EXPECT_EQ(maps_of(m), kMaterialMapped);
  }
  for (int32_t Material::*const map : {&Material::map_bump, &Material::map_normal}) {
    Material m;
    m.*map = 0;
    EXPECT_EQ(maps_of(m), kMaterialMapped | kMaterialBumped);
  }
}

}  // namespace
}  // namespace spanray
