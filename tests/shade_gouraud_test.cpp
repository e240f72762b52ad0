#include <gtest/gtest.h>

#include "math/elementary.h"
#include "support/test_surfaces.h"

namespace spanray {
namespace {

constexpr int kCount = 1009;

TEST(Gouraud, InterpolatesTheCornersOfTheSideThatIsSeen) {
  for (const bool bounce : {false, true}) {
    auto t = make_test_surfaces(2, kCount, Shading::kGouraud, bounce);
    const TestRadiance radiance = shade_all(*t, Isa::kScalar);
    double worst = 0;
    int compared = 0;
    for (int i = 0; i < kCount; ++i) {
      if (!t->surfaces.valid[i]) continue;
      const OracleSurface s = t->oracle(i);
      glm::dvec3 want = s.ambient * oracle_vec(t->scene().ambient_radiance) + s.emission;
      bool near = false;
      for (const Light& light : t->scene().lights) {
        const double facing = dot3(s.geometric_normal, oracle_incidence(s.position, light).to_light);
        near |= std::fabs(facing) < 1e-5;
        if (facing <= 0) continue;
        for (int j = 0; j < 3; ++j) {
          const glm::dvec3 p = t->corner(i, j);
          glm::dvec3 n = t->corner_normal(i, j);
          if (dot3(n, s.geometric_normal) < 0) n = -n;
          const OracleIncidence in = oracle_incidence(p, light);
          near |= std::fabs(dot3(n, in.to_light)) < 1e-5;
          const OracleReflected r = oracle_reflected(n, in.to_light, normalize3(t->viewer(i) - p, n), s.shininess, t->reflectance(i));
          const glm::dvec3 color = s.diffuse * r.diffuse + s.specular * r.specular;
          want += double(t->surfaces.weight[j][i]) * in.irradiance * oracle_vec(light.intensity) * color;
        }
      }
      if (near) continue;
      ++compared;
      worst = std::max(worst, radiance.max_encoded_difference(i, want));
    }
    EXPECT_LE(worst, 1.0 / 255);
    EXPECT_GT(compared, kCount * 8 / 10);
  }
}

TEST(Gouraud, BothSidesOfASheetAreLitFromTheirOwnSide) {
  auto t = make_test_surfaces(5, 2, Shading::kGouraud, false);
  std::vector<SoupTriangle> soup = {soup_triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0})};
  t->scene() = make_test_scene(soup);
  for (const double side : {1.0, -1.0}) {
    Light light;
    light.position[2] = static_cast<float>(2 * side);
    t->scene().lights = {light};
    for (const double eye : {5.0, -5.0}) {
      t->frame().primary.eye = {0, 0, eye};
      clear_surfaces(t->surfaces, 1);
      put_surface(*t, 0, 0, glm::dvec3(1.0 / 3), t->frame().primary.eye);
      put3(t->surfaces.diffuse, 0, glm::dvec3(1));
      const float got = shade_all(*t, Isa::kScalar).channel[0][0];
      if (side * eye > 0) EXPECT_GT(got, 0.03);
      else EXPECT_EQ(got, 0);
    }
  }
}

TEST(Gouraud, CornerNormalsAreTurnedAsOne) {
  auto t = make_test_surfaces(7, 1, Shading::kGouraud, false);
  t->frame().primary.eye = {0, 0, 5};
  Light light = t->scene().lights[2];
  const glm::dvec3 toward = normalize3(glm::dvec3(1, 0, 0.5), glm::dvec3(0));
  for (int k = 0; k < 3; ++k) light.direction[k] = static_cast<float>(-toward[k]), light.intensity[k] = 1;
  float seen[2];
  for (const int opposed : {0, 1}) {
    SoupTriangle soup = soup_triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
    // The third normal lies 10 degrees below the horizon, on the side of the light; or all of them oppose the winding.
    const double bent[3] = {0, 0, 100 * kPi / 180};
    glm::dvec3 n[3];
    for (int j = 0; j < 3; ++j) {
      n[j] = glm::dvec3(std::sin(bent[j]), 0, std::cos(bent[j])) * (opposed ? -1.0 : 1.0);
      for (int k = 0; k < 3; ++k) soup.corner[j].normal[k] = static_cast<float>(n[j][k]);
    }
    t->scene() = make_test_scene({soup});
    t->scene().lights = {light};
    clear_surfaces(t->surfaces, 1);
    put_surface(*t, 0, 0, glm::dvec3(1.0 / 3), t->frame().primary.eye);
    put3(t->surfaces.diffuse, 0, glm::dvec3(1));
    t->frame().plan.ambient = false;
    seen[opposed] = shade_all(*t, Isa::kScalar).channel[0][0];
    const double up = toward.z / kPi, third = std::max(0.0, toward.x * std::sin(bent[2]) + toward.z * std::cos(bent[2])) / kPi;
    EXPECT_NEAR(seen[opposed], (2 * up + third) / 3, 1e-6);
  }
  EXPECT_EQ(seen[0], seen[1]);
}

}  // namespace
}  // namespace spanray
