// The tree of Settings::tree "high": the same for any number of threads, complete, cheaper, and what rays find is what they find in the
// fast one.
#include <gtest/gtest.h>

#include <array>

#include "ray/bvh_refit.h"
#include "render/ray_trees.h"
#include "scene/pose.h"
#include "support/moving_scene.h"
#include "support/ray_answers.h"
#include "support/scene_files.h"
#include "support/tree_check.h"

namespace spanray {
namespace {

const std::vector<uint32_t> kNoFlags(16, 0);

Bvh build(const SceneData& scene, TreeQuality quality, int threads = 2, bool whole = false) {
  Parallel parallel(threads);
  return build_bvh(scene, kNoFlags.data(), 0, 0, parallel, quality, whole);
}
bool in_parts(const Bvh& bvh) { return bvh.data().references > bvh.primitive_count(); }
double cost(const Bvh& bvh) { return BvhRefit(bvh, {}).cost(); }

// Small triangles among large ones, and bars across everything.
std::vector<SoupTriangle> mixed_soup(TestRandom& random, int small) {
  std::vector<SoupTriangle> soup;
  add_random_triangles(soup, random, small, 0.03);
  add_random_triangles(soup, random, small / 100, 1);
  for (int i = 0; i < small / 100; ++i) {
    const glm::dvec3 a = random_point(random, 1), b = random_point(random, 1);
    soup.push_back(soup_triangle(a, b, b + random_point(random, 0.02)));
  }
  return soup;
}

TEST(RayHigh, SameTreeForAnyNumberOfThreads) {
  TestRandom random(41);
  const SceneData scene = make_test_scene(mixed_soup(random, 40000));
  for (const bool whole : {false, true}) {
    const Bvh one = build(scene, TreeQuality::kHigh, 1, whole);
    EXPECT_NE(in_parts(one), whole);
    EXPECT_NE(tree_hash(one), tree_hash(build(scene, TreeQuality::kFast, 1)));
    for (const int threads : {2, 7})
      EXPECT_EQ(tree_hash(build(scene, TreeQuality::kHigh, threads, whole)), tree_hash(one)) << threads << " threads";
  }
}

TEST(RayHigh, CompleteAndCheaper) {
  TestRandom random(42);
  for (const int small : {1000, 30000}) {
    const SceneData scene = make_test_scene(mixed_soup(random, small));
    const Bvh fast = build(scene, TreeQuality::kFast), whole = build(scene, TreeQuality::kHigh, 2, true);
    const Bvh parts = build(scene, TreeQuality::kHigh);
    check_complete(scene, whole);
    check_parts(scene, parts);
    EXPECT_TRUE(in_parts(parts));
    EXPECT_LE(parts.data().references, 1.2 * static_cast<double>(scene.triangles.size()));
    EXPECT_LE(cost(whole), (small < 10000 ? 1 : 0.92) * cost(fast));  // of a small tree, the fast one's rounds leave nothing
    EXPECT_LT(cost(parts), 0.96 * cost(whole));
    EXPECT_LT(whole.memory_bytes(), 1.1 * static_cast<double>(fast.memory_bytes()));
  }
}

// Four rounds for the largest nodes: in a room, most of what can be gained. Without them the hall's tree costs 1.24 times that of all rounds.
TEST(RayHigh, TheFastTreeIsNearlyAsCheapInARoom) {
  const Loaded hall = must_load(std::string(SPANRAY_SOURCE_DIR) + "/assets/hall.toml");
  const std::vector<uint32_t> flags(hall.scene().materials.size(), 0);
  Parallel parallel(2);
  const auto cost_of = [&](TreeQuality quality) { return cost(build_bvh(hall.scene(), flags.data(), 0, 0, parallel, quality, true)); };
  EXPECT_LT(cost_of(TreeQuality::kFast), 1.12 * cost_of(TreeQuality::kHigh));
}

TEST(RayHigh, FewTriangles) {
  TestRandom random(43);
  for (int n = 0; n < 40; ++n) {
    std::vector<SoupTriangle> soup;
    add_random_triangles(soup, random, n, 0.5);
    auto t = frame_of(soup);
    const Bvh bvh = build(t->scene, TreeQuality::kHigh);
    check_parts(t->scene, bvh);
    const RayBatch rays = random_rays(random, 500);
    expect_equal(trace(*t, bvh, rays, supported_isas().back()), brute_force(*t, rays), rays, "few");
  }
}

// All the same, nested about one point, without area, ever smaller, as large as floats go: a complete tree all the same, in bounded time.
TEST(RayHigh, DegenerateInput) {
  TestRandom random(44);
  std::vector<std::vector<SoupTriangle>> soups(6);
  for (int i = 0; i < 50000; ++i) {
    soups[0].push_back(soup_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
    const double s = 1 + i * 0.001;
    soups[1].push_back(soup_triangle({-s, -s, 0}, {s, -s, 0}, {0, s, 0}));
  }
  for (int i = 0; i < 5000; ++i) {
    const glm::dvec3 a = random_point(random, 1), b = random_point(random, 1);
    soups[2].push_back(i % 2 == 0 ? soup_triangle(a, a, a) : soup_triangle(a, b, (a + b) * 0.5));
    const double s = std::ldexp(1.0 + (i % 50) * 0.01, -(i / 50) + 40);
    soups[3].push_back(soup_triangle({s, 0, 0}, {s, s, 0}, {s, 0, s}));
    soups[4].push_back(soup_triangle(random_point(random, 3.4e38), random_point(random, 3.4e38), random_point(random, 3.4e38)));
    soups[5].push_back(soup_triangle(random_point(random, 1e-30), random_point(random, 1e-30), random_point(random, 1e-30)));
  }
  for (size_t i = 0; i < soups.size(); ++i) {
    SCOPED_TRACE(i);
    const SceneData scene = make_test_scene(soups[i]);
    const Bvh high = build(scene, TreeQuality::kHigh);
    check_parts(scene, high);
    check_complete(scene, build(scene, TreeQuality::kHigh, 2, true));
    if (i > 3) {
      EXPECT_EQ(tree_hash(high), tree_hash(build(scene, TreeQuality::kFast))) << "areas beyond what float holds";
    }
  }
}

TEST(RayHigh, HitsEqualThoseOfTheFastTree) {
  TestRandom random(45);
  auto t = frame_of(mixed_soup(random, 20000));
  const Bvh fast = build(t->scene, TreeQuality::kFast), high = build(t->scene, TreeQuality::kHigh);
  ASSERT_TRUE(in_parts(high));
  const std::vector<Isa> isas = supported_isas();
  int hits = 0;
  for (int batch = 0; batch < 12; ++batch) {
    const RayBatch rays = random_rays(random, 10000);
    const Answers want = trace(*t, fast, rays, isas.back());
    for (const Isa isa : isas)
      if (batch == 0 || isa == isas.back()) expect_equal(trace(*t, high, rays, isa), want, rays, isa_name(isa));
    hits += static_cast<int>(std::count(want.any.begin(), want.any.end(), true));
  }
  EXPECT_GT(hits, 30000);
}

// Bars across a grid, their corners on it, and rays on it: edges, planes and corners that rays meet exactly.
std::vector<SoupTriangle> bars_on_grid(TestRandom& random) {
  std::vector<SoupTriangle> soup;
  const auto place = [&] { return glm::dvec3(random.between(-6, 6), random.between(-6, 6), random.between(-6, 6)) * 0.5; };
  for (int i = 0; i < 60; ++i) {
    const glm::dvec3 a = place(), b = place();
    const glm::dvec3 c = b + glm::dvec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)) * 0.25;
    soup.push_back(soup_triangle(a, b, c));
    soup.push_back(soup_triangle(a, c, a + (c - b)));
  }
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 a = place() + glm::dvec3(0.125);
    soup.push_back(soup_triangle(a, a + glm::dvec3(0.125, 0, 0), a + glm::dvec3(0, 0.125, 0)));
  }
  return soup;
}

