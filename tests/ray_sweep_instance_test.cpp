// Spheres against trees of two levels: the bits that one tree over all triangles gives, and no tree at all.
#include <gtest/gtest.h>

#include "ray/sweep.h"
#include "support/bvh_oracle.h"
#include "support/scattered_instances.h"

namespace spanray {
namespace {

SphereTriangle triangle_from(const SceneData& scene, uint32_t primitive, const glm::dvec3& start) {
  return {scene_vertex(scene, primitive, 0) - start, scene_vertex(scene, primitive, 1) - start, scene_vertex(scene, primitive, 2) - start};
}

SphereHit sweep_all(const SceneData& scene, const glm::dvec3& start, const glm::dvec3& end, double radius) {
  SphereHit best;
  const glm::dvec3 motion = end - start;
  for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
    SphereContact contact;
    if (!first_contact(triangle_from(scene, i, start), motion, length3(motion), radius, 1, contact)) continue;
    if (best.primitive == kNoPrimitive || contact.time < best.contact.time) best.primitive = i, best.contact = contact;
  }
  return best;
}

std::vector<SphereHit> touch_all(const SceneData& scene, const glm::dvec3& center, double radius) {
  std::vector<SphereHit> hits;
  for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
    const NearestPoint nearest = nearest_point(triangle_from(scene, i, center), glm::dvec3(0));
    if (nearest.distance <= radius) hits.push_back({i, {0, nearest.away * -nearest.distance, nearest.away}, nearest.distance});
  }
  std::stable_sort(hits.begin(), hits.end(), [](const SphereHit& a, const SphereHit& b) { return a.distance < b.distance; });
  return hits;
}

bool same(const SphereHit& a, const SphereHit& b) {
  return a.primitive == b.primitive && a.distance == b.distance && a.contact.time == b.contact.time && a.contact.point == b.contact.point &&
         a.contact.normal == b.contact.normal;
}

// A place on a random triangle, its plane's normal, and its size.
struct Target {
  uint32_t primitive;
  glm::dvec3 at, normal, along;
  double size;

  Target(const SceneData& scene, TestRandom& random) : primitive(static_cast<uint32_t>(random.below(static_cast<int>(scene.triangles.size())))) {
    glm::dvec3 v[3];
    const int turn = random.below(3), where = random.below(3);
    for (int c = 0; c < 3; ++c) v[c] = scene_vertex(scene, primitive, (c + turn) % 3);
    along = v[1] - v[0];
    size = std::max({length3(along), length3(v[2] - v[0]), 1e-30});
    normal = normalize3(cross3(along, v[2] - v[0]), glm::dvec3(1, 0, 0));
    if (random.below(2) == 0) normal = -normal;
    at = v[0];
    if (where == 1) at = v[0] + along * random.uniform(0, 1);
    if (where == 2) at = v[0] + along * random.uniform(0, 0.5) + (v[2] - v[0]) * random.uniform(0, 0.5);
  }
};

struct Way {
  glm::dvec3 start, end;
  double radius;
};

// At triangles from near and far, grazing them by as little as arithmetic can tell, also of spheres that start far away, touching them at the start, along axes, and at random.
Way random_way(const SceneData& scene, TestRandom& random, int i) {
  const Target t(scene, random);
  const double radius = t.size * std::ldexp(random.uniform(0.5, 1), random.between(-30, i % 3 == 0 ? 24 : 4));
  const double far = t.size * std::ldexp(random.uniform(0.5, 1), random.between(-2, i % 2 == 0 ? 5 : 40));
  glm::dvec3 d = normalize3(random_point(random, 1), glm::dvec3(1, 0, 0));
  if (i % 5 == 1) d = {0, 0, 0}, d[random.below(3)] = random.below(2) == 0 ? 1 : -1;
  if (i % 5 == 2 || i % 5 == 3) {
    const glm::dvec3 level = normalize3(random.below(2) == 0 ? t.along : cross3(t.normal, d), d);
    const glm::dvec3 center = t.at + t.normal * (radius + (far + radius) * 0x1p-46 * random.uniform(-1, 3));
    return {center - level * far, center + level * (far * random.uniform(0.01, 2)), radius};
  }
  if (i % 5 == 4) return {t.at + t.normal * radius, t.at + t.normal * radius + d * far, radius};
  return {t.at - d * far, t.at + d * (far * random.uniform(-0.1, 2)), radius};
}

// Centers and radii: the radius is often the very distance to a triangle, or the next smaller double.
std::pair<glm::dvec3, double> random_place(const SceneData& scene, TestRandom& random, int i) {
  const Target t(scene, random);
  const double far = t.size * std::ldexp(random.uniform(0.5, 1), random.between(-30, i % 2 == 0 ? 3 : 30));
  glm::dvec3 d = normalize3(random_point(random, 1), glm::dvec3(1, 0, 0));
  if (i % 3 == 1) d = t.normal;
  if (i % 6 == 2) d = {0, 0, 0}, d[random.below(3)] = 1;
  const glm::dvec3 center = i % 9 == 0 ? t.at : t.at + d * far;
  const double distance = nearest_point(triangle_from(scene, t.primitive, center), glm::dvec3(0)).distance;
  if (i % 7 == 0) return {center, distance * random.uniform(0.9, 1.2)};
  return {center, i % 7 == 1 ? std::nextafter(distance, 0.0) : distance};
}

struct Tally {
  int hits = 0, misses = 0, touches = 0;
};

