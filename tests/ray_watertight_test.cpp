// No ray that starts inside a closed mesh gets out (HARD-CASES Y1, Y2, Y3), flat boxes are hit (Y6).
#include <gtest/gtest.h>

#include "ray/bvh.h"
#include "support/bvh_oracle.h"

namespace spanray {
namespace {

std::unique_ptr<TestFrame> sphere_frame(const IndexedMesh& mesh, double scale, const glm::dvec3& move) {
  std::vector<SoupTriangle> soup;
  add_mesh(soup, mesh, scale, move);
  return make_test_frame(make_test_scene(soup), Camera(), test_settings(16, 16));
}

Bvh build_all(const TestFrame& t) { return build_bvh(t.scene, t.material_flags.data(), 0, 0, *t.parallel); }

enum class Aim { kVertex, kEdge, kInterior };

// Rays from within half a radius of the center; every other one from the very center, so that directions to vertices are exact.
RayBatch rays_inside(const TestFrame& frame, Aim aim, int n, uint32_t seed, double scale, const glm::dvec3& center) {
  TestRandom random(seed);
  RayBatch rays = make_rays(n);
  for (int i = 0; i < n; ++i) {
    const uint32_t p = static_cast<uint32_t>(random.below(static_cast<int>(frame.scene.triangles.size())));
    const int v = random.below(3);
    const glm::dvec3 a = scene_vertex(frame.scene, p, v), b = scene_vertex(frame.scene, p, (v + 1) % 3), c = scene_vertex(frame.scene, p, (v + 2) % 3);
    glm::dvec3 target = a;
    if (aim == Aim::kEdge) target = a + (b - a) * (i % 4 < 2 ? 0.5 : random.uniform());
    if (aim == Aim::kInterior) target = (a + b + c) / 3.0;
    glm::dvec3 origin = i % 2 == 0 ? center : center + random_point(random, 0.28 * scale);
    for (int k = 0; k < 3; ++k) origin[k] = static_cast<float>(origin[k]);
    set_ray(rays, i, origin, target - origin);
  }
  return rays;
}

int count_misses(TestFrame& t, const Bvh& bvh, const RayBatch& rays, Isa isa) {
  t.frame.isa = isa;
  std::vector<uint32_t> closest(static_cast<size_t>(rays.count)), any(static_cast<size_t>(rays.count) / 32 + 1);
  trace_closest(t.frame, bvh, rays, closest.data());
  trace_any(t.frame, bvh, rays, any.data());
  int misses = 0;
  for (int i = 0; i < rays.count; ++i) {
    const size_t r = static_cast<size_t>(i);
    misses += closest[r] == kNoPrimitive || !(any[r / 32] >> (r % 32) & 1);
  }
  return misses;
}

TEST(RayWatertight, Y1_ClosedMeshHasNoLeak) {
  auto t = sphere_frame(make_sphere(4), 1, glm::dvec3(0));
  const Bvh bvh = build_all(*t);
  const std::vector<Isa> isas = supported_isas();
  for (const Isa isa : isas) {
    const int n = isa == isas.back() ? 340000 : 40000;  // a million on the widest
    for (const Aim aim : {Aim::kVertex, Aim::kEdge, Aim::kInterior})
      EXPECT_EQ(count_misses(*t, bvh, rays_inside(*t, aim, n, 11, 1, glm::dvec3(0)), isa), 0) << isa_name(isa) << " aim " << static_cast<int>(aim);
  }
}

TEST(RayWatertight, Y2_PowersOfTwoGiveIdenticalHits) {
  const IndexedMesh mesh = make_sphere(3);
  constexpr int kRays = 3000;
  for (const Isa isa : supported_isas()) {
    std::vector<uint32_t> first;
    for (int e = -20; e <= 20; e += 4) {
      const double scale = std::ldexp(1.0, e);
      auto t = sphere_frame(mesh, scale, glm::dvec3(0));
      t->frame.isa = isa;
      const Bvh bvh = build_all(*t);
      TestRandom random(5);
      RayBatch rays = make_rays(kRays);
      for (int i = 0; i < kRays; ++i) {
        const glm::dvec3 origin = random_point(random, 1.5), direction = random_point(random, 1);
        const bool scaled_direction = i % 2 == 0;  // then t stays, otherwise t scales
        const glm::dvec3 o{glm::vec3(origin)};
        set_ray(rays, i, o * scale, direction * (scaled_direction ? scale : 1.0), static_cast<float>(2 * (scaled_direction ? 1.0 : scale)));
      }
      std::vector<uint32_t> hits(kRays);
      trace_closest(t->frame, bvh, rays, hits.data());
      if (first.empty()) first = hits;
      EXPECT_EQ(hits, first) << isa_name(isa) << " scale 2^" << e;
    }
    EXPECT_GT(std::count_if(first.begin(), first.end(), [](uint32_t p) { return p != kNoPrimitive; }), kRays / 4);
  }
}

TEST(RayWatertight, Y2_DecimalScalesHaveNoLeak) {
  const IndexedMesh mesh = make_sphere(3);
  for (const double scale : {1e-12, 1e-6, 1e-3, 0.1, 3.3, 1e2, 1e5, 1e9, 1e20, 1e30}) {
    auto t = sphere_frame(mesh, scale, glm::dvec3(0));
    const Bvh bvh = build_all(*t);
    for (const Isa isa : supported_isas())
      for (const Aim aim : {Aim::kVertex, Aim::kEdge, Aim::kInterior})
        EXPECT_EQ(count_misses(*t, bvh, rays_inside(*t, aim, 2000, 12, scale, glm::dvec3(0)), isa), 0) << isa_name(isa) << " scale " << scale;
  }
}

TEST(RayWatertight, Y3_MeshesFarAwayHaveNoLeak) {
  const IndexedMesh mesh = make_sphere(3);
  for (const double distance : {1e3, 1e4, 1e5, 1e6}) {
    const glm::dvec3 center = glm::dvec3(glm::vec3(distance, -0.7 * distance, 0.4 * distance));
    auto t = sphere_frame(mesh, 1, center);
    const Bvh bvh = build_all(*t);
    for (const Isa isa : supported_isas())
      for (const Aim aim : {Aim::kVertex, Aim::kEdge, Aim::kInterior})
        EXPECT_EQ(count_misses(*t, bvh, rays_inside(*t, aim, 4000, 13, 1, center), isa), 0) << isa_name(isa) << " distance " << distance;
  }
}

// One axis-aligned quad in each plane: its box has no thickness.
TEST(RayWatertight, Y6_BoxesWithoutThicknessAreHit) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double at : {0.0, 1.0, -3.7, 1e5}) {
      const auto point = [&](double a, double b) {
        glm::dvec3 p;
        p[axis] = at, p[(axis + 1) % 3] = a, p[(axis + 2) % 3] = b;
        return p;
      };
      auto t = make_test_frame(make_test_scene({soup_triangle(point(-1, -1), point(1, -1), point(1, 1)), soup_triangle(point(-1, -1), point(1, 1), point(-1, 1))}),
                               Camera(), test_settings(16, 16));
      const Bvh bvh = build_all(*t);
      constexpr int kRays = 2000;
      TestRandom random(3);
      RayBatch rays = make_rays(kRays);
      for (int i = 0; i < kRays; ++i) {
        const glm::dvec3 target = point(random.uniform(-0.98, 0.98), random.uniform(-0.98, 0.98));
        glm::dvec3 direction = random_point(random, 0.4);
        if (i % 3 == 0) direction = glm::dvec3(0);
        direction[axis] = i % 2 ? 1 : -1;
        if (i == 0) set_ray(rays, i, point(0, 0) - direction, direction);  // along the diagonal
        else set_ray(rays, i, target - direction * 0.01, direction);
      }
      for (const Isa isa : supported_isas()) EXPECT_EQ(count_misses(*t, bvh, rays, isa), 0) << isa_name(isa) << " axis " << axis << " at " << at;
    }
  }
}

}  // namespace
}  // namespace spanray
