// Closest, any and all against brute force, for whatever tree and instruction set (HARD-CASES Y4, Y5, Y8, Y9, Y10).
#include <gtest/gtest.h>

#include "support/ray_answers.h"

namespace spanray {
namespace {

// Unit cubes on an integer grid, rays on the grid and along its axes: all ties and all zeros that there are.
TEST(RayTrace, Y4_SignedZerosAndOriginsOnSlabs) {
  std::vector<SoupTriangle> soup;
  TestRandom random(21);
  for (int i = 0; i < 40; ++i) {
    const glm::dvec3 p(random.between(-3, 2), random.between(-3, 2), random.between(-3, 2));
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        glm::dvec3 a(0), b(0), n(0);
        a[(axis + 1) % 3] = 1, b[(axis + 2) % 3] = 1, n[axis] = side;
        soup.push_back(soup_triangle(p + n, p + n + a, p + n + a + b));
        soup.push_back(soup_triangle(p + n, p + n + a + b, p + n + b));
      }
  }
  auto t = frame_of(soup);
  const Bvh bvh = build_all(*t);
  constexpr int kRays = 6000;
  RayBatch rays = make_rays(kRays);
  constexpr double kSteps[] = {0.0, -0.0, 1, -1, 2, -2, 0.0, -0.0, 0.5, 1e-40, -1e-40, 1e-30};
  for (int i = 0; i < kRays; ++i) {
    glm::dvec3 o, d;
    for (int k = 0; k < 3; ++k) o[k] = random.between(-8, 8) * 0.5, d[k] = kSteps[random.below(12)];
    set_ray(rays, i, o, d, i % 2 ? kInfinity : static_cast<float>(random.between(0, 4)));
  }
  const Answers want = brute_force(*t, rays);
  EXPECT_GT(std::count(want.any.begin(), want.any.end(), true), kRays / 5);
  for (const Isa isa : supported_isas()) expect_equal(trace(*t, bvh, rays, isa), want, rays, isa_name(isa));
}

// A million rays for the closest hit on the widest instruction set, some of them for every answer on all.
TEST(RayTrace, Y5_RandomRaysEqualBruteForce) {
  std::vector<SoupTriangle> soup;
  TestRandom random(22);
  add_mesh(soup, make_sphere(0), 0.8, glm::dvec3(0.1, 0, 0));
  add_random_triangles(soup, random, 40, 0.7);
  auto t = frame_of(soup);
  const Bvh bvh = build_all(*t);
  const std::vector<Isa> isas = supported_isas();
  int hits = 0;
  for (int batch = 0; batch < 50; ++batch) {
    constexpr int kRays = 20000;
    const RayBatch rays = random_rays(random, kRays);
    std::vector<uint32_t> closest(kRays);
    t->frame.isa = isas.back();
    trace_closest(t->frame, bvh, rays, closest.data());
    for (int i = 0; i < kRays; ++i) ASSERT_EQ(closest[static_cast<size_t>(i)], brute_force_closest(t->scene, rays, i)) << "batch " << batch << " ray " << i;
    hits += static_cast<int>(std::count_if(closest.begin(), closest.end(), [](uint32_t p) { return p != kNoPrimitive; }));
    if (batch % 25 != 0) continue;
    const Answers want = brute_force(*t, rays);
    for (const Isa isa : isas) expect_equal(trace(*t, bvh, rays, isa), want, rays, isa_name(isa));
  }
  EXPECT_GT(hits, 300000);
}

// What brute force with the engine's own test cannot show: that the test itself is right.
TEST(RayTrace, Y5_RandomRaysEqualTheIndependentOracle) {
  std::vector<SoupTriangle> soup;
  TestRandom random(23);
  add_mesh(soup, make_sphere(0), 0.8, glm::dvec3(0.1, 0, 0));
  add_random_triangles(soup, random, 20, 0.6);
  auto t = frame_of(soup);
  const Bvh bvh = build_all(*t);
  int hits = 0, undecidable = 0;
  for (int batch = 0; batch < 3; ++batch) {
    constexpr int kRays = 20000;
    const RayBatch rays = random_rays(random, kRays);
    std::vector<uint32_t> closest(kRays);
    t->frame.isa = supported_isas().back();
    trace_closest(t->frame, bvh, rays, closest.data());
    for (int i = 0; i < kRays; ++i) {
      const glm::dvec3 o = ray_origin(rays, i), d = ray_direction(rays, i);
      uint32_t want = kNoPrimitive;
      long double best = rays.t_max[static_cast<size_t>(i)], margin = 1;
      for (uint32_t p = 0; p < t->scene.triangles.size(); ++p) {
        const RayOracleHit h = oracle_hit(t->scene, p, o, d);
        margin = std::min(margin, h.margin);
        if (h.hit && h.t <= best) best = h.t, want = p;
      }
      hits += want != kNoPrimitive;
      if (margin < 1e-14) ++undecidable;
      else ASSERT_EQ(closest[static_cast<size_t>(i)], want) << "batch " << batch << " ray " << i;
    }
  }
  EXPECT_GT(hits, 12000);
  EXPECT_LT(undecidable, 20);
}

TEST(RayTrace, ClosestAnyAndAllAgreeOnEveryInstructionSet) {
  std::vector<SoupTriangle> soup;
  TestRandom random(24);
  add_mesh(soup, make_sphere(3), 0.5, glm::dvec3(0.3, 0, 0));
  add_random_triangles(soup, random, 20000, 0.05);
  add_random_triangles(soup, random, 20, 2);
  auto t = frame_of(soup);
  const Bvh bvh = build_all(*t);
  const RayBatch rays = random_rays(random, 20000);
  Answers first;
  for (const Isa isa : supported_isas()) {
    const Answers a = trace(*t, bvh, rays, isa);
    if (first.closest.empty()) first = a;
    expect_equal(a, first, rays, isa_name(isa));
    for (size_t i = 0; i < a.closest.size(); ++i) {
      ASSERT_EQ(a.any[i], a.closest[i] != kNoPrimitive);
      ASSERT_EQ(a.any[i], !a.all[i].empty());
      ASSERT_TRUE(!a.any[i] || std::binary_search(a.all[i].begin(), a.all[i].end(), a.closest[i]));
      ASSERT_TRUE(std::adjacent_find(a.all[i].begin(), a.all[i].end()) == a.all[i].end()) << "a primitive twice";
    }
  }
  EXPECT_GT(std::count(first.any.begin(), first.any.end(), true), 5000);
  for (int i = 0; i < rays.count; i += 100) ASSERT_EQ(first.closest[static_cast<size_t>(i)], brute_force_closest(t->scene, rays, i)) << i;
}

// The same 60 triangles thirteen times (more than a leaf holds), corners rotated and mirrored, among others that change the tree.
TEST(RayTrace, Y8_CoincidentTrianglesGiveTheLowestId) {
  TestRandom random(25);
  std::vector<SoupTriangle> base;
  add_random_triangles(base, random, 60, 1);
  for (const int others : {0, 7, 500, 2000}) {
    std::vector<SoupTriangle> soup = base;
    for (int copy = 1; copy <= 12; ++copy) {
      add_random_triangles(soup, random, others, 0.02);
      for (SoupTriangle triangle : base) {
        std::rotate(triangle.corner, triangle.corner + copy % 3, triangle.corner + 3);
        if (copy % 2 == 0) std::swap(triangle.corner[0], triangle.corner[1]);
        soup.push_back(triangle);
      }
    }
    auto t = frame_of(soup);
    const Bvh bvh = build_all(*t);
    const uint32_t block = static_cast<uint32_t>(others + 60);  // others, then a copy of the base, from 60 on
    const RayBatch rays = random_rays(random, 2000);
    for (const Isa isa : supported_isas()) {
      const Answers a = trace(*t, bvh, rays, isa);
      int on_base = 0;
      for (size_t i = 0; i < a.closest.size(); ++i) {
        const uint32_t p = a.closest[i];
        on_base += p < 60;
        ASSERT_FALSE(p != kNoPrimitive && p >= 60 && (p - 60) % block >= block - 60) << "ray " << i << " primitive " << p;
        for (const uint32_t q : a.all[i]) {
          if (q >= 60) continue;
          ASSERT_TRUE(std::binary_search(a.all[i].begin(), a.all[i].end(), q + 12 * block)) << "a copy was missed";
        }
      }
      EXPECT_GT(on_base, 250);
    }
  }
}

TEST(RayTrace, Y9_BadRaysMissAndTMaxIsIncluded) {
  auto t = frame_of({soup_triangle({-1, -1, 2}, {3, -1, 2}, {-1, 3, 2})});
  const Bvh bvh = build_all(*t);
  const double nan = std::nan(""), inf = kInfinity;
  const glm::dvec3 z(0, 0, 1);
  struct Case { glm::dvec3 origin, direction; float t_max; bool hit; };
  const std::vector<Case> cases = {
      {{0, 0, 0}, z, kInfinity, true}, {{0, 0, 0}, z, 2.0f, true}, {{0, 0, 0}, z, std::nextafter(2.0f, 0.0f), false},
      {{0, 0, 0}, z * 8.0, 0.25f, true}, {{0, 0, 0}, z * 8.0, std::nextafter(0.25f, 0.0f), false},
      {{0.2, 0.1, 0}, z * 3.0, 2.0f / 3 * 1.0000001f, true},
      {{0, 0, 0}, {0, 0, 0}, kInfinity, false}, {{0, 0, 0}, {-0.0, 0, -0.0}, kInfinity, false},
      {{0, 0, 0}, {nan, 0, 1}, kInfinity, false}, {{0, 0, 0}, {0, nan, nan}, kInfinity, false}, {{0, 0, 0}, {0, 0, inf}, kInfinity, false},
      {{0, 0, 0}, {-inf, 0, 1}, kInfinity, false}, {{nan, 0, 0}, z, kInfinity, false}, {{0, inf, 0}, z, kInfinity, false}, {{0, 0, -inf}, z, kInfinity, false},
      {{0, 0, 0}, z, static_cast<float>(nan), false}, {{0, 0, 0}, z, -1.0f, false}, {{0, 0, 0}, z, 0.0f, false},
      {{0, 0, 0}, -z, kInfinity, false}, {{0, 0, 2}, z, kInfinity, false}, {{0, 0, 2}, -z, kInfinity, false},  // t = 0 is not in front
      {{0, 0, 0}, {0, 0, 1e-45}, kInfinity, true}, {{0, 0, 0}, {0, 0, 3e38}, kInfinity, true}, {{0, 0, -3e38}, {0, 0, 3e38}, kInfinity, true},
      {{0, 0, 0}, {1e-45, 1e-45, 1e-45}, kInfinity, false}, {{0.2, 0.2, 0}, {1e-45, 1e-45, 3e-39}, kInfinity, true},
  };
  RayBatch rays = make_rays(static_cast<int>(cases.size()));
  for (size_t i = 0; i < cases.size(); ++i) set_ray(rays, static_cast<int>(i), cases[i].origin, cases[i].direction, cases[i].t_max);
  for (const Isa isa : supported_isas()) {
    const Answers a = trace(*t, bvh, rays, isa);
    for (size_t i = 0; i < cases.size(); ++i) {
      EXPECT_EQ(a.closest[i], cases[i].hit ? 0u : kNoPrimitive) << isa_name(isa) << " case " << i;
      EXPECT_EQ(a.any[i], cases[i].hit) << isa_name(isa) << " case " << i;
      EXPECT_EQ(a.all[i].size(), cases[i].hit ? 1u : 0u) << isa_name(isa) << " case " << i;
    }
  }
}

TEST(RayTrace, Y10_UnitSphereFromFarAway) {
  std::vector<SoupTriangle> soup;
  add_mesh(soup, make_sphere(2), 1, glm::dvec3(0));
  auto t = frame_of(soup);
  const Bvh bvh = build_all(*t);
  constexpr int kRays = 1500;
  TestRandom random(26);
  RayBatch rays = make_rays(kRays);
  for (int i = 0; i < kRays; ++i) {
    const glm::dvec3 origin = normalize3(random_point(random, 1), glm::dvec3(1, 0, 0)) * 1e5;
    set_ray(rays, i, origin, normalize3(random_point(random, 0.6) - origin, glm::dvec3(1, 0, 0)));
  }
  for (const Isa isa : supported_isas()) {
    t->frame.isa = isa;
    std::vector<uint32_t> closest(kRays);
    trace_closest(t->frame, bvh, rays, closest.data());
    int hits = 0;
    for (int i = 0; i < kRays; ++i) {
      const glm::dvec3 o = ray_origin(rays, i), d = ray_direction(rays, i);
      long double best = kInfinity, margin = 1;
      for (uint32_t p = 0; p < t->scene.triangles.size(); ++p) {
        const RayOracleHit h = oracle_hit(t->scene, p, o, d);
        margin = std::min(margin, h.margin);
        if (h.hit) best = std::min(best, h.t);
      }
      if (margin < 1e-19) continue;  // within 1e-9 of an edge, seen from 1e5 away
      const uint32_t p = closest[static_cast<size_t>(i)];
      ASSERT_EQ(p != kNoPrimitive, best < kInfinity) << i;
      if (p == kNoPrimitive) continue;
      ++hits;
      EXPECT_LE(std::fabs(oracle_hit(t->scene, p, o, d).t - best), 4 * 0.0078125L) << i;  // ulp of floats from 65536 on
    }
    EXPECT_GT(hits, kRays * 3 / 4);
  }
}

// A mask that refuses by pixel and primitive, like a screen-door; counts who was asked.
int asked_wrongly = 0;
bool every_third(const Frame& frame, const RayBatch& rays, int ray, uint32_t primitive) {
  asked_wrongly += !(flags_of(frame, primitive) & kMaterialMasked);
  return (rays.pixel[static_cast<size_t>(ray)] + primitive) % 3 == 0;
}

TEST(RayTrace, MasksAndCullingFilterHits) {
  TestRandom random(27);
  std::vector<Material> materials(2);
  materials[1].transparency = static_cast<int32_t>(MaterialTransparency::kMask);
  materials[1].opacity = 0.5f;  // what is wholly opaque has nothing to ask accept(hit)
  std::vector<SoupTriangle> soup;
  add_random_triangles(soup, random, 100, 0.8, 0);
  add_random_triangles(soup, random, 200, 0.8, 1);
  auto t = frame_of(soup, materials);
  t->frame.accept_ray = &every_third;
  const Bvh bvh = build_all(*t);
  const RayBatch rays = random_rays(random, 5000);
  const auto mask = [&](int i, uint32_t p) { return material_of(t->scene.triangles[p]) == 0 || (rays.pixel[static_cast<size_t>(i)] + p) % 3 == 0; };
  const auto front = [&](int i, uint32_t p) { return facing(t->scene, t->scene.triangles[p], ray_origin(rays, i)) > 0; };
  for (const Culling culling : {Culling::kNone, Culling::kBack}) {
    t->frame.settings.culling = culling;
    const Answers want = brute_force(*t, rays, mask, [&](int i, uint32_t p) { return mask(i, p) && (culling == Culling::kNone || front(i, p)); });
    for (const Isa isa : supported_isas()) expect_equal(trace(*t, bvh, rays, isa), want, rays, isa_name(isa));
  }
  EXPECT_EQ(asked_wrongly, 0);
}

}  // namespace
}  // namespace spanray
