// A binary tree as eight-wide nodes.
#pragma once
#include <vector>

#include "ray/bvh_binary.h"
#include "ray/bvh_data.h"

namespace spanray::bvh {

struct WideTree {
  AlignedBuffer<BvhNode> nodes;  // parents before their children
  AlignedBuffer<TriangleBlock> blocks;
  int depth = 0;
  size_t references = 0;  // triangles in leaves
  double cost = 0;        // the sum of half the surface areas of all nodes and leaves, as of BvhRefit::cost()
};

// Of all ways to take nodes of the binary tree as wide nodes and leaves, the one of the least cost.
// Source:   Ylitie, Karras, Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", section 3.2.
// Input:    refs: as build_binary() left them; surface areas are finite.
// Output:   false, and nothing else, if the binary tree is so deep that the wide one would be deeper than kBvhMaxDepth.
bool collapse(const SceneData& scene, const BinaryTree& binary, const AlignedBuffer<Ref>& refs, Parallel& parallel, WideTree& wide);

}  // namespace spanray::bvh
