// A tree of spheres for rays: the nodes of the triangles' tree (ray/bvh_data.h) over blocks of spheres.
#pragma once
#include <cstdint>

#include "core/aligned.h"
#include "ray/bvh_node.h"
#include "scene/scene_data.h"

namespace spanray {

// A leaf: one to eight spheres. Unused lanes are zero.
struct alignas(64) SphereBlock {
  float center[3][kBvhWidth], radius[kBvhWidth];
  uint32_t primitive[kBvhWidth];
};

struct SphereTree {
  AlignedBuffer<BvhNode> nodes;  // the first is the root; none if there are no spheres. Boxes hold their spheres with a margin
  AlignedBuffer<SphereBlock> blocks;
  size_t count = 0;  // of spheres

  // f(sphere, primitive) of each, in no order; the spheres' material is not set.
  template <class F> void for_each(const F& f) const {
    for (const BvhNode& node : nodes)
      for (int c = 0; c < kBvhWidth; ++c)
        if ((node.child[c] & kLeafBit) != 0) for_each_of(blocks[leaf_block(node.child[c])], leaf_triangles(node.child[c]), f);
  }

 private:
  template <class F> static void for_each_of(const SphereBlock& block, uint32_t count, const F& f) {
    for (uint32_t i = 0; i < count; ++i) {
      Sphere sphere{};
      for (int k = 0; k < 3; ++k) sphere.center[k] = block.center[k][i];
      sphere.radius = block.radius[i];
      f(sphere, block.primitive[i]);
    }
  }
};

// Over the spheres of a scene whose material flags satisfy (flags & mask) == value, as build_bvh. The same bytes on every machine.
SphereTree build_sphere_tree(const SceneData& scene, const uint32_t* material_flags, uint32_t mask, uint32_t value);

}  // namespace spanray
