// Layers count once, also where a ray runs exactly through an edge or a corner that triangles share.
#include <gtest/gtest.h>

#include <cmath>

#include "support/ray_answers.h"

namespace spanray {
namespace {

// Hits of each ray.
std::vector<int> count_hits(TestFrame& t, const Bvh& bvh, const RayBatch& rays, HitsOnEdges edges, Isa isa) {
  t.frame.isa = isa;
  FragmentList list;
  trace_all(t.frame, bvh, rays, edges, list);
  std::vector<int> counts(static_cast<size_t>(rays.count), 0);
  for (const uint32_t ray : list.ray) ++counts[ray];
  return counts;
}

// A level of 8 x 8 squares, each of two triangles with the diagonal either way, seen through every corner, edge and diagonal.
TEST(RayEdges, AFlatSurfaceIsOneLayer) {
  for (int tilt = 0; tilt < 3; ++tilt) {
    std::vector<SoupTriangle> soup;
    const auto at = [&](int x, int y) {
      const glm::dvec3 p(x, y, tilt == 0 ? 0 : 0.25 * x - 0.5 * y);
      return tilt == 2 ? glm::dvec3(p.z, p.x, p.y) : p;
    };
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) {
        const bool turned = (x * 3 + y) % 2 == 0;
        const glm::dvec3 a = at(x, y), b = at(x + 1, y), c = at(x + 1, y + 1), d = at(x, y + 1);
        soup.push_back(turned ? soup_triangle(a, b, c) : soup_triangle(b, c, d));
        soup.push_back(turned ? soup_triangle(a, c, d) : soup_triangle(a, b, d));
      }
    auto t = frame_of(soup);
    const Bvh bvh = build_all(*t);
    TestRandom random(30);
    constexpr int kRays = 3000;
    RayBatch rays = make_rays(kRays);
    for (int i = 0; i < kRays; ++i) {
      // Quarters of a square: corners, edges and diagonals are among them; never the border.
      const double x = random.between(1, 31) * 0.25, y = random.between(1, 31) * 0.25;
      const glm::dvec3 p(x, y, tilt == 0 ? 0 : 0.25 * x - 0.5 * y), target = tilt == 2 ? glm::dvec3(p.z, p.x, p.y) : p;
      glm::dvec3 d(random.between(-3, 3) * 0.5, random.between(-3, 3) * 0.25, i % 2 == 0 ? -8 : 8);
      if (tilt == 2) d = {d.z, d.x, d.y};
      set_ray(rays, i, target - d, d);
    }
    for (const Isa isa : supported_isas()) {
      const std::vector<int> once = count_hits(*t, bvh, rays, HitsOnEdges::kOfOne, isa);
      for (int i = 0; i < kRays; ++i) ASSERT_EQ(once[static_cast<size_t>(i)], 1) << isa_name(isa) << " tilt " << tilt << " ray " << i;
      const std::vector<int> all = count_hits(*t, bvh, rays, HitsOnEdges::kOfAll, isa);
      EXPECT_GT(std::count_if(all.begin(), all.end(), [](int n) { return n > 1; }), kRays / 4) << "too few rays meet an edge to prove anything";
      EXPECT_EQ(std::count(all.begin(), all.end(), 0), 0);
    }
  }
}

// From within a closed mesh, through its corners and the middles of its edges: out, once.
TEST(RayEdges, AClosedMeshIsLeftOnce) {
  std::vector<SoupTriangle> soup;
  add_mesh(soup, make_sphere(3), 1, glm::dvec3(0));
  auto t = frame_of(soup);
  const Bvh bvh = build_all(*t);
  const int triangles = static_cast<int>(t->scene.triangles.size());
  RayBatch rays = make_rays(6 * triangles);
  for (int i = 0; i < rays.count; ++i) {
    const uint32_t p = static_cast<uint32_t>(i / 6);
    const glm::dvec3 a = scene_vertex(t->scene, p, i % 3), b = scene_vertex(t->scene, p, (i + 1) % 3);
    set_ray(rays, i, glm::dvec3(0), i % 6 < 3 ? a : (a + b) * 0.5);
  }
  for (const Isa isa : supported_isas()) {
    const std::vector<int> once = count_hits(*t, bvh, rays, HitsOnEdges::kOfOne, isa);
    for (size_t i = 0; i < once.size(); ++i) ASSERT_EQ(once[i], 1) << isa_name(isa) << " ray " << i;
    const std::vector<int> all = count_hits(*t, bvh, rays, HitsOnEdges::kOfAll, isa);
    EXPECT_GT(std::count_if(all.begin(), all.end(), [](int n) { return n > 3; }), triangles) << "of the corners";
  }
}

}  // namespace
}  // namespace spanray
