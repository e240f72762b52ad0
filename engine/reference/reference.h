// The ground truth: the renderer's model once more, exactly (and paths.h: physics instead of the model). Plain code in double, one
// ray at a time, without SIMD. It shares with the fast path the scene (its parts where they stand at a time, its default light) and
// the places of samples in a pixel, nothing else.
#pragma once
#include <functional>

#include "spanray/image.h"
#include "spanray/scene.h"

namespace spanray {

struct ReferenceOptions {
  int threads = 0;  // 0: one per processor; changes no value
  // Samples a pixel: 0, as many as the settings say, in their pattern, each shaded on its own (Antialiasing::kSupersample,
  // whatever the settings ask); n from 1 to 64, n x n in multi-jittered places.
  int grid = 0;
  std::function<void(double fraction)> progress = {};  // called now and then, by one thread at a time; may be empty
};

// The picture that settings ask for: radiance (linear RGB, mean of the samples), its bytes, and the primitive at each pixel's
// center. What is modelled: opaque, cut-out, screen-door and blended surfaces; ray-traced shadows and mirrors; textures, height
// and normal maps; flat, Gouraud and Phong shading; all that settings say but visibility, threads and isa, which change nothing
// here. What the fast path approximates and this does not: coverage of snapped vertices, positions and texture weights in few
// bits, shading in float. Errors: a scene with a reflectance or light that this renderer does not know (formulas added by a
// program); settings out of range.
Result<void> render_reference(const Scene& scene, const Camera& camera, const Settings& settings,
                              const ReferenceOptions& options, Framebuffer& out);

}  // namespace spanray
