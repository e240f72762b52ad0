#include "ray/bvh_binary.h"

namespace spanray::bvh {
namespace {

constexpr size_t kReserved = 64;  // nodes that wait: more are rare

struct OpenRange {
  uint32_t node;
  Range range;
  int depth;
};

// Nodes as in BinaryTree.
struct Nodes {
  std::vector<Box> box;
  std::vector<uint32_t> child, count, parent = {0};

  uint32_t size() const { return static_cast<uint32_t>(box.size()); }
  void add(const Range& range) {
    box.push_back(range.bounds.box), child.push_back(BinaryTree::kLeaf | range.begin), count.push_back(range.count());
    box.back().lo[3] = box.back().hi[3] = 0;
  }
  void reserve(size_t nodes) { box.reserve(nodes), child.reserve(nodes), count.reserve(nodes), parent.reserve(nodes / 2 + 1); }
};

// Splits down to leaves, whose references end up in the first array. With `pending`, ranges of at most kSubtreeSize are left to
// later tasks.
void split_all(const OpenRange& root, int median_depth, const Splitter& splitter, std::vector<OpenRange>* pending, Ref* refs,
               Nodes& nodes) {
  std::vector<OpenRange> open;
  open.reserve(kReserved);
  open.push_back({0, root.range, root.depth});
  nodes.add(root.range);
  while (!open.empty()) {
    const auto [node, range, depth] = open.back();
    open.pop_back();
    if (pending != nullptr && range.count() <= kSubtreeSize) {
      pending->push_back({node, range, depth});
      continue;
    }
    Range left, right;
    if (!splitter.split(range, depth >= median_depth, left, right)) {
      if (range.second) std::copy_n(splitter.refs(range), range.count(), refs + range.begin);
      continue;
    }
    const uint32_t child = nodes.size();
    nodes.child[node] = child, nodes.count[node] = 0, nodes.parent.push_back(node);
    nodes.add(left), nodes.add(right);
    open.push_back({child, left, depth + 1});
    open.push_back({child + 1, right, depth + 1});
  }
}

// Subtrees behind the top.
BinaryTree join(const Nodes& top, const std::vector<OpenRange>& pending, const std::vector<Nodes>& subtrees, Parallel& parallel) {
  BinaryTree tree;
  std::vector<uint32_t> bases;
  uint32_t size = top.size();
  for (const Nodes& subtree : subtrees) bases.push_back(size - 1), size += subtree.size() - 1;
  tree.box.resize(size), tree.child.resize(size), tree.count.resize(size), tree.parent.resize(size / 2 + 1);
  // A root stands in the top already: node i of a subtree goes to base + i.
  const auto put = [&](const Nodes& from, uint32_t i, uint32_t base, uint32_t to) {
    tree.box[to] = from.box[i], tree.count[to] = from.count[i];
    tree.child[to] = from.child[i] + ((from.child[i] & BinaryTree::kLeaf) != 0 ? 0 : base);
  };
  for (uint32_t i = 0; i < top.size(); ++i) put(top, i, 0, i);
  std::copy(top.parent.begin(), top.parent.end(), tree.parent.begin());
  parallel.for_each(subtrees.size(), [&](size_t s, int) {
    const Nodes& from = subtrees[s];
    const uint32_t root = pending[s].node, base = bases[s];
    put(from, 0, base, root);
    for (uint32_t i = 1; i < from.size(); ++i) put(from, i, base, base + i);
    for (uint32_t p = 1; p < from.parent.size(); ++p) tree.parent[base / 2 + p] = from.parent[p] == 0 ? root : base + from.parent[p];
  });
  return tree;
}

}  // namespace

Preorder::Preorder(const BinaryTree& tree) {
  place.reserve(tree.nodes());
  struct Open { uint32_t node; int depth; };
  std::vector<Open> open;
  open.reserve(kReserved);
  open.push_back({0, 1});
  while (!open.empty()) {
    const auto [node, level] = open.back();
    open.pop_back();
    depth = std::max(depth, level);
    place.push_back({node, 1});
    if (tree.leaf(node)) continue;
    open.push_back({tree.child[node] + 1, level + 1});
    open.push_back({tree.child[node], level + 1});
  }
  for (size_t i = place.size(); i-- > 0;)
    if (!tree.leaf(place[i].node)) place[i].size += place[i + 1].size + place[i + 1 + place[i + 1].size].size;
}

BinaryTree build_binary(AlignedBuffer<Ref>& refs, const Bounds& bounds, Parallel& parallel, int median_depth) {
  const uint32_t n = static_cast<uint32_t>(refs.size());
  AlignedBuffer<Ref> second(n);
  std::vector<OpenRange> pending;
  Nodes top;
  split_all({0, {0, n, false, bounds}, 1}, median_depth, Splitter(refs.data(), second.data(), &parallel), &pending, refs.data(), top);
  std::vector<Nodes> subtrees(pending.size());
  parallel.for_each(pending.size(), [&](size_t s, int) {
    subtrees[s].reserve(pending[s].range.count() / 2);
    split_all(pending[s], median_depth, Splitter(refs.data(), second.data(), nullptr), nullptr, refs.data(), subtrees[s]);
  });
  return join(top, pending, subtrees, parallel);
}

}  // namespace spanray::bvh
