#include "render/make_frame.h"

#include "frame/primary_rays.h"
#include "scene/default_view.h"
#include "shade/surface.h"

namespace spanray {

Frame make_frame(const SceneData& scene, const Camera& camera, const Settings& settings, const Plan& plan, Parallel& parallel) {
  Frame frame;
  frame.scene = &scene;
  frame.settings = settings;
  frame.plan = plan.flags;
  frame.primary = make_primary_rays(camera, settings.width, settings.height);
  frame.grid = TileGrid(settings.width, settings.height);
  if (plan.flags.samples) {
    frame.places = make_sample_places(settings.samples);
    if (settings.antialiasing == Antialiasing::kSupersample) frame.footprint = frame.places.spacing;
  }
  if (plan.flags.coarse_quads) frame.places.x[kQuadPlace] = frame.places.y[kQuadPlace] = 1;
  frame.isa = resolve_isa(settings.isa);
  frame.parallel = &parallel;
  frame.material_flags = plan.material_flags.data();
  frame.accept_row = accept_row;
  frame.accept_rays = plan.flags.masks ? accept_rays : nullptr;
  if (scene.light_follows_eye) frame.eye_light = default_light(scene, camera);
  return frame;
}

}  // namespace spanray
