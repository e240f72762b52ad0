// The sRGB transfer function (IEC 61966-2-1), the same bits on every machine.
#pragma once
#include <cstdint>

namespace spanray {

// Nearest 16-bit linear value of an sRGB code: 65535 = 1.0. For texels; exact round trip through srgb8_from_linear(v / 65535.0f).
uint16_t linear16_from_srgb8(uint8_t code);

// Linear value of an sRGB-encoded one in [0, 1]; error <= 0.5001 ulp. Negative or NaN -> 0; above 1 the same curve goes on.
float linear_from_srgb(float encoded);

// The sRGB code nearest to the encoded value. Monotone; negative, -0, -infinity and NaN -> 0; from 1 up -> 255.
// Contract: equal to the number of steps of kSrgbSteps that are <= linear, on every instruction set.
uint8_t srgb8_from_linear(float linear);

// How srgb8_from_linear works, here and in color-inl.h. Code k ends where the encoded value is (k + 1/2) / 255. Floats from
// 2^-13 to 1 fall into bins of 2^16 consecutive values (their upper 16 bits), narrow enough to hold one step at most. An entry
// packs code << 17 (below the step) plus 2^17 - (lower bits of the step): adding the lower 16 bits of a float carries into
// the code from the step on.
struct SrgbEncodeTable {
  static constexpr uint32_t kFirstBits = (127u - 13u) << 23, kLastBits = 127u << 23;  // 2^-13 and 1
  static constexpr uint32_t kFirstBin = kFirstBits >> 16, kBins = (kLastBits >> 16) - kFirstBin + 1;
  uint32_t entry[kBins];
  float step[255];  // step[k]: the least float whose code is k + 1
};
const SrgbEncodeTable& srgb_encode_table();  // built once, thread-safe

}  // namespace spanray
