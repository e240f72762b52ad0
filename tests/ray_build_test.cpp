// The tree: the same for any number of threads, complete, of bounded depth (HARD-CASES Y14).
#include <gtest/gtest.h>

#include "support/bvh_oracle.h"
#include "support/tree_check.h"

namespace spanray {
namespace {

const std::vector<uint32_t> kNoFlags = {0};

TEST(RayBuild, SameTreeForAnyNumberOfThreads) {
  TestRandom random(1);
  std::vector<SoupTriangle> soup;
  add_random_triangles(soup, random, 40000, 0.02);
  add_random_triangles(soup, random, 100, 2);
  const SceneData scene = make_test_scene(soup);
  uint64_t first = 0;
  for (const int threads : {1, 2, 7}) {
    Parallel parallel(threads);
    const Bvh bvh = build_bvh(scene, kNoFlags.data(), 0, 0, parallel);
    if (threads == 1) {
      first = tree_hash(bvh);
      EXPECT_LT(check_complete(scene, bvh), 20);
      EXPECT_GT(bvh.memory_bytes(), scene.triangles.size() * 36);
      EXPECT_LT(bvh.memory_bytes(), scene.triangles.size() * 200);
    }
    EXPECT_EQ(tree_hash(bvh), first) << threads << " threads";
  }
}

TEST(RayBuild, FiltersByMaterialFlags) {
  TestRandom random(2);
  std::vector<SoupTriangle> soup;
  for (uint32_t m = 0; m < 4; ++m) add_random_triangles(soup, random, 50, 0.3, m);
  const SceneData scene = make_test_scene(soup, std::vector<Material>(4));
  const std::vector<uint32_t> flags = {0, kMaterialMasked, kMaterialTranslucent, kMaterialMasked | kMaterialTranslucent};
  Parallel parallel(1);
  std::vector<int> seen(200);
  for (const uint32_t value : {0u, +kMaterialTranslucent}) {
    const Bvh bvh = build_bvh(scene, flags.data(), kMaterialTranslucent, value, parallel);
    EXPECT_EQ(bvh.primitive_count(), 100u);
    std::vector<int> here(200);
    check_tree(scene, bvh, here);
    for (size_t p = 0; p < 200; ++p) {
      EXPECT_EQ(here[p], (flags[material_of(scene.triangles[p])] & kMaterialTranslucent) == value);
      seen[p] += here[p];
    }
  }
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
}

TEST(RayBuild, Y14_EqualCentroidsGiveBoundedDepth) {
  std::vector<SoupTriangle> same, nested;
  for (int i = 0; i < 100000; ++i) {
    same.push_back(soup_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
    // The box is symmetric about the origin: one centroid, many sizes.
    const double s = 1 + i * 0.001;
    nested.push_back(soup_triangle({-s, -s, 0}, {s, -s, 0}, {0, s, 0}));
  }
  Parallel parallel(2);
  for (const auto& soup : {same, nested}) {
    const SceneData scene = make_test_scene(soup);
    const Bvh bvh = build_bvh(scene, kNoFlags.data(), 0, 0, parallel);
    EXPECT_LE(check_complete(scene, bvh), 14);
    auto t = make_test_frame(make_test_scene(soup), Camera(), test_settings(16, 16));
    RayBatch rays = make_rays(1);
    set_ray(rays, 0, {0.2, 0.2, 1}, {0, 0, -1});
    for (const Isa isa : supported_isas()) {
      t->frame.isa = isa;
      uint32_t hit = 7;
      trace_closest(t->frame, bvh, rays, &hit);
      EXPECT_EQ(hit, 0u) << isa_name(isa);
    }
  }
}

// Sizes that shrink by halves defeat bins: each split takes a few triangles off.
TEST(RayBuild, Y14_GeometricSeriesGivesBoundedDepth) {
  std::vector<SoupTriangle> soup;
  for (int i = 0; i < 12000; ++i) {
    const double s = std::ldexp(1.0 + (i % 50) * 0.01, -(i / 50) + 120);
    soup.push_back(soup_triangle({s, 0, 0}, {s, s, 0}, {s, 0, s}));
  }
  const SceneData scene = make_test_scene(soup);
  Parallel parallel(2);
  const Bvh bvh = build_bvh(scene, kNoFlags.data(), 0, 0, parallel);
  check_complete(scene, bvh);
}

TEST(RayBuild, HugeCoordinatesGiveACompleteTree) {
  TestRandom random(4);
  std::vector<SoupTriangle> soup;
  for (int i = 0; i < 9000; ++i) soup.push_back(soup_triangle(random_point(random, 3.4e38), random_point(random, 3.4e38), random_point(random, 3.4e38)));
  const SceneData scene = make_test_scene(soup);
  Parallel parallel(2);
  EXPECT_LT(check_complete(scene, build_bvh(scene, kNoFlags.data(), 0, 0, parallel)), 20);
}

TEST(RayBuild, Y14_EmptyMeshMisses) {
  auto t = make_test_frame(make_test_scene({}), Camera(), test_settings(16, 16));
  const Bvh built = build_bvh(t->scene, t->material_flags.data(), 0, 0, *t->parallel);
  const Bvh untouched;
  RayBatch rays = make_rays(40);
  for (int i = 0; i < 40; ++i) set_ray(rays, i, {0, 0, 0}, {0, 0, -1});
  for (const Bvh* bvh : {&built, &untouched}) {
    EXPECT_EQ(bvh->primitive_count(), 0u);
    EXPECT_EQ(bvh->memory_bytes(), 0u);
    for (const Isa isa : supported_isas()) {
      t->frame.isa = isa;
      uint32_t closest[40], any[2] = {~0u, ~0u};
      FragmentList all;
      trace_closest(t->frame, *bvh, rays, closest);
      trace_any(t->frame, *bvh, rays, any);
      trace_all(t->frame, *bvh, rays, HitsOnEdges::kOfAll, all);
      EXPECT_TRUE(std::all_of(closest, closest + 40, [](uint32_t p) { return p == kNoPrimitive; }));
      EXPECT_EQ(any[0] | any[1], 0u);
      EXPECT_TRUE(all.primitive.empty());
    }
  }
}

}  // namespace
}  // namespace spanray
