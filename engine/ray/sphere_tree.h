// A tree of spheres for rays: the nodes of the triangles' tree (ray/bvh_node.h), down to single spheres, so that lanes that meet
// boxes sort out nearly all of them.
#pragma once
#include <cstdint>

#include "core/aligned.h"
#include "ray/bvh_node.h"
#include "scene/scene_data.h"

namespace spanray {

struct TreeSphere {
  float center[3], radius;
  uint32_t primitive;
};

struct SphereTree {
  // The first is the root; none if there are no spheres. Boxes hold their spheres with a margin. Leaves: sphere_child().
  AlignedBuffer<BvhNode> nodes;
  AlignedBuffer<TreeSphere> spheres;
};
inline uint32_t sphere_child(uint32_t sphere) { return kLeafBit | sphere; }
inline uint32_t sphere_of(uint32_t child) { return child & ~kLeafBit; }

// Over the spheres of a scene whose material flags satisfy (flags & mask) == value, as build_bvh. The same bytes on every
// machine.
SphereTree build_sphere_tree(const SceneData& scene, const uint32_t* material_flags, uint32_t mask, uint32_t value);

}  // namespace spanray
