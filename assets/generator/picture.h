// Textures in memory, painted per pixel, and written as PNG.
#pragma once
#include <functional>
#include <string>

#include "codec/decode.h"
#include "math/vec.h"

namespace spanray::assets {

using Picture = RawImage;  // 1 or 3 channels

// The painters get the center of each texel in [0, 1) with v = 0 at the *bottom* (as texture coordinates do).
Picture paint_color(int width, int height, const std::function<glm::dvec3(double u, double v)>& srgb);
// Values clamped to [0, 1]. bits: 8, or 16 of which the lowest are kept zero so that the file stays small.
Picture paint_gray(int width, int height, int bits, const std::function<double(double u, double v)>& value);

Result<void> write_picture(const std::string& path, const Picture& picture);

}  // namespace spanray::assets
