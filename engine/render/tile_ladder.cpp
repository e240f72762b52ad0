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

// What one surface adds to a rung of its pixel: words chained after another, then mixed or (several samples) added as one.
class SurfaceWords {
 public:
  SurfaceWords(const FrameJob& job, Rung rung, const SurfaceBatch& s, const HitBatch& hits, int i)
      : ladder_(*job.request.ladder), rung_(rung), x_(x_of(s.pixel[i])), y_(y_of(s.pixel[i])), add_up_(job.frame.places.count > 1) {
    if (add_up_) *this << (s.primitive[i] | static_cast<uint64_t>(hits.place.empty() ? 0 : hits.place[i]) << 32);
  }
  ~SurfaceWords() { if (add_up_) ladder_.add(rung_, x_, y_, state_); }
  SurfaceWords(const SurfaceWords&) = delete;
  SurfaceWords& operator=(const SurfaceWords&) = delete;
  SurfaceWords& operator<<(uint64_t word) {
    if (add_up_) state_ = mix64(state_ ^ word) + 1;
    else ladder_.mix(rung_, x_, y_, word);
    return *this;
  }

 private:
  Ladder& ladder_;
  const Rung rung_;
  const int x_, y_;
  const bool add_up_;
  uint64_t state_ = 0;
};

}  // namespace

void mix_surfaces(const FrameJob& job, const SurfaceBatch& s, const HitBatch& hits) {
  for (int i = 0; i < s.count; ++i)
    SurfaceWords(job, Rung::kSurfaces, s, hits, i)
        << s.primitive[i] << two_floats(s.t[i], s.weight[1][i]) << two_floats(s.position[0][i], s.position[1][i])
        << two_floats(s.position[2][i], s.normal[0][i]) << two_floats(s.normal[1][i], s.normal[2][i])
        << two_floats(s.diffuse[0][i], s.diffuse[1][i]) << two_floats(s.diffuse[2][i], s.opacity[i]);
}

void mix_shadow_bits(const FrameJob& job, const SurfaceBatch& s, const HitBatch& hits, const uint32_t* lit, int light) {
  for (int i = 0; i < s.count; ++i)
    SurfaceWords(job, Rung::kShadowBits, s, hits, i) << static_cast<uint64_t>(light) * 2 + ((lit[i / 32] >> (i % 32)) & 1u);
}

void mix_chunk(const FrameJob& job, const TileWorker& w, const Chunk& chunk, const ChunkPixels& pixels) {
  Ladder& ladder = *job.request.ladder;
  const TileGrid& grid = job.frame.grid;
  const int samples = job.frame.places.count;
  for (int y = chunk.y0, i = 0; y < chunk.y1; ++y)
    for (int x = chunk.x0; x < chunk.x0 + chunk.columns; ++x, ++i) {
      const int in_tile = (y - grid.y0(chunk.tile)) * kTileSize + x - chunk.x0;
      ladder.set_primitive(x, y, pixels.primitive[i]);
      for (int s = 0; s < samples; ++s)
        ladder.mix(Rung::kIds, x, y, samples == 1 ? pixels.primitive[i] : w.samples->primitive[static_cast<size_t>(s * kSamplePlane + in_tile)]);
      ladder.mix(Rung::kRadiance, x, y, two_floats(pixels.radiance[0][i], pixels.radiance[1][i]));
      ladder.mix(Rung::kRadiance, x, y, two_floats(pixels.radiance[2][i], 0));
      uint32_t bytes;
      std::memcpy(&bytes, job.out.color.rgba.data() + 4 * (static_cast<size_t>(y) * static_cast<size_t>(grid.width) + static_cast<size_t>(x)), 4);
      ladder.mix(Rung::kBytes, x, y, bytes);
    }
}

}  // namespace spanray
