// Lines against planes, judged in quadruple precision: grazing, from far away, from on the plane, at all scales and offsets.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "math/line_plane.h"
#include "support/random.h"

namespace spanray {
namespace {

__extension__ typedef __float128 Quad;

// Exact but for 2^-113 of the sum: the products of floats or doubles with floats fit.
Quad height_of(const glm::dvec3& n, const glm::dvec3& point, const glm::dvec3& place) {
  Quad sum = 0;
  for (int k = 0; k < 3; ++k) sum += Quad(n[k]) * (Quad(place[k]) - Quad(point[k]));
  return sum;
}
Quad slope_of(const glm::dvec3& n, const glm::dvec3& d) { return height_of(n, glm::dvec3(0), d); }

double ulps(double got, Quad want) {
  const double rounded = std::fabs(static_cast<double>(want));
  const Quad off = (Quad(got) - want) / Quad(std::nextafter(rounded, INFINITY) - rounded);
  return static_cast<double>(off < 0 ? -off : off);
}

glm::dvec3 rounded(const glm::dvec3& v) {
  return {static_cast<double>(static_cast<float>(v.x)), static_cast<double>(static_cast<float>(v.y)),
          static_cast<double>(static_cast<float>(v.z))};
}
glm::dvec3 any_normal(TestRandom& random, int i) {
  if (i % 4 == 0) {
    glm::dvec3 n(0);
    n[i / 4 % 3] = i % 8 == 0 ? 1.375 : -1;
    return n;
  }
  const glm::dvec3 p = random_point(random, 2);
  return rounded(i % 4 == 1 ? glm::dvec3(p.x * 1e-6, p.y, p.z * 1e-12) : p);
}

// Rays of floats (and, as primary ones, of doubles) that fall towards a plane at every slope down to 1e-12, from heights down
// to 1e-7 of how far away the plane's point is.
TEST(LinePlane, MeetingsAreWithinThreeUlp) {
  TestRandom random(31);
  double worst = 0;
  int met = 0;
  for (int i = 0; i < 200000; ++i) {
    const glm::dvec3 n = any_normal(random, i), point = rounded(random_point(random, std::pow(10, random.uniform(-3, 6))));
    const glm::dvec3 a = random_point(random), flat = a - n * (dot3(a, n) / dot3(n, n));
    const double far = std::max(length3(point), 1.0);
    glm::dvec3 o = point + flat * far + n * (std::pow(10, random.uniform(-7, 1)) * far);
    glm::dvec3 d = random_point(random);
    d = d - n * (dot3(d, n) / dot3(n, n)) - n * std::pow(10, random.uniform(-12, 1));
    if (i % 2 == 0) o = rounded(o), d = rounded(d);
    const Quad height = height_of(n, point, o), slope = slope_of(n, d);
    const double t = cross_plane(height_over(n, point, o), slope_over(n, d));
    const bool towards = (height > 0 && slope < 0) || (height < 0 && slope > 0);
    ASSERT_EQ(std::isfinite(t), towards) << i;
    if (!towards) continue;
    ++met;
    worst = std::max(worst, ulps(t, -height / slope));
  }
  EXPECT_GT(met, 150000);
  EXPECT_LE(worst, 3);
  EXPECT_GT(worst, 0.5) << "nothing was measured";
}

// Places of floats: the sign is that of exact arithmetic, and 0 is 0. Every third lies exactly on its plane.
TEST(LinePlane, TheSideOfAPlaceIsRight) {
  TestRandom random(32);
  int on = 0;
  for (int i = 0; i < 200000; ++i) {
    const glm::dvec3 n = {double(random.between(-500, 500)), double(random.between(-500, 500)),
                          double(random.between(-500, 500))};
    const double grid = std::ldexp(1.0, random.between(-20, 0));
    const glm::dvec3 point = {double(random.between(-4000, 4000)), double(random.between(-4000, 4000)),
                              double(random.between(-4000, 4000))};
    glm::dvec3 place = point;
    const glm::dvec3 along = {n.y, -n.x, 0}, along2 = {0, n.z, -n.y};
    place = place + along * double(random.between(-3, 3)) + along2 * double(random.between(-3, 3));
    if (i % 3 != 0) place[i % 2] += random.between(-1, 1) * 0x1p-10;
    const Quad want = height_of(n, point * grid, place * grid);
    const double got = height_over(n, point * grid, place * grid);
    ASSERT_EQ(got > 0, want > 0) << i;
    ASSERT_EQ(got < 0, want < 0) << i;
    on += got == 0;
  }
  EXPECT_GT(on, 60000);
}

TEST(LinePlane, WhatStartsOnAPlaneOrRunsAlongItNeverMeetsIt) {
  const glm::dvec3 n = rounded({0.3, -0.7, 0.2}), point = rounded({0.1, 0.2, 0.3});
  EXPECT_TRUE(std::isinf(cross_plane(0, -1)));
  EXPECT_TRUE(std::isinf(cross_plane(1, 0)));
  EXPECT_TRUE(std::isinf(cross_plane(1, 2)));
  EXPECT_TRUE(std::isinf(cross_plane(-1, -2)));
  EXPECT_EQ(cross_plane(-1, 2), 0.5);
  EXPECT_EQ(height_over(n, point, point), 0);
  EXPECT_EQ(slope_over(n, {n.y, -n.x, 0}), 0);
  EXPECT_EQ(slope_over(n, {0, n.z, -n.y}), 0);
  EXPECT_NE(slope_over(n, {std::nextafter(n.y, 2.0), -n.x, 0}), 0);
  EXPECT_EQ(along_normal({1, 1, 1}, {0x1p60, -0x1p60, 0x1p-50}, glm::dvec3(0)), 0) << "a sign that is not proven";
  EXPECT_EQ(along_normal({1, 1, 1}, {0x1p60, -0x1p60, 0x1p-30}, glm::dvec3(0)), 0x1p-30);
}

TEST(LinePlane, PowersOfTwoInScaleChangeNoBit) {
  TestRandom random(33);
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 n = any_normal(random, i), point = random_point(random, 50), o = random_point(random, 50),
                     d = random_point(random);
    const double t = cross_plane(height_over(n, point, o), slope_over(n, d));
    for (const double scale : {0x1p-60, 0x1p-20, 0x1p20, 0x1p60}) {
      const double same = cross_plane(height_over(n, point * scale, o * scale), slope_over(n, d * scale));
      ASSERT_EQ(std::bit_cast<uint64_t>(same), std::bit_cast<uint64_t>(t)) << i;
    }
  }
}

}  // namespace
}  // namespace spanray
