#include "render/ray_trees.h"

#include <algorithm>
#include <new>

#include "core/timed.h"

namespace spanray {

RayTrees::Work RayTrees::update(const SceneData& scene, const Plan& plan, const Settings& settings,
                                const std::vector<MovingRun>& moving, uint64_t poses, Parallel& parallel) {
  if (flags_ != plan.material_flags || quality_ != settings.tree) {
    clear();
    flags_ = plan.material_flags, quality_ = settings.tree;
  }
  Work work;
  const auto build = [&](uint32_t value, Tree& tree) {
    Tree built;  // all of it or nothing, should memory run out
    built.build_ms = timed_ms([&] {
      built.bvh = std::make_unique<Bvh>(build_bvh(scene, flags_.data(), kMaterialTranslucent, value, parallel, quality_, !moving.empty()));
      if (!moving.empty()) built.refit = std::make_unique<BvhRefit>(*built.bvh, moving);
    });
    if (built.refit) built.built_cost = built.refit->cost();
    built.poses = poses;
    tree = std::move(built);
    return tree.build_ms;
  };
  const auto follow = [&](bool needed, uint32_t value, Tree& tree) {
    if (!needed || (tree.bvh && tree.poses == poses)) return;
    if (!tree.bvh) return void(work.first_build_ms += build(value, tree));
    if (!tree.refit->any()) return;
    work.refit_ms += timed_ms([&] { tree.refit->refit(scene, *tree.bvh, parallel); });
    tree.poses = poses;
    if (tree.refit->cost() <= kMostCost * tree.built_cost) return void(++work.refits);
    work.rebuild_ms += build(value, tree);
    ++work.rebuilds;
  };
  follow(plan.flags.bvh, 0, opaque_);
  follow(plan.flags.translucent_bvh, kMaterialTranslucent, translucent_);
  if (settings.light_grids == LightGridUse::kNever) grids_.reset();
  if (plan.flags.light_grids && !grids_ && (asked_grids_ || settings.light_grids == LightGridUse::kAlways)) {
    std::unique_ptr<LightGrids> built;
    grids_build_ms_ = timed_ms([&] {
      try {
        built = std::make_unique<LightGrids>(scene, flags_.data(), *opaque_.bvh, parallel);
      } catch (const std::bad_alloc&) {  // the tree answers as well
        built = std::make_unique<LightGrids>();
      }
    });
    work.first_build_ms += grids_build_ms_;
    grids_ = std::move(built);
  }
  asked_grids_ = asked_grids_ || plan.flags.light_grids;
  return work;
}

RayTrees::Makeup RayTrees::makeup() const {
  Makeup all;
  for (const Tree* tree : {&opaque_, &translucent_})
    if (tree->bvh) all.levels = std::max(all.levels, tree->bvh->levels()), all.instances = std::max(all.instances, tree->bvh->instance_count());
  all.bytes = tree_bytes();
  return all;
}

RayTrees::Makeup tree_makeup(const SceneData& scene, const Settings& settings) {
  Parallel parallel(settings.threads);
  RayTrees trees;
  Settings trees_only = settings;
  trees_only.light_grids = LightGridUse::kNever;
  trees.update(scene, make_plan(scene, find_scene_use(scene), trees_only), trees_only, scene.moving_triangles, 0, parallel);
  return trees.makeup();
}

size_t RayTrees::memory_bytes() const { return tree_bytes() + (grids_ ? grids_->memory_bytes() : 0); }

size_t RayTrees::tree_bytes() const {
  size_t bytes = 0;
  for (const Tree* tree : {&opaque_, &translucent_}) {
    if (tree->bvh) bytes += tree->bvh->memory_bytes();
    if (tree->refit) bytes += tree->refit->memory_bytes();
  }
  return bytes;
}

}  // namespace spanray
