// Rays against spheres: a small tree of their own beside that of the triangles (ray/bvh.h), so that triangles pay nothing for
// them.
#pragma once
#include <cstdint>
#include <vector>

#include "frame/frame.h"

namespace spanray {

struct SphereRay;  // frame/sphere_hit.h

struct SphereMeeting {
  uint32_t primitive = kNoPrimitive;
  double t = 0;
};

class SphereTree {
 public:
  SphereTree() = default;
  // Over the spheres of a scene whose material flags satisfy (flags & mask) == value, as build_bvh.
  SphereTree(const SceneData& scene, const uint32_t* material_flags, uint32_t mask, uint32_t value);
  bool empty() const { return spheres_.empty(); }
  size_t size() const { return spheres_.size(); }
  size_t memory_bytes() const { return spheres_.capacity() * sizeof(Item) + nodes_.capacity() * sizeof(Node); }

  struct Item {
    Sphere sphere;
    uint32_t primitive;
  };
  const std::vector<Item>& items() const { return spheres_; }

  // The first hit, ties to the lowest primitive; and whether there is any. What they answer is what first_hit()
  // (frame/sphere_hit.h) says of every sphere: it does not depend on the tree. A direction that is zero or not finite, an
  // origin that is not, a t_max that is NaN: miss.
  SphereMeeting closest(const SphereRay& ray) const;
  bool any(const SphereRay& ray) const;

 private:
  // Boxes hold their spheres with a margin (kMargin), and are rounded outwards.
  struct Node {
    float low[3], high[3];
    uint32_t first, count;  // spheres of a leaf; count 0: `first` is the right child, the left one is the next node
  };
  void build(size_t begin, size_t end);
  template <class Visit>
  void walk(const SphereRay& ray, const Visit& visit) const;

  std::vector<Item> spheres_;
  std::vector<Node> nodes_;
};

// trace_closest and trace_any of ray/bvh.h, for spheres: after the triangles. out: of the triangles, and then of both.
// Not for primary rays: what these see of spheres is found by raster/spheres.h, for both visibility engines alike.
void closest_spheres(const Frame& frame, const SphereTree& spheres, const RayBatch& rays, uint32_t* out);
void any_spheres(const SphereTree& spheres, const RayBatch& rays, uint32_t* out);

}  // namespace spanray
