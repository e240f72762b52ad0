// Rays that go down the tree together answer as if each went alone.
#include <gtest/gtest.h>

#include <cmath>

#include "support/ray_answers.h"

namespace spanray {
namespace {

// Neighbours that point into one octant go down the tree together: pencils of rays, wide and narrow, toward a mesh with large and small
// triangles, some along an axis, some that end early, some invalid, in batches that do not fill the last packet.
TEST(RayPacket, CoherentBatchesEqualBruteForceInAnyOrder) {
  std::vector<SoupTriangle> soup;
  TestRandom random(28);
  std::vector<Material> materials(2);
  materials[1].transparency = static_cast<int32_t>(MaterialTransparency::kMask);
  materials[1].opacity = 0.5f;  // what is wholly opaque has nothing to ask accept(hit)
  add_mesh(soup, make_sphere(2), 0.5, glm::dvec3(0.3, 0, 0), 1);
  add_random_triangles(soup, random, 400, 0.2);
  add_random_triangles(soup, random, 10, 2);
  auto t = frame_of(soup, materials);
  t->frame.accept_rays = accept_every_other;
  const auto mask = [&](const RayBatch& rays) {
    return [&](int i, uint32_t p) { return material_of(t->scene.triangles[p]) == 0 || (rays.pixel[static_cast<size_t>(i)] + p) % 2 == 0; };
  };
  const Bvh bvh = build_all(*t);
  for (const double spread : {0.0, 0.01, 0.3}) {
    const int n = 1003;
    RayBatch rays = make_rays(n), shuffled = make_rays(n);
    glm::dvec3 origin(0), direction(0);
    for (int i = 0; i < n; ++i) {
      if (i % 48 == 0) origin = random_point(random, 1.5), direction = i % 96 == 0 ? -origin : glm::dvec3(0, 0.0, i % 192 == 48 ? 1 : -1);
      const bool on_axis = i % 96 >= 48;
      glm::dvec3 d = direction + random_point(random, spread);
      if (on_axis) d.x = 0, d.y = -0.0;
      const glm::dvec3 o = origin + random_point(random, spread * 0.3);
      set_ray(rays, i, o, i == 500 ? glm::dvec3(0) : d, i % 5 == 0 ? static_cast<float>(random.uniform(0, 2)) : kInfinity);
      const int j = i * 500 % n;
      set_ray(shuffled, j, ray_origin(rays, i), ray_direction(rays, i), rays.t_max[static_cast<size_t>(i)]);
      shuffled.pixel[static_cast<size_t>(j)] = static_cast<uint32_t>(i);
    }
    const Answers want = brute_force(*t, rays, mask(rays), mask(rays));
    EXPECT_GT(std::count(want.any.begin(), want.any.end(), true), n / 3);
    for (const Isa isa : supported_isas()) {
      expect_equal(trace(*t, bvh, rays, isa), want, rays, isa_name(isa));
      const Answers other = trace(*t, bvh, shuffled, isa);
      for (int i = 0; i < n; ++i) {
        const size_t a = static_cast<size_t>(i), b = static_cast<size_t>(i * 500 % n);
        ASSERT_TRUE(other.closest[b] == want.closest[a] && other.any[b] == want.any[a] && other.all[b] == want.all[a]) << isa_name(isa) << " ray " << i;
      }
    }
  }
}

// Where a hit is certain without the exact test and where it is not lies at the edges of triangles, at the origin and at the end of the ray:
// parallel and slightly turned rays through corners, edges and inner points of a grid of triangles and of its copies a little behind,
// that end at the hit exactly, one step of a float before or after it, or start at it.
TEST(RayPacket, EndsEdgesAndOriginsAreExactForEveryLane) {
  std::vector<SoupTriangle> soup;
  for (int layer = 0; layer < 3; ++layer)
    for (int y = -4; y < 4; ++y)
      for (int x = -4; x < 4; ++x) {
        const glm::dvec3 p(x, y, 2 + layer * 0x1p-20), dx(1, 0, 0), dy(0, 1, 0);
        soup.push_back(soup_triangle(p, p + dx, p + dx + dy));
        soup.push_back(soup_triangle(p, p + dx + dy, p + dy));
      }
  auto t = frame_of(soup);
  const Bvh bvh = build_all(*t);
  constexpr int kRays = 4800;
  RayBatch rays = make_rays(kRays);
  TestRandom random(29);
  for (int i = 0; i < kRays; ++i) {
    const int block = i / 16, kind = block % 5, axis_kind = block / 5 % 3;
    const glm::dvec3 at(block % 7 - 3 + (i % 4) * 0.25, block % 6 - 3 + (i / 4 % 4) * 0.25, 2 + i % 3 * 0x1p-20);
    glm::dvec3 d(0, 0, 1);
    if (axis_kind == 1) d.x = (i % 4 - 1) * 0x1p-22, d.y = -0.0;
    if (axis_kind == 2) d = glm::dvec3(0.25, -0.125, 1);
    const float whole = kind == 4 ? kInfinity : 1.0f;
    float t_max = whole;
    if (kind == 1) t_max = std::nextafter(1.0f, 0.0f);
    if (kind == 2) t_max = std::nextafter(1.0f, 2.0f);
    if (kind == 3) t_max = static_cast<float>(random.uniform(0.5, 1.5));
    set_ray(rays, i, kind == 4 ? at : at - d, d, t_max);
  }
  const Answers want = brute_force(*t, rays);
  EXPECT_GT(std::count(want.any.begin(), want.any.end(), true), kRays / 4);
  EXPECT_GT(std::count(want.any.begin(), want.any.end(), false), kRays / 10);
  for (const Isa isa : supported_isas()) expect_equal(trace(*t, bvh, rays, isa), want, rays, isa_name(isa));
}

}  // namespace
}  // namespace spanray
