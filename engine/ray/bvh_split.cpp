#include "ray/bvh_split.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>

#include "ray/bvh_data.h"

namespace spanray::bvh {
namespace {

constexpr int kBins = 16;
constexpr uint32_t kChunk = 8192;
constexpr float kTraversalCost = 0.4f;  // of one binary level of an eight-wide node, in units of one block test

// A quarter of lo + hi: halves of the sum of two finite floats may overflow, and so may the range of such halves.
F4 centroid(const Box& b) { return 0.25f * b.lo + 0.25f * b.hi; }

struct Bounds {
  Box box = Box::empty();
  Box centroids = Box::empty();
};

struct BinGrid {
  F4 origin, scale;  // bin = (centroid - origin) * scale, in [0, kBins); scale 0: the axis has no extent
};

struct Bins {
  Box box[3][kBins];
  uint32_t count[3][kBins];
  Bins() {
    for (int k = 0; k < 3; ++k)
      for (int b = 0; b < kBins; ++b) box[k][b] = Box::empty(), count[k][b] = 0;
  }
  void add(const Bins& o) {
    for (int k = 0; k < 3; ++k)
      for (int b = 0; b < kBins; ++b) box[k][b].add(o.box[k][b]), count[k][b] += o.count[k][b];
  }
};

Bounds bounds_of(const Ref* refs, uint32_t begin, uint32_t end) {
  Bounds r;
  for (uint32_t i = begin; i < end; ++i) {
    r.box.add(refs[i].box), r.centroids.add(Box::of(centroid(refs[i].box)));
  }
  return r;
}

BinGrid make_grid(const Box& c) {
  BinGrid g{F4{}, F4{}};
  for (int k = 0; k < 3; ++k) {
    const float extent = c.hi[k] - c.lo[k];
    g.origin[k] = c.lo[k];
    g.scale[k] = extent > 1e-36f ? static_cast<float>(kBins) * 0.9999f / extent : 0.0f;
  }
  return g;
}

void fill_bins(const Ref* refs, uint32_t begin, uint32_t end, const BinGrid& grid, Bins& bins) {
  for (uint32_t i = begin; i < end; ++i) {
    const Box b = refs[i].box;
    const I4 at = __builtin_convertvector((centroid(b) - grid.origin) * grid.scale, I4);
    for (int k = 0; k < 3; ++k) bins.box[k][at[k]].add(b), ++bins.count[k][at[k]];
  }
}

// Blocks of eight cost the same however full: this fills leaves.
float block_cost(const Box& box, uint32_t count) {
  return box.half_area() * static_cast<float>((count + kBvhWidth - 1) / kBvhWidth);
}

// The cheapest plane over all axes; ties to the first. Leaves range.axis at -1 if no plane separates anything.
float choose_split(const Bins& bins, const BinGrid& grid, Range& range) {
  float best = std::numeric_limits<float>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (grid.scale[k] == 0.0f) continue;
    float right_cost[kBins];
    uint32_t right_count[kBins];
    Box box = Box::empty();
    uint32_t count = 0;
    for (int b = kBins - 1; b > 0; --b) {
      box.add(bins.box[k][b]);
      count += bins.count[k][b];
      right_cost[b] = count > 0 ? block_cost(box, count) : 0.0f;
      right_count[b] = count;
    }
    box = Box::empty(), count = 0;
    for (int b = 0; b + 1 < kBins; ++b) {
      box.add(bins.box[k][b]);
      count += bins.count[k][b];
      if (count == 0 || right_count[b + 1] == 0) continue;
      const float cost = block_cost(box, count) + right_cost[b + 1];
      if (cost < best) {
        best = cost;
        range.axis = k, range.bin = b, range.origin = grid.origin[k], range.scale = grid.scale[k];
      }
    }
  }
  return best;
}

bool goes_left(const Ref& ref, const Range& r) { return static_cast<int>((centroid(ref.box)[r.axis] - r.origin) * r.scale) <= r.bin; }

}  // namespace

