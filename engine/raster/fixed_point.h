// Screen positions in 24.8 fixed point: 1/256 of a pixel, centers of pixels at 256 * i + 128.
#pragma once
#include <cmath>
#include <cstdint>

#include "frame/tiles.h"

namespace spanray {

inline constexpr int32_t kSubpixels = 1 << kSubpixelBits;
inline constexpr int32_t kMax_24_8 = kGuardBandPixels * kSubpixels;  // 2^23

// A pixel coordinate to the nearest 1/256, halves up; clamped to the guard band (rounding after a clip may leave it by an ulp).
// The same bits as round_i32 of simd/lanes-inl.h, which the transform kernel uses.
inline int32_t snap_24_8(double pixel) {
  const double v = pixel * kSubpixels;
  if (!(v > -kMax_24_8)) return -kMax_24_8;
  if (v > kMax_24_8) return kMax_24_8;
  const double floor = std::floor(v);
  return static_cast<int32_t>(v - floor < 0.5 ? floor : floor + 1.0);
}

// Index of the first pixel whose center lies at or after x_24_8: ceil((x - 128) / 256).
inline int32_t first_center(int32_t x_24_8) { return (x_24_8 + kSubpixels / 2 - 1) >> kSubpixelBits; }

}  // namespace spanray
