#include "ray/bvh_binary.h"

namespace spanray::bvh {
namespace {

struct OpenRange {
  uint32_t node;
  Range range;
};

// A range that is split at m has its parts at 2m - 1 and 2m: no two splits share a place, whatever thread makes them.
struct SparseTree {
  AlignedBuffer<Range> range;
  AlignedBuffer<uint32_t> middle;  // 0: a leaf
  explicit SparseTree(size_t refs) : range(2 * refs - 1), middle(2 * refs - 1) {}
};

// Splits down to leaves. With `pending`, ranges of at most kSubtreeSize are left to later tasks.
void split_all(const OpenRange& root, const Splitter& splitter, std::vector<OpenRange>* pending, SparseTree& tree) {
  std::vector<OpenRange> open = {root};
  while (!open.empty()) {
    const auto [node, range] = open.back();
    open.pop_back();
    if (pending != nullptr && !range.leaf && range.count() <= kSubtreeSize) {
      pending->push_back({node, range});
      continue;
    }
    const uint32_t middle = range.leaf ? 0 : splitter.partition(range);
    tree.range[node] = range, tree.middle[node] = middle;
    if (range.leaf) continue;
    open.push_back({2 * middle - 1, splitter.analyse(range.begin, middle, false)});
    open.push_back({2 * middle, splitter.analyse(middle, range.end, false)});
  }
}

// Without the places that were not taken, level by level.
BinaryTree compact(const SparseTree& sparse) {
  BinaryTree tree;
  std::vector<uint32_t> order = {0};
  for (size_t i = 0; i < order.size(); ++i)
    if (const uint32_t middle = sparse.middle[order[i]]; middle != 0)
      order.push_back(2 * middle - 1), order.push_back(2 * middle);
  tree.box.resize(order.size()), tree.child.resize(order.size()), tree.count.resize(order.size());
  tree.parent.resize(order.size() / 2 + 1);
  tree.parent[0] = 0;
  uint32_t next = 1;
  for (uint32_t i = 0; i < order.size(); ++i) {
    const Range& range = sparse.range[order[i]];
    tree.box[i] = range.box;
    tree.box[i].lo[3] = tree.box[i].hi[3] = 0;
    tree.count[i] = range.leaf ? range.count() : 0;
    tree.child[i] = BinaryTree::kLeaf | range.begin;
    if (range.leaf) continue;
    tree.child[i] = next, tree.parent[(next + 1) / 2] = i;
    next += 2;
  }
  return tree;
}

}  // namespace

std::vector<uint32_t> top_down(const BinaryTree& tree) {
  std::vector<uint32_t> order = {0};
  order.reserve(tree.nodes());
  for (size_t i = 0; i < order.size(); ++i)
    if (const uint32_t node = order[i]; !tree.leaf(node))
      order.push_back(tree.child[node]), order.push_back(tree.child[node] + 1);
  return order;
}

BinaryTree build_binary(AlignedBuffer<Ref>& refs, Parallel& parallel) {
  const uint32_t n = static_cast<uint32_t>(refs.size());
  SparseTree tree(n);
  AlignedBuffer<Ref> scratch(n);
  const Splitter splitter(refs.data(), scratch.data(), &parallel);
  std::vector<OpenRange> pending;
  split_all({0, splitter.analyse(0, n, false)}, splitter, &pending, tree);
  parallel.for_each(pending.size(), [&](size_t i, int) {
    split_all(pending[i], Splitter(refs.data(), scratch.data(), nullptr), nullptr, tree);
  });
  return compact(tree);
}

}  // namespace spanray::bvh
