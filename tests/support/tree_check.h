// What every tree promises: all of its triangles, once, inside its boxes.
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

// Walks the tree: boxes inside boxes, every triangle inside its leaf's box and in exactly one leaf. Returns the depth.
inline int check_tree(const SceneData& scene, const Bvh& bvh, std::vector<int>& seen) {
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
        ++seen[block.primitive[i]];
        for (int v = 0; v < 3; ++v)
          for (int k = 0; k < 3; ++k) {
            const float p = block.vertex[v][k][i];
            EXPECT_EQ(p, scene.vertices[scene.triangles[block.primitive[i]].vertex[v]].position[k]);
            EXPECT_TRUE(p >= child.lo[k] && p <= child.hi[k]);
          }
      }
    }
  }
  EXPECT_EQ(depth, data.depth);
  EXPECT_LE(depth, kBvhMaxDepth);
  return depth;
}

inline int check_complete(const SceneData& scene, const Bvh& bvh) {
  std::vector<int> seen(scene.triangles.size());
  const int depth = check_tree(scene, bvh, seen);
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
  EXPECT_EQ(bvh.primitive_count(), scene.triangles.size());
  return depth;
}

}  // namespace spanray
