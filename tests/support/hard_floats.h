// Floats and doubles that find mistakes: zeros, subnormals, ties, the limits of integers, infinities, NaN.
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace spanray {

inline float float_of(uint32_t bits) { return std::bit_cast<float>(bits); }

// Quiet NaNs only: a signaling one may come out of arithmetic as another NaN.
inline std::vector<float> hard_floats() {
  std::vector<float> v;
  for (const uint32_t bits : {0x00000000u, 0x00000001u, 0x00000002u, 0x00000003u, 0x00400000u, 0x007fffffu,  // 0, subnormal
                              0x00800000u, 0x00800001u, 0x1e3ce508u, 0x33800000u,                            // 2^-126, 1e-20, 2^-24
                              0x3effffffu, 0x3f000000u, 0x3f000001u, 0x3f7fffffu, 0x3f800000u, 0x3f800001u,  // 1/2, 1 and neighbors
                              0x3fc00000u, 0x40200000u, 0x40600000u, 0x3eaaaaabu,                            // 1.5, 2.5, 3.5, 1/3
                              0x4a7ffffdu, 0x4affffffu, 0x4b000000u, 0x4b7fffffu, 0x4b800000u,               // around 2^22, 2^23, 2^24
                              0x4effffffu, 0x4f000000u, 0x4f000001u, 0x4f800000u, 0x5f000000u,               // 2^31 and beyond
                              0x7e800000u, 0x7f7ffffeu, 0x7f7fffffu, 0x7f800000u, 0x7fc00000u, 0x7fc12345u}) {  // limits, inf, NaN
    v.push_back(float_of(bits));
    v.push_back(float_of(bits | 0x80000000u));
  }
  return v;
}

inline std::vector<int32_t> hard_integers() {
  return {0, 1, -1, 2, -2, 3, 7, 255, 256, 65535, 65536, -65536, 16777215, 16777216, 16777217, 16777219, -16777217, 33554433,
          1431655765, -1431655766, 2147483520, 2147483583, 2147483584, 2147483585, 2147483646, 2147483647, -2147483647, -2147483647 - 1};
}

}  // namespace spanray
