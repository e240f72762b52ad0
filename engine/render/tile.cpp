// The loop of a tile. Read render_tile first, then shade_levels: the order there is the order of the renderer.
#include "render/tile.h"

#include <algorithm>
#include <utility>

#include "frame/ladder.h"
#include "raster/raster.h"
#include "render/tile_exact.h"
#include "render/tile_hits.h"
#include "render/tile_ladder.h"
#include "render/tile_light.h"
#include "render/tile_output.h"

namespace spanray {
namespace {

int chunk_rows(const Frame& frame) {
  const bool every_sample = frame.places.count > 1 && frame.settings.antialiasing == Antialiasing::kSupersample;
  return every_sample ? kChunkRows / frame.places.count : kChunkRows;
}

void find_primary_hits(const FrameJob& job, const Chunk& chunk, TileWorker& w, Level& level) {
  if (job.bins != nullptr) {
    const int row0 = chunk.y0 - job.frame.grid.y0(chunk.tile), column0 = chunk.x0 - job.frame.grid.x0(chunk.tile);
    w.pixel_order.from_rows(w.visible.primitive + row0 * kTileSize + column0, kTileSize, level.primitive.data());
  } else if (job.frame.plan.primary_rays) {
    make_primary_batch(job.frame, level.pixel.data(), level.slots, 0, level.rays);
    trace_closest(job.frame, *job.opaque, level.rays, level.primitive.data());
    if (job.exact != nullptr) add_exact(job, chunk, w, level);
    w.counts.rays_primary += static_cast<uint64_t>(level.slots);
  } else {
    std::fill_n(level.primitive.data(), level.slots, kNoPrimitive);
  }
}

// shaded: SurfaceBatch or DirectCounts.
template <class Shaded> void count_lanes(const Frame& frame, const Shaded& shaded, FrameCounts& counts) {
  if (frame.plan.lit_vertices) counts.vertices_lit += 3 * shaded.plane_lanes.used;
  counts.plane_lanes.add(shaded.plane_lanes), counts.surface_lanes.add(shaded.surface_lanes);
}

// Level 0 where no surface need be stored: its slots are the hits, among them those that are none.
void shade_slots(const FrameJob& job, TileWorker& w, Level& level) {
  AlignedBuffer<uint32_t>& place = level.shading_place.empty() ? level.place : level.shading_place;
  HitBatch& hits = level.hits;
  const auto lend = [&] { hits.primitive.swap(level.primitive), hits.pixel.swap(level.pixel), hits.place.swap(place); };
  hits.rays = nullptr, hits.count = level.slots, hits.place.clear();
  for (auto& channel : w.radiance) channel.resize(static_cast<size_t>(level.slots) + 64);  // whole vectors are written
  float* const radiance[3] = {w.radiance[0].data(), w.radiance[1].data(), w.radiance[2].data()};
  lend();
  hits.pad();
  const DirectCounts counts = shade_direct(job.frame, hits, level.surfaces.planes, radiance, level.opaque_t.data());
  lend();
  for (int c = 0; c < 3; ++c) std::swap(level.radiance[c], w.radiance[c]);
  hits.count = static_cast<int>(counts.surface_lanes.used);
  count_lanes(job.frame, counts, w.counts);
}

// Opaque surfaces of a level, lit; their radiance goes to the slots, the background to all others, unless only bytes will.
void shade_opaque(const FrameJob& job, TileWorker& w, Level& level, bool primary) {
  w.clock.enter(TileStage::kShade);
  if (can_shade_direct(job.frame)) return shade_slots(job, w, level);
  compact_hits(job.frame, level, primary);
  resolve_surfaces(job.frame, level.hits, level.surfaces);
  count_lanes(job.frame, level.surfaces, w.counts);
  light_surfaces(job, w, level.surfaces, level.hits);
  if (!job.keeps_radiance_of_hits()) scatter_hits(job.frame, w, level);
}

// The tile's rasterized fragments that lie in this chunk, with their slots.
void pick_fragments(const Chunk& chunk, TileWorker& w) {
  w.clock.enter(TileStage::kRaster);
  FragmentList& list = w.chunk_fragments;
  for (size_t i = 0; i < w.fragments.pixel.size(); ++i) {
    const int x = static_cast<int>(w.fragments.pixel[i] & 0xffff), y = static_cast<int>(w.fragments.pixel[i] >> 16);
    if (y < chunk.y0 || y >= chunk.y1 || x < chunk.x0 || x >= chunk.x0 + chunk.columns) continue;
    list.pixel.push_back(w.fragments.pixel[i]);
    list.ray.push_back(0);
    list.primitive.push_back(w.fragments.primitive[i]);
    w.fragment_slot.push_back(w.pixel_order.slot(x - chunk.x0, y - chunk.y0));
  }
}

// All fragments of a chunk before anything is shaded. Samples know theirs already.
void find_fragments(const FrameJob& job, const Chunk& chunk, TileWorker& w, const Level& level) {
  w.chunk_fragments.clear();
  w.fragment_slot.clear();
  if (!job.frame.plan.translucents) return;
  if (job.bins == nullptr) {
    w.clock.enter(TileStage::kBounceRays);
    trace_layers(job, level.rays, level.primitive.data(), w.fragments);
    w.counts.rays_translucent += static_cast<uint64_t>(level.slots);
  }
  pick_fragments(chunk, w);
}

// The translucent surfaces that the level's rays pass through, with their slots.
void trace_fragments(const FrameJob& job, TileWorker& w, Level& level, bool primary) {
  w.clock.enter(TileStage::kBounceRays);
  // A little beyond the opaque hit, since t of the tracer and t of resolve round differently; composite decides by the latter.
  const float start = primary ? static_cast<float>(job.frame.primary.near_plane) : 0.0f;
  for (int i = 0; i < level.slots; ++i) level.rays.t_max[i] = (level.opaque_t[i] - start) * 1.00001f;
  trace_all(job.frame, *job.translucent, level.rays, HitsOnEdges::kOfOne, w.chunk_fragments);
  w.counts.rays_translucent += static_cast<uint64_t>(level.slots);
  for (const uint32_t ray : w.chunk_fragments.ray) w.fragment_slot.push_back(static_cast<int32_t>(ray));
}

void composite_translucents(const FrameJob& job, TileWorker& w, Level& level, bool primary, const Chunk& chunk) {
  std::fill_n(level.transmittance.data(), level.slots, 1.0f);
  if (!primary || (level.place.empty() && level.shading_place.empty())) {  // else they have been found before
    w.chunk_fragments.clear();
    w.fragment_slot.clear();
    if (primary && job.bins != nullptr)
      pick_fragments(chunk, w);
    else
      trace_fragments(job, w, level, primary);
  }
  const FragmentList& list = w.chunk_fragments;
  const int n = static_cast<int>(list.primitive.size());
  if (n == 0) return;
  w.clock.enter(TileStage::kComposite);
  w.counts.fragments_translucent += static_cast<uint64_t>(n);
  HitBatch& hits = w.fragment_hits;
  hits.resize(n, true);
  std::copy_n(list.pixel.data(), n, hits.pixel.data());
  std::copy_n(list.ray.data(), n, hits.ray.data());
  std::copy_n(list.primitive.data(), n, hits.primitive.data());
  hits.place.resize(level.place.empty() ? 0 : static_cast<size_t>(n));
  for (size_t i = 0; i < hits.place.size(); ++i) hits.place[i] = level.place[static_cast<size_t>(w.fragment_slot[i])];
  hits.rays = primary ? nullptr : &level.rays;
  hits.pad();
  resolve_surfaces(job.frame, hits, w.fragment_surfaces);
  count_lanes(job.frame, w.fragment_surfaces, w.counts);
  light_surfaces(job, w, w.fragment_surfaces, hits);
  const float* fragment_radiance[3] = {w.radiance[0].data(), w.radiance[1].data(), w.radiance[2].data()};
  float* radiance[3] = {level.radiance[0].data(), level.radiance[1].data(), level.radiance[2].data()};
  composite(w.fragment_surfaces, w.fragment_slot.data(), fragment_radiance, level.opaque_t.data(), level.slots, radiance,
            level.transmittance.data());
}

// The next level: one slot for each mirror ray. Returns false if there is none.
bool start_bounce(const FrameJob& job, TileWorker& w, Level& level, Level& next) {
  w.clock.enter(TileStage::kBounceRays);
  next.rays.count = 0;
  w.surface_of_ray.clear();
  make_bounce_rays(job.frame, level.surfaces, level.hits, next.rays, w.surface_of_ray);
  const int n = next.rays.count;
  if (n == 0) return false;
  next.resize(n, job.frame.plan.translucents);
  for (int i = 0; i < n; ++i) {
    const uint32_t surface = w.surface_of_ray[i], slot = level.slot_of_hit[surface];
    const float through = job.frame.plan.translucents ? level.transmittance[slot] : 1.0f;
    next.pixel[i] = next.rays.pixel[i];
    next.parent[i] = slot;
    for (int c = 0; c < 3; ++c) next.weight[c][i] = level.surfaces.mirror[c][surface] * through;
  }
  trace_closest(job.frame, *job.opaque, next.rays, next.primitive.data());
  w.counts.rays_bounce += static_cast<uint64_t>(n);
  return true;
}

// Color for all pixels of the quads; and what else somebody asks for, each pixel's own.
void finish_quads(const FrameJob& job, TileWorker& w, Level& level) {
  spread_quads(level);
  if (!job.request.depth && !job.request.normal && !job.request.uv) return;
  w.clock.enter(TileStage::kShade);
  level.shading_place.clear();
  compact_hits(job.frame, level, true);
  resolve_surfaces(job.frame, level.hits, level.surfaces);
  for (int i = 0; i < level.hits.count; ++i) level.opaque_t[level.slot_of_hit[i]] = level.surfaces.t[i];
}

// One level after the other; then the bounces' radiance comes back, last first.
void shade_levels(const FrameJob& job, TileWorker& w, const Chunk& chunk) {
  size_t k = 0;
  for (;; ++k) {
    const bool primary = k == 0;
    Level& level = *w.levels[k];
    shade_opaque(job, w, level, primary);
    if (job.request.ladder != nullptr) mix_surfaces(job, level.surfaces, level.hits);
    if (job.frame.plan.translucents) composite_translucents(job, w, level, primary, chunk);
    if (!job.frame.plan.bounces || k == static_cast<size_t>(job.frame.settings.max_bounces)) break;
    if (w.levels.size() == k + 1) w.levels.push_back(std::make_unique<Level>());
    if (!start_bounce(job, w, level, *w.levels[k + 1])) break;
  }
  for (; k > 0; --k) {
    const Level& from = *w.levels[k];
    Level& to = *w.levels[k - 1];
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i < from.slots; ++i) to.radiance[c][from.parent[i]] += from.weight[c][i] * from.radiance[c][i];
  }
}

// Whether all that anybody asks of the chunk is the background's color.
bool shows_background(const FrameJob& job, const Chunk& chunk, const TileWorker& w) {
  if (job.asks_for_more() || job.bins == nullptr || job.frame.places.count > 1 || !w.fragments.pixel.empty()) return false;
  const uint32_t* row = w.visible.primitive + (chunk.y0 - job.frame.grid.y0(chunk.tile)) * kTileSize;
  for (int y = chunk.y0; y < chunk.y1; ++y, row += kTileSize) {
    uint32_t all = kNoPrimitive;  // no early end within a row: the compiler takes vectors
    for (int x = 0; x < chunk.columns; ++x) all &= row[x];
    if (all != kNoPrimitive) return false;
  }
  return true;
}

}  // namespace

