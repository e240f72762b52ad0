// Rays against exact primitives, beside the tree of the triangles (ray/bvh.h), so that triangles pay nothing for them: a tree
// of spheres, and a list of planes, which no tree can hold.
#pragma once
#include "ray/sphere_tree.h"

namespace spanray {

class ExactSet {
 public:
  ExactSet() = default;
  // Those of a scene whose material flags satisfy (flags & mask) == value, as build_bvh.
  ExactSet(const SceneData& scene, const uint32_t* material_flags, uint32_t mask, uint32_t value);
  bool empty() const { return spheres_.empty() && planes_.empty(); }
  size_t size() const { return spheres_.size() + planes_.size(); }
  size_t memory_bytes() const { return spheres_.memory_bytes() + planes_.capacity() * sizeof(PlaneItem); }

  struct PlaneItem {
    Plane plane;
    uint32_t primitive;
  };
  const SphereTree& spheres() const { return spheres_; }
  const std::vector<PlaneItem>& planes() const { return planes_; }

  // The first hit, ties to the lowest primitive; and whether there is any: what first_hit() (frame/exact_hit.h) says of all of
  // them. A direction that is zero or not finite, an origin that is not, a t_max that is NaN: miss.
  ExactMeeting closest(const ExactRay& ray) const;
  bool any(const ExactRay& ray) const;

 private:
  SphereTree spheres_;
  std::vector<PlaneItem> planes_;
};

// trace_closest and trace_any of ray/bvh.h, for exact primitives: after the triangles. out: of the triangles, and then of all.
// Not for primary rays: what these see of exact primitives is found by raster/exact.h, for both visibility engines alike.
void closest_exact(const Frame& frame, const ExactSet& set, const RayBatch& rays, uint32_t* out);
void any_exact(const ExactSet& set, const RayBatch& rays, uint32_t* out);

}  // namespace spanray
