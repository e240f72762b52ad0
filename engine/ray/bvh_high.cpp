#include "ray/bvh_high.h"

namespace spanray::bvh {

bool build_high(const SceneData& scene, AlignedBuffer<Ref>& refs, Parallel& parallel, WideTree& wide) {
  BinaryTree tree = build_binary(refs, parallel);
  // Sums of as many areas as there are nodes, and differences of them, must stay finite.
  if (const float area = tree.box[0].half_area(); !(area > 1e-25f && area < 1e25f)) return false;
  reinsert(tree, parallel);
  return collapse(scene, tree, refs, wide);
}

}  // namespace spanray::bvh
