#include "ray/bvh_collapse.h"

#include "ray/bvh_parts.h"

namespace spanray::bvh {
namespace {

// What a subtree costs as at most i children of a wide node, i from 1 to 7, and how to get there.
struct Cheapest {
  static constexpr uint8_t kFewer = 0xff;
  float cost[kBvhWidth];        // [i]
  uint8_t left[kBvhWidth + 1];  // [i]: so many of the i are of the left side; kFewer: i - 1 do as well. [8]: of a wide node
  bool leaf;                    // as one child
  uint32_t references;
};

class Collapse {
 public:
  Collapse(const SceneData& scene, const BinaryTree& tree, const AlignedBuffer<Ref>& refs, WideTree& wide)
      : scene_(scene), tree_(tree), refs_(refs), wide_(wide), cheapest_(tree.nodes()) {}

  void choose(const std::vector<uint32_t>& order) {
    for (size_t i = order.size(); i-- > 0;) choose(order[i]);
  }

  uint32_t add_node(uint32_t root, int depth) {
    const uint32_t index = static_cast<uint32_t>(wide_.nodes.size());
    wide_.nodes.push_back(empty_node());
    wide_.depth = std::max(wide_.depth, depth);
    uint32_t parts[kBvhWidth];
    int n = 0;
    if (cheapest_[root].leaf) parts[n++] = root;  // the root of the tree: any other leaf is in its parent
    else take_sides(root, kBvhWidth, parts, n);
    for (int i = 0; i < n; ++i) {
      const Box& box = tree_.box[parts[i]];
      set_box(wide_.nodes[index], i, box);
      wide_.cost += static_cast<double>(box.half_area());
      const bool leaf = cheapest_[parts[i]].leaf;
      const uint32_t child = leaf ? add_leaf(parts[i]) : add_node(parts[i], depth + 1);  // may move wide_.nodes
      wide_.nodes[index].child[i] = child;
    }
    return index;
  }

 private:
  void choose(uint32_t node) {
    Cheapest& c = cheapest_[node];
    const float area = tree_.box[node].half_area();
    std::fill_n(c.cost, kBvhWidth, area);
    std::fill_n(c.left, kBvhWidth + 1, Cheapest::kFewer);
    c.leaf = tree_.leaf(node), c.references = tree_.count[node];
    if (c.leaf) return;
    const Cheapest &l = cheapest_[tree_.child[node]], &r = cheapest_[tree_.child[node] + 1];
    c.references = l.references + r.references;
    float shared[kBvhWidth + 1];  // the children are of both sides
    uint8_t left[kBvhWidth + 1];
    for (int i = 2; i <= kBvhWidth; ++i) {
      shared[i] = l.cost[1] + r.cost[i - 1], left[i] = 1;
      for (int k = 2; k < i; ++k)
        if (const float cost = l.cost[k] + r.cost[i - k]; cost < shared[i]) shared[i] = cost, left[i] = static_cast<uint8_t>(k);
    }
    c.leaf = c.references <= kBvhWidth;  // never dearer: a leaf costs what a node costs without its children
    c.cost[1] = c.leaf ? area : area + shared[kBvhWidth];
    c.left[kBvhWidth] = left[kBvhWidth];
    for (int i = 2; i < kBvhWidth; ++i) {
      c.cost[i] = std::min(c.cost[i - 1], shared[i]);
      if (shared[i] < c.cost[i - 1]) c.left[i] = left[i];
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

  void collect(uint32_t node, LeafIds& ids) const {
    if (!tree_.leaf(node)) {
      collect(tree_.child[node], ids), collect(tree_.child[node] + 1, ids);
      return;
    }
    const uint32_t first = tree_.child[node] & ~BinaryTree::kLeaf;
    for (uint32_t i = 0; i < tree_.count[node]; ++i) ids.add(refs_[first + i].primitive());
  }

  uint32_t add_leaf(uint32_t node) {
    LeafIds ids;
    collect(node, ids);
    wide_.blocks.push_back(make_block(scene_, ids));
    wide_.references += ids.count;
    return leaf_child(static_cast<uint32_t>(wide_.blocks.size() - 1), ids.count);
  }

  const SceneData& scene_;
  const BinaryTree& tree_;
  const AlignedBuffer<Ref>& refs_;
  WideTree& wide_;
  std::vector<Cheapest> cheapest_;
};

int depth_of(const BinaryTree& tree, const std::vector<uint32_t>& order) {
  std::vector<int> depth(tree.nodes());
  int deepest = 1;
  depth[0] = 1;
  for (const uint32_t node : order)
    if (node != 0) deepest = std::max(deepest, depth[node] = depth[tree.parent_of(node)] + 1);
  return deepest;
}

}  // namespace

bool collapse(const SceneData& scene, const BinaryTree& binary, const AlignedBuffer<Ref>& refs, WideTree& wide) {
  const std::vector<uint32_t> order = top_down(binary);
  // A wide node takes in at most seven levels; below, recursion goes no deeper than that.
  if (depth_of(binary, order) > kBvhMaxDepth * (kBvhWidth - 1)) return false;
  WideTree made;
  Collapse work(scene, binary, refs, made);
  work.choose(order);
  work.add_node(0, 1);
  if (made.depth > kBvhMaxDepth) return false;
  wide = std::move(made);
  return true;
}

}  // namespace spanray::bvh
