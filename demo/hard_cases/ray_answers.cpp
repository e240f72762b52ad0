// What the tree answers against what brute force does (Y4, Y5, Y8, Y9), and trees of awkward meshes (Y14).
#include <algorithm>
#include <cmath>

#include "cases.h"
#include "ray/bvh_data.h"
#include "ray_cases.h"
#include "support/awkward_rays.h"

namespace spanray::hard {
namespace {

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

}  // namespace

// All ties and all zeros that there are.
Finding y4_zeros(const Effort& effort) {
  TestRandom random(21);
  auto t = frame_of(cubes_on_grid(random));
  const Bvh bvh = build_all(*t);
  const int count = effort.count(60000, 6000);
  const RayBatch rays = rays_on_grid(random, count);
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
      const Judged nearest = judge(t->scene, rays, i);
      if (nearest.margin < 1e-14L) continue;
      ++judged;
      answers.check(nearest.primitive == want[static_cast<size_t>(i)], [&] { return std::string("the triangle test itself"); });
    }
  }
  return none_wrong(answers, "rays", 100000, grouped(hits) + " hits, " + grouped(judged) + " judged by an independent test, too");
}

// Of coincident triangles the first, never a copy.
Finding y8_coincident(const Effort& effort) {
  TestRandom random(25);
  std::vector<SoupTriangle> base;
  add_random_triangles(base, random, CoincidentSoup::kBase, 1);
  Tally answers;
  uint64_t on_base = 0;
  for (const int others : {0, 7, 500, 2000}) {
    const CoincidentSoup soup = coincident_soup(base, others, random);
    auto t = frame_of(soup.triangles);
    const Bvh bvh = build_all(*t);
    const RayBatch rays = random_rays(random, effort.count(20000, 2000));
    std::vector<uint32_t> closest(static_cast<size_t>(rays.count));
    for (const Isa isa : supported_isas()) {
      t->frame.isa = isa;
      trace_closest(t->frame, bvh, rays, closest.data());
      for (const uint32_t p : closest) {
        on_base += p < CoincidentSoup::kBase;
        answers.check(!soup.is_copy(p));
      }
    }
  }
  if (on_base < 1000) answers.check(false, [] { return std::string("hardly a ray hit the coincident triangles"); });
  return none_wrong(answers, "rays", 8000, grouped(on_base) + " hit coincident triangles");
}

Finding y9_bad_rays(const Effort&) {
  auto t = frame_of({bad_ray_target()});
  const Bvh bvh = build_all(*t);
  const std::vector<RayCase> cases = bad_rays();
  const RayBatch rays = batch_of(cases);
  std::vector<uint32_t> want;
  for (const RayCase& c : cases) want.push_back(c.hit ? 0u : kNoPrimitive);
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
