// Portable float maps: linear radiance on disk, every bit of it.
#pragma once
#include <string>
#include <vector>

#include "spanray/result.h"

namespace spanray {

// Linear RGB, 3 floats a pixel, row-major, top row first.
struct FloatImage {
  int width = 0, height = 0;
  std::vector<float> rgb;  // 3 * width * height
};

// Writes "PF", little endian, bottom row first as the format wants; atomically (core/atomic_file.h). NaN and infinities are kept.
Result<void> write_pfm(const std::string& path, const FloatImage& image);
// The same as "Pf": one float a pixel, top row first.
Result<void> write_pfm_gray(const std::string& path, int width, int height, const std::vector<float>& values);
// Reads "PF" (RGB) and "Pf" (gray, copied to three channels), both byte orders; the scale's magnitude is ignored.
// Errors: unreadable, another format, a bad header, truncated, a side over 16384.
Result<FloatImage> read_pfm(const std::string& path);

}  // namespace spanray
