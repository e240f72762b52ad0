// Everything that the stages of a frame read, from what the caller gave and what the plan found.
#pragma once
#include "frame/frame.h"
#include "render/plan.h"

namespace spanray {

// Points into scene, plan and parallel, which must outlive it. settings: checked (render/check_request.h).
Frame make_frame(const SceneData& scene, const Camera& camera, const Settings& settings, const Plan& plan, Parallel& parallel);

}  // namespace spanray
