#include "math/color.h"

#include <bit>

#include "core/fp_env.h"
#include "math/elementary.h"

namespace spanray {
namespace {

double decode(double encoded) { return encoded <= 0.04045 ? encoded / 12.92 : pow_((encoded + 0.055) / 1.055, 2.4); }

float least_float_not_below(double x) {  // x > 0
  const float f = static_cast<float>(x);
  return f >= x ? f : std::bit_cast<float>(std::bit_cast<uint32_t>(f) + 1);
}

SrgbEncodeTable make_encode_table() {
  const FpEnvGuard guard;  // whoever asks first must not decide the rounding
  SrgbEncodeTable table;
  for (int k = 0; k < 255; ++k) table.step[k] = least_float_not_below(decode((k + 0.5) / 255));
  uint32_t code = 0;
  for (uint32_t bin = 0; bin < SrgbEncodeTable::kBins; ++bin) {
    const uint32_t next_bits = (SrgbEncodeTable::kFirstBin + bin + 1) << 16;
    const uint32_t step_bits = code < 255 ? std::bit_cast<uint32_t>(table.step[code]) : 0xffffffffu;
    const bool steps = step_bits < next_bits;
    table.entry[bin] = (code << 17) + (steps ? (1u << 17) - (step_bits & 0xffff) : 0);
    code += steps;
  }
  return table;
}

struct LinearTable {
  uint16_t value[256];
  LinearTable() {
    const FpEnvGuard guard;
    for (int k = 0; k < 256; ++k) value[k] = static_cast<uint16_t>(decode(k / 255.0) * 65535 + 0.5);
  }
};

}  // namespace

const SrgbEncodeTable& srgb_encode_table() {
  static const SrgbEncodeTable table = make_encode_table();
  return table;
}

uint16_t linear16_from_srgb8(uint8_t code) {
  static const LinearTable table;
  return table.value[code];
}

float linear_from_srgb(float encoded) { return encoded > 0 ? static_cast<float>(decode(encoded)) : 0.0f; }

uint8_t srgb8_from_linear(float linear) {
  if (!(linear > 0x1p-13f)) return 0;
  if (linear >= 1.0f) return 255;
  const uint32_t bits = std::bit_cast<uint32_t>(linear);
  return static_cast<uint8_t>((srgb_encode_table().entry[(bits >> 16) - SrgbEncodeTable::kFirstBin] + (bits & 0xffff)) >> 17);
}

}  // namespace spanray
