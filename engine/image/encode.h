// Linear radiance to picture bytes.
#pragma once
#include <cstdint>

#include "math/color.h"
#include "simd/isa.h"

namespace spanray {

// Encodes one row: rgba[4 i + k] = srgb8_from_linear(radiance[k][i]), alpha 255, 0 <= i < count. Arrays of `count`; no padding is
// read or written. `isa` is concrete and supported. The same bytes on every instruction set.
void encode_row(Isa isa, const float* const radiance[3], int count, uint8_t* rgba);

// The same from interleaved linear RGB (Framebuffer::radiance).
void encode_row_rgb(Isa isa, const float* rgb, int count, uint8_t* rgba);

using EncodeRowFn = void (*)(const float* const radiance[3], int count, const SrgbEncodeTable& table, uint8_t* rgba);
extern const EncodeRowFn kEncodeRow[kIsaCount];

// Straight channel of a premultiplied one: nearest to 255 * value / alpha, halves up, at most 255; 0 where alpha is 0. In integers.
inline uint8_t straight_from_premultiplied(uint8_t value, uint8_t alpha) {
  if (alpha == 0) return 0;
  const unsigned straight = (2u * 255u * value + alpha) / (2u * alpha);
  return static_cast<uint8_t>(straight < 255u ? straight : 255u);
}

}  // namespace spanray
