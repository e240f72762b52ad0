// Whole pictures with several samples a pixel.
#pragma once
#include <gtest/gtest.h>

#include "spanray/render.h"

namespace spanray {

inline constexpr int kPatterns[] = {4, 8, 16};
inline constexpr Antialiasing kModes[] = {Antialiasing::kMultisample, Antialiasing::kSupersample};
inline constexpr Visibility kEngines[] = {Visibility::kRaster, Visibility::kRay};

inline Framebuffer render(const Scene& scene, const Camera& camera, const Settings& settings) {
  Renderer renderer;
  Framebuffer out;
  FrameRequest request;
  request.radiance = request.primitive = request.depth = true;
  const auto stats = renderer.render(scene, camera, settings, out, request);
  EXPECT_TRUE(stats) << stats.error().to_string();
  return out;
}

}  // namespace spanray
