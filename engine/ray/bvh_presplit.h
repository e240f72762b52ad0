// Several references for a triangle whose box is mostly empty: long thin ones that lie askew.
#pragma once
#include "core/aligned.h"
#include "core/parallel.h"
#include "frame/frame.h"
#include "ray/bvh_split.h"

namespace spanray::bvh {

// Source:   Karras and Aila 2013, "Fast Parallel Construction of High-Quality Bounding Volume Hierarchies", section 4: splits go where they
//           save most area, at planes of a grid of the whole scene, so that parts of neighbours end where subtrees do.
// Input:    refs: whole triangles, at least one; box: theirs, of finite surface area.
// Output:   refs, with parts in place of some triangles: at most one reference in five more. Each part's box holds its part of the triangle
//           and kPartMargin (ray/triangle_test.h) more on all sides; it may reach beyond the triangle's box by that.
// Contract: the same for any number of threads.
AlignedBuffer<Ref> presplit(const SceneData& scene, const AlignedBuffer<Ref>& refs, const Box& box, Parallel& parallel);

}  // namespace spanray::bvh
