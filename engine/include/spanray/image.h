// Pictures in memory and on disk.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "spanray/result.h"

namespace spanray {

// 8 bits a channel, RGBA, sRGB-encoded, straight alpha, row-major, top row first, no padding.
struct Image {
  int width = 0, height = 0;
  std::vector<uint8_t> rgba;  // 4 * width * height
};

// What a frame gave. Arrays that were not asked for stay empty.
struct Framebuffer {
  Image color;
  std::vector<float> radiance;      // linear RGB, 3 * width * height
  // Of the nearest opaque surface, translucent layers left out; with several samples a pixel of that which the sample nearest
  // the center sees, where it was shaded.
  std::vector<float> depth;         // reversed z: near / view depth, 0 = background
  std::vector<uint32_t> primitive;  // triangle index, 0xffffffff = background
  std::vector<float> normal;        // shading normal in world space, bump maps included, unit; 3 * width * height, 0 = background
  std::vector<float> uv;            // texture coordinates of the vertices, interpolated; 2 * width * height, 0 = background
};

// Writes atomically: to a temporary file beside it, then renamed; never a half-written file. text: tEXt chunks (key, value).
Result<void> write_png(const std::string& path, const Image& image,
                       const std::vector<std::pair<std::string, std::string>>& text = {});
// Any PNG, converted to 8-bit RGBA; gamma and color-profile chunks are ignored.
Result<Image> read_png(const std::string& path);
// Hash of width, height and decoded pixels, never of file bytes. The same on every machine.
uint64_t hash_image(const Image& image);

}  // namespace spanray
