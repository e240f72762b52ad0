// Reflectance as paths use it: energy, reciprocity, and sampling that says the truth about itself.
#include "reference/scatter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "catalog/catalog.h"
#include "support/random.h"

namespace spanray::reference {
namespace {

constexpr double kPi = std::numbers::pi;
const glm::dvec3 kNormal = normalize3(glm::dvec3(0.2, 0.9, -0.4), glm::dvec3(0));

// A frame about kNormal.
glm::dvec3 from_angles(double cosine, double phi) {
  const glm::dvec3 x = normalize3(cross3(kNormal, glm::dvec3(0, 0, 1)), glm::dvec3(0)), y = cross3(kNormal, x);
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return kNormal * cosine + x * (sine * std::cos(phi)) + y * (sine * std::sin(phi));
}

Surface surface(double diffuse, double specular, double mirror, double shininess, const glm::dvec3& view) {
  Surface s;
  s.geometric = s.normal = kNormal, s.view = view;
  s.diffuse = glm::dvec3(diffuse), s.specular = glm::dvec3(specular), s.mirror = glm::dvec3(mirror), s.shininess = shininess;
  return s;
}

// Integral over the sphere, by the middles of a fine grid that is denser around a peak at the mirrored direction.
template <class F>
double integrate(const glm::dvec3& view, const F& f) {
  const glm::dvec3 axis = kNormal * (2 * dot3(kNormal, view)) - view;
  const glm::dvec3 x = normalize3(cross3(axis, glm::dvec3(0.3, -0.2, 1)), glm::dvec3(0)), y = cross3(axis, x);
  constexpr int kRings = 600, kSpokes = 120;
  double sum = 0;
  for (int i = 0; i < kRings; ++i) {
    const double s = (i + 0.5) / kRings, theta = kPi * s * s, ring = std::sin(theta) * kPi * 2 * s / kRings;
    for (int j = 0; j < kSpokes; ++j) {
      const double phi = 2 * kPi * (j + 0.5) / kSpokes;
      sum += f(axis * std::cos(theta) + x * (std::sin(theta) * std::cos(phi)) + y * (std::sin(theta) * std::sin(phi))) * ring *
             2 * kPi / kSpokes;
    }
  }
  return sum;
}

constexpr double kCosines[] = {1.0, 0.8, 0.5, 0.2, 0.02};
constexpr double kShininesses[] = {0, 1, 3, 5.6, 10, 60, 800, 1e4};

TEST(ReferenceScatter, KnowsTheReflectancesOfTheCatalog) {
  ASSERT_EQ(catalog_count(CatalogKind::kReflectance), 2) << "a new reflectance wants its rows in this test";
  EXPECT_EQ(catalog_name(CatalogKind::kReflectance, kBlinnPhong), "blinn_phong");
  EXPECT_EQ(catalog_name(CatalogKind::kReflectance, kLambert), "lambert");
}

// HARD-CASES S5. The MTL highlight alone (Ks = 1) is what its formula says, at most, and above 1 for low exponents: a fact of
// the format. What paths use stays at or below 1 for every material.
TEST(ReferenceScatter, NothingReflectsMoreThanItReceives) {
  std::printf("albedo of the MTL highlight, Ks = 1, seen at cosines 1.0 0.8 0.5 0.2 0.02:\n");
  for (const double shininess : kShininesses) {
    std::printf("  Ns %-6g", shininess);
    for (const double cosine : kCosines) {
      const glm::dvec3 view = from_angles(cosine, 1);
      const double albedo = integrate(view, [&](const glm::dvec3& l) {
        return dot3(kNormal, l) > 0 ? reflectance(kBlinnPhong, kNormal, l, view, shininess).specular : 0.0;
      });
      std::printf(" %.4f", albedo);
      EXPECT_LE(albedo, highlight_albedo(shininess) * 1.001) << shininess << " " << cosine;
      if (cosine == 1) {
        EXPECT_NEAR(albedo, highlight_albedo(shininess), 3e-3 * highlight_albedo(shininess))
            << shininess << ": the grid's rings run along the horizon";
      }
      for (const int32_t model : {kBlinnPhong, kLambert})
        for (const double share : {0.0, 0.4, 1.0, 7.0}) {
          const Surface s = surface(1, share, share > 1 ? 1 : 0, shininess, view);
          const Scatter scatter(s, model);
          const Scatter::Sample mirrored = scatter.sample({1e-9, 0.5, 0.5, 0.5});
          const double whole = integrate(view, [&](const glm::dvec3& l) { return scatter.value(l).x; });
          // The mirror's own weight is the rest: chosen as often as it reflects.
          const double mirror =
              mirrored.mirror ? s.mirror.x / most_reflected(model, s.diffuse, s.specular, s.mirror, shininess) : 0;
          EXPECT_LE(whole + mirror, 1.001) << model << " " << shininess << " " << cosine << " " << share;
          if (share == 0) {
            EXPECT_NEAR(whole, 1, 1e-3) << "Lambert";
          }
        }
    }
    std::printf("\n");
  }
}

// Diffuse: f(l, v) = f(v, l). The highlight: f cos is symmetric, so f itself is not reciprocal; Helmholtz wants f(l, v) = f(v,
// l). Asserted as it is, so that a formula that changes is noticed.
TEST(ReferenceScatter, Reciprocity) {
  TestRandom random(1);
  double most = 0;
  for (int i = 0; i < 10000; ++i) {
    const glm::dvec3 l = from_angles(random.uniform(0.01, 1), random.uniform(0, 2 * kPi)),
                     v = from_angles(random.uniform(0.01, 1), random.uniform(0, 2 * kPi));
    const double n_l = dot3(kNormal, l), n_v = dot3(kNormal, v), shininess = std::exp(random.uniform(-1, 9));
    for (const int32_t model : {kBlinnPhong, kLambert}) {
      const Reflectance there = reflectance(model, kNormal, l, v, shininess),
                        back = reflectance(model, kNormal, v, l, shininess);
      EXPECT_NEAR(there.diffuse / n_l, back.diffuse / n_v, 1e-12);
      EXPECT_NEAR(there.specular, back.specular, 1e-12);
      if (there.specular > 1e-3) most = std::max(most, std::fabs(there.specular / n_l / (back.specular / n_v) - 1));
      if (model == kLambert) {
        EXPECT_EQ(there.specular, 0);
      }
    }
  }
  std::printf("f(l, v) / f(v, l) of the MTL highlight is off from 1 by up to %.1f\n", most);
}

// The density integrates to the chance that a direction is no mirror and above the half-way plane; means of weights are the
// integral of value(): asked for a direction-dependent measure, so that samples in wrong places show.
TEST(ReferenceScatter, SamplesAreAsDenseAsTheySay) {
  TestRandom random(7);
  for (const double shininess : kShininesses)
    for (const double cosine : {1.0, 0.5, 0.1})
      for (const double specular : {0.0, 0.3, 1.0}) {
        const glm::dvec3 view = from_angles(cosine, 2), probe = normalize3(glm::dvec3(0.3, 0.5, 0.6), glm::dvec3(0));
        const Surface s = surface(0.4, specular, 0.2, shininess, view);
        const Scatter scatter(s, kBlinnPhong);
        const auto measure = [&](const glm::dvec3& l) { return 1 + 0.9 * dot3(l, probe); };
        const double want = integrate(view, [&](const glm::dvec3& l) { return scatter.value(l).x * measure(l); });
        EXPECT_LE(integrate(view, [&](const glm::dvec3& l) { return scatter.density(l); }), 1.001);
        double sum = 0, square = 0, mirrors = 0;
        constexpr int kSamples = 40000;
        for (int i = 0; i < kSamples; ++i) {
          const Scatter::Sample sample = scatter.sample({random.uniform(), random.uniform(), random.uniform(), 0});
          mirrors += sample.mirror ? sample.weight.x : 0;
          if (sample.mirror || sample.weight == glm::dvec3(0)) continue;
          EXPECT_NEAR(length3(sample.direction), 1, 1e-9);
          EXPECT_NEAR(sample.density, scatter.density(sample.direction), 1e-9 * sample.density);
          const double x = sample.weight.x * measure(sample.direction);
          sum += x, square += x * x;
        }
        const double mean = sum / kSamples, error = std::sqrt((square / kSamples - mean * mean) / kSamples);
        EXPECT_NEAR(mean, want, 4.7 * error + 1e-3 * want) << shininess << " " << cosine << " " << specular;
        const double scale = 1 / std::max(1.0, most_reflected(kBlinnPhong, s.diffuse, s.specular, s.mirror, shininess));
        EXPECT_NEAR(mirrors / kSamples, 0.2 * scale, 0.01);
      }
}

// Light from below the geometric surface counts for nothing, wherever the shading normal points.
TEST(ReferenceScatter, NothingComesThroughFromBelow) {
  Surface s = surface(0.5, 0.5, 0, 20, from_angles(0.3, 1));
  s.normal = from_angles(0.2, 2);
  const Scatter scatter(s, kBlinnPhong);
  TestRandom random(3);
  int lit = 0;
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 l = from_angles(random.uniform(-1, 1), random.uniform(0, 2 * kPi));
    const bool above = dot3(l, s.geometric) > 0 && dot3(l, s.normal) > 0;
    EXPECT_EQ(scatter.value(l).x > 0, above);
    lit += above;
  }
  EXPECT_GT(lit, 100);
}

}  // namespace
}  // namespace spanray::reference
