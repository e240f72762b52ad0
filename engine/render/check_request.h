// What a frame may ask for: ranges of settings and camera, checked before anything is computed.
#pragma once
#include "spanray/render.h"

namespace spanray {

inline constexpr int kMaxImageSide = 16384;  // pixels
inline constexpr int kMaxThreads = 1024;
inline constexpr int kMaxBounces = 64;

Result<void> check_request(const Scene& scene, const Camera& camera, const Settings& settings);

}  // namespace spanray
