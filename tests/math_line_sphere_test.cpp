// Lines against spheres, judged in quadruple precision: from far away, from within, at tangents, at all scales and offsets
// (HARD-CASES Y10).
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "math/line_sphere.h"
#include "support/random.h"

namespace spanray {
namespace {

__extension__ typedef __float128 Quad;

Quad root_of(Quad x) {
  if (!(x > 0)) return 0;
  Quad r = std::sqrt(static_cast<long double>(x));
  for (int i = 0; i < 3; ++i) r = (r + x / r) / 2;  // Newton
  return r;
}

struct Truth {
  Quad enter = 0, leave = 0;
  Quad beside = 0;  // (r^2 - squared distance of line and center) / r^2: below 0 it passes by
};
Truth truth_of(const glm::dvec3& f, const glm::dvec3& d, double r) {
  Quad a = 0, b = 0, c = -Quad(r) * Quad(r);
  for (int k = 0; k < 3; ++k) a += Quad(d[k]) * Quad(d[k]), b -= Quad(f[k]) * Quad(d[k]), c += Quad(f[k]) * Quad(f[k]);
  const Quad square = b * b - a * c, root = root_of(square), q = b < 0 ? b - root : b + root;
  const Quad far = q / a, near = q != 0 ? c / q : Quad(0);
  return {b < 0 ? far : near, b < 0 ? near : far, square / (a * Quad(r) * Quad(r))};
}

double ulps(double got, Quad want) {
  const double rounded = static_cast<double>(want);
  const double ulp = std::nextafter(std::fabs(rounded), INFINITY) - std::fabs(rounded);
  const Quad off = (Quad(got) - want) / Quad(ulp);
  return static_cast<double>(off < 0 ? -off : off);
}

glm::dvec3 unit_vector(TestRandom& random) {
  for (;;) {
    const glm::dvec3 p = random_point(random);
    if (const double length = length3(p); length <= 1 && length > 0.1) return p / length;
  }
}
glm::dvec3 rounded(const glm::dvec3& v) {
  glm::dvec3 r;
  for (int k = 0; k < 3; ++k) r[k] = static_cast<float>(v[k]);
  return r;
}

// Rays (of floats, or of doubles) that pass the center at `beside` radii, from `away` radii; worst error of the hits in ulp,
// not at tangents.
struct Worst {
  double enter = 0, leave = 0;
  int hits = 0, wrong = 0;
};
Worst worst_of(double away, double least_beside, double most_beside, uint32_t seed, bool floats = true) {
  TestRandom random(seed);
  Worst worst;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 from = rounded(unit_vector(random) * away);
    const glm::dvec3 side =
        normalize3(cross3(from, unit_vector(random)), glm::dvec3(1, 0, 0)) * random.uniform(least_beside, most_beside);
    const glm::dvec3 exact = (side - from) * random.uniform(0.1, 10), d = floats ? rounded(exact) : exact;
    const Truth want = truth_of(from, d, 1);
    SphereCrossing got;
    const bool meets = cross_sphere(from, d, 1, got);
    if (want.beside > Quad(0x1p-50) || want.beside < -Quad(0x1p-50)) worst.wrong += meets != (want.beside > 0);
    if (!meets || want.beside < Quad(1e-4)) continue;
    ++worst.hits;
    worst.enter = std::max(worst.enter, ulps(got.enter, want.enter)),
    worst.leave = std::max(worst.leave, ulps(got.leave, want.leave));
    worst.wrong += !(got.enter <= got.leave) || (got.outside > 0) != (away > 1);
  }
  return worst;
}

TEST(LineSphere, Y10_UnitSphereFromFarAwayWithin4Ulp) {
  for (const double away : {1.001, 1.5, 10.0, 1e3, 1e5, 0x1p20}) {
    const Worst w = worst_of(away, 0, 0.9999, 1);
    EXPECT_GT(w.hits, 15000) << away;
    EXPECT_EQ(w.wrong, 0) << away;
    EXPECT_LE(w.enter, 4) << away;
    EXPECT_LE(w.leave, 4) << away;
  }
}

TEST(LineSphere, FromWithin) {
  for (const double away : {1e-6, 0.1, 0.9, 0.9999}) {
    const Worst w = worst_of(away, 0, std::min(away, 0.99), 2);
    EXPECT_GT(w.hits, 15000) << away;
    EXPECT_EQ(w.wrong, 0) << away;
    EXPECT_LE(w.enter, 4) << away;
    EXPECT_LE(w.leave, 4) << away;
  }
}

TEST(LineSphere, HitsAndMissesAreToldApartNearTangents) {
  for (const double away : {1.5, 1e3, 1e5}) {
    for (const double beside : {1e-2, 1e-6, 1e-10}) {
      const Worst w = worst_of(away, 1 - beside, 1 + beside, 3, false);
      EXPECT_EQ(w.wrong, 0) << away << ", " << beside;
    }
  }
}

TEST(LineSphere, ExactTangentsOriginsOnTheSphereAndItsCenter) {
  SphereCrossing c;
  ASSERT_TRUE(cross_sphere({-3, 1, 0}, {2, 0, 0}, 1, c));  // touches
  EXPECT_EQ(c.enter, 1.5);
  EXPECT_EQ(c.leave, 1.5);
  EXPECT_GT(c.outside, 0);
  EXPECT_FALSE(cross_sphere({-3, std::nextafter(1.0, 2.0), 0}, {2, 0, 0}, 1, c));
  ASSERT_TRUE(cross_sphere({-1, 0, 0}, {1, 0, 0}, 1, c));  // on the sphere, inwards
  EXPECT_EQ(c.enter, 0);
  EXPECT_EQ(c.leave, 2);
  EXPECT_EQ(c.outside, 0);
  ASSERT_TRUE(cross_sphere({-1, 0, 0}, {-1, 0, 0}, 1, c));  // and outwards
  EXPECT_EQ(c.enter, -2);
  EXPECT_EQ(c.leave, 0);
  EXPECT_EQ(c.outside, 0);
  ASSERT_TRUE(cross_sphere({0, 1, 0}, {1, 0, 0}, 1, c));  // along it
  EXPECT_EQ(c.enter, 0);
  EXPECT_EQ(c.leave, 0);
  ASSERT_TRUE(cross_sphere({0, 0, 0}, {0, 0, -4}, 1, c));
  EXPECT_EQ(c.enter, -0.25);
  EXPECT_EQ(c.leave, 0.25);
  EXPECT_LT(c.outside, 0);
}

// 0.6^2 + 0.8^2 in floats is not 1: which side of the sphere an origin near it is on is known nevertheless.
TEST(LineSphere, TheSideOfOriginsNearTheSphereIsRight) {
  TestRandom random(4);
  int inside = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 from = rounded(unit_vector(random));
    Quad side = -1;
    for (int k = 0; k < 3; ++k) side += Quad(from[k]) * Quad(from[k]);
    SphereCrossing c;
    ASSERT_TRUE(cross_sphere(from, -from, 1, c));
    ASSERT_EQ(c.outside > 0, side > 0) << i;
    ASSERT_EQ(c.outside < 0, side < 0) << i;
    ASSERT_EQ(c.enter > 0, side > 0) << i;
    inside += side < 0;
  }
  EXPECT_GT(inside, 5000);
  EXPECT_LT(inside, 15000);
}

TEST(LineSphere, PowersOfTwoChangeNoBit) {
  TestRandom random(5);
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 from = rounded(unit_vector(random) * random.uniform(0.5, 100)),
                     d = rounded(random_point(random, 0.02) - from);
    SphereCrossing one;
    if (!cross_sphere(from, d, 1, one)) continue;
    for (const double s : {0x1p-100, 0x1p-20, 0x1p20, 0x1p100}) {
      SphereCrossing other;
      ASSERT_TRUE(cross_sphere(from * s, d * s, s, other));
      ASSERT_EQ(std::bit_cast<uint64_t>(one.enter), std::bit_cast<uint64_t>(other.enter)) << s;
      ASSERT_EQ(std::bit_cast<uint64_t>(one.leave), std::bit_cast<uint64_t>(other.leave)) << s;
      ASSERT_TRUE(cross_sphere(from, d * s, 1, other));
      ASSERT_EQ(one.enter, other.enter * s) << s;
    }
  }
}

}  // namespace
}  // namespace spanray