// Awkward rays against brute force: along edges and slabs, among coincident triangles, from far away.
TEST(RayHigh, AwkwardRaysEqualBruteForce) {
  TestRandom random(46);
  const auto check = [&](const std::vector<SoupTriangle>& soup, const RayBatch& rays, const char* what) {
    auto t = frame_of(soup);
    const Bvh bvh = build(t->scene, TreeQuality::kHigh);
    const Answers want = brute_force(*t, rays);
    EXPECT_GT(std::count(want.any.begin(), want.any.end(), true), rays.count / 10) << what;
    for (const Isa isa : supported_isas()) expect_equal(trace(*t, bvh, rays, isa), want, rays, what);
  };
  check(cubes_on_grid(random), rays_on_grid(random, 6000), "grid");
  const std::vector<SoupTriangle> bars = bars_on_grid(random);
  EXPECT_TRUE(in_parts(build(make_test_scene(bars), TreeQuality::kHigh)));
  check(bars, rays_on_grid(random, 20000), "bars");
  std::vector<SoupTriangle> sphere, base;
  add_mesh(sphere, make_sphere(2), 1, glm::dvec3(0));
  check(sphere, rays_from_far(random, 1500), "far");
  add_random_triangles(base, random, CoincidentSoup::kBase, 1);
  check(coincident_soup(base, 500, random).triangles, random_rays(random, 300), "coincident");
}