void see_tile(const FrameJob& job, int tile, TileWorker& w) {
  if (job.frame.places.count > 1) {
    rasterize_samples(job, tile, w);
  } else if (job.bins != nullptr) {
    w.clock.enter(TileStage::kRaster);
    rasterize_tile(job.frame, *job.bins, tile, w.visible);
    w.counts.add(w.visible);
    if (job.exact != nullptr) w.counts.samples_passed += rasterize_exact(job, tile, 0, w.visible);
    w.fragments.clear();
    if (job.frame.plan.translucents) rasterize_translucent(job.frame, *job.bins, tile, w.visible, w.fragments);
  }
}

void start_chunk(const FrameJob& job, const Chunk& chunk, TileWorker& w, Level& level) {
  const bool samples = job.frame.places.count > 1;
  w.clock.enter(TileStage::kRaster);
  level.resize(chunk.pixels(), job.frame.plan.translucents);
  if (samples) {
    find_sample_slots(job, chunk, w, level);
  } else {
    w.pixel_order.make(chunk.columns, chunk.y1 - chunk.y0);
    w.pixel_order.name_pixels(pack_pixel(static_cast<uint32_t>(chunk.x0), static_cast<uint32_t>(chunk.y0)), level.pixel.data());
    find_primary_hits(job, chunk, w, level);
  }
  if (!job.frame.plan.coarse_quads) return;
  if (!samples) find_fragments(job, chunk, w, level);
  find_quads(job.frame, chunk, w, level);
}