Range Splitter::analyse(uint32_t begin, uint32_t end, bool by_median) const {
  Range range;
  range.begin = begin, range.end = end;
  const uint32_t n = end - begin;
  const uint32_t chunks = n > kSubtreeSize ? (n + kChunk - 1) / kChunk : 1;
  const auto for_chunks = [&](const std::function<void(uint32_t, uint32_t, uint32_t)>& work) {
    const auto one = [&](size_t c, int) {
      const uint32_t first = begin + static_cast<uint32_t>(c) * kChunk;
      work(static_cast<uint32_t>(c), first, std::min(first + kChunk, end));
    };
    if (parallel_ != nullptr) return parallel_->for_each(chunks, one);
    for (uint32_t c = 0; c < chunks; ++c) one(c, 0);
  };

  Bounds bounds;
  if (chunks == 1) {
    bounds = bounds_of(refs_, begin, end);
  } else {
    std::vector<Bounds> parts(chunks);
    for_chunks([&](uint32_t c, uint32_t a, uint32_t b) { parts[c] = bounds_of(refs_, a, b); });
    for (const Bounds& p : parts) bounds.box.add(p.box), bounds.centroids.add(p.centroids);
  }
  range.box = bounds.box;
  range.leaf = n <= 2;
  if (range.leaf || by_median) {
    range.leaf = n <= kBvhWidth;
    return range;
  }

  const BinGrid grid = make_grid(bounds.centroids);
  Bins bins;
  if (chunks == 1) {
    fill_bins(refs_, begin, end, grid, bins);
  } else {
    std::vector<Bins> parts(chunks);
    for_chunks([&](uint32_t c, uint32_t a, uint32_t b) { fill_bins(refs_, a, b, grid, parts[c]); });
    for (const Bins& p : parts) bins.add(p);
  }
  const float cost = choose_split(bins, grid, range);
  const float area = range.box.half_area();
  range.leaf = n <= kBvhWidth && !(kTraversalCost * area + cost < area);
  return range;
}

uint32_t Splitter::partition(const Range& range) const {
  if (range.axis < 0) return range.begin + range.count() / 2;
  if (range.count() > kSubtreeSize) return partition_parallel(range);
  Ref* const middle =
      std::partition(refs_ + range.begin, refs_ + range.end, [&](const Ref& r) { return goes_left(r, range); });
  return static_cast<uint32_t>(middle - refs_);
}

// A stable partition has one result, whoever computes it: counts a chunk, prefix sums, scatter, copy back.
uint32_t Splitter::partition_parallel(const Range& range) const {
  const uint32_t chunks = (range.count() + kChunk - 1) / kChunk;
  std::vector<uint32_t> left(chunks);
  const auto first = [&](size_t c) { return range.begin + static_cast<uint32_t>(c) * kChunk; };
  const auto last = [&](size_t c) { return std::min(first(c) + kChunk, range.end); };
  const auto run = [&](const std::function<void(size_t, int)>& body) {
    if (parallel_ != nullptr) return parallel_->for_each(chunks, body);
    for (uint32_t c = 0; c < chunks; ++c) body(c, 0);
  };
  run([&](size_t c, int) {
    left[c] = static_cast<uint32_t>(std::count_if(refs_ + first(c), refs_ + last(c), [&](const Ref& r) { return goes_left(r, range); }));
  });
  uint32_t total = 0;
  for (uint32_t& l : left) total += std::exchange(l, total);
  run([&](size_t c, int) {
    uint32_t to_left = range.begin + left[c], to_right = range.begin + total + (first(c) - range.begin) - left[c];
    for (uint32_t i = first(c); i < last(c); ++i) scratch_[goes_left(refs_[i], range) ? to_left++ : to_right++] = refs_[i];
  });
  run([&](size_t c, int) { std::copy(scratch_ + first(c), scratch_ + last(c), refs_ + first(c)); });
  return range.begin + total;
}

}  // namespace spanray::bvh
