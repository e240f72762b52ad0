// The trees that a renderer keeps from frame to frame.
#pragma once
#include <memory>

#include "ray/bvh_refit.h"
#include "ray/light_grid.h"
#include "render/plan.h"

namespace spanray {

// Opaque and translucent triangles each have a tree. Where parts move, a tree follows by a refit, or is built anew once its cost has
// grown to kMostCost times that of the last build. Which of the two changes no picture.
class RayTrees {
 public:
  // What one frame did.
  struct Work {
    double first_build_ms = 0;     // trees and light grids that were not there yet
    double refit_ms = 0, rebuild_ms = 0;
    uint64_t refits = 0, rebuilds = 0;
  };

  void clear() { opaque_ = {}, translucent_ = {}, grids_.reset(), asked_grids_ = false; }
  // Builds what the plan asks for and is not there yet, and lets what is there follow the scene. moving: of the scene at rest; poses: how
  // often the scene was posed so far.
  // Builds all of them anew if `settings.tree` is another than before.
  Work update(const SceneData& scene, const Plan& plan, const Settings& settings, const std::vector<MovingRun>& moving, uint64_t poses,
              Parallel& parallel);

  const Bvh* opaque() const { return opaque_.bvh.get(); }
  const LightGrids* grids() const { return grids_.get(); }  // of the opaque ones; nullptr: none
  const Bvh* translucent() const { return translucent_.bvh.get(); }
  double grids_build_ms() const { return grids_ ? grids_build_ms_ : 0; }
  double build_ms() const { return opaque_.build_ms + translucent_.build_ms; }  // of the trees that are there
  size_t memory_bytes() const;
  // What the trees are made of.
  struct Makeup {
    int levels = 0;       // of the tree that has most: 2 where parts of instances have their own; 0: there is none
    size_t instances = 0;  // that stand in a tree of two levels; of the tree that has most
    size_t bytes = 0;
  };
  Makeup makeup() const;

  // A choice, not a measured optimum: a build costs as much as 25 refits of the shipped moving scene (docs/decisions/0011-motion.md).
  static constexpr double kMostCost = 1.5;

 private:
  struct Tree {
    std::unique_ptr<Bvh> bvh;
    std::unique_ptr<BvhRefit> refit;  // only where something moves
    double built_cost = 0, build_ms = 0;
    uint64_t poses = 0;               // where its triangles stand
  };
  size_t tree_bytes() const;

  std::vector<uint32_t> flags_;       // of materials, as the trees were built
  TreeQuality quality_ = TreeQuality::kFast;
  Tree opaque_, translucent_;
  std::unique_ptr<LightGrids> grids_;
  double grids_build_ms_ = 0;
  bool asked_grids_ = false;          // a frame before could have used grids
};

// Of the trees of a frame. Builds them, of the scene at rest, and drops them again.
RayTrees::Makeup tree_makeup(const SceneData& scene, const Settings& settings);

}  // namespace spanray