void render_tile(const FrameJob& job, int tile, TileWorker& w) {
  const TileGrid& grid = job.frame.grid;
  see_tile(job, tile, w);
  if (w.levels.empty()) w.levels.push_back(std::make_unique<Level>());
  Level& level = *w.levels[0];
  level.place.clear(), level.shading_place.clear(), level.quads.clear();
  const int rows = chunk_rows(job.frame);
  for (int y0 = grid.y0(tile); y0 < grid.y1(tile); y0 += rows) {
    const Chunk chunk{tile, grid.x0(tile), grid.x1(tile) - grid.x0(tile), y0, std::min(y0 + rows, grid.y1(tile))};
    if (shows_background(job, chunk, w)) {
      write_background(job, w, chunk);
      continue;
    }
    fetch_output(job, chunk);
    start_chunk(job, chunk, w, level);
    shade_levels(job, w, chunk);
    w.counts.surfaces_shaded += static_cast<uint64_t>(level.hits.count);
    w.counts.quads_shaded += level.quads.size();
    if (level.place.empty()) w.counts.pixels_covered += static_cast<uint64_t>(level.hits.count) + 3 * level.quads.size();
    if (!level.quads.empty()) finish_quads(job, w, level);
    write_chunk(job, w, level, chunk);
  }
  w.clock.stop();
}

