// Rays against spheres: a small tree of their own.
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "frame/frame.h"

namespace spanray {

struct ExactRay;  // frame/exact_hit.h

struct ExactMeeting {
  uint32_t primitive = kNoPrimitive;
  double t = std::numeric_limits<double>::infinity();
  // The nearer of two, of equal ones the lowest primitive; infinity is no hit.
  bool improve(uint32_t other, double other_t) {
    if (!(other_t < t || (other_t == t && other < primitive)) || other_t == std::numeric_limits<double>::infinity())
      return false;
    primitive = other, t = other_t;
    return true;
  }
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
  // (frame/exact_hit.h) says of every sphere: it does not depend on the tree. Origin and direction finite, the direction not
  // zero, no NaN (ray/exact_set.h asks).
  ExactMeeting closest(const ExactRay& ray) const;
  bool any(const ExactRay& ray) const;

 private:
  // Boxes hold their spheres with a margin (kMargin), and are rounded outwards.
  struct Node {
    float low[3], high[3];
    uint32_t first, count;  // spheres of a leaf; count 0: `first` is the right child, the left one is the next node
  };
  void build(size_t begin, size_t end);
  template <class Visit>
  void walk(const ExactRay& ray, const Visit& visit) const;

  std::vector<Item> spheres_;
  std::vector<Node> nodes_;
};

}  // namespace spanray
