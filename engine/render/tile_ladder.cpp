#include "render/tile_ladder.h"

#include <cstring>

namespace spanray {
namespace {

uint64_t two_floats(float a, float b) {
  uint32_t bits[2];
  std::memcpy(&bits[0], &a, 4);
  std::memcpy(&bits[1], &b, 4);
  return bits[0] | static_cast<uint64_t>(bits[1]) << 32;
}
int x_of(uint32_t pixel) { return static_cast<int>(pixel & 0xffff); }
int y_of(uint32_t pixel) { return static_cast<int>(pixel >> 16); }

}  // namespace

void mix_surfaces(Ladder& ladder, const SurfaceBatch& s) {
  for (int i = 0; i < s.count; ++i) {
    const int x = x_of(s.pixel[i]), y = y_of(s.pixel[i]);
    ladder.mix(Rung::kSurfaces, x, y, s.primitive[i]);
    ladder.mix(Rung::kSurfaces, x, y, two_floats(s.t[i], s.weight[1][i]));
    ladder.mix(Rung::kSurfaces, x, y, two_floats(s.position[0][i], s.position[1][i]));
    ladder.mix(Rung::kSurfaces, x, y, two_floats(s.position[2][i], s.normal[0][i]));
    ladder.mix(Rung::kSurfaces, x, y, two_floats(s.normal[1][i], s.normal[2][i]));
    ladder.mix(Rung::kSurfaces, x, y, two_floats(s.diffuse[0][i], s.diffuse[1][i]));
    ladder.mix(Rung::kSurfaces, x, y, two_floats(s.diffuse[2][i], s.opacity[i]));
  }
}

void mix_shadow_bits(Ladder& ladder, const SurfaceBatch& s, const uint32_t* lit, int light) {
  for (int i = 0; i < s.count; ++i) {
    const uint64_t bit = (lit[i / 32] >> (i % 32)) & 1u;
    ladder.mix(Rung::kShadowBits, x_of(s.pixel[i]), y_of(s.pixel[i]), static_cast<uint64_t>(light) * 2 + bit);
  }
}

void mix_chunk(Ladder& ladder, const FrameJob& job, const Level& level) {
  for (int i = 0; i < level.slots; ++i) {
    const int x = x_of(level.pixel[i]), y = y_of(level.pixel[i]);
    const size_t p = static_cast<size_t>(y) * static_cast<size_t>(job.frame.grid.width) + static_cast<size_t>(x);
    ladder.set_primitive(x, y, level.primitive[i]);
    ladder.mix(Rung::kIds, x, y, level.primitive[i]);
    ladder.mix(Rung::kRadiance, x, y, two_floats(level.radiance[0][i], level.radiance[1][i]));
    ladder.mix(Rung::kRadiance, x, y, two_floats(level.radiance[2][i], 0));
    uint32_t bytes;
    std::memcpy(&bytes, job.out.color.rgba.data() + 4 * p, 4);
    ladder.mix(Rung::kBytes, x, y, bytes);
  }
}

}  // namespace spanray
