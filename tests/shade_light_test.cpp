#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "math/elementary.h"
#include "support/test_surfaces.h"

namespace spanray {
namespace {

constexpr int kCount = 2011;  // not a multiple of any vector

std::vector<std::vector<uint32_t>> random_lit(TestRandom& random, size_t lights, int count) {
  std::vector<std::vector<uint32_t>> lit(lights);
  for (auto& words : lit) {
    words.resize(static_cast<size_t>(count + 31) / 32);
    for (uint32_t& w : words) w = random.bits() | random.bits();
  }
  return lit;
}

// The highlight of a light jumps where n.l changes sign, and all of it where the geometric n.l does.
bool near_terminator(const TestSurfaces& t, int i) {
  const OracleSurface s = t.oracle(i);
  for (const Light& light : t.test->scene.lights) {
    const glm::dvec3 l = oracle_incidence(s.position, light).to_light;
    if (std::fabs(dot3(s.normal, l)) < 1e-5 || std::fabs(dot3(s.geometric_normal, l)) < 1e-5) return true;
  }
  return false;
}

TEST(ShadeLight, AgreesWithDoubleOnRandomSurfaces) {
  for (const bool bounce : {false, true}) {
    auto t = make_test_surfaces(11, kCount, Shading::kPhong, bounce);
    TestRandom random(12);
    const auto lit = random_lit(random, t->scene().lights.size(), kCount);
    const TestRadiance radiance = shade_all(*t, Isa::kScalar, lit.data());
    double worst = 0;
    int skipped = 0, bright = 0;
    for (int i = 0; i < kCount; ++i) {
      glm::dvec3 want(0);
      if (t->surfaces.valid[i]) {
        if (near_terminator(*t, i)) { ++skipped; continue; }
        uint64_t mask = 0;
        for (size_t l = 0; l < lit.size(); ++l) mask |= uint64_t{lit[l][static_cast<size_t>(i) / 32] >> (i % 32) & 1} << l;
        want = oracle_radiance(t->oracle(i), t->scene(), mask, t->reflectance(i));
        bright += want.x > 0.05;
      }
      worst = std::max(worst, radiance.max_encoded_difference(i, want));
    }
    EXPECT_LE(worst, 1.0 / 255) << "in units of 1/255: " << worst * 255;
    RecordProperty("worst_of_255", std::to_string(worst * 255));
    EXPECT_LE(skipped, 2);
    EXPECT_GT(bright, kCount / 3);  // the picture is not black
  }
}

TEST(ShadeLight, EqualBitsOnEveryInstructionSet) {
  for (const Shading shading : {Shading::kFlat, Shading::kGouraud, Shading::kPhong})
    for (const bool bounce : {false, true}) {
      auto t = make_test_surfaces(21, kCount, shading, bounce);
      TestRandom random(22);
      const auto lit = random_lit(random, t->scene().lights.size(), kCount);
      const TestRadiance want = shade_all(*t, Isa::kScalar, lit.data());
      for (const Isa isa : supported_isas()) EXPECT_TRUE(shade_all(*t, isa, lit.data()) == want) << isa_name(isa);
    }
}

TEST(ShadeLight, EqualBitsForAnySplitOfTheBatch) {
  for (const Shading shading : {Shading::kFlat, Shading::kGouraud, Shading::kPhong}) {
    auto t = make_test_surfaces(31, 257, shading, false);
    for (const Isa isa : supported_isas()) {
      const TestRadiance want = shade_all(*t, isa);
      TestRadiance got(257);
      SurfaceBatch part;
      TestRandom random(32);
      for (int first = 0, count; first < 257; first += count) {
        count = std::min(257 - first, random.between(1, 20));
        copy_surfaces(t->surfaces, first, count, part);
        shade_ambient(t->frame(), part, got.at(first).p);
        for (int l = 0; l < 6; ++l) shade_light(t->frame(), part, t->hits, l, nullptr, got.at(first).p);
      }
      EXPECT_TRUE(got == want) << isa_name(isa);
    }
  }
}

// Few lights and many, more than a vector meets in one go; all of the scene or a part; all lit, or bits that stand apart.
TEST(ShadeLight, LightsInOneGoAreOneAfterTheOther) {
  constexpr int kSurfaces = 301;
  for (const Shading shading : {Shading::kFlat, Shading::kGouraud, Shading::kPhong})
    for (const bool bounce : {false, true}) {
      auto t = make_test_surfaces(35, kSurfaces, shading, bounce);
      TestRandom random(36);
      std::vector<Light>& lights = t->scene().lights;
      while (lights.size() < 40) lights.push_back(lights[lights.size() - 6]);
      for (size_t i = 0; i < lights.size(); ++i) lights[i].intensity[0] = 0.1f * static_cast<float>(random.between(1, 20));
      for (int i = 100; i < 140; ++i) t->surfaces.valid[i] = 0;
      constexpr size_t kWords = (kSurfaces + 31) / 32 + 3;
      std::vector<uint32_t> lit(kWords * lights.size());
      for (uint32_t& w : lit) w = random.bits();
      for (const Isa isa : supported_isas())
        for (const int count : {0, 1, 2, 3, 6, 16, 17, 35})
          for (const bool shadows : {false, true}) {
            t->frame().isa = isa;
            const LightRange range{count % 5, count, shadows ? lit.data() : nullptr, kWords};
            TestRadiance want(kSurfaces), got(kSurfaces);
            shade_ambient(t->frame(), t->surfaces, want.at().p);
            for (int k = 0; k < count; ++k)
              shade_light(t->frame(), t->surfaces, t->hits, range.first + k,
                          shadows ? &lit[kWords * static_cast<size_t>(k)] : nullptr, want.at().p);
            shade_lights(t->frame(), t->surfaces, t->hits, range, got.at().p);
            EXPECT_TRUE(got == want) << isa_name(isa) << ", lights: " << count << ", shading " << static_cast<int>(shading);
          }
    }
}

// Scenes of exact primitives alone have no triangle whose corners could be read.
TEST(ShadeLight, FlatVectorsWithoutAnyTriangleReadNone) {
  auto t = make_test_surfaces(37, 100, Shading::kFlat, true);
  std::fill_n(t->surfaces.valid, 100, 0u);
  auto none = decltype(t->scene().triangles)();
  std::swap(t->scene().triangles, none);
  for (const Isa isa : supported_isas()) {
    t->frame().isa = isa;
    TestRadiance got(100);
    shade_lights(t->frame(), t->surfaces, t->hits, {0, 6}, got.at().p);
    EXPECT_TRUE(got == TestRadiance(100)) << isa_name(isa);
  }
}

TEST(ShadeLight, S1_MirrorDirectionNeverExceedsOneOverPi) {
  TestRandom random(41);
  auto t = one_surface(directional_light({0, 0, 1}), 500);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 n = random_unit(random);
    put3(t->surfaces.normal, i, n), put3(t->surfaces.geometric_normal, i, n), put3(t->surfaces.view, i, n);
    t->surfaces.shininess[i] = 1e4f;
  }
  for (int i = 0; i < 500; ++i) {
    t->scene().lights = {directional_light(get3(t->surfaces.normal, i))};
    TestRadiance r(500);
    shade_light(t->frame(), t->surfaces, t->hits, 0, nullptr, r.at().p);
    EXPECT_LE(r.channel[0][static_cast<size_t>(i)], 0.318309886f);
    EXPECT_GE(r.channel[0][static_cast<size_t>(i)], 0.318309886f * 0.99f);
  }
}

TEST(ShadeLight, LightsFarBeyondTheRangeOfFloatSquaresAreFinite) {
  for (const float far : {1e18f, 1e19f, 1e25f, 3e38f})
    for (const float linear : {0.0f, 1.0f}) {
      Light light;
      light.position[2] = far, light.attenuation[1] = linear;
      auto t = one_surface(light);
      EXPECT_LE(shade_all(*t, Isa::kScalar).channel[0][0], 1e-30f);
    }
}

TEST(ShadeLight, LightBehindTheGeometricNormalGivesNothing) {
  auto t = make_test_surfaces(62, kCount, Shading::kPhong, false);
  for (int l = 0; l < 6; ++l) {
    TestRadiance r(kCount);
    shade_light(t->frame(), t->surfaces, t->hits, l, nullptr, r.at().p);
    RayBatch rays;
    AlignedBuffer<uint32_t> of;
    make_shadow_rays(t->frame(), t->surfaces, l, rays, of);
    std::vector<bool> has_ray(kCount);
    for (int i = 0; i < rays.count; ++i) has_ray[of[static_cast<size_t>(i)]] = true;
    int behind = 0;
    for (int i = 0; i < kCount; ++i) {
      const OracleSurface s = t->oracle(i);
      const glm::dvec3 to = oracle_incidence(s.position, t->scene().lights[static_cast<size_t>(l)]).to_light;
      if (dot3(s.geometric_normal, to) < -1e-5) {
        EXPECT_EQ(r.channel[0][static_cast<size_t>(i)], 0);
        ++behind;
      }
      // What was lit asked whether it is; what asked can be lit.
      EXPECT_EQ(has_ray[static_cast<size_t>(i)], r.channel[0][static_cast<size_t>(i)] > 0) << i;
    }
    EXPECT_GT(behind, kCount / 10);
  }
}

TEST(ShadeLight, AmbientAndEmissionFollowThePlan) {
  auto t = make_test_surfaces(71, 100, Shading::kPhong, false);
  t->scene().lights.clear();
  for (int plan = 0; plan < 4; ++plan) {
    t->frame().plan.ambient = plan & 1, t->frame().plan.emission = plan & 2;
    const TestRadiance r = shade_all(*t, Isa::kScalar);
    for (int i = 0; i < 100; ++i) {
      const OracleSurface s = t->oracle(i);
      const double want = (plan & 1) * s.ambient.x * t->scene().ambient_radiance[0] + (plan & 2 ? s.emission.x : 0.0);
      EXPECT_NEAR(r.channel[0][static_cast<size_t>(i)], want, 1e-7);
    }
  }
}

TEST(ShadeLight, SpecularOffEqualsNoSpecularColor) {
  auto t = make_test_surfaces(81, 333, Shading::kPhong, false);
  for (const Shading shading : {Shading::kPhong, Shading::kGouraud}) {
    t->frame().settings.shading = shading;
    t->frame().plan.specular = false;
    const TestRadiance off = shade_all(*t, Isa::kScalar);
    t->frame().plan.specular = true;
    SurfaceBatch saved;
    copy_surfaces(t->surfaces, 0, 333, saved);
    for (int c = 0; c < 3; ++c) std::memset(t->surfaces.specular[c], 0, 333 * 4);
    EXPECT_TRUE(shade_all(*t, Isa::kScalar) == off);
    copy_surfaces(saved, 0, 333, t->surfaces);
    EXPECT_FALSE(shade_all(*t, Isa::kScalar) == off);
  }
}

TEST(ShadeLight, FlatLightsTheCentroidOnce) {
  for (const bool bounce : {false, true}) {
    auto t = make_test_surfaces(91, kCount, Shading::kFlat, bounce);
    const TestRadiance r = shade_all(*t, Isa::kScalar);
    double worst = 0;
    for (int i = 0; i < kCount; ++i) {
      if (!t->surfaces.valid[i] || near_terminator(*t, i)) continue;
      OracleSurface s = t->oracle(i);
      s.position = (t->corner(i, 0) + t->corner(i, 1) + t->corner(i, 2)) / 3.0;
      s.view = normalize3(t->viewer(i) - s.position, s.normal);
      worst = std::max(worst, r.max_encoded_difference(i, oracle_radiance(s, t->scene(), ~0ull, t->reflectance(i))));
    }
    EXPECT_LE(worst, 1.0 / 255);
  }
}

}  // namespace
}  // namespace spanray