// A triangle in several leaves is one layer.
TEST(RayHigh, EveryLayerOnce) {
  TestRandom random(47);
  auto t = frame_of(mixed_soup(random, 4000));
  const Bvh fast = build(t->scene, TreeQuality::kFast), high = build(t->scene, TreeQuality::kHigh);
  ASSERT_TRUE(in_parts(high));
  const RayBatch rays = random_rays(random, 20000);
  for (const HitsOnEdges edges : {HitsOnEdges::kOfAll, HitsOnEdges::kOfOne})
    for (const Isa isa : supported_isas()) {
      t->frame.isa = isa;
      const auto layers = [&](const Bvh& bvh) {
        FragmentList list;
        list.pixel.push_back(1), list.ray.push_back(2), list.primitive.push_back(3);  // appended to
        trace_all(t->frame, bvh, rays, edges, list);
        std::vector<std::array<uint32_t, 3>> all;
        for (size_t i = 0; i < list.ray.size(); ++i) all.push_back({list.ray[i], list.primitive[i], list.pixel[i]});
        EXPECT_EQ(all[0], (std::array<uint32_t, 3>{2, 3, 1}));
        std::sort(all.begin() + 1, all.end());
        return all;
      };
      const auto want = layers(fast), got = layers(high);
      EXPECT_GT(want.size(), 10000u);
      EXPECT_TRUE(got == want) << isa_name(isa);
      EXPECT_TRUE(std::adjacent_find(got.begin() + 1, got.end()) == got.end());
    }
}

// A renderer that is asked for the other tree builds it; where something moves, of whole triangles.
TEST(RayHigh, TreesOfAFrameAreOfTheQualityAskedFor) {
  TestRandom random(48);
  const SceneData scene = make_test_scene(mixed_soup(random, 4000));
  Parallel parallel(2);
  Plan plan;
  plan.flags.bvh = true, plan.material_flags = kNoFlags;
  RayTrees trees;
  for (const TreeQuality quality : {TreeQuality::kFast, TreeQuality::kHigh, TreeQuality::kFast}) {
    Settings settings;
    settings.tree = quality;
    trees.update(scene, plan, settings, {}, 0, parallel);
    EXPECT_EQ(tree_hash(*trees.opaque()), tree_hash(build(scene, quality)));
  }
  RayTrees moving;
  Settings high;
  high.tree = TreeQuality::kHigh;
  moving.update(scene, plan, high, {{0, 10, 0}}, 0, parallel);
  EXPECT_EQ(tree_hash(*moving.opaque()), tree_hash(build(scene, TreeQuality::kHigh, 2, true)));
}

TEST(RayHigh, FollowsMotionAndEqualsATreeBuiltAnew) {
  const TempFolder folder;
  const Loaded loaded = must_load(write_moving_scene(folder, 1500));
  Parallel parallel(2);
  PosedScene posed(loaded.scene());
  Bvh bvh = build(loaded.scene(), TreeQuality::kHigh, 2, true);
  const uint64_t built = tree_hash(bvh);
  BvhRefit refit(bvh, loaded.scene().moving_triangles);
  refit.refit(loaded.scene(), bvh, parallel);
  EXPECT_EQ(tree_hash(bvh), built) << "nothing moved";
  for (const double time : {0.9, 3.3, 1000.0}) {
    posed.pose(time, parallel);
    refit.refit(posed.data(), bvh, parallel);
    EXPECT_NE(tree_hash(bvh), built);
    auto t = make_test_frame(SceneData(), Camera(), test_settings(16, 16));
    t->frame.scene = &posed.data(), t->frame.material_flags = kNoFlags.data();
    TestRandom random(3);
    RayBatch rays = make_rays(12000);
    for (int i = 0; i < rays.count; ++i)
      set_ray(rays, i, random_point(random, 3) + glm::dvec3(0, 2, 0), random_point(random, 1));
    const Isa isa = supported_isas().back();
    const Answers want = trace(*t, build(posed.data(), TreeQuality::kFast), rays, isa);
    expect_equal(trace(*t, bvh, rays, isa), want, rays, "refitted");
    expect_equal(trace(*t, build(posed.data(), TreeQuality::kHigh), rays, isa), want, rays, "built anew");
    EXPECT_GT(std::count(want.any.begin(), want.any.end(), true), 2000);
  }
}

}  // namespace
}  // namespace spanray
