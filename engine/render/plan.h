// The plan: which stages this scene and these settings need, each with its reason. Derived before anything is computed; a stage
// that is not needed allocates nothing and runs nothing (DESIGN, "only what the scene needs").
#pragma once
#include <vector>

#include "frame/frame.h"
#include "spanray/render.h"
#include "spanray/stats.h"

namespace spanray {

struct Plan {
  PlanFlags flags;
  std::vector<uint32_t> material_flags;  // MaterialFlags by material
  std::vector<PlanLine> lines;           // in the order of the frame
};

// What the primitives of a scene use, found once a scene: settings come later.
struct SceneUse {
  std::vector<bool> material_used;  // by any of them
  bool any_surface = false;
  bool any_smooth = false;          // triangle whose corners have different normals
};
SceneUse find_scene_use(const SceneData& scene);

Plan make_plan(const SceneData& scene, const SceneUse& use, const Settings& settings);

// The plan does not know what else the caller asks for: what surfaces need not have.
void leave_out_unread(const FrameRequest& request, const SceneData& scene, Shading shading, PlanFlags& plan);

}  // namespace spanray
