// A binary tree whose leaves are small ranges of references: what can be improved before it becomes eight-wide nodes (ray/bvh_high.h).
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/aligned.h"
#include "core/parallel.h"
#include "ray/bvh_split.h"

namespace spanray::bvh {

// The root is node 0, siblings stand at 2p - 1 and 2p: pair p.
struct BinaryTree {
  static constexpr uint32_t kLeaf = 0x80000000u;
  AlignedBuffer<Box> box;          // fourth lanes are 0
  AlignedBuffer<uint32_t> child;   // the first of two siblings; kLeaf | first reference
  AlignedBuffer<uint32_t> count;   // of leaves: references
  AlignedBuffer<uint32_t> parent;  // of pair p; [0] is not used

  uint32_t nodes() const { return static_cast<uint32_t>(box.size()); }
  bool leaf(uint32_t node) const { return (child[node] & kLeaf) != 0; }
  uint32_t parent_of(uint32_t node) const { return parent[(node + 1) / 2]; }
  static uint32_t sibling(uint32_t node) { return node % 2 == 1 ? node + 1 : node - 1; }
};

// So deep may splits by areas go: 28 levels more halve 2^28 triangles, and a wide node takes in up to seven levels.
inline constexpr int kBinaryDepth = 400;

// All nodes, parents before their children and subtrees in one piece.
struct Preorder {
  struct Place { uint32_t node, size; };  // size: nodes of the subtree
  std::vector<Place> place;
  int depth = 0;  // nodes on the longest path
  explicit Preorder(const BinaryTree& tree);
};

// Splits top-down by binned surface areas, with leaves of up to eight references.
// Source:   Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies".
// Input:    refs: at least one, reordered; bounds: of all of them. Below median_depth ranges are halved by count.
// Contract: the same tree for any number of threads.
BinaryTree build_binary(AlignedBuffer<Ref>& refs, const Bounds& bounds, Parallel& parallel, int median_depth = kBinaryDepth);

// Whether sums of as many areas as there are nodes, and differences of them, are finite and more than noise.
bool areas_add_up(const BinaryTree& tree);

struct Reinsertion {
  int most_rounds;
  size_t share;  // a round tries one node in so many, those of the largest surface
};

// Takes subtrees out and puts them in where surface areas grow least.
// Source:   Bittner, Hapala, Havran 2013, "Fast Insertion-Based Optimization of Bounding Volume Hierarchies"; Meister and Bittner 2018,
//           "Parallel Reinsertion for Bounding Volume Hierarchy Optimization".
// Contract: the same tree for any number of threads. Leaves stay as they are; so does all where areas do not add up.
void reinsert(BinaryTree& tree, const Reinsertion& how, Parallel& parallel);

}  // namespace spanray::bvh
