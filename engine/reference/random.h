// Random numbers that are a function of what they are for, so that no path depends on threads or on the order of work.
#pragma once
#include <array>
#include <cstdint>

namespace spanray::reference {

// Philox4x32-10: four words from a counter and a key.
// Source:   Salmon, Moraes, Dror, Shaw 2011, "Parallel Random Numbers: As Easy as 1, 2, 3".
constexpr std::array<uint32_t, 4> philox(std::array<uint32_t, 4> counter, std::array<uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const uint64_t a = uint64_t{0xd2511f53u} * counter[0], b = uint64_t{0xcd9e8d57u} * counter[2];
    counter = {static_cast<uint32_t>(b >> 32) ^ counter[1] ^ key[0], static_cast<uint32_t>(b),
               static_cast<uint32_t>(a >> 32) ^ counter[3] ^ key[1], static_cast<uint32_t>(a)};
    key[0] += 0x9e3779b9u, key[1] += 0xbb67ae85u;
  }
  return counter;
}

// What numbers are drawn for.
enum class Draw : uint32_t { kPixel, kEmitter, kScatter, kLayer };

// One path: its pixel, its number among the paths of the pixel, its branch (16 bits).
struct PathKey {
  uint64_t seed = 0;
  uint32_t pixel = 0, path = 0, branch = 0;

  // Four numbers in (0, 1). bounce: surfaces before this one, 16 bits; index: 28 bits.
  std::array<double, 4> draw(uint32_t bounce, Draw what, uint32_t index = 0) const {
    const std::array<uint32_t, 4> words = philox({pixel, path, branch << 16 | bounce, index << 4 | static_cast<uint32_t>(what)},
                                                 {static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32)});
    std::array<double, 4> out{};
    for (size_t i = 0; i < 4; ++i) out[i] = (words[i] + 0.5) * 0x1p-32;
    return out;
  }
};

}  // namespace spanray::reference
