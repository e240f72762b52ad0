#include "ray/bvh_collapse.h"

#include <cstring>

#include "ray/bvh_parts.h"

namespace spanray::bvh {
namespace {

constexpr uint32_t kSubtreeNodes = 2048;  // of the binary tree: so many or fewer are one task

// What a subtree costs as at most i children of a wide node, i from 1 to 7, and how to get there.
struct Cheapest {
  static constexpr uint8_t kFewer = 0xff;
  float cost[kBvhWidth];        // [i]
  uint8_t left[kBvhWidth + 1];  // [i]: so many of the i are of the left side; kFewer: i - 1 do as well. [8]: of a wide node
  bool leaf;                    // as one child
  uint32_t references;
};

// The least costs of i children, i from 1 to 8, of two sides that both have some, and how many are of the left side.
struct Shared {
  float cost[kBvhWidth];  // [i - 1]
  int32_t left[kBvhWidth];
  Shared(const float* l, const float* r) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    float padded[2 * kBvhWidth];  // [7 + i]: of i on the right
    std::fill_n(padded, kBvhWidth, inf), std::memcpy(padded + kBvhWidth, r + 1, (kBvhWidth - 1) * sizeof *r);
    padded[2 * kBvhWidth - 1] = inf;
    F4 best[2];
    I4 best_left[2];
    for (int h = 0; h < 2; ++h) {
      const auto of = [&](int k) {
        F4 right;
        std::memcpy(&right, padded + kBvhWidth - k + 4 * h, sizeof right);
        return l[k] + right;
      };
      best[h] = of(1), best_left[h] = I4{1, 1, 1, 1};
      for (int k = 2; k < kBvhWidth; ++k) {
        const F4 c = of(k);
        const I4 better = c < best[h];
        best[h] = better ? c : best[h], best_left[h] = better ? I4{k, k, k, k} : best_left[h];
      }
    }
    std::memcpy(cost, best, sizeof cost), std::memcpy(left, best_left, sizeof left);
  }
};

// Wide nodes below one of the top, and the binary nodes that are their leaves.
struct Task {
  uint32_t root, node, slot;  // the root's index goes to children `slot` of `node`
  int depth;
};
struct Emitted {
  std::vector<BvhNode> nodes;
  std::vector<uint32_t> leaves;
  int depth = 0;
  double cost = 0;
};

class Collapse {
 public:
  Collapse(const SceneData& scene, const BinaryTree& tree, const AlignedBuffer<Ref>& refs, Parallel& parallel)
      : scene_(scene), tree_(tree), refs_(refs), parallel_(parallel), cheapest_(tree.nodes()) {}

  void choose(const Preorder& order) {
    struct Piece { size_t begin, end; };
    std::vector<Piece> subtrees;
    std::vector<uint32_t> top;
    for (size_t i = 0; i < order.place.size();) {
      const auto [node, size] = order.place[i];
      if (size > kSubtreeNodes) top.push_back(node), ++i;
      else subtrees.push_back({i, i + size}), i += size;
    }
    parallel_.for_each(subtrees.size(), [&](size_t s, int) {
      for (size_t i = subtrees[s].end; i-- > subtrees[s].begin;) choose(order.place[i].node);
    });
    for (size_t i = top.size(); i-- > 0;) choose(top[i]);
  }

  // False, and nothing else, if the tree would be too deep.
  bool emit(WideTree& wide) {
    std::vector<Task> tasks;
    std::vector<Emitted> all(1);
    add_node(0, 1, &tasks, all[0]);
    all.resize(1 + tasks.size());
    parallel_.for_each(tasks.size(), [&](size_t i, int) {
      all[i + 1].nodes.reserve(cheapest_[tasks[i].root].references / kBvhWidth);
      all[i + 1].leaves.reserve(cheapest_[tasks[i].root].references / 4);
      add_node(tasks[i].root, tasks[i].depth, nullptr, all[i + 1]);
    });
    wide.depth = 0, wide.cost = 0;
    size_t nodes = 0, leaves = 0;
    std::vector<size_t> first_node, first_leaf;
    for (const Emitted& e : all) {
      wide.depth = std::max(wide.depth, e.depth), wide.cost += e.cost;
      first_node.push_back(nodes), first_leaf.push_back(leaves);
      nodes += e.nodes.size(), leaves += e.leaves.size();
    }
    if (wide.depth > kBvhMaxDepth) return false;
    for (size_t i = 0; i < tasks.size(); ++i)
      all[0].nodes[tasks[i].node].child[tasks[i].slot] = static_cast<uint32_t>(first_node[i + 1]);
    wide.nodes = AlignedBuffer<BvhNode>(nodes), wide.blocks = AlignedBuffer<TriangleBlock>(leaves);
    std::vector<size_t> references(all.size());
    parallel_.for_each(all.size(), [&](size_t i, int) {
      references[i] = copy(all[i], first_node[i], first_leaf[i], wide);
    });
    wide.references = 0;
    for (const size_t r : references) wide.references += r;
    return true;
  }

