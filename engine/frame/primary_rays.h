// From a camera to the primary rays of a frame.
#pragma once
#include "frame/rays.h"
#include "spanray/camera.h"

namespace spanray {

// Right-handed camera with square pixels: x to the right, pixel row 0 at the top. width, height >= 1; the camera's numbers finite,
// fov_y_degrees in (0, 180), near_plane > 0 (checked by render/). Never fails: a zero view direction looks along -z, an up vector
// (nearly) parallel to it is replaced by an axis that is not.
PrimaryRays make_primary_rays(const Camera& camera, int width, int height);

// The ray through (x, y), in pixels, as visibility engine 2 traces it: from the near plane on, t counts view depth from there.
void round_primary_ray(const PrimaryRays& primary, double x, double y, float (&origin)[3], float (&direction)[3]);

}  // namespace spanray
