#include "render/tile_samples.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

#include "frame/primary_rays.h"
#include "raster/raster.h"
#include "render/tile.h"
#include "render/tile_exact.h"

namespace spanray {
namespace {

// Where row y of a chunk begins in a plane of SampleHits::primitive.
size_t tile_row(const TileGrid& grid, const Chunk& chunk, int y) {
  return static_cast<size_t>((y - grid.y0(chunk.tile)) * kTileSize + chunk.x0 - grid.x0(chunk.tile));
}

// The other engine: traces a chunk once a sample.
void trace_samples(const FrameJob& job, const Chunk& chunk, TileWorker& w, Level& level) {
  w.clock.enter(TileStage::kRaster);
  SampleHits& seen = *w.samples;
  const SamplePlaces& places = job.frame.places;
  for (int y = chunk.y0, i = 0; y < chunk.y1; ++y)
    for (int x = chunk.x0; x < chunk.x0 + chunk.columns; ++x, ++i) level.pixel[i] = pack_pixel(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
  for (int s = 0; s < places.count; ++s) {
    make_primary_batch(job.frame, level.pixel.data(), chunk.pixels(), places.first() + s, seen.rays);
    seen.traced.resize(static_cast<size_t>(chunk.pixels()));
    trace_closest(job.frame, *job.opaque, seen.rays, seen.traced.data());
    if (job.exact != nullptr) add_exact(job, chunk, places.first() + s, w, seen.traced.data());
    w.counts.rays_primary += static_cast<uint64_t>(chunk.pixels());
    for (int y = chunk.y0; y < chunk.y1; ++y)
      std::copy_n(seen.traced.data() + (y - chunk.y0) * chunk.columns, chunk.columns,
                  seen.primitive.data() + s * kSamplePlane + tile_row(job.frame.grid, chunk, y));
    if (!job.frame.plan.translucents) continue;
    trace_layers(job, seen.rays, seen.traced.data(), seen.fragments[s]);
    w.counts.rays_translucent += static_cast<uint64_t>(chunk.pixels());
  }
}

// Counting sort of the chunk's fragments by pixel and sample. False, and nothing else, if there are none.
bool index_fragments(const Chunk& chunk, int samples, SampleHits& seen) {
  const auto for_each = [&](const auto& visit) {
    for (int s = 0; s < samples; ++s) {
      const FragmentList& list = seen.fragments[s];
      for (size_t i = 0; i < list.pixel.size(); ++i) {
        const int x = static_cast<int>(list.pixel[i] & 0xffff) - chunk.x0, y = static_cast<int>(list.pixel[i] >> 16);
        if (x >= 0 && x < chunk.columns && y >= chunk.y0 && y < chunk.y1)
          visit(static_cast<size_t>(((y - chunk.y0) * chunk.columns + x) * samples + s), list.primitive[i]);
      }
    }
  };
  bool any = false;
  for_each([&](size_t, uint32_t) { any = true; });
  if (!any) return false;
  seen.start.assign(static_cast<size_t>(chunk.pixels() * samples) + 2, 0);
  for_each([&](size_t i, uint32_t) { ++seen.start[i + 2]; });
  for (size_t i = 2; i < seen.start.size(); ++i) seen.start[i] += seen.start[i - 1];
  seen.fragment.resize(seen.start.back());
  for_each([&](size_t i, uint32_t primitive) { seen.fragment[seen.start[i + 1]++] = primitive; });
  seen.start.pop_back();
  // Rays find them in no order.
  for (size_t i = 0; i + 1 < seen.start.size(); ++i)
    if (seen.start[i + 1] - seen.start[i] > 1) std::sort(seen.fragment.begin() + seen.start[i], seen.fragment.begin() + seen.start[i + 1]);
  return true;
}

// What the samples of a chunk see. Pixels count from its upper left corner.
class ChunkSamples {
 public:
  // compare: differ() will be asked.
  ChunkSamples(const Frame& frame, const Chunk& chunk, const SampleHits& seen, bool compare) : samples_(frame.places.count) {
    id_ = seen.primitive.data() + tile_row(frame.grid, chunk, chunk.y0);
    for (int y = 0; compare && y < chunk.y1 - chunk.y0; ++y)
      for (int s = 1; s < samples_; ++s) {
        const uint32_t *first = id_ + y * kTileSize, *other = first + s * kSamplePlane;
        for (int x = 0; x < chunk.columns; ++x) differ_[y][x] |= first[x] ^ other[x];
      }
  }
  bool differ(int x, int y) const { return differ_[y][x] != 0; }
  uint32_t first(int x, int y) const { return id_[y * kTileSize + x]; }
  // In an order of samples.
  void get(int x, int y, const int* order, uint32_t id[kMaxSamples]) const {
    for (int r = 0; r < samples_; ++r) id[r] = id_[order[r] * kSamplePlane + y * kTileSize + x];
  }

 private:
  const int samples_;
  const uint32_t* id_;
  uint32_t differ_[kChunkRows][kTileSize] = {};
};

// Fills level 0 and the list of fragments, slot by slot.
class SlotMaker {
 public:
  // level: with room for a slot a sample.
  SlotMaker(const FrameJob& job, TileWorker& worker, Level& level)
      : samples_(job.frame.places.count), one_each_(job.frame.settings.antialiasing == Antialiasing::kSupersample), worker_(worker),
        pixel_(level.pixel.data()), primitive_(level.primitive.data()), place_(level.place.data()), parent_(level.parent.data()) {
    for (int c = 0; c < 3; ++c) weight_[c] = level.weight[c].data();
    const SamplePlaces& places = job.frame.places;
    const auto distance = [&](int s) {
      const int x = places.offset_x_24_8[places.first() + s], y = places.offset_y_24_8[places.first() + s];
      return x * x + y * y;
    };
    std::iota(order_, order_ + samples_, 0);
    std::stable_sort(order_, order_ + samples_, [&](int a, int b) { return distance(a) < distance(b); });
  }
  int slots() const { return slots_; }
  const int* nearest_first() const { return order_; }

  // All samples see the same, and no layers.
  void add_whole(uint32_t parent, uint32_t pixel, uint32_t primitive) { add(parent, pixel, primitive, 0, 1.0f); }

  // id: what the samples see, nearest_first. layers: whether some see translucent ones.
  void add_groups(uint32_t parent, uint32_t pixel, const uint32_t* id, bool layers) {
    for (uint32_t rest = (1u << samples_) - 1; rest != 0;) {
      const int nearest = __builtin_ctz(rest);
      uint32_t same = 0;
      for (int r = 0; r < samples_; ++r) same |= static_cast<uint32_t>(id[r] == id[nearest]) << r;
      if (layers) same &= same_layers(parent, nearest);
      same = one_each_ ? 1u << nearest : same & rest;
      rest &= ~same;
      const int count = __builtin_popcount(same), place = count == samples_ ? 0 : 1 + order_[nearest];
      if (layers) add_fragments(pixel, fragments(parent, nearest));
      add(parent, pixel, id[nearest], place, static_cast<float>(count) / static_cast<float>(samples_));
    }
  }

 private:
  std::span<const uint32_t> fragments(uint32_t parent, int rank) const {
    const SampleHits& seen = *worker_.samples;
    const size_t i = parent * static_cast<size_t>(samples_) + static_cast<size_t>(order_[rank]);
    return {seen.fragment.data() + seen.start[i], seen.start[i + 1] - seen.start[i]};
  }
  uint32_t same_layers(uint32_t parent, int rank) const {
    uint32_t same = 0;
    for (int r = 0; r < samples_; ++r) same |= static_cast<uint32_t>(std::ranges::equal(fragments(parent, r), fragments(parent, rank))) << r;
    return same;
  }
  void add_fragments(uint32_t pixel, std::span<const uint32_t> primitives) {
    FragmentList& list = worker_.chunk_fragments;
    for (const uint32_t primitive : primitives) {
      list.pixel.push_back(pixel), list.ray.push_back(0), list.primitive.push_back(primitive);
      worker_.fragment_slot.push_back(slots_);
    }
  }
  void add(uint32_t parent, uint32_t pixel, uint32_t primitive, int place, float weight) {
    const int i = slots_++;
    pixel_[i] = pixel, primitive_[i] = primitive, place_[i] = static_cast<uint32_t>(place), parent_[i] = parent;
    for (float* w : weight_) w[i] = weight;
  }

  const int samples_;
  const bool one_each_;
  TileWorker& worker_;
  uint32_t *const pixel_, *const primitive_, *const place_, *const parent_;  // of level 0
  float* weight_[3];
  int order_[kMaxSamples];  // samples by distance from the center
  int slots_ = 0;
};

}  // namespace

void make_primary_batch(const Frame& frame, const uint32_t* pixel, int count, int place, RayBatch& rays) {
  rays.resize(count, false);
  rays.primary = true;  // accept(hit) then asks the exact rays, as the rasterizer does
  rays.place = place;
  for (int i = 0; i < count; ++i) {
    const double x = (pixel[i] & 0xffff) + frame.places.x[place], y = (pixel[i] >> 16) + frame.places.y[place];
    float origin[3], direction[3];
    round_primary_ray(frame.primary, x, y, origin, direction);
    for (int k = 0; k < 3; ++k) rays.origin[k][i] = origin[k], rays.direction[k][i] = direction[k];
    rays.t_max[i] = std::numeric_limits<float>::infinity();
    rays.pixel[i] = pixel[i];
  }
}

void trace_layers(const FrameJob& job, const RayBatch& rays, const uint32_t* opaque, FragmentList& out) {
  FragmentList all;
  trace_all(job.frame, *job.translucent, rays, HitsOnEdges::kOfOne, all);
  out.clear();
  const SamplePlaces& places = job.frame.places;
  for (size_t i = 0; i < all.primitive.size(); ++i) {
    const double x = (all.pixel[i] & 0xffff) + places.x[rays.place], y = (all.pixel[i] >> 16) + places.y[rays.place];
    if (depth_at(job.frame, all.primitive[i], x, y) < depth_at(job.frame, opaque[all.ray[i]], x, y)) continue;
    out.pixel.push_back(all.pixel[i]), out.ray.push_back(0), out.primitive.push_back(all.primitive[i]);
  }
}

void rasterize_samples(const FrameJob& job, int tile, TileWorker& w) {
  const SamplePlaces& places = job.frame.places;
  if (!w.samples) w.samples = std::make_unique<SampleHits>();
  w.samples->primitive.resize(static_cast<size_t>(places.count) * kSamplePlane);
  if (job.bins == nullptr) return;
  w.clock.enter(TileStage::kRaster);
  for (int s = 0; s < places.count; ++s) {
    rasterize_tile(job.frame, *job.bins, tile, w.visible, places.first() + s);
    w.counts.add(w.visible);
    if (job.exact != nullptr) w.counts.samples_passed += rasterize_exact(job, tile, places.first() + s, w.visible);
    std::copy_n(w.visible.primitive, kTilePixels, w.samples->primitive.data() + s * kSamplePlane);
    w.samples->fragments[s].clear();
    if (job.frame.plan.translucents)
      rasterize_translucent(job.frame, *job.bins, tile, w.visible, w.samples->fragments[s], places.first() + s);
  }
}

void find_sample_slots(const FrameJob& job, const Chunk& chunk, TileWorker& w, Level& level) {
  SampleHits& seen = *w.samples;
  const int samples = job.frame.places.count;
  const bool translucents = job.frame.plan.translucents, one_each = job.frame.settings.antialiasing == Antialiasing::kSupersample;
  if (job.bins == nullptr) trace_samples(job, chunk, w, level);
  w.clock.enter(TileStage::kRaster);
  w.chunk_fragments.clear(), w.fragment_slot.clear();
  const bool fragments = translucents && index_fragments(chunk, samples, seen);
  level.resize(chunk.pixels() * samples, translucents);
  level.place.resize(static_cast<size_t>(level.slots));
  SlotMaker maker(job, w, level);
  w.pixel_order.make(chunk.columns, chunk.y1 - chunk.y0);
  const ChunkSamples chunk_samples(job.frame, chunk, seen, !one_each);
  for (const uint32_t at : w.pixel_order.pixel()) {
    const int x = static_cast<int>(at & 0xffff), y = static_cast<int>(at >> 16);
    const uint32_t parent = static_cast<uint32_t>(y * chunk.columns + x);
    const size_t first = static_cast<size_t>(parent) * static_cast<size_t>(samples);
    const bool layers = fragments && seen.start[first] != seen.start[first + static_cast<size_t>(samples)];
    const uint32_t pixel = pack_pixel(static_cast<uint32_t>(chunk.x0), static_cast<uint32_t>(chunk.y0)) + at;
    if (!one_each && !layers && !chunk_samples.differ(x, y)) {
      maker.add_whole(parent, pixel, chunk_samples.first(x, y));
    } else {
      uint32_t id[kMaxSamples];
      chunk_samples.get(x, y, maker.nearest_first(), id);
      maker.add_groups(parent, pixel, id, layers);
    }
  }
  level.resize(maker.slots(), translucents);
  level.place.resize(static_cast<size_t>(level.slots));
}

bool is_front_slot(const Level& level, uint32_t slot) {
  return level.place.empty() || slot == 0 || level.parent[slot] != level.parent[slot - 1];
}

void resolve_samples(const Chunk& chunk, const Level& level, TileWorker& w) {
  SampleHits& seen = *w.samples;
  const size_t pixels = static_cast<size_t>(chunk.pixels());
  for (auto& channel : seen.radiance) channel.assign(pixels, 0.0f);
  seen.front_t.resize(pixels), seen.front.resize(pixels);
  uint32_t last_covered = kNoPrimitive;
  for (int slot = 0; slot < level.slots; ++slot) {
    const uint32_t parent = level.parent[slot];
    for (int c = 0; c < 3; ++c) seen.radiance[c][parent] += level.weight[c][slot] * level.radiance[c][slot];
    if (is_front_slot(level, static_cast<uint32_t>(slot))) seen.front_t[parent] = level.opaque_t[slot], seen.front[parent] = level.primitive[slot];
    if (level.primitive[slot] != kNoPrimitive && parent != last_covered) ++w.counts.pixels_covered, last_covered = parent;
  }
}

size_t SampleHits::memory_bytes() const {
  size_t bytes = sizeof(SampleHits) + primitive.bytes() + start.capacity() * sizeof(uint32_t) + fragment.bytes() + rays.memory_bytes() +
                 traced.bytes() + front_t.bytes() + front.bytes();
  for (const FragmentList& list : fragments) bytes += list.memory_bytes();
  for (const auto& channel : radiance) bytes += channel.bytes();
  return bytes;
}

}  // namespace spanray