void expect_as_flat(const TestFrame& t, TestRandom& random, int ways, Tally& tally) {
  const Bvh two = build(t, InstanceUse::kAlways), flat = build(t, InstanceUse::kNever);
  for (int i = 0; i < ways; ++i) {
    const Way w = random_way(t.scene, random, i);
    const SphereHit want = sweep_all(t.scene, w.start, w.end, w.radius);
    ASSERT_TRUE(same(want, sweep_sphere(t.scene, flat, w.start, w.end, w.radius))) << "flat, way " << i;
    ASSERT_TRUE(same(want, sweep_sphere(t.scene, two, w.start, w.end, w.radius))) << "two levels, way " << i;
    ++(want.primitive != kNoPrimitive ? tally.hits : tally.misses);
    const auto [center, radius] = random_place(t.scene, random, i);
    const std::vector<SphereHit> touched = touch_all(t.scene, center, radius);
    for (const Bvh* bvh : {&flat, &two}) {
      const std::vector<SphereHit> got = touch_sphere(t.scene, *bvh, center, radius);
      const char* const tree = bvh == &flat ? "flat, place " : "two levels, place ";
      ASSERT_EQ(touched.size(), got.size()) << tree << i;
      for (size_t k = 0; k < got.size(); ++k) ASSERT_TRUE(same(touched[k], got[k])) << tree << i << " triangle " << k;
    }
    tally.touches += !touched.empty();
  }
}

TEST(RaySweepInstance, TurnedScaledAndMirroredPlaces) {
  TestRandom random(81);
  for (int kind = 0; kind < 4; ++kind) {
    const auto t = scattered(random, 6, [&](int i, glm::dvec3& scale, glm::dvec3& offset) {
      offset = random_point(random, 3);
      if (kind == 1) scale = glm::dvec3(i % 3 == 0 ? -1 : 0.7);
      if (kind == 2) scale = {random.uniform(0.3, 1), i % 2 == 0 ? 1.3 : -1.3, random.uniform(0.4, 1.2)};
      if (kind == 3) scale = glm::dvec3(std::ldexp(1.0, random.between(-6, 2)));
    });
    ASSERT_EQ(places(build(*t, InstanceUse::kAlways)), 6u) << kind;
    Tally tally;
    expect_as_flat(*t, random, 1000, tally);
    ASSERT_FALSE(HasFatalFailure()) << kind;
    EXPECT_GT(tally.hits, 300);
    EXPECT_GT(tally.misses, 40);
    EXPECT_GT(tally.touches, 700);
  }
}

// Of sizes from 2^-20 to 2^20, and so far from the origin that vertices lose digits.
TEST(RaySweepInstance, AllSizesAndPlaces) {
  TestRandom random(82);
  size_t used = 0;
  Tally tally;
  for (int n = 0; n < 24; ++n) {
    const double size = std::ldexp(1.0, n < 2 ? (n == 0 ? -20 : 20) : random.between(-20, 20));
    const auto t = scattered(random, 4, [&](int i, glm::dvec3& scale, glm::dvec3& offset) {
      scale = glm::dvec3(size * random.uniform(0.7, 1), size, i % 2 == 0 ? size : -size * 0.8);
      offset = random_point(random, size * std::ldexp(1.0, random.between(0, n < 12 ? 10 : 17)));
    });
    used += places(build(*t, InstanceUse::kAlways));
    expect_as_flat(*t, random, 250, tally);
    ASSERT_FALSE(HasFatalFailure()) << n;
  }
  EXPECT_GT(used, 48u);
  EXPECT_GT(tally.hits, 2000);
  EXPECT_GT(tally.misses, 500);
  EXPECT_GT(tally.touches, 4000);
}

// Along the axes of their parts boxes are as tight as they can be: level floors, grazed from afar or touched by spheres that are much larger, or much smaller,
// than they.
TEST(RaySweepInstance, LevelFloors) {
  TestRandom random(84);
  InstanceScene s;
  std::vector<SoupTriangle> floor;
  for (int i = 0; i < 64; ++i) {
    const glm::dvec3 a(i % 8, 0, i / 8);
    floor.push_back(soup_triangle(a, a + glm::dvec3(0, 0, 1), a + glm::dvec3(1, 0, 0)));
  }
  s.add_part(floor);
  s.add_part(floor);
  for (int i = 0; i < 6; ++i) {
    AffineMap map;
    for (int k = 0; k < 3; ++k) map.linear[k][(k + i) % 3] = std::ldexp(i % 2 == 0 ? 1.0 : -0.7, i), map.offset[k] = random.uniform(-40, 40);
    s.place(1, map);
  }
  const auto t = frame_of_scene(s.build());
  ASSERT_EQ(places(build(*t, InstanceUse::kAlways)), 6u);
  Tally tally;
  expect_as_flat(*t, random, 4000, tally);
  EXPECT_GT(tally.hits, 1500);
  EXPECT_GT(tally.misses, 500);
  EXPECT_GT(tally.touches, 3000);
}

// The same triangles at one place: the lowest id stops the sphere, and all are touched.
TEST(RaySweepInstance, TiesGoToTheLowestId) {
  TestRandom random(83);
  InstanceScene s;
  s.add_part(ball(1));
  s.add_part(ball(1));
  const AffineMap turned = random_map(random, glm::dvec3(1.5), glm::dvec3(0.3, 0, 0));
  for (int i = 0; i < 6; ++i) s.place(1, i % 3 == 0 ? AffineMap() : turned);  // without a map it is where part 0 stands
  const auto t = frame_of_scene(s.build());
  ASSERT_EQ(places(build(*t, InstanceUse::kAlways)), 6u);
  Tally tally;
  expect_as_flat(*t, random, 1500, tally);
  EXPECT_GT(tally.hits, 500);
}

}  // namespace
}  // namespace spanray
