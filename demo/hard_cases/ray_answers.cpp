// What the tree answers against what brute force does (Y4, Y5, Y8, Y9), and trees of awkward meshes (Y14).
#include <algorithm>
#include <cmath>

#include "cases.h"
#include "ray/bvh_data.h"
#include "ray_cases.h"

namespace spanray::hard {
namespace {

std::unique_ptr<TestFrame> frame_of(const std::vector<SoupTriangle>& soup) {
  return make_test_frame(make_test_scene(soup), Camera(), test_settings(16, 16));
}

// "Closest" and "any" of every ray must be what `want` says (kNoPrimitive: a miss).
void check_answers(TestFrame& t, const Bvh& bvh, const RayBatch& rays, const std::vector<uint32_t>& want, Isa isa, Tally& tally) {
  t.frame.isa = isa;
  std::vector<uint32_t> closest(want.size()), any(want.size() / 32 + 1);
  trace_closest(t.frame, bvh, rays, closest.data());
  trace_any(t.frame, bvh, rays, any.data());
  for (size_t i = 0; i < want.size(); ++i)
    tally.check(closest[i] == want[i] && ((any[i / 32] >> (i % 32) & 1) != 0) == (want[i] != kNoPrimitive),
                [&] { return "ray " + std::to_string(i) + " on " + std::string(isa_name(isa)); });
}

std::vector<uint32_t> brute_force(const TestFrame& t, const RayBatch& rays) {
  std::vector<uint32_t> closest(static_cast<size_t>(rays.count));
  for (int i = 0; i < rays.count; ++i) closest[static_cast<size_t>(i)] = brute_force_closest(t.scene, rays, i);
  return closest;
}

uint64_t count_of_hits(const std::vector<uint32_t>& closest) {
  return static_cast<uint64_t>(std::count_if(closest.begin(), closest.end(), [](uint32_t p) { return p != kNoPrimitive; }));
}

RayBatch random_rays(TestRandom& random, int n) {
  RayBatch rays = make_rays(n);
  for (int i = 0; i < n; ++i) {
    const float t_max = i % 3 == 0 ? static_cast<float>(random.uniform(0, 3)) : kInfinity;
    const glm::dvec3 origin = random_point(random, 1.5);
    set_ray(rays, i, origin, random_point(random, 1) - (i % 2 != 0 ? origin : glm::dvec3(0)), t_max);
  }
  return rays;
}

}  // namespace

// Unit cubes on an integer grid, rays on the grid and along its axes: all ties and all zeros that there are.
Finding y4_zeros(const Effort& effort) {
  std::vector<SoupTriangle> soup;
  TestRandom random(21);
  for (int i = 0; i < 40; ++i) {
    glm::dvec3 p;
    for (int k = 0; k < 3; ++k) p[k] = random.between(-3, 2);
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
  const int count = effort.count(60000, 6000);
  RayBatch rays = make_rays(count);
  constexpr double kSteps[] = {0.0, -0.0, 1, -1, 2, -2, 0.0, -0.0, 0.5, 1e-40, -1e-40, 1e-30};
  for (int i = 0; i < count; ++i) {
    glm::dvec3 o, d;
    for (int k = 0; k < 3; ++k) o[k] = random.between(-8, 8) * 0.5, d[k] = kSteps[random.below(12)];
    set_ray(rays, i, o, d, i % 2 != 0 ? kInfinity : static_cast<float>(random.between(0, 4)));
  }
  const std::vector<uint32_t> want = brute_force(*t, rays);
  Tally answers;
  for (const Isa isa : supported_isas()) check_answers(*t, bvh, rays, want, isa, answers);
  if (count_of_hits(want) < static_cast<uint64_t>(count) / 5) answers.check(false, [] { return std::string("hardly a ray hit"); });
  return none_wrong(answers, "rays", 6000);
}

// Against the engine's own triangle test over all triangles; and, of some rays, against an independent test in extended
// precision, where that can tell inside from outside.
Finding y5_brute_force(const Effort& effort) {
  std::vector<SoupTriangle> soup;
  TestRandom random(22);
  add_mesh(soup, make_sphere(0), 0.8, glm::dvec3(0.1, 0, 0));
  add_random_triangles(soup, random, 40, 0.7);
  auto t = frame_of(soup);
  const Bvh bvh = build_all(*t);
  Tally answers;
  uint64_t hits = 0, judged = 0;
  for (int batch = 0; batch < effort.count(100, 10); ++batch) {
    const RayBatch rays = random_rays(random, 10000);
    const std::vector<uint32_t> want = brute_force(*t, rays);
    hits += count_of_hits(want);
    for (const Isa isa : supported_isas())
      if (batch % 10 == 0 || isa == supported_isas().back()) check_answers(*t, bvh, rays, want, isa, answers);
    for (int i = batch % 10; i < rays.count; i += 40) {
      const glm::dvec3 o = ray_origin(rays, i), d = ray_direction(rays, i);
      uint32_t nearest = kNoPrimitive;
      long double best = rays.t_max[static_cast<size_t>(i)], margin = 1;
      for (uint32_t p = 0; p < t->scene.triangles.size(); ++p) {
        const RayOracleHit h = oracle_hit(t->scene, p, o, d);
        margin = std::min(margin, h.margin);
        if (h.hit && h.t <= best) best = h.t, nearest = p;
      }
      if (margin < 1e-14L) continue;
      ++judged;
      answers.check(nearest == want[static_cast<size_t>(i)], [&] { return std::string("the triangle test itself"); });
    }
  }
  return none_wrong(answers, "rays", 100000, grouped(hits) + " hits, " + grouped(judged) + " judged by an independent test, too");
}

// The same 60 triangles thirteen times, corners rotated and mirrored, among others that change the tree: never a copy.
Finding y8_coincident(const Effort& effort) {
  TestRandom random(25);
  std::vector<SoupTriangle> base;
  add_random_triangles(base, random, 60, 1);
  Tally answers;
  uint64_t on_base = 0;
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
    const RayBatch rays = random_rays(random, effort.count(20000, 2000));
    std::vector<uint32_t> closest(static_cast<size_t>(rays.count));
    for (const Isa isa : supported_isas()) {
      t->frame.isa = isa;
      trace_closest(t->frame, bvh, rays, closest.data());
      for (const uint32_t p : closest) {
        on_base += p < 60;
        answers.check(p == kNoPrimitive || p < 60 || (p - 60) % block < block - 60);
      }
    }
  }
  if (on_base < 1000) answers.check(false, [] { return std::string("hardly a ray hit the coincident triangles"); });
  return none_wrong(answers, "rays", 8000, grouped(on_base) + " hit coincident triangles");
}

Finding y9_bad_rays(const Effort&) {
  auto t = frame_of({soup_triangle({-1, -1, 2}, {3, -1, 2}, {-1, 3, 2})});
  const Bvh bvh = build_all(*t);
  const double nan = std::nan(""), inf = kInfinity;
  const glm::dvec3 z(0, 0, 1);
  struct Case { glm::dvec3 origin, direction; float t_max; bool hit; };
  const std::vector<Case> cases = {
      // A hit at exactly t_max counts.
      {{0, 0, 0}, z, kInfinity, true},
      {{0, 0, 0}, z, 2.0f, true},
      {{0, 0, 0}, z, std::nextafter(2.0f, 0.0f), false},
      {{0, 0, 0}, z * 8.0, 0.25f, true},
      {{0, 0, 0}, z * 8.0, std::nextafter(0.25f, 0.0f), false},
      {{0.2, 0.1, 0}, z * 3.0, 2.0f / 3 * 1.0000001f, true},
      // Directions and origins that are no numbers, zero, infinite.
      {{0, 0, 0}, {0, 0, 0}, kInfinity, false},
      {{0, 0, 0}, {-0.0, 0, -0.0}, kInfinity, false},
      {{0, 0, 0}, {nan, 0, 1}, kInfinity, false},
      {{0, 0, 0}, {0, nan, nan}, kInfinity, false},
      {{0, 0, 0}, {0, 0, inf}, kInfinity, false},
      {{0, 0, 0}, {-inf, 0, 1}, kInfinity, false},
      {{nan, 0, 0}, z, kInfinity, false},
      {{0, inf, 0}, z, kInfinity, false},
      {{0, 0, -inf}, z, kInfinity, false},
      {{0, 0, 0}, z, static_cast<float>(nan), false},
      {{0, 0, 0}, z, -1.0f, false},
      {{0, 0, 0}, z, 0.0f, false},
      // t = 0 is not in front.
      {{0, 0, 0}, -z, kInfinity, false},
      {{0, 0, 2}, z, kInfinity, false},
      {{0, 0, 2}, -z, kInfinity, false},
      // Denormal and huge directions are directions.
      {{0, 0, 0}, {0, 0, 1e-45}, kInfinity, true},
      {{0, 0, 0}, {0, 0, 3e38}, kInfinity, true},
      {{0, 0, -3e38}, {0, 0, 3e38}, kInfinity, true},
      {{0, 0, 0}, {1e-45, 1e-45, 1e-45}, kInfinity, false},
      {{0.2, 0.2, 0}, {1e-45, 1e-45, 3e-39}, kInfinity, true},
  };
  RayBatch rays = make_rays(static_cast<int>(cases.size()));
  std::vector<uint32_t> want;
  for (size_t i = 0; i < cases.size(); ++i) {
    set_ray(rays, static_cast<int>(i), cases[i].origin, cases[i].direction, cases[i].t_max);
    want.push_back(cases[i].hit ? 0u : kNoPrimitive);
  }
  Tally answers;
  for (const Isa isa : supported_isas()) check_answers(*t, bvh, rays, want, isa, answers);
  return none_wrong(answers, "rays", 26, "a hit at exactly t_max counts");
}

// Depth of the tree of 1e5 triangles with one centroid: the same triangle, and nested ones; of sizes that halve; and no triangle at all.
Finding y14_equal_centroids(const Effort& effort) {
  std::vector<SoupTriangle> same, nested, series;
  for (int i = 0; i < effort.count(100000, 20000); ++i) {
    same.push_back(soup_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
    const double s = 1 + i * 0.001;
    nested.push_back(soup_triangle({-s, -s, 0}, {s, -s, 0}, {0, s, 0}));
  }
  for (int i = 0; i < 12000; ++i) {
    const double s = std::ldexp(1.0 + (i % 50) * 0.01, -(i / 50) + 120);
    series.push_back(soup_triangle({s, 0, 0}, {s, s, 0}, {s, 0, s}));
  }
  Worst depth;
  RayBatch rays = make_rays(1);
  set_ray(rays, 0, {0.2, 0.2, 1}, {0, 0, -1});
  for (const auto* soup : {&same, &nested}) {
    auto t = frame_of(*soup);
    const Bvh bvh = build_all(*t);
    depth.add(bvh.data().depth);
    Tally answers;
    for (const Isa isa : supported_isas()) check_answers(*t, bvh, rays, {0}, isa, answers);
    if (answers.wrong() > 0 || bvh.primitive_count() != soup->size()) depth.add(INFINITY);
  }
  auto t = frame_of(series);
  depth.add(build_all(*t).data().depth);
  auto none = frame_of({});
  const Bvh empty = build_all(*none);
  Tally answers;
  for (const Isa isa : supported_isas()) check_answers(*none, empty, rays, {kNoPrimitive}, isa, answers);
  if (answers.wrong() > 0 || empty.primitive_count() != 0) depth.add(INFINITY);
  return within(depth, kBvhMaxDepth, "nodes deep", "trees", 3, "the empty mesh misses");
}

}  // namespace spanray::hard
