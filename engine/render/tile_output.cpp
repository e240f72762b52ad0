#include "render/tile_output.h"

#include <algorithm>

#include "image/encode.h"
#include "render/slots_kernel.h"
#include "render/tile_ladder.h"

namespace spanray {
namespace {

// Normals and texture coordinates of a chunk's opaque surfaces, where the caller asked for them.
void write_surfaces(const FrameJob& job, const Level& level, const Chunk& chunk) {
  const size_t width = static_cast<size_t>(job.frame.grid.width), columns = static_cast<size_t>(chunk.columns);
  for (int y = chunk.y0; y < chunk.y1; ++y) {
    const size_t first = static_cast<size_t>(y) * width + static_cast<size_t>(chunk.x0);
    if (job.request.normal) std::fill_n(job.out.normal.begin() + static_cast<ptrdiff_t>(3 * first), 3 * columns, 0.0f);
    if (job.request.uv) std::fill_n(job.out.uv.begin() + static_cast<ptrdiff_t>(2 * first), 2 * columns, 0.0f);
  }
  const SurfaceBatch& s = level.surfaces;
  const SceneData& scene = *job.frame.scene;
  for (int i = 0; i < s.count; ++i) {
    if (!is_front_slot(level, level.slot_of_hit[i])) continue;
    const size_t pixel = static_cast<size_t>(s.pixel[i] >> 16) * width + (s.pixel[i] & 0xffff);
    if (job.request.normal)
      for (size_t k = 0; k < 3; ++k) job.out.normal[3 * pixel + k] = s.normal[k][i];
    if (!scene.is_triangle(s.primitive[i])) continue;  // no texture coordinates: they stay 0
    const uint32_t* vertex = scene.triangles[s.primitive[i]].vertex;
    if (job.request.uv)
      for (size_t k = 0; k < 2; ++k)
        job.out.uv[2 * pixel + k] = s.weight[0][i] * scene.vertices[vertex[0]].uv[k] + s.weight[1][i] * scene.vertices[vertex[1]].uv[k] +
                                    s.weight[2][i] * scene.vertices[vertex[2]].uv[k];
  }
}

ChunkPixels pixels_of(const Chunk& chunk, const Level& level, TileWorker& w) {
  const size_t pixels = static_cast<size_t>(chunk.pixels());
  const auto to_rows = [&](const auto& slots, auto& rows) {
    rows.resize(pixels);
    w.pixel_order.to_rows(slots.data(), chunk.columns, rows.data());
    return rows.data();
  };
  const auto channel = [&](size_t c) { return to_rows(level.radiance[c], w.row_radiance[c]); };
  return {{channel(0), channel(1), channel(2)}, to_rows(level.opaque_t, w.row_t), to_rows(level.primitive, w.row_primitive)};
}
ChunkPixels pixels_of(const SampleHits& s) {
  return {{s.radiance[0].data(), s.radiance[1].data(), s.radiance[2].data()}, s.front_t.data(), s.front.data()};
}

// The bytes of a chunk's first pixel.
uint8_t* first_byte(const FrameJob& job, const Chunk& chunk) {
  const size_t width = static_cast<size_t>(job.frame.grid.width);
  return job.out.color.rgba.data() + 4 * (static_cast<size_t>(chunk.y0) * width + static_cast<size_t>(chunk.x0));
}

uint32_t background_color(const FrameJob& job) {
  const float* const background = job.frame.scene->background;
  const float* const radiance[3] = {background, background + 1, background + 2};
  uint32_t color = 0;
  encode_row(job.frame.isa, radiance, 1, reinterpret_cast<uint8_t*>(&color));
  return color;
}

void encode(const FrameJob& job, const AlignedBuffer<float> (&radiance)[3], int count, AlignedBuffer<uint32_t>& bytes) {
  const float* const channels[3] = {radiance[0].data(), radiance[1].data(), radiance[2].data()};
  bytes.resize(static_cast<size_t>(count));
  encode_row(job.frame.isa, channels, count, reinterpret_cast<uint8_t*>(bytes.data()));
}

// By slot of level 0, one sample a pixel.
const uint32_t* encode_slots(const FrameJob& job, TileWorker& w, const Level& level) {
  if (!job.keeps_radiance_of_hits()) {
    encode(job, level.radiance, level.slots, w.encoded);
    return w.encoded.data();
  }
  encode(job, w.radiance, level.hits.count, w.encoded_hits);
  if (level.hits.count == level.slots) return w.encoded_hits.data();
  w.encoded.resize(static_cast<size_t>(level.slots));
  spread_hits(job.frame.isa, level.primitive.data(), level.slots, w.encoded_hits.data(), background_color(job), w.encoded.data());
  return w.encoded.data();
}

// Radiance of a chunk -> bytes.
void encode_chunk(const FrameJob& job, TileWorker& w, const Level& level, const Chunk& chunk) {
  const size_t width = static_cast<size_t>(job.frame.grid.width);
  uint8_t* const out = first_byte(job, chunk);
  if (level.place.empty()) {
    w.pixel_order.to_rows(encode_slots(job, w, level), job.frame.grid.width, reinterpret_cast<uint32_t*>(out));
    return;
  }
  const size_t columns = static_cast<size_t>(chunk.columns);
  for (size_t row = 0; row < static_cast<size_t>(chunk.y1 - chunk.y0); ++row) {
    const auto& from = w.samples->radiance;
    const float* radiance[3] = {from[0].data() + row * columns, from[1].data() + row * columns, from[2].data() + row * columns};
    encode_row(job.frame.isa, radiance, chunk.columns, out + 4 * row * width);
  }
}

// The arrays that the caller asked for.
void write_extras(const FrameJob& job, const ChunkPixels& pixels, const Chunk& chunk) {
  for (int y = chunk.y0; y < chunk.y1; ++y) {
    const size_t slot = static_cast<size_t>((y - chunk.y0) * chunk.columns);
    const size_t pixel = static_cast<size_t>(y) * static_cast<size_t>(job.frame.grid.width) + static_cast<size_t>(chunk.x0);
    for (size_t i = 0; i < static_cast<size_t>(chunk.columns); ++i) {
      if (job.request.radiance)
        for (size_t c = 0; c < 3; ++c) job.out.radiance[3 * (pixel + i) + c] = pixels.radiance[c][slot + i];
      // t of a miss is infinite: its depth is 0, the background's.
      if (job.request.depth) job.out.depth[pixel + i] = static_cast<float>(job.frame.primary.near_plane) / pixels.opaque_t[slot + i];
      if (job.request.primitive) job.out.primitive[pixel + i] = pixels.primitive[slot + i];
    }
  }
}

}  // namespace

void fetch_output(const FrameJob& job, const Chunk& chunk) {
  constexpr int kLine = 64;
  const uint8_t* row = first_byte(job, chunk);
  for (int y = chunk.y0; y < chunk.y1; ++y, row += 4 * static_cast<size_t>(job.frame.grid.width))
    for (int i = 0; i < 4 * chunk.columns; i += kLine) __builtin_prefetch(row + i, 1);
}

void write_background(const FrameJob& job, TileWorker& w, const Chunk& chunk) {
  w.clock.enter(TileStage::kEncode);
  const uint32_t color = background_color(job);
  const size_t width = static_cast<size_t>(job.frame.grid.width);
  uint8_t* row = first_byte(job, chunk);
  for (int y = chunk.y0; y < chunk.y1; ++y, row += 4 * width) std::fill_n(reinterpret_cast<uint32_t*>(row), chunk.columns, color);
}

void write_chunk(const FrameJob& job, TileWorker& w, const Level& level, const Chunk& chunk) {
  w.clock.enter(TileStage::kEncode);
  const bool samples = !level.place.empty();
  if (samples) resolve_samples(chunk, level, w);
  encode_chunk(job, w, level, chunk);
  const FrameRequest& request = job.request;
  if (request.normal || request.uv) write_surfaces(job, level, chunk);
  if (!request.radiance && !request.depth && !request.primitive && request.ladder == nullptr) return;
  const ChunkPixels pixels = samples ? pixels_of(*w.samples) : pixels_of(chunk, level, w);
  write_extras(job, pixels, chunk);
  if (request.ladder != nullptr) mix_chunk(job, w, chunk, pixels);
}

}  // namespace spanray
