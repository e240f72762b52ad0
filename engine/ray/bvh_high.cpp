#include "ray/bvh_high.h"

#include "ray/bvh_presplit.h"

namespace spanray::bvh {
namespace {

constexpr double kWorthSplitting = 0.98;  // of the cost without split triangles

bool improve(const SceneData& scene, BinaryTree& tree, const AlignedBuffer<Ref>& refs, Parallel& parallel, WideTree& wide) {
  reinsert(tree, parallel);
  return collapse(scene, tree, refs, wide);
}

}  // namespace

bool build_high(const SceneData& scene, bool whole, AlignedBuffer<Ref>& refs, Parallel& parallel, WideTree& wide) {
  BinaryTree tree = build_binary(refs, parallel);
  const Box box = tree.box[0];
  // Sums of as many areas as there are nodes, and differences of them, must stay finite.
  if (const float area = box.half_area(); !(area > 1e-25f && area < 1e25f)) return false;
  if (!improve(scene, tree, refs, parallel, wide)) return false;
  if (whole) return true;
  AlignedBuffer<Ref> parts = presplit(scene, refs, box, parallel);
  if (parts.size() == refs.size()) return true;
  tree = build_binary(parts, parallel);
  WideTree split;
  if (improve(scene, tree, parts, parallel, split) && split.cost < kWorthSplitting * wide.cost) wide = std::move(split);
  return true;
}

}  // namespace spanray::bvh
