// PNG and JPEG files to raw samples: for textures (scene/) and pictures (image/). Knows libpng and libjpeg; nothing else does.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "spanray/result.h"
#include "spanray/settings.h"

namespace spanray {

// Samples as they stand in the file: row-major, top row first, channels interleaved, no color management.
struct RawImage {
  int width = 0, height = 0;
  int channels = 0;               // 1 gray, 2 gray + alpha, 3 RGB, 4 RGBA (straight alpha)
  int bits = 8;                   // 8: samples 0..255; 16: samples 0..65535
  std::vector<uint16_t> samples;  // width * height * channels
};

// Decodes a PNG or JPEG file, told apart by its first bytes, never by its name. Palettes become RGB (or RGBA), gray of 1, 2
// and 4 bits becomes 8 bits; gamma, color-profile and orientation chunks are ignored. The same samples everywhere for PNG;
// for JPEG with the same libjpeg (slow integer transform, fancy upsampling).
// Errors, all naming the file: unreadable, empty, another format, truncated, damaged, a side over kMaxImageSide, CMYK JPEG,
// not enough memory.
Result<RawImage> decode_image_file(const std::string& path);
// The same from memory; errors name no file.
Result<RawImage> decode_image(std::string_view bytes);
Result<RawImage> decode_png(std::string_view bytes);
Result<RawImage> decode_jpeg(std::string_view bytes);

bool is_png(std::string_view bytes);
bool is_jpeg(std::string_view bytes);

}  // namespace spanray
