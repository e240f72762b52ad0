#include "ray/bvh_binary.h"

namespace spanray::bvh {
namespace {

constexpr size_t kLeastTried = 256;  // nodes
constexpr size_t kReserved = 128;    // nodes that wait: more are rare
constexpr double kLeastGain = 1e-3;  // of the sum of all areas: a round that gains less is the last

struct Move {
  uint32_t from, to;  // to 0: none
  float gain;         // of surface area
};

Box united(const Box& a, const Box& b) {
  Box u = a;
  u.add(b);
  return u;
}

// Where a subtree goes: it and what stands there get a common parent. Branch and bound from its sibling upwards.
class PlaceFinder {
 public:
  explicit PlaceFinder(const BinaryTree& tree) : tree_(tree) { open_.reserve(kReserved); }

  Move find(uint32_t node) {
    const Box box = tree_.box[node];
    const uint32_t parent = tree_.parent_of(node);
    Move best{node, 0, 0};
    if (parent == 0) return best;
    float gain = tree_.box[parent].half_area();  // so far: what nodes above lose without it
    uint32_t pivot = parent, sibling = BinaryTree::sibling(node);
    Box without = tree_.box[sibling];  // the pivot's box
    for (;;) {
      search(sibling, box, gain, best);
      if (pivot != parent) {
        without.add(tree_.box[sibling]);
        gain += tree_.box[pivot].half_area() - without.half_area();
      }
      if (pivot == 0) break;
      sibling = BinaryTree::sibling(pivot), pivot = tree_.parent_of(pivot);
    }
    if (best.to == BinaryTree::sibling(node) || best.to == parent) best.to = 0;  // where it is
    return best;
  }

 private:
  void search(uint32_t subtree, const Box& box, float gain, Move& best) {
    const float area = box.half_area();
    open_.assign(1, {gain, subtree});
    while (!open_.empty()) {
      const auto [above, node] = open_.back();  // gain if it goes below `node`, but for what `node` and its new parent grow
      open_.pop_back();
      if (!(above - area > best.gain)) continue;
      const float here = above - united(tree_.box[node], box).half_area();
      if (here > best.gain) best.to = node, best.gain = here;
      if (tree_.leaf(node)) continue;
      const float below = here + tree_.box[node].half_area();
      open_.push_back({below, tree_.child[node]});
      open_.push_back({below, tree_.child[node] + 1});
    }
  }

  const BinaryTree& tree_;
  std::vector<std::pair<float, uint32_t>> open_;
};

void fit_upwards(BinaryTree& tree, uint32_t node) {
  for (;; node = tree.parent_of(node)) {
    tree.box[node] = united(tree.box[tree.child[node]], tree.box[tree.child[node] + 1]);
    if (node == 0) return;
  }
}

struct Content {
  Box box;
  uint32_t child, count;
};
Content content(const BinaryTree& tree, uint32_t node) { return {tree.box[node], tree.child[node], tree.count[node]}; }
void set_content(BinaryTree& tree, uint32_t node, const Content& c) {
  tree.box[node] = c.box, tree.child[node] = c.child, tree.count[node] = c.count;
  if (!tree.leaf(node)) tree.parent[(c.child + 1) / 2] = node;
}

// The sibling takes the parent's place; the pair that becomes free stands below `to`.
void apply(BinaryTree& tree, const Move& move) {
  const uint32_t sibling = BinaryTree::sibling(move.from), parent = tree.parent_of(move.from);
  const uint32_t pair = std::min(move.from, sibling);
  const Content kept = content(tree, sibling), there = content(tree, move.to);
  set_content(tree, sibling, there);
  set_content(tree, parent, kept);
  set_content(tree, move.to, {there.box, pair, 0});
  fit_upwards(tree, move.to);
  fit_upwards(tree, tree.parent_of(parent));
}

bool inside(const BinaryTree& tree, uint32_t node, uint32_t subtree) {
  while (node != 0 && node != subtree) node = tree.parent_of(node);
  return node == subtree;
}

// The best moves first, leaving out those that touch a better one. moves: gains are of the tree as it was. Returns what was gained.
double apply_all(BinaryTree& tree, std::vector<Move>& moves) {
  std::sort(moves.begin(), moves.end(),
            [](const Move& a, const Move& b) { return a.gain != b.gain ? a.gain > b.gain : a.from < b.from; });
  std::vector<bool> touched(tree.nodes());
  const auto is_touched = [&](uint32_t n) { return touched[n]; };
  double gain = 0;
  for (const Move& m : moves) {
    const uint32_t parent = tree.parent_of(m.from);
    const uint32_t nodes[] = {m.from, m.to, BinaryTree::sibling(m.from),
                              parent, tree.parent_of(parent), tree.parent_of(m.to)};
    // An earlier move may have put the subtree that holds the place into this one.
    if (std::any_of(nodes, nodes + 6, is_touched) || inside(tree, m.to, m.from)) continue;
    for (const uint32_t n : nodes) touched[n] = true;
    apply(tree, m);
    gain += static_cast<double>(m.gain);
  }
  return gain;
}

double area_sum(const BinaryTree& tree) {
  double sum = 0;
  for (uint32_t n = 0; n < tree.nodes(); ++n) sum += static_cast<double>(tree.box[n].half_area());
  return sum;
}

// The `count` nodes of the largest surfaces below the root, in no order.
std::vector<uint32_t> largest(const BinaryTree& tree, size_t count) {
  std::vector<std::pair<float, uint32_t>> nodes(tree.nodes() - 1);
  for (uint32_t n = 1; n < tree.nodes(); ++n) nodes[n - 1] = {-tree.box[n].half_area(), n};
  if (count < nodes.size()) std::nth_element(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(count), nodes.end());
  nodes.resize(std::min(count, nodes.size()));
  std::vector<uint32_t> ids;
  for (const auto& [area, n] : nodes) ids.push_back(n);
  return ids;
}

}  // namespace

bool areas_add_up(const BinaryTree& tree) {
  const float area = tree.box[0].half_area();
  return area > 1e-25f && area < 1e25f;
}

void reinsert(BinaryTree& tree, const Reinsertion& how, Parallel& parallel) {
  constexpr size_t kChunk = 64;
  if (!areas_add_up(tree)) return;
  double sum = area_sum(tree);
  // Once for all rounds: which nodes are the largest changes little, and finding them takes longer than a round of few.
  const std::vector<uint32_t> candidates = largest(tree, std::max<size_t>(tree.nodes() / how.share, kLeastTried));
  std::vector<Move> moves;
  for (int round = 0; round < how.most_rounds; ++round) {
    moves.resize(candidates.size());
    parallel.for_each((candidates.size() + kChunk - 1) / kChunk, [&](size_t c, int) {
      PlaceFinder finder(tree);
      for (size_t i = c * kChunk; i < std::min(candidates.size(), (c + 1) * kChunk); ++i) moves[i] = finder.find(candidates[i]);
    });
    std::erase_if(moves, [](const Move& m) { return m.to == 0; });
    const double gain = apply_all(tree, moves);
    if (!(gain > kLeastGain * sum)) return;
    sum -= gain;
  }
}

}  // namespace spanray::bvh
