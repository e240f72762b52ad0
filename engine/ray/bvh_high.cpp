#include "ray/bvh_high.h"

#include "ray/bvh_presplit.h"

namespace spanray::bvh {
namespace {

constexpr Reinsertion kThoroughReinsertion{20, 5};
constexpr double kWorthSplitting = 0.98;  // of the cost without split triangles

bool improve(const SceneData& scene, BinaryTree& tree, const AlignedBuffer<Ref>& refs, Parallel& parallel, WideTree& wide) {
  reinsert(tree, kThoroughReinsertion, parallel);
  return collapse(scene, tree, refs, parallel, wide);
}

}  // namespace

bool build_high(const SceneData& scene, bool whole, AlignedBuffer<Ref>& refs, const Bounds& bounds, Parallel& parallel, WideTree& wide) {
  BinaryTree tree = build_binary(refs, bounds, parallel);
  const Box box = tree.box[0];
  if (!areas_add_up(tree)) return false;
  if (!improve(scene, tree, refs, parallel, wide)) return false;
  if (whole) return true;
  AlignedBuffer<Ref> parts = presplit(scene, refs, box, parallel);
  if (parts.size() == refs.size()) return true;
  Bounds of_parts;
  for (const Ref& ref : parts) of_parts.add(ref);
  tree = build_binary(parts, of_parts, parallel);
  WideTree split;
  if (improve(scene, tree, parts, parallel, split) && split.cost < kWorthSplitting * wide.cost) wide = std::move(split);
  return true;
}

}  // namespace spanray::bvh