 private:
  void choose(uint32_t node) {
    Cheapest& c = cheapest_[node];
    const float area = tree_.box[node].half_area();
    c.leaf = tree_.leaf(node), c.references = tree_.count[node];
    if (c.leaf) {
      std::fill_n(c.cost, kBvhWidth, area);
      std::fill_n(c.left, kBvhWidth + 1, Cheapest::kFewer);
      return;
    }
    const Cheapest &l = cheapest_[tree_.child[node]], &r = cheapest_[tree_.child[node] + 1];
    c.references = l.references + r.references;
    const Shared shared(l.cost, r.cost);
    c.leaf = c.references <= kBvhWidth;  // never dearer: a leaf costs what a node costs without its children
    c.cost[0] = c.cost[1] = c.leaf ? area : area + shared.cost[kBvhWidth - 1];
    c.left[0] = c.left[1] = Cheapest::kFewer, c.left[kBvhWidth] = static_cast<uint8_t>(shared.left[kBvhWidth - 1]);
    for (int i = 2; i < kBvhWidth; ++i) {
      const bool more = shared.cost[i - 1] < c.cost[i - 1];
      c.cost[i] = more ? shared.cost[i - 1] : c.cost[i - 1];
      c.left[i] = more ? static_cast<uint8_t>(shared.left[i - 1]) : Cheapest::kFewer;
    }
  }

  void take(uint32_t node, int children, uint32_t* parts, int& n) const {
    while (children > 1 && cheapest_[node].left[children] == Cheapest::kFewer) --children;
    if (children == 1) parts[n++] = node;
    else take_sides(node, children, parts, n);
  }
  void take_sides(uint32_t node, int children, uint32_t* parts, int& n) const {
    const int left = cheapest_[node].left[children];
    take(tree_.child[node], left, parts, n);
    take(tree_.child[node] + 1, children - left, parts, n);
  }

  // With `tasks`, subtrees of at most kSubtreeSize references are left to these.
  uint32_t add_node(uint32_t root, int depth, std::vector<Task>* tasks, Emitted& out) const {
    const uint32_t index = static_cast<uint32_t>(out.nodes.size());
    out.nodes.push_back(empty_node());
    out.depth = std::max(out.depth, depth);
    if (depth > kBvhMaxDepth) return index;  // too deep
    uint32_t parts[kBvhWidth];
    int n = 0;
    if (cheapest_[root].leaf) parts[n++] = root;  // the root of the tree: any other leaf is in its parent
    else take_sides(root, kBvhWidth, parts, n);
    for (int i = 0; i < n; ++i) {
      const uint32_t part = parts[i];
      set_box(out.nodes[index], i, tree_.box[part]);
      out.cost += static_cast<double>(tree_.box[part].half_area());
      if (cheapest_[part].leaf) {
        out.nodes[index].child[i] = leaf_child(static_cast<uint32_t>(out.leaves.size()), cheapest_[part].references);
        out.leaves.push_back(part);
      } else if (tasks != nullptr && cheapest_[part].references <= kSubtreeSize) {
        tasks->push_back({part, index, static_cast<uint32_t>(i), depth + 1});
      } else {
        const uint32_t child = add_node(part, depth + 1, tasks, out);  // may move out.nodes
        out.nodes[index].child[i] = child;
      }
    }
    return index;
  }

  void collect(uint32_t node, LeafIds& ids) const {
    if (!tree_.leaf(node)) {
      collect(tree_.child[node], ids), collect(tree_.child[node] + 1, ids);
      return;
    }
    const uint32_t first = tree_.child[node] & ~BinaryTree::kLeaf;
    for (uint32_t i = 0; i < tree_.count[node]; ++i) ids.add(refs_[first + i].primitive());
  }

  // To its place in the tree; returns the number of triangles in leaves.
  size_t copy(const Emitted& from, size_t first_node, size_t first_leaf, WideTree& wide) const {
    size_t references = 0;
    for (size_t n = 0; n < from.nodes.size(); ++n) {
      BvhNode& node = wide.nodes[first_node + n] = from.nodes[n];
      for (int c = 0; c < kBvhWidth; ++c) {
        if (!(node.bounds[0][c] <= node.bounds[3][c])) continue;
        if ((node.child[c] & kLeafBit) == 0) {
          node.child[c] += static_cast<uint32_t>(first_node);
          continue;
        }
        LeafIds ids;
        const uint32_t block = leaf_block(node.child[c]);
        collect(from.leaves[block], ids);
        const size_t to = first_leaf + block;
        wide.blocks[to] = make_block(scene_, ids);
        node.child[c] = leaf_child(static_cast<uint32_t>(to), ids.count);
        references += ids.count;
      }
    }
    return references;
  }

  const SceneData& scene_;
  const BinaryTree& tree_;
  const AlignedBuffer<Ref>& refs_;
  Parallel& parallel_;
  std::vector<Cheapest> cheapest_;
};

}  // namespace

bool collapse(const SceneData& scene, const BinaryTree& binary, const AlignedBuffer<Ref>& refs, Parallel& parallel,
              WideTree& wide) {
  // A wide node takes in at most seven levels; below, recursion goes no deeper than that.
  const Preorder order(binary);
  if (order.depth > kBvhMaxDepth * (kBvhWidth - 1)) return false;
  Collapse work(scene, binary, refs, parallel);
  work.choose(order);
  return work.emit(wide);
}

}  // namespace spanray::bvh
