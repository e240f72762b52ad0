// What every tree promises: all of its triangles, once, inside its boxes; or in parts, each part inside a box.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/hash.h"
#include "ray/bvh_data.h"
#include "support/bvh_oracle.h"

namespace spanray {

inline uint64_t tree_hash(const Bvh& bvh) {
  Hash hash;
  for (const BvhNode& n : bvh.data().nodes) hash.add(n.bounds, sizeof n.bounds).add(n.child, sizeof n.child);
  for (const TriangleBlock& b : bvh.data().blocks) hash.add(b.vertex, sizeof b.vertex).add(b.primitive, sizeof b.primitive);
  return hash.value();
}

struct LeafBox { float lo[3], hi[3]; };

// Walks the tree: boxes inside boxes, vertices and ids of every triangle. leaf(primitive, box): is called for each that stands in a leaf.
// Returns the depth.
template <class Leaf> int walk_tree(const SceneData& scene, const Bvh& bvh, const Leaf& leaf) {
  struct Entry { uint32_t node; int depth; float lo[3], hi[3]; };
  const Bvh::Data& data = bvh.data();
  if (data.nodes.empty()) return 0;
  std::vector<Entry> stack = {{0, 1, {-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}}};
  int depth = 0;
  while (!stack.empty()) {
    const Entry e = stack.back();
    stack.pop_back();
    depth = std::max(depth, e.depth);
    const BvhNode& node = data.nodes[e.node];
    for (int c = 0; c < kBvhWidth; ++c) {
      Entry child{node.child[c], e.depth + 1, {}, {}};
      for (int k = 0; k < 3; ++k) child.lo[k] = node.bounds[k][c], child.hi[k] = node.bounds[k + 3][c];
      if (!(child.lo[0] <= child.hi[0])) continue;
      for (int k = 0; k < 3; ++k) EXPECT_TRUE(child.lo[k] >= e.lo[k] && child.hi[k] <= e.hi[k]);
      if (!(node.child[c] & kLeafBit)) {
        stack.push_back(child);
        continue;
      }
      const TriangleBlock& block = data.blocks[leaf_block(node.child[c])];
      for (uint32_t i = 0; i < leaf_triangles(node.child[c]); ++i) {
        LeafBox box;
        for (int k = 0; k < 3; ++k) box.lo[k] = child.lo[k], box.hi[k] = child.hi[k];
        leaf(block.primitive[i], box);
        for (int v = 0; v < 3; ++v)
          for (int k = 0; k < 3; ++k)
            EXPECT_EQ(block.vertex[v][k][i], scene.vertices[scene.triangles[block.primitive[i]].vertex[v]].position[k]);
      }
    }
  }
  EXPECT_EQ(depth, data.depth);
  EXPECT_LE(depth, kBvhMaxDepth);
  return depth;
}

// Every triangle that is seen stands in exactly one leaf, wholly inside its box.
inline int check_tree(const SceneData& scene, const Bvh& bvh, std::vector<int>& seen) {
  EXPECT_EQ(bvh.data().references, bvh.data().primitives);
  return walk_tree(scene, bvh, [&](uint32_t primitive, const LeafBox& box) {
    ++seen[primitive];
    for (const uint32_t v : scene.triangles[primitive].vertex)
      for (int k = 0; k < 3; ++k) {
        const float p = scene.vertices[v].position[k];
        EXPECT_TRUE(p >= box.lo[k] && p <= box.hi[k]);
      }
  });
}

// Points of every triangle, and points beside it by up to what kPartMargin leaves for rounding: each is inside a box that has the triangle.
inline void check_parts(const SceneData& scene, const Bvh& bvh) {
  std::vector<std::vector<LeafBox>> boxes(scene.triangles.size());
  walk_tree(scene, bvh, [&](uint32_t primitive, const LeafBox& box) { boxes[primitive].push_back(box); });
  size_t references = 0;
  TestRandom random(7);
  for (uint32_t p = 0; p < boxes.size(); ++p) {
    references += boxes[p].size();
    ASSERT_FALSE(boxes[p].empty()) << p;
    glm::dvec3 corner[3];
    for (int v = 0; v < 3; ++v) corner[v] = scene_vertex(scene, p, v);
    double extent = 0;
    for (int k = 0; k < 3; ++k)
      extent = std::max(extent, std::max({corner[0][k], corner[1][k], corner[2][k]}) - std::min({corner[0][k], corner[1][k], corner[2][k]}));
    for (int i = 0; i < 64; ++i) {
      double b[3] = {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
      if (i < 3) b[i] = 1e9;  // a corner
      else if (i % 3 == 0) b[i / 3 % 3] = 0;  // on an edge
      const glm::dvec3 on = (corner[0] * b[0] + corner[1] * b[1] + corner[2] * b[2]) / (b[0] + b[1] + b[2]);
      const glm::dvec3 point = boxes[p].size() > 1 ? on + random_point(random, 0.9 * kPartMargin * extent) : on;
      const double slack = boxes[p].size() > 1 ? 0 : 1e-6 * extent + 1e-12 * length3(on);  // `on` is rounded
      EXPECT_TRUE(std::any_of(boxes[p].begin(), boxes[p].end(), [&](const LeafBox& box) {
        for (int k = 0; k < 3; ++k)
          if (point[k] < box.lo[k] - slack || point[k] > box.hi[k] + slack) return false;
        return true;
      })) << "triangle " << p << " of " << boxes[p].size() << " parts";
    }
  }
  EXPECT_EQ(references, bvh.data().references);
  EXPECT_EQ(bvh.primitive_count(), scene.triangles.size());
}

inline int check_complete(const SceneData& scene, const Bvh& bvh) {
  std::vector<int> seen(scene.triangles.size());
  const int depth = check_tree(scene, bvh, seen);
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
  EXPECT_EQ(bvh.primitive_count(), scene.triangles.size());
  return depth;
}

}  // namespace spanray