void Level::resize(int n, bool translucents) {
  slots = n;
  const size_t size = static_cast<size_t>(n);
  pixel.resize(size), primitive.resize(size), opaque_t.resize(size), parent.resize(size);
  if (translucents) transmittance.resize(size);
  for (int c = 0; c < 3; ++c) radiance[c].resize(size), weight[c].resize(size);
}

size_t Level::memory_bytes() const {
  size_t bytes = rays.memory_bytes() + pixel.bytes() + place.bytes() + primitive.bytes() + opaque_t.bytes() + transmittance.bytes() + parent.bytes() +
                 slot_of_hit.bytes() + surfaces.memory_bytes() + hits.memory_bytes() + quads.capacity() * sizeof(Quad) +
                 shading_place.bytes() + whole_slot.bytes();
  for (int c = 0; c < 3; ++c) bytes += radiance[c].bytes() + weight[c].bytes();
  return bytes;
}

size_t TileWorker::memory_bytes() const {
  size_t bytes = sizeof(TileWorker) + fragments.memory_bytes() + chunk_fragments.memory_bytes() + shadow_rays.memory_bytes() +
                 surface_of_ray.bytes() + occluded.bytes() + lit.bytes() + fragment_hits.memory_bytes() + fragment_slot.bytes() +
                 fragment_surfaces.memory_bytes() + pixel_order.memory_bytes() + row_t.bytes() + row_primitive.bytes() +
                 encoded.bytes() + encoded_hits.bytes();
  for (int c = 0; c < 3; ++c) bytes += radiance[c].bytes() + row_radiance[c].bytes();
  if (samples) bytes += samples->memory_bytes();
  for (const auto& level : levels) bytes += level->memory_bytes();
  return bytes;
}

}  // namespace spanray
