// Trees that follow moving triangles: the bytes of the boxes, what rays find, what it costs.
#include <gtest/gtest.h>

#include "ray/bvh_refit.h"
#include "scene/pose.h"
#include "support/moving_scene.h"
#include "support/ray_answers.h"
#include "support/scene_files.h"
#include "support/tree_check.h"

namespace spanray {
namespace {

const std::vector<uint32_t> kNoFlags(16, 0);

Loaded moving_scene(int spikes) {
  const TempFolder folder;
  return must_load(write_moving_scene(folder, spikes));
}

TEST(RayRefit, WithoutMotionTheBytesStay) {
  const Loaded loaded = moving_scene(3000);
  Parallel parallel(2);
  Bvh bvh = build_bvh(loaded.scene(), kNoFlags.data(), 0, 0, parallel);
  const uint64_t built = tree_hash(bvh);
  BvhRefit refit(bvh, loaded.scene().moving_triangles);
  const double cost = refit.cost();
  EXPECT_GT(cost, 0);
  refit.refit(loaded.scene(), bvh, parallel);
  EXPECT_EQ(tree_hash(bvh), built);
  EXPECT_DOUBLE_EQ(refit.cost(), cost);
}

TEST(RayRefit, TheSameBytesForAnyThreadsAndAnyPast) {
  const Loaded loaded = moving_scene(3000);
  uint64_t first = 0;
  double first_cost = 0;
  for (const int threads : {1, 2, 7})
    for (const bool detour : {false, true}) {
      Parallel parallel(threads);
      PosedScene posed(loaded.scene());
      Bvh bvh = build_bvh(loaded.scene(), kNoFlags.data(), 0, 0, parallel);
      const uint64_t built = tree_hash(bvh);
      BvhRefit refit(bvh, loaded.scene().moving_triangles);
      for (const double t : {-3.0, 0.7, 90.0}) {
        if (!detour) break;
        EXPECT_TRUE(posed.pose(t, parallel));
        refit.refit(posed.data(), bvh, parallel);
      }
      posed.pose(1.25, parallel);
      refit.refit(posed.data(), bvh, parallel);
      EXPECT_NE(tree_hash(bvh), built);
      if (first == 0) first = tree_hash(bvh), first_cost = refit.cost();
      EXPECT_EQ(tree_hash(bvh), first) << threads << " threads, detour " << detour;
      EXPECT_EQ(refit.cost(), first_cost);
      check_complete(posed.data(), bvh);
      // Nothing that an observer of the whole tree would count otherwise.
      EXPECT_NEAR(BvhRefit(bvh, loaded.scene().moving_triangles).cost() / first_cost, 1, 1e-12);
    }
}

// Boxes are the smallest possible: those that hold all triangles below, bit for bit.
TEST(RayRefit, BoxesAreTight) {
  const Loaded loaded = moving_scene(500);
  Parallel parallel(1);
  PosedScene posed(loaded.scene());
  Bvh bvh = build_bvh(loaded.scene(), kNoFlags.data(), 0, 0, parallel);
  BvhRefit refit(bvh, loaded.scene().moving_triangles);
  posed.pose(2.5, parallel);
  refit.refit(posed.data(), bvh, parallel);
  const Bvh::Data& data = bvh.data();
  std::vector<std::array<float, 6>> whole(data.nodes.size());
  for (size_t n = data.nodes.size(); n-- > 0;) {
    whole[n] = {kInfinity, kInfinity, kInfinity, -kInfinity, -kInfinity, -kInfinity};
    for (int c = 0; c < kBvhWidth; ++c) {
      const BvhNode& node = data.nodes[n];
      if (!(node.bounds[0][c] <= node.bounds[3][c])) continue;
      std::array<float, 6> box = {kInfinity, kInfinity, kInfinity, -kInfinity, -kInfinity, -kInfinity};
      if (node.child[c] & kLeafBit) {
        const TriangleBlock& block = data.blocks[leaf_block(node.child[c])];
        for (uint32_t i = 0; i < leaf_triangles(node.child[c]); ++i)
          for (const uint32_t v : posed.data().triangles[block.primitive[i]].vertex)
            for (size_t k = 0; k < 3; ++k) {
              const float p = posed.data().vertices[v].position[k];
              box[k] = std::min(box[k], p), box[k + 3] = std::max(box[k + 3], p);
            }
      } else {
        box = whole[node.child[c]];
      }
      for (size_t k = 0; k < 6; ++k) EXPECT_EQ(node.bounds[k][c], box[k]);
      for (size_t k = 0; k < 3; ++k) whole[n][k] = std::min(whole[n][k], box[k]), whole[n][k + 3] = std::max(whole[n][k + 3], box[k + 3]);
    }
  }
  for (size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(data.bounds_min[k], whole[0][k]);
    EXPECT_EQ(data.bounds_max[k], whole[0][k + 3]);
  }
}

TEST(RayRefit, RaysFindWhatTheyFindInANewTree) {
  const Loaded loaded = moving_scene(300);
  Parallel parallel(2);
  PosedScene posed(loaded.scene());
  Bvh bvh = build_bvh(loaded.scene(), kNoFlags.data(), 0, 0, parallel);
  BvhRefit refit(bvh, loaded.scene().moving_triangles);
  for (const double time : {0.9, 3.3, 1000.0}) {
    posed.pose(time, parallel);
    refit.refit(posed.data(), bvh, parallel);
    const Scene still = scene_at(loaded.loaded.scene, time);
    const Bvh fresh = build_bvh(still.data(), kNoFlags.data(), 0, 0, parallel);
    auto t = make_test_frame(SceneData(), Camera(), test_settings(16, 16));
    t->frame.scene = &still.data(), t->frame.material_flags = kNoFlags.data();
    TestRandom random(3);
    RayBatch rays = make_rays(2000);
    for (int i = 0; i < rays.count; ++i) set_ray(rays, i, random_point(random, 3) + glm::dvec3(0, 2, 0), random_point(random, 1));
    for (const Isa isa : supported_isas()) {
      const Answers want = trace(*t, fresh, rays, isa);
      expect_equal(trace(*t, bvh, rays, isa), want, rays, isa_name(isa));
      EXPECT_GT(std::count_if(want.closest.begin(), want.closest.end(), [](uint32_t p) { return p != kNoPrimitive; }), 300);
    }
  }
}

TEST(RayRefit, CostGrowsWhereATreeNoLongerFits) {
  // Two heaps of small triangles in one tree; half of each flies to the other's place.
  TestRandom random(5);
  SceneData scene;
  scene.materials.emplace_back(), scene.material_names.emplace_back("m");
  Motion motion;
  motion.keys = {{0, {0, 0, 0}, {0, 1, 0}, 0}, {1, {50, 0, 0}, {0, 1, 0}, 0}};
  scene.motions.push_back(motion);
  std::vector<SoupTriangle> soup;
  for (int i = 0; i < 4000; ++i) {
    const glm::dvec3 c = random_point(random, 1);
    soup.push_back(soup_triangle(c, c + random_point(random, 0.05), c + random_point(random, 0.05)));
    soup.back().motion = static_cast<uint32_t>(i % 2);
  }
  ASSERT_TRUE(build_geometry(soup, scene));
  Parallel parallel(2);
  Bvh bvh = build_bvh(scene, kNoFlags.data(), 0, 0, parallel);
  BvhRefit refit(bvh, scene.moving_triangles);
  PosedScene posed(scene);
  const double cost = refit.cost();
  posed.pose(1, parallel);
  refit.refit(posed.data(), bvh, parallel);
  EXPECT_GT(refit.cost(), 10 * cost);
  EXPECT_LT(BvhRefit(build_bvh(posed.data(), kNoFlags.data(), 0, 0, parallel), scene.moving_triangles).cost(), 10 * cost);
  posed.pose(0, parallel);
  refit.refit(posed.data(), bvh, parallel);
  EXPECT_DOUBLE_EQ(refit.cost(), cost);
}

}  // namespace
}  // namespace spanray
