#include <algorithm>
#include <cstring>

#include "image/encode.h"
#include "simd/dispatch.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "image/encode_kernel.cpp"
#include "hwy/foreach_target.h"
#include "math/color-inl.h"
#include "simd/lanes-inl.h"
HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// Encodes one row of linear radiance to sRGB RGBA8, alpha 255.
// Source:   math/color.h: a table of exact steps instead of pow.
// Input:    three arrays of count floats, any values.   Output: 4 * count bytes.
// Contract: equal to srgb8_from_linear; reads and writes nothing past count.
void encode_row(const float* const radiance[3], int count, const SrgbEncodeTable& table, uint8_t* rgba) {
  const auto encode = [&](const float* r, const float* g, const float* b, uint8_t* out) HWY_ATTR {
    const I32 pixels = srgb8_from_linear(F32::load(r), table) | shift_left<8>(srgb8_from_linear(F32::load(g), table)) |
                       shift_left<16>(srgb8_from_linear(F32::load(b), table)) | i32(0xff000000u);
    pixels.store(reinterpret_cast<int32_t*>(out));
  };
  int i = 0;
  for (; i + kLanes <= count; i += kLanes) encode(radiance[0] + i, radiance[1] + i, radiance[2] + i, rgba + 4 * static_cast<size_t>(i));
  if (i >= count) return;
  float padded[3][kLanes] = {};
  const size_t left = static_cast<size_t>(std::min(kLanes, count - i));
  for (int k = 0; k < 3; ++k) std::memcpy(padded[k], radiance[k] + i, left * sizeof(float));
  alignas(4) uint8_t pixels[4 * kLanes];
  encode(padded[0], padded[1], padded[2], pixels);
  std::memcpy(rgba + 4 * static_cast<size_t>(i), pixels, 4 * left);
}

}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();
#if HWY_ONCE
namespace spanray {

const EncodeRowFn kEncodeRow[kIsaCount] = SPANRAY_KERNEL_TABLE(encode_row);

void encode_row(Isa isa, const float* const radiance[3], int count, uint8_t* rgba) {
  kEncodeRow[isa_index(isa)](radiance, count, srgb_encode_table(), rgba);
}

void encode_row_rgb(Isa isa, const float* rgb, int count, uint8_t* rgba) {
  constexpr int kBlock = 256;
  float planes[3][kBlock];
  const float* const pointers[3] = {planes[0], planes[1], planes[2]};
  for (int begin = 0; begin < count; begin += kBlock) {
    const int n = std::min(kBlock, count - begin);
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < 3; ++k) planes[k][i] = rgb[3 * static_cast<size_t>(begin + i) + static_cast<size_t>(k)];
    encode_row(isa, pointers, n, rgba + 4 * static_cast<size_t>(begin));
  }
}

}  // namespace spanray
#endif
