// Rays against exact primitives, beside the tree of the triangles (ray/bvh.h), so that triangles pay nothing for them: a tree
// of spheres, and a list of planes, which no tree can hold.
#pragma once
#include <vector>

#include "frame/frame.h"
#include "ray/sphere_tree.h"

namespace spanray {

struct PlaneItem {
  Plane plane;
  uint32_t primitive;
};

struct ExactSet {
  ExactSet() = default;
  // Those of a scene whose material flags satisfy (flags & mask) == value, as build_bvh.
  ExactSet(const SceneData& scene, const uint32_t* material_flags, uint32_t mask, uint32_t value);
  bool empty() const { return size() == 0; }
  size_t size() const { return spheres.spheres.size() + planes.size(); }
  size_t memory_bytes() const {
    return spheres.nodes.bytes() + spheres.spheres.bytes() + planes.capacity() * sizeof(PlaneItem);
  }

  SphereTree spheres;
  std::vector<PlaneItem> planes;
};

// trace_closest and trace_any of ray/bvh.h, for exact primitives: after the triangles. out: of the triangles, and then of all.
// What they answer is what first_hit() (frame/exact_hit.h) says of all of them, ties to the lowest primitive: it depends neither
// on the tree nor on the batch. A direction that is zero or not finite, an origin that is not, a t_max that is negative or NaN:
// miss.
// t_min >= 0: hits count beyond it, in units of the direction; what `out` tells of triangles is taken as it is.
// Not for primary rays: what these see of exact primitives is found by raster/exact.h, for both visibility engines alike.
void closest_exact(const Frame& frame, const ExactSet& set, const RayBatch& rays, double t_min, uint32_t* out);
void any_exact(const Frame& frame, const ExactSet& set, const RayBatch& rays, uint32_t* out);

}  // namespace spanray
