// A tree that follows triangles which move: the same nodes, new boxes.
#pragma once
#include <cstdint>
#include <vector>

#include "ray/bvh.h"

namespace spanray {

// Knows which leaves and nodes of one tree hold moving triangles, so that a refit touches nothing else.
// Source: Lauterbach, Yoon, Tuft, Manocha 2006, "RT-DEFORM: Interactive Ray Tracing of Dynamic Scenes using BVHs": refit bottom-up,
//         build anew when the tree has become too costly.
class BvhRefit {
 public:
  // bvh: as built, with follows_motion; moving: runs of moving triangles.
  BvhRefit(const Bvh& bvh, const std::vector<MovingRun>& moving);

  // Takes the vertices of moving triangles from `scene` and makes all boxes around them anew, smallest possible. The bytes do not
  // depend on threads, nor on earlier refits. bvh: the tree of the constructor.
  void refit(const SceneData& scene, Bvh& bvh, Parallel& parallel);

  bool any() const { return !leaves_.empty(); }  // some triangle moves
  size_t memory_bytes() const;
  // What rays through the scene pay, as the builder's heuristic has it: the sum of half the surface areas of the boxes of all nodes and
  // leaves. Not relative to the root's: what rays there are depends on the camera, not on how far a part flies. A sum in fixed order.
  double cost() const { return still_cost_ + moving_cost_; }

 private:
  struct MovingNode {
    uint32_t node;
    uint8_t slots;  // bit c: something moves in child c
  };
  struct MovingLeaf {
    uint32_t block, triangles;
  };

  std::vector<MovingLeaf> leaves_;
  std::vector<std::vector<MovingNode>> levels_;  // children before parents: those of one level do not depend on each other
  double still_cost_ = 0, moving_cost_ = 0;
};

}  // namespace spanray
