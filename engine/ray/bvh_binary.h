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

// Every node after its parent.
std::vector<uint32_t> top_down(const BinaryTree& tree);

// The tree that bvh_build.cpp would open into wide nodes: binned surface areas, with leaves of up to eight references.
// refs: at least one, reordered. The same tree for any number of threads.
BinaryTree build_binary(AlignedBuffer<Ref>& refs, Parallel& parallel);

// Takes subtrees out and puts them in where surface areas grow least.
// Source:   Bittner, Hapala, Havran 2013, "Fast Insertion-Based Optimization of Bounding Volume Hierarchies"; Meister and Bittner 2018,
//           "Parallel Reinsertion for Bounding Volume Hierarchy Optimization".
// Input:    boxes whose surface areas are finite.
// Contract: the same tree for any number of threads. Leaves stay as they are.
void reinsert(BinaryTree& tree, Parallel& parallel);

}  // namespace spanray::bvh
