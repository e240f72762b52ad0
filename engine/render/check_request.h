// What a frame may ask for: ranges of settings and camera, checked before anything is computed.
#pragma once
#include "spanray/render.h"

namespace spanray {

Result<void> check_camera(const Camera& camera);
Result<void> check_request(const Scene& scene, const Camera& camera, const Settings& settings);

}  // namespace spanray
