// Closest, any and all against brute force, for whatever tree and instruction set (HARD-CASES Y4, Y5, Y8, Y9, Y10).
#include <gtest/gtest.h>

#include "support/ray_answers.h"

namespace spanray {
namespace {

TEST(RayTrace, Y4_SignedZerosAndOriginsOnSlabs) {
  TestRandom random(21);
  auto t = frame_of(cubes_on_grid(random));
  const Bvh bvh = build_all(*t);
  constexpr int kRays = 6000;
  const RayBatch rays = rays_on_grid(random, kRays);
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
      const Judged want = judge(t->scene, rays, i);
      hits += want.primitive != kNoPrimitive;
      if (want.margin < 1e-14) ++undecidable;
      else ASSERT_EQ(closest[static_cast<size_t>(i)], want.primitive) << "batch " << batch << " ray " << i;
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

// Some rays leave the triangle that they would hit first, some another one, some none; then all of them the same one.
TEST(RayTrace, RaysNeverHitTheTriangleThatTheyLeave) {
  std::vector<SoupTriangle> soup;
  TestRandom random(31);
  add_random_triangles(soup, random, 300, 0.8);
  auto t = frame_of(soup);
  const Bvh bvh = build_all(*t);
  for (const bool coherent : {false, true}) {
    RayBatch rays = coherent ? make_rays(2003) : random_rays(random, 2003);
    if (coherent)
      for (int i = 0; i < rays.count; ++i) set_ray(rays, i, {0, 0, -3}, glm::dvec3(0, 0, 1) + random_point(random, i % 32 < 16 ? 0.01 : 0.3));
    const Answers free = brute_force(*t, rays);
    const uint32_t often = free.closest[static_cast<size_t>(std::find_if(free.closest.begin(), free.closest.end(), [](uint32_t p) { return p != kNoPrimitive; }) - free.closest.begin())];
    for (const bool all_one : {false, true}) {
      rays.from.resize(static_cast<size_t>(rays.count));
      for (size_t i = 0; i < rays.from.size(); ++i)
        rays.from[i] = all_one ? often : i % 3 == 0 ? kNoPrimitive : i % 3 == 1 ? free.closest[i] : static_cast<uint32_t>(i % soup.size());
      const auto another = [&](int i, uint32_t p) { return p != rays.from[static_cast<size_t>(i)]; };
      const Answers want = brute_force(*t, rays, another, another);
      EXPECT_NE(want.closest, free.closest);
      for (const Isa isa : supported_isas()) expect_equal(trace(*t, bvh, rays, isa), want, rays, isa_name(isa));
    }
  }
}

TEST(RayTrace, Y8_CoincidentTrianglesGiveTheLowestId) {
  TestRandom random(25);
  std::vector<SoupTriangle> base;
  add_random_triangles(base, random, CoincidentSoup::kBase, 1);
  for (const int others : {0, 7, 500, 2000}) {
    const CoincidentSoup soup = coincident_soup(base, others, random);
    auto t = frame_of(soup.triangles);
    const Bvh bvh = build_all(*t);
    const RayBatch rays = random_rays(random, 2000);
    for (const Isa isa : supported_isas()) {
      const Answers a = trace(*t, bvh, rays, isa);
      int on_base = 0;
      for (size_t i = 0; i < a.closest.size(); ++i) {
        const uint32_t p = a.closest[i];
        on_base += p < CoincidentSoup::kBase;
        ASSERT_FALSE(soup.is_copy(p)) << "ray " << i << " primitive " << p;
        for (const uint32_t q : a.all[i]) {
          if (q >= CoincidentSoup::kBase) continue;
          ASSERT_TRUE(std::binary_search(a.all[i].begin(), a.all[i].end(), q + CoincidentSoup::kCopies * soup.block)) << "a copy was missed";
        }
      }
      EXPECT_GT(on_base, 250);
    }
  }
}

TEST(RayTrace, Y9_BadRaysMissAndTMaxIsIncluded) {
  auto t = frame_of({bad_ray_target()});
  const Bvh bvh = build_all(*t);
  const std::vector<RayCase> cases = bad_rays();
  const RayBatch rays = batch_of(cases);
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
  const RayBatch rays = rays_from_far(random, kRays);
  for (const Isa isa : supported_isas()) {
    t->frame.isa = isa;
    std::vector<uint32_t> closest(kRays);
    trace_closest(t->frame, bvh, rays, closest.data());
    int hits = 0;
    for (int i = 0; i < kRays; ++i) {
      const Judged want = judge(t->scene, rays, i);
      if (want.margin < 1e-19) continue;  // within 1e-9 of an edge, seen from 1e5 away
      const uint32_t p = closest[static_cast<size_t>(i)];
      ASSERT_EQ(p != kNoPrimitive, want.primitive != kNoPrimitive) << i;
      if (p == kNoPrimitive) continue;
      ++hits;
      const long double t_found = oracle_hit(t->scene, p, ray_origin(rays, i), ray_direction(rays, i)).t;
      EXPECT_LE(std::fabs(t_found - want.t), 4 * 0.0078125L) << i;  // ulp of floats from 65536 on
    }
    EXPECT_GT(hits, kRays * 3 / 4);
  }
}

// A mask that refuses by pixel and primitive, like a screen-door; counts who was asked.
int asked_wrongly = 0;
uint32_t every_third(const Frame& frame, const RayBatch& rays, int first, uint32_t primitive, uint32_t candidates) {
  asked_wrongly += !(flags_of(frame, primitive) & kMaterialMasked);
  return accept_each(rays, first, candidates, [primitive](uint32_t pixel) { return (pixel + primitive) % 3 == 0; });
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
  t->frame.accept_rays = &every_third;
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
