// The bytes of the tree: the same for any number of threads and on every instruction set.
#pragma once
#include <cstdint>
#include <memory>

#include "core/aligned.h"
#include "ray/bvh.h"
#include "ray/bvh_node.h"
#include "ray/exact_set.h"

namespace spanray {

// A leaf: one to eight triangles, vertices in the canonical order of the scene. Unused lanes are zero.
struct alignas(64) TriangleBlock {
  float vertex[3][3][kBvhWidth];  // [vertex][axis][triangle]
  uint32_t primitive[kBvhWidth];
};

// Triangles first to first + count - 1 of a scene.
struct TriangleRange { uint32_t first, count; };

struct InstanceTrees;  // ray/bvh_instances.h

struct Bvh::Data {
  AlignedBuffer<BvhNode> nodes;  // the first is the root; none if there are no triangles at all
  AlignedBuffer<TriangleBlock> blocks;
  std::shared_ptr<const InstanceTrees> instances;  // their triangles stand in no block; nullptr: none
  float bounds_min[3] = {0, 0, 0}, bounds_max[3] = {0, 0, 0};
  size_t primitives = 0;
  size_t references = 0;  // triangles in leaves: more than `primitives` where parts of one stand in several
  int depth = 0;  // nodes on the longest path
  ExactSet exact;  // of the same material flags; all else here is about triangles
};

}  // namespace spanray
