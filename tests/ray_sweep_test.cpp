// Moving spheres: never through anything, stopped where an oracle says, whatever the tree, the scale and the length of the way.
#include <gtest/gtest.h>

#include "ray/sweep.h"
#include "support/ray_answers.h"
#include "support/sweep_oracle.h"

namespace spanray {
namespace {

// What the tree must find: every triangle, one by one.
SphereHit brute_force_sweep(const SceneData& scene, const glm::dvec3& start, const glm::dvec3& end, double radius) {
  SphereHit best;
  const glm::dvec3 motion = end - start;
  for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
    const SphereTriangle t(scene_vertex(scene, i, 0) - start, scene_vertex(scene, i, 1) - start, scene_vertex(scene, i, 2) - start);
    SphereContact contact;
    if (!first_contact(t, motion, length3(motion), radius, 1, contact)) continue;
    if (best.primitive == kNoPrimitive || contact.time < best.contact.time) best.primitive = i, best.contact = contact;
  }
  return best;
}

struct Tally {
  int hits = 0, misses = 0, inside = 0, phantoms = 0;
};

// One sweep against brute force (the same bits) and against the oracle (no later, and not in anything).
void check_sweep(const TestFrame& t, const Bvh& bvh, const glm::dvec3& start, const glm::dvec3& end, double radius, Tally& tally) {
  const SphereHit got = sweep_sphere(t.scene, bvh, start, end, radius), plain = brute_force_sweep(t.scene, start, end, radius);
  ASSERT_EQ(plain.primitive, got.primitive);
  ASSERT_EQ(plain.contact.time, got.contact.time);
  if (mesh_distance(t.scene, Long3(start)) <= static_cast<long double>(radius)) return void(++tally.inside);
  const Long3 motion = Long3(end) - Long3(start);
  long double first = std::numeric_limits<long double>::infinity(), reach = static_cast<long double>(radius);
  for (uint32_t i = 0; i < t.scene.triangles.size(); ++i) {
    const LongTriangle triangle(t.scene, i);
    first = std::min(first, oracle_contact(triangle, Long3(start), motion, static_cast<long double>(radius)));
    for (const Long3& v : triangle.v) reach = std::max(reach, length3(v - Long3(start)));
  }
  const long double tolerance = reach * 0x1p-42L;
  if (got.primitive == kNoPrimitive) {
    ASSERT_TRUE(std::isinf(first)) << "it went through something at " << static_cast<double>(first);
    return void(++tally.misses);
  }
  const long double time = static_cast<long double>(got.contact.time);
  ASSERT_LE(time, first) << "later than the contact";
  const Long3 center = Long3(start) + motion * time;
  const long double away = oracle_distance(LongTriangle(t.scene, got.primitive), center);
  ASSERT_NEAR(static_cast<double>(away / tolerance), static_cast<double>(static_cast<long double>(radius) / tolerance), 1) << "not in contact";
  ASSERT_GE(mesh_distance(t.scene, center), static_cast<long double>(radius) - tolerance) << "inside of something";
  ASSERT_NEAR(1, length3(got.contact.normal), 1e-12);
  const Long3 point = Long3(start) + Long3(got.contact.point);
  ASSERT_LE(oracle_distance(LongTriangle(t.scene, got.primitive), point), tolerance) << "the point is not on the triangle";
  ++tally.hits;
  if (std::isinf(first)) ++tally.phantoms;
}

TEST(RaySweep, RandomSpheresStopWhereTheOracleSaysAtEveryScale) {
  for (const int exponent : {-20, 0, 20}) {
    const double scale = std::ldexp(1.0, exponent);
    TestRandom random(static_cast<uint32_t>(71 + exponent));
    std::vector<SoupTriangle> soup;
    add_mesh(soup, make_sphere(1), 0.6 * scale, glm::dvec3(0.1, 0, 0) * scale);
    std::vector<SoupTriangle> loose;
    add_random_triangles(loose, random, 60, 0.5);
    for (SoupTriangle& s : loose)
      for (Vertex& v : s.corner)
        for (float& x : v.position) x = static_cast<float>(x * scale);
    soup.insert(soup.end(), loose.begin(), loose.end());
    auto t = frame_of(soup);
    const Bvh bvh = build_all(*t);
    Tally tally;
    for (int i = 0; i < 1200; ++i) {
      const double radius = scale * std::pow(10.0, random.uniform(-5, -0.3));
      const glm::dvec3 start = random_point(random, 2) * scale;
      const double length = i % 5 == 0 ? 1e4 : i % 5 == 1 ? 1e-3 : 1;
      const glm::dvec3 end = i % 2 ? start + random_point(random, length) * scale : random_point(random, 1) * scale * length;
      check_sweep(*t, bvh, start, end, radius, tally);
      ASSERT_FALSE(HasFatalFailure()) << "sweep " << i << " scale 2^" << exponent;
    }
    EXPECT_GT(tally.hits, 240);
    EXPECT_GT(tally.misses, 240);
    EXPECT_EQ(0, tally.phantoms) << "none of these grazes";
  }
}

// Straight at corners, edges and middles of a closed mesh, by spheres much smaller than its triangles, from far away.
TEST(RaySweep, NothingPassesACornerOrAnEdgeHoweverFast) {
  for (const double scale : {0x1p-20, 1.0, 0x1p20}) {
    std::vector<SoupTriangle> soup;
    add_mesh(soup, make_sphere(1), scale, glm::dvec3(0));
    auto t = frame_of(soup);
    const Bvh bvh = build_all(*t);
    TestRandom random(72);
    for (int i = 0; i < 3000; ++i) {
      const uint32_t id = static_cast<uint32_t>(random.below(static_cast<int>(t->scene.triangles.size())));
      const glm::dvec3 a = scene_vertex(t->scene, id, 0), b = scene_vertex(t->scene, id, 1), c = scene_vertex(t->scene, id, 2);
      const double part = random.uniform(0, 1);
      const glm::dvec3 target = i % 3 == 0 ? a : i % 3 == 1 ? a + (b - a) * part : (a + b + c) / 3.0;
      const glm::dvec3 direction = normalize3(random_point(random, 1), glm::dvec3(1, 0, 0));
      const double far = std::pow(10.0, random.uniform(0.5, 7)), radius = scale * std::pow(10.0, random.uniform(-7, -1));
      const glm::dvec3 outside = target + normalize3(target + direction * (0.3 * scale), target) * (scale * far);
      const glm::dvec3 beyond = target + (target - outside) * random.uniform(0.05, 1e3);
      const SphereHit hit = sweep_sphere(t->scene, bvh, outside, beyond, radius);
      ASSERT_NE(kNoPrimitive, hit.primitive) << "through the mesh: ray " << i << " radius " << radius;
      const Long3 center = Long3(outside) + (Long3(beyond) - Long3(outside)) * static_cast<long double>(hit.contact.time);
      ASSERT_GE(static_cast<double>(length3(center)), 0.8 * scale) << "it is inside";
      ASSERT_GE(static_cast<double>(mesh_distance(t->scene, center)), radius - 1e-14 * far * scale) << i;
    }
  }
}

std::vector<SoupTriangle> floor_soup() {  // y = 0, |x| and |z| <= 10
  return {soup_triangle({-10, 0, -10}, {-10, 0, 10}, {10, 0, 10}), soup_triangle({-10, 0, -10}, {10, 0, 10}, {10, 0, -10})};
}

TEST(RaySweep, KnownContacts) {
  auto t = frame_of(floor_soup());
  const Bvh bvh = build_all(*t);
  const SphereHit face = sweep_sphere(t->scene, bvh, {3, 5, 1}, {3, -5, 1}, 0.5);
  EXPECT_NEAR(0.45, face.contact.time, 1e-13);
  EXPECT_NEAR(1, face.contact.normal.y, 1e-13);
  EXPECT_NEAR(-5, face.contact.point.y, 1e-12);
  const SphereHit below = sweep_sphere(t->scene, bvh, {3, -5, 1}, {3, 5, 1}, 0.5);
  EXPECT_NEAR(-1, below.contact.normal.y, 1e-13) << "both sides stop it";
  const SphereHit edge = sweep_sphere(t->scene, bvh, {15, 0, 1}, {5, 0, 1}, 0.5);
  EXPECT_NEAR(0.45, edge.contact.time, 1e-13);
  EXPECT_NEAR(1, edge.contact.normal.x, 1e-13);
  const SphereHit corner = sweep_sphere(t->scene, bvh, {20, 10, 20}, {0, -10, 0}, 1);
  EXPECT_NEAR(length3(corner.contact.normal - normalize3(glm::dvec3(1, 1, 1), glm::dvec3(0))), 0, 1e-7);
  EXPECT_NEAR((std::sqrt(300.0) - 1) / std::sqrt(1200.0), corner.contact.time, 1e-13);
  EXPECT_EQ(kNoPrimitive, sweep_sphere(t->scene, bvh, {3, 0.5 + 1e-9, 1}, {-9, 0.5 + 1e-9, 1}, 0.5).primitive) << "along the floor, just above it";
  EXPECT_EQ(kNoPrimitive, sweep_sphere(t->scene, bvh, {3, 1, 1}, {3, 0.5 + 1e-9, 1}, 0.5).primitive) << "down to just above it";
  EXPECT_NE(kNoPrimitive, sweep_sphere(t->scene, bvh, {3, 1, 1}, {3, 0.5, 1}, 0.5).primitive) << "down to it";
  EXPECT_EQ(kNoPrimitive, sweep_sphere(t->scene, bvh, {30, 0.2, 1}, {30, 0.2, 400}, 0.5).primitive);
}

TEST(RaySweep, WhatTouchesAtTheStartStopsOnlyWhoMovesTowardsIt) {
  auto t = frame_of(floor_soup());
  const Bvh bvh = build_all(*t);
  for (const double height : {0.5, 0.4, 1e-3}) {  // touching, then deeper and deeper in it
    const glm::dvec3 start(1, height, 2);
    const SphereHit towards = sweep_sphere(t->scene, bvh, start, start + glm::dvec3(1, -1e-3, 0), 0.5);
    EXPECT_EQ(0, towards.contact.time);
    EXPECT_NE(kNoPrimitive, towards.primitive) << height;
    EXPECT_EQ(kNoPrimitive, sweep_sphere(t->scene, bvh, start, start + glm::dvec3(0.1, 0, 0), 0.5).primitive) << "along";
    EXPECT_EQ(kNoPrimitive, sweep_sphere(t->scene, bvh, start, start + glm::dvec3(0, 1e-6, 0), 0.5).primitive) << "out of it";
  }
}

TEST(RaySweep, TrianglesWithoutAreaAndNeedlesStopSpheres) {
  std::vector<SoupTriangle> soup = {soup_triangle({-1, 0, 0}, {1, 0, 0}, {0.25, 0, 0}), soup_triangle({0, 5, 0}, {0, 5, 0}, {0, 5, 0}),
                                    soup_triangle({-1, -5, 0}, {1, -5, 0}, {0.3, -5, 1e-7})};
  auto t = frame_of(soup);
  const Bvh bvh = build_all(*t);
  for (const double height : {0.0, 5.0, -5.0}) {
    const SphereHit hit = sweep_sphere(t->scene, bvh, {0, height, -4}, {0, height, 4}, 0.25);
    ASSERT_NE(kNoPrimitive, hit.primitive) << height;
    EXPECT_NEAR(3.75 / 8, hit.contact.time, 1e-12);
  }
  Tally tally;
  TestRandom random(73);
  for (int i = 0; i < 3000; ++i) {
    check_sweep(*t, bvh, random_point(random, 7), random_point(random, 7), random.uniform(1e-3, 1), tally);
    ASSERT_FALSE(HasFatalFailure()) << i;
  }
  EXPECT_GT(tally.hits, 100);
}

TEST(RaySweep, TouchingFindsWhatIsNearAndNothingElse) {
  TestRandom random(74);
  std::vector<SoupTriangle> soup;
  add_random_triangles(soup, random, 300, 0.4);
  auto t = frame_of(soup);
  const Bvh bvh = build_all(*t);
  size_t found = 0;
  for (int i = 0; i < 300; ++i) {
    const glm::dvec3 center = random_point(random, 1.2);
    const double radius = random.uniform(0, 0.6);
    const std::vector<SphereHit> hits = touch_sphere(t->scene, bvh, center, radius);
    std::vector<bool> listed(soup.size(), false);
    for (size_t k = 0; k < hits.size(); ++k) {
      ASSERT_FALSE(listed[hits[k].primitive]);
      listed[hits[k].primitive] = true;
      ASSERT_TRUE(k == 0 || hits[k - 1].distance <= hits[k].distance);
    }
    for (uint32_t p = 0; p < soup.size(); ++p) {
      const double distance = static_cast<double>(oracle_distance(LongTriangle(t->scene, p), Long3(center)));
      if (std::fabs(distance - radius) < 1e-12) continue;
      ASSERT_EQ(distance < radius, listed[p]) << i << " " << p;
    }
    found += hits.size();
  }
  EXPECT_GT(found, 3000u);
}

}  // namespace
}  // namespace spanray
