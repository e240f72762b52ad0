// The tree of Settings::tree "high": slower to build, faster to trace.
#pragma once
#include "ray/bvh_collapse.h"

namespace spanray::bvh {

// The fast tree's splits as a binary tree, improved by reinsertion, then opened into wide nodes at the least cost. Where that costs
// less, long thin triangles stand in it in parts, each with a box of its own (ray/bvh_presplit.h); not if `whole`.
// refs: at least one, may be reordered. Output: false, and nothing else, where the fast tree has to do: surface areas beyond what float holds,
// or a tree that would be too deep. The same tree for any number of threads.
bool build_high(const SceneData& scene, bool whole, AlignedBuffer<Ref>& refs, const Bounds& bounds, Parallel& parallel, WideTree& wide);

}  // namespace spanray::bvh
