#include "ray/bvh_refit.h"

#include <algorithm>
#include <functional>

#include "ray/bvh_data.h"
#include "ray/bvh_instances.h"
#include "ray/bvh_parts.h"

namespace spanray {
namespace {

using bvh::Box;

constexpr size_t kLeavesInTask = 256, kNodesInTask = 128;

void for_chunks(size_t count, size_t chunk, Parallel& parallel, const std::function<void(size_t begin, size_t end)>& body) {
  parallel.for_each((count + chunk - 1) / chunk, [&](size_t c, int) { body(c * chunk, std::min(count, (c + 1) * chunk)); });
}

bool used(const BvhNode& node, int slot) { return node.bounds[0][slot] <= node.bounds[3][slot]; }

Box slot_box(const BvhNode& node, int slot) {
  const auto row = [&](int k) { return node.bounds[k][slot]; };
  return {bvh::F4{row(0), row(1), row(2), 0}, bvh::F4{row(3), row(4), row(5), 0}};
}

Box node_box(const BvhNode& node) {
  Box box = Box::empty();
  for (int c = 0; c < kBvhWidth; ++c)
    if (used(node, c)) box.add(slot_box(node, c));
  return box;
}

Box block_box(const TriangleBlock& block, uint32_t triangles) {
  Box box = Box::empty();
  for (uint32_t i = 0; i < triangles; ++i)
    for (const auto& v : block.vertex) box.add(Box::of(bvh::F4{v[0][i], v[1][i], v[2][i], 0}));
  return box;
}

// In double: no overflow.
double node_cost(const BvhNode& node) {
  double sum = 0;
  for (int c = 0; c < kBvhWidth; ++c) {
    if (!used(node, c)) continue;
    double size[3];
    for (int k = 0; k < 3; ++k) size[k] = static_cast<double>(node.bounds[k + 3][c]) - static_cast<double>(node.bounds[k][c]);
    sum += size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
  }
  return sum;
}

void refit_leaf(const SceneData& scene, TriangleBlock& block, uint32_t triangles) {
  for (uint32_t i = 0; i < triangles; ++i) {
    const Triangle& t = scene.triangles[block.primitive[i]];
    for (int v = 0; v < 3; ++v)
      for (int k = 0; k < 3; ++k) block.vertex[v][k][i] = scene.vertices[t.vertex[v]].position[k];
  }
}

void refit_slot(const Bvh::Data& data, BvhNode& node, int slot) {
  const uint32_t child = node.child[slot];
  const Box box = (child & kLeafBit) ? block_box(data.blocks[leaf_block(child)], leaf_triangles(child)) : node_box(data.nodes[child]);
  for (int k = 0; k < 3; ++k) node.bounds[k][slot] = box.lo[k], node.bounds[k + 3][slot] = box.hi[k];
}

}  // namespace

size_t BvhRefit::memory_bytes() const {
  size_t bytes = leaves_.capacity() * sizeof(MovingLeaf);
  for (const auto& level : levels_) bytes += level.capacity() * sizeof(MovingNode);
  return bytes;
}

BvhRefit::BvhRefit(const Bvh& bvh, const std::vector<MovingRun>& moving) {
  const Bvh::Data& data = bvh.data();
  const auto moves = [&](uint32_t primitive) {
    const auto after = std::upper_bound(moving.begin(), moving.end(), primitive,
                                        [](uint32_t p, const MovingRun& run) { return p < run.first; });
    return after != moving.begin() && primitive < (after - 1)->first + (after - 1)->count;
  };
  // Height of a node above its lowest moving leaf, 0: nothing moves in it. The builder puts parents before their children.
  std::vector<uint8_t> height(data.nodes.size(), 0);
  for (size_t n = data.nodes.size(); n-- > 0;) {
    const BvhNode& node = data.nodes[n];
    MovingNode found{static_cast<uint32_t>(n), 0};
    for (int c = 0; c < kBvhWidth; ++c) {
      if (!used(node, c)) continue;
      const uint32_t child = node.child[c];
      uint8_t below = 0;
      if (child & kLeafBit) {
        const MovingLeaf leaf{leaf_block(child), leaf_triangles(child)};
        const uint32_t* ids = data.blocks[leaf.block].primitive;
        if (!std::any_of(ids, ids + leaf.triangles, moves)) continue;
        leaves_.push_back(leaf);
      } else if ((below = height[child]) == 0) {
        continue;
      }
      found.slots = static_cast<uint8_t>(found.slots | 1u << c);
      height[n] = std::max(height[n], static_cast<uint8_t>(below + 1));
    }
    if (found.slots == 0) {
      still_cost_ += node_cost(node);
      continue;
    }
    moving_cost_ += node_cost(node);
    levels_.resize(std::max<size_t>(levels_.size(), height[n]));
    levels_[height[n] - 1u].push_back(found);
  }
}

void BvhRefit::refit(const SceneData& scene, Bvh& bvh, Parallel& parallel) {
  if (!any()) return;
  Bvh::Data& data = *bvh.data_;
  for_chunks(leaves_.size(), kLeavesInTask, parallel, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) refit_leaf(scene, data.blocks[leaves_[i].block], leaves_[i].triangles);
  });
  moving_cost_ = 0;
  std::vector<double> costs;
  for (const std::vector<MovingNode>& level : levels_) {
    costs.assign(level.size(), 0);
    for_chunks(level.size(), kNodesInTask, parallel, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        BvhNode& node = data.nodes[level[i].node];
        for (int c = 0; c < kBvhWidth; ++c)
          if (level[i].slots >> c & 1) refit_slot(data, node, c);
        costs[i] = node_cost(node);
      }
    });
    for (const double cost : costs) moving_cost_ += cost;
  }
  Box root = node_box(data.nodes[0]);
  if (data.instances) root.add(bvh::box_of(data.instances->bounds_min, data.instances->bounds_max));
  for (int k = 0; k < 3; ++k) data.bounds_min[k] = root.lo[k], data.bounds_max[k] = root.hi[k];
}

}  // namespace spanray
