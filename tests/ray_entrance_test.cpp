// Groups of rays that share their way into the tree answer as if each went alone.
#include <gtest/gtest.h>

#include <cmath>

#include "support/ray_answers.h"

namespace spanray {
namespace {

constexpr int kGroup = 256;  // rays of one cell of the picture

// A floor of coplanar triangles, a wall, a round thing, needles and slivers down to edges of 1e-12: sizes that the shaft's margins know and
// that they must leave alone.
std::vector<SoupTriangle> make_room(TestRandom& random, double scale, const glm::dvec3& move) {
  std::vector<SoupTriangle> soup;
  const auto add = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    soup.push_back(soup_triangle(move + a * scale, move + b * scale, move + c * scale));
  };
  const glm::dvec3 dx(0.25, 0, 0), dy(0, 0.25, 0), dz(0, 0, 0.25);
  for (int y = -4; y < 4; ++y)
    for (int x = -4; x < 4; ++x) {
      const glm::dvec3 p(x * 0.25, y * 0.25, 0), q(1, x * 0.25, y * 0.25 + 1);
      add(p, p + dx, p + dx + dy), add(p, p + dx + dy, p + dy);
      add(q, q + dy, q + dy + dz), add(q, q + dy + dz, q + dz);
    }
  add_mesh(soup, make_sphere(2), 0.25 * scale, move + glm::dvec3(0, 0, 0.6) * scale);
  for (int i = 0; i < 60; ++i) {
    const double width = std::pow(10.0, -random.uniform(1, 12));
    const glm::dvec3 p = i % 3 == 0 ? glm::dvec3(0) : random_point(random, 0.8) + glm::dvec3(0, 0, 1), along = random_point(random, 0.7);
    add(p, p + along, p + random_point(random, width));
    add(p, p + random_point(random, width), p + along);
    add(p, p + along, p + along + random_point(random, width));
  }
  return soup;
}

// Where a group starts: on the floor (in its plane, a breath above, below), on the round thing, in the air, all in one place.
glm::dvec3 start_of(int kind, int i, const glm::dvec3& corner, TestRandom& random) {
  const double size = 0.2, height[4] = {0, 3e-8, 1e-5, -3e-8};
  if (kind < 4) return {corner.x + size * (i % 16) / 16, corner.y + size * (i / 16 % 16) / 16, height[kind]};
  const glm::dvec3 p = corner + random_point(random, 0.1);
  if (kind == 4) return glm::dvec3(0, 0, 0.6) + normalize3(p, glm::dvec3(0, 0, 1)) * (0.25 * (1 + 1e-7));
  return kind == 5 ? p + glm::dvec3(0, 0, 0.8) : corner;
}

void expect_groups_as_brute_force(double scale, const glm::dvec3& move, uint32_t seed) {
  TestRandom random(seed);
  auto t = frame_of(make_room(random, scale, move));
  const Bvh bvh = build_all(*t);
  const glm::dvec3 lights[6] = {{0.1, 0.2, 1.9}, {-5, 2, 0}, {-5, 2, 1e-6}, {1, 0.25, 1.25}, {0, 0, 0}, {40, 10, 300}};
  constexpr int kKinds = 7, kLights = 6, kEnds = 4;
  RayBatch rays = make_rays(kKinds * kLights * kEnds * kGroup - 100);  // the last group is short, and ends within a packet
  for (int i = 0; i < rays.count; ++i) {
    const int group = i / kGroup, kind = group % kKinds, light = group / kKinds % kLights, end = group / kKinds / kLights;
    TestRandom of_group(seed + static_cast<uint32_t>(group));
    const glm::dvec3 corner = random_point(of_group, 0.7), o = start_of(kind, i % kGroup, corner, random);
    set_ray(rays, i, move + o * scale, glm::dvec3(0));
    // From the rounded origin, so that an end on a corner of a triangle is one.
    const glm::dvec3 to_light = move + lights[light] * scale - ray_origin(rays, i);
    const float t_max[kEnds] = {1.0f, std::nextafter(1.0f, 0.0f), kInfinity, static_cast<float>(random.uniform(0, 1))};
    set_ray(rays, i, ray_origin(rays, i), end == 2 ? lights[light] - corner : to_light, t_max[end]);
    rays.pixel[static_cast<size_t>(i)] =
        static_cast<uint32_t>(i % 16 + 16 * (group % 64)) | static_cast<uint32_t>(i / 16 % 16 + 16 * (group / 64)) << 16;
  }
  const Answers want = brute_force(*t, rays);
  EXPECT_GT(std::count(want.any.begin(), want.any.end(), true), rays.count / 20);
  EXPECT_GT(std::count(want.any.begin(), want.any.end(), false), rays.count / 20);
  for (const Isa isa : supported_isas()) expect_equal(trace(*t, bvh, rays, isa), want, rays, isa_name(isa));
}

TEST(RayEntrance, GroupsEqualBruteForce) {
  for (uint32_t seed = 1; seed <= 2; ++seed) expect_groups_as_brute_force(1, glm::dvec3(0), seed);
}
TEST(RayEntrance, GroupsEqualBruteForceFarFromZero) {
  expect_groups_as_brute_force(1, glm::dvec3(1000, -300, 20), 5);
  expect_groups_as_brute_force(0.01, glm::dvec3(7, 5, 1000), 6);
}
TEST(RayEntrance, GroupsEqualBruteForceAtEveryScale) {
  for (const int e : {-60, -28, 20, 28}) expect_groups_as_brute_force(std::ldexp(1.0, e), glm::dvec3(0), static_cast<uint32_t>(e + 100));
}

}  // namespace
}  // namespace spanray
