// Incoherent rays that go down the tree as sets answer as if each went alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "support/ray_answers.h"

namespace spanray {
namespace {

// Rays from one small place in all directions, as light scatters: large sets at the top of the tree, single rays at its leaves. Streams that are
// full, that lack one ray or get one too many; invalid rays among them; rays that end before what they would hit;
// triangles that coincide, so that of several hits at one t the lowest must be kept whichever is met first.
TEST(RayStream, ScatteredRaysEqualBruteForceInAnyOrder) {
  TestRandom random(41);
  std::vector<SoupTriangle> soup;
  add_mesh(soup, make_sphere(2), 0.6, glm::dvec3(0.2, 0, 0));
  add_random_triangles(soup, random, 600, 0.15);
  add_random_triangles(soup, random, 12, 2);
  const size_t half = soup.size() / 2;
  for (size_t i = 0; i < half; i += 3) soup.push_back(soup[i]);
  auto t = frame_of(soup);
  const Bvh bvh = build_all(*t);
  int ends = 0;
  for (const int n : {1, 2, 17, 63, 64, 65, 500, 1027}) {
    RayBatch rays = make_rays(n), shuffled = make_rays(n);
    const glm::dvec3 center = random_point(random, 0.8);
    for (int i = 0; i < n; ++i) {
      glm::dvec3 d = random_point(random, 1);
      if (i % 29 == 0) d[i % 3] = i % 2 == 0 ? 0.0 : -0.0;
      set_ray(rays, i, center + random_point(random, 0.05), i % 97 == 96 ? glm::dvec3(0) : d, i % 4 == 0 ? static_cast<float>(random.uniform(0, 1)) : kInfinity);
    }
    const Answers free = brute_force(*t, rays);
    for (int i = 3; i < n; i += 8) {  // as far as a corner of what is hit: the hit is nearer or farther
      const uint32_t hit = free.closest[static_cast<size_t>(i)];
      if (hit == kNoPrimitive) continue;
      rays.t_max[static_cast<size_t>(i)] = static_cast<float>(length3(scene_vertex(t->scene, hit, 0) - ray_origin(rays, i)) / length3(ray_direction(rays, i)));
      ++ends;
    }
    int step = n / 2 + 1;
    while (std::gcd(step, n) != 1) ++step;
    const auto place = [&](int i) { return static_cast<int>(static_cast<long>(i) * step % n); };
    for (int i = 0; i < n; ++i) {
      set_ray(shuffled, place(i), ray_origin(rays, i), ray_direction(rays, i), rays.t_max[static_cast<size_t>(i)]);
      shuffled.pixel[static_cast<size_t>(place(i))] = static_cast<uint32_t>(i);
    }
    const Answers want = brute_force(*t, rays);
    for (const Isa isa : supported_isas()) {
      expect_equal(trace(*t, bvh, rays, isa), want, rays, isa_name(isa));
      const Answers other = trace(*t, bvh, shuffled, isa);
      for (int i = 0; i < n; ++i) {
        const size_t a = static_cast<size_t>(i), b = static_cast<size_t>(place(i));
        ASSERT_TRUE(other.closest[b] == want.closest[a] && other.any[b] == want.any[a]) << isa_name(isa) << ", " << n << " rays, ray " << i;
      }
    }
  }
  EXPECT_GT(ends, 100);
}

// A room of few large triangles: rays that end just before or behind a wall, most of whose corners are behind them or beyond their end. Rays
// from the plane of a wall, and from just off it.
TEST(RayStream, RaysThatEndAtLargeTriangles) {
  TestRandom random(44);
  std::vector<SoupTriangle> soup;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      glm::dvec3 c(0), u(0), v(0);
      c[axis] = side, u[(axis + 1) % 3] = 1, v[(axis + 2) % 3] = 1;
      soup.push_back(soup_triangle(c - u - v, c + u - v, c + u + v)), soup.push_back(soup_triangle(c - u - v, c + u + v, c - u + v));
    }
  for (int i = 0; i < 12; ++i) soup.push_back(soup_triangle(random_point(random, 4), random_point(random, 4), random_point(random, 4)));
  auto t = frame_of(soup);
  const Bvh bvh = build_all(*t);
  int ends = 0, stopped = 0, counted = 0;
  for (int batch = 0; batch < 24; ++batch) {
    constexpr int kRays = 512;
    RayBatch rays;
    const glm::dvec3 center = random_point(random, 0.8);
    for (int i = 0; i < kRays; ++i) {
      glm::dvec3 origin = center + random_point(random, 0.1);
      if (i % 6 == 0) origin[i % 3] = i % 12 == 0 ? 1.0 : 1.0 - 1e-6;
      add_ray(rays, origin, random_point(random, 1));
    }
    const Answers free = brute_force(*t, rays);
    for (int i = 0; i < kRays; ++i) {  // where the plane of what is hit is, less or more by a share from 1e-7 to 1e-1
      const uint32_t hit = free.closest[static_cast<size_t>(i)];
      if (hit == kNoPrimitive || i % 8 == 7) continue;
      const glm::dvec3 a = scene_vertex(t->scene, hit, 0);
      const glm::dvec3 n = cross3(scene_vertex(t->scene, hit, 1) - a, scene_vertex(t->scene, hit, 2) - a);
      const double plane = dot3(a - ray_origin(rays, i), n) / dot3(ray_direction(rays, i), n);
      const double off = std::pow(10, -random.uniform(1, 7));
      rays.t_max[static_cast<size_t>(i)] = static_cast<float>(std::max(0.0, plane * (i % 2 == 0 ? 1 - off : 1 + off)));
      ++ends;
    }
    const Answers want = brute_force(*t, rays);
    stopped += static_cast<int>(std::count(want.any.begin(), want.any.end(), true)), counted += kRays;
    for (const Isa isa : supported_isas()) expect_equal(trace(*t, bvh, rays, isa), want, rays, isa_name(isa));
  }
  EXPECT_GT(ends, 8000);
  EXPECT_GT(stopped, counted / 4);
  EXPECT_LT(stopped, counted * 3 / 4);
}

// Boxes without thickness, met at their very edges and corners, and rays along axes and in the planes of boxes: what culls must take all that
// slab() of ray/triangle_test.h takes, by which hit_triangle() decides.
TEST(RayStream, BoxesMetAtTheirEdges) {
  TestRandom random(42);
  std::vector<SoupTriangle> soup;
  for (int i = 0; i < 400; ++i) {  // in planes across an axis
    const glm::dvec3 corner = random_point(random, 1);
    glm::dvec3 u(0), v(0);
    u[(i + 1) % 3] = random.uniform(-0.2, 0.2), v[(i + 2) % 3] = random.uniform(-0.2, 0.2);
    soup.push_back(soup_triangle(corner, corner + u, corner + v));
  }
  auto t = frame_of(soup);
  const Bvh bvh = build_all(*t);
  int hits = 0;
  for (int batch = 0; batch < 40; ++batch) {
    constexpr int kRays = 512;
    RayBatch rays = make_rays(kRays);
    const glm::dvec3 center = random_point(random, 0.9);
    for (int i = 0; i < kRays; ++i) {
      const uint32_t triangle = static_cast<uint32_t>(random.below(400)), corner = static_cast<uint32_t>(i % 3);
      const glm::dvec3 at = scene_vertex(t->scene, triangle, corner), next = scene_vertex(t->scene, triangle, (corner + 1) % 3);
      const glm::dvec3 target = i % 4 == 0 ? at : at + (next - at) * random.uniform(0, 1);
      glm::dvec3 origin = center + random_point(random, 0.05);
      if (i % 5 == 0) origin[i % 3] = target[i % 3];                              // in a plane across an axis
      if (i % 10 == 0) origin[(i + 1) % 3] = target[(i + 1) % 3];                 // along an axis
      if (i % 7 == 0) origin = target - (target - origin) * random.uniform(0, 1e-4);  // close by
      set_ray(rays, i, origin, target - origin, i % 2 == 0 ? kInfinity : 1.0f);
    }
    const Answers want = brute_force(*t, rays);
    hits += static_cast<int>(std::count(want.any.begin(), want.any.end(), true));
    for (const Isa isa : supported_isas()) expect_equal(trace(*t, bvh, rays, isa), want, rays, isa_name(isa));
  }
  EXPECT_GT(hits, 4000);
}

}  // namespace
}  // namespace spanray
