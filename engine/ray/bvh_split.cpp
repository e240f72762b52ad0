#include "ray/bvh_split.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>

#include "ray/bvh_data.h"

namespace spanray::bvh {
namespace {

constexpr int kMostBins = 16, kLeastBins = 4;
constexpr uint32_t kRefsOfABin = 2;   // small ranges have fewer bins: they are many, and sweeps over bins most of their time
constexpr ptrdiff_t kTwoSets = 128;   // references; see Bins::fill()
constexpr uint32_t kChunk = 8192;     // references of a task where a larger range is worked on
constexpr float kTraversalCost = 0.4f;  // of one binary level of an eight-wide node, in units of one block test

struct BinGrid {
  F4 origin, scale;  // bin = (centroid - origin) * scale, in [0, bins); scale 0: the axis has no extent
  int bins;
  I4 bins_of(const Box& b) const { return __builtin_convertvector((centroid(b) - origin) * scale, I4); }
};

BinGrid make_grid(const Box& c, uint32_t n) {
  BinGrid g{F4{}, F4{}, std::clamp(static_cast<int>(n / kRefsOfABin), kLeastBins, kMostBins)};
  for (int k = 0; k < 3; ++k) {
    const float extent = c.hi[k] - c.lo[k];
    g.origin[k] = c.lo[k];
    g.scale[k] = extent > 1e-36f ? static_cast<float>(g.bins) * 0.9999f / extent : 0.0f;
  }
  return g;
}

// The same bin of the three axes side by side.
struct Bins {
  Box box[kMostBins][3];
  int32_t count[kMostBins][4];
  explicit Bins(int bins = kMostBins) {
    for (int b = 0; b < bins; ++b) {
      for (Box& of_axis : box[b]) of_axis = Box::empty();
      std::fill_n(count[b], 4, 0);
    }
  }
  void add(const Bins& o, int bins = kMostBins) {
    for (int b = 0; b < bins; ++b)
      for (int k = 0; k < 3; ++k) box[b][k].add(o.box[b][k]), count[b][k] += o.count[b][k];
  }
  void add(const Ref& r, const BinGrid& grid) {
    const Box b = r.box;
    const I4 at = grid.bins_of(b);
    for (int k = 0; k < 3; ++k) {
      const auto bin = static_cast<uint32_t>(at[k]);
      box[bin][k].add(b), ++count[bin][k];
    }
  }
  // Neighbours often fall into one bin, and each waits for the one before it to be stored: so two halves take turns, in bins of their own.
  void fill(const Ref* begin, const Ref* end, const BinGrid& grid) {
    if (end - begin < kTwoSets) {
      for (const Ref* r = begin; r < end; ++r) add(*r, grid);
      return;
    }
    Bins other(grid.bins);
    const ptrdiff_t half = (end - begin) / 2;
    for (ptrdiff_t i = 0; i < half; ++i) add(begin[i], grid), other.add(begin[half + i], grid);
    if (((end - begin) & 1) != 0) add(end[-1], grid);
    add(other, grid.bins);
  }
};

// Half the surface areas of three boxes.
F4 half_areas(const Box (&b)[3]) {
  const F4 d0 = b[0].hi - b[0].lo, d1 = b[1].hi - b[1].lo, d2 = b[2].hi - b[2].lo;
  const F4 low = __builtin_shufflevector(d0, d1, 0, 4, 1, 5), high = __builtin_shufflevector(d0, d1, 2, 6, 3, 7);
  const F4 x = __builtin_shufflevector(low, d2, 0, 1, 4, 4), y = __builtin_shufflevector(low, d2, 2, 3, 5, 5);
  const F4 z = __builtin_shufflevector(high, d2, 0, 1, 6, 6);
  return x * y + y * z + z * x;
}

// Blocks of eight cost the same however full: this fills leaves.
F4 block_costs(const Box (&box)[3], I4 count) {
  return half_areas(box) * __builtin_convertvector((count + (kBvhWidth - 1)) >> 3, F4);
}

// The references in bins up to `bin` of an axis go left. Axis -1: no plane separates the centroids.
struct Cut {
  int axis = -1, bin = 0;
  float cost = std::numeric_limits<float>::infinity();
};

I4 load(const int32_t (&four)[4]) { return I4{four[0], four[1], four[2], four[3]}; }

// The cheapest plane over all axes; ties to the first. Lanes are axes.
Cut choose_cut(const Bins& bins, const BinGrid& grid) {
  F4 right_cost[kMostBins];
  I4 right_count[kMostBins];
  Box box[3] = {Box::empty(), Box::empty(), Box::empty()};
  I4 count{};
  for (int b = grid.bins - 1; b > 0; --b) {
    for (int k = 0; k < 3; ++k) box[k].add(bins.box[b][k]);
    count += load(bins.count[b]);
    right_cost[b] = block_costs(box, count), right_count[b] = count;
  }
  constexpr float inf = std::numeric_limits<float>::infinity();
  F4 best = {inf, inf, inf, inf};
  I4 best_bin{};
  std::fill_n(box, 3, Box::empty()), count = I4{};
  for (int b = 0; b + 1 < grid.bins; ++b) {
    for (int k = 0; k < 3; ++k) box[k].add(bins.box[b][k]);
    count += load(bins.count[b]);
    const F4 cost = block_costs(box, count) + right_cost[b + 1];
    const I4 better = (cost < best) & (count > 0) & (right_count[b + 1] > 0);
    best = better ? cost : best;
    best_bin = better ? I4{b, b, b, b} : best_bin;
  }
  Cut cut;
  for (int k = 0; k < 3; ++k)
    if (grid.scale[k] != 0.0f && best[k] < cut.cost) cut = {k, best_bin[k], best[k]};
  return cut;
}

// Where a part of a split is being written.
struct Parts {
  Ref *left, *right;         // the next ones
  ptrdiff_t right_step;
  Box left_centroids = Box::empty(), right_centroids = Box::empty();
};

// Copies references to their parts, without branches: they would go wrong every third time.
template <int kAxis> void distribute(const Ref* begin, const Ref* end, const BinGrid& grid, int bin, Parts& parts) {
  Ref *left = parts.left, *right = parts.right;
  Box in_left = parts.left_centroids, in_right = parts.right_centroids;
  const ptrdiff_t step = parts.right_step;
  for (const Ref* r = begin; r < end; ++r) {
    const Ref ref = *r;
    const F4 c = centroid(ref.box);
    const I4 at = __builtin_convertvector((c - grid.origin) * grid.scale, I4);
    const I4 goes_left = __builtin_shufflevector(at, at, kAxis, kAxis, kAxis, kAxis) <= bin;
    // NaN is neither less nor greater.
    const F4 if_left = reinterpret_cast<F4>(reinterpret_cast<I4>(c) | ~goes_left);
    const F4 if_right = reinterpret_cast<F4>(reinterpret_cast<I4>(c) | goes_left);
    in_left.add(Box::of(if_left)), in_right.add(Box::of(if_right));
    const bool l = goes_left[0] != 0;
    *(l ? left : right) = ref;
    left += l, right += l ? 0 : step;
  }
  parts = {left, right, step, in_left, in_right};
}

void distribute(const Ref* begin, const Ref* end, const BinGrid& grid, const Cut& cut, Parts& parts) {
  if (cut.axis == 0) distribute<0>(begin, end, grid, cut.bin, parts);
  else if (cut.axis == 1) distribute<1>(begin, end, grid, cut.bin, parts);
  else distribute<2>(begin, end, grid, cut.bin, parts);
}

// The boxes of the two parts, and where the second begins.
void take_boxes(const Bins& bins, const BinGrid& grid, const Cut& cut, Range& left, Range& right) {
  uint32_t count = 0;
  for (int b = 0; b < grid.bins; ++b) {
    (b <= cut.bin ? left : right).bounds.box.add(bins.box[b][cut.axis]);
    if (b <= cut.bin) count += static_cast<uint32_t>(bins.count[b][cut.axis]);
  }
  left.end = right.begin = left.begin + count;
}

uint32_t chunks_of(const Range& range) { return (range.count() + kChunk - 1) / kChunk; }

void for_chunks(const Range& range, Parallel* parallel,
                const std::function<void(uint32_t chunk, uint32_t first, uint32_t last)>& work) {
  const auto one = [&](size_t c, int) {
    const uint32_t first = static_cast<uint32_t>(c) * kChunk;  // from the range's begin
    work(static_cast<uint32_t>(c), first, std::min(first + kChunk, range.count()));
  };
  if (parallel != nullptr) return parallel->for_each(chunks_of(range), one);
  for (uint32_t c = 0; c < chunks_of(range); ++c) one(c, 0);
}

// A stable partition has one result, whoever computes it: each chunk knows from its bins how many it has for the left.
void distribute_chunks(const Range& range, Parallel* parallel, const Ref* from, Ref* to, const std::vector<Bins>& bins,
                       const BinGrid& grid, const Cut& cut, Range& left, Range& right) {
  std::vector<Parts> parts(bins.size());
  Ref *to_left = to, *to_right = to + left.count();
  for (size_t c = 0; c < bins.size(); ++c) {
    parts[c] = {to_left, to_right, 1};
    uint32_t goes_left = 0;
    for (int b = 0; b <= cut.bin; ++b) goes_left += static_cast<uint32_t>(bins[c].count[b][cut.axis]);
    to_left += goes_left;
    to_right += std::min(kChunk, range.count() - static_cast<uint32_t>(c) * kChunk) - goes_left;
  }
  for_chunks(range, parallel, [&](uint32_t c, uint32_t first, uint32_t last) {
    distribute(from + first, from + last, grid, cut, parts[c]);
  });
  for (const Parts& p : parts) left.bounds.centroids.add(p.left_centroids), right.bounds.centroids.add(p.right_centroids);
}

}  // namespace

void Splitter::halve(const Range& range, Range& left, Range& right) const {
  left.end = right.begin = range.begin + range.count() / 2;
  left.second = right.second = range.second;
  for (Range* part : {&left, &right})
    for (const Ref *r = refs(*part), *end = r + part->count(); r < end; ++r) part->bounds.add(*r);
}

bool Splitter::split(const Range& range, bool by_median, Range& left, Range& right) const {
  const uint32_t n = range.count();
  if (n <= (by_median ? uint32_t{kBvhWidth} : 2u)) return false;
  left = right = Range{range.begin, range.end, !range.second, {}};
  if (by_median) {
    halve(range, left, right);
    return true;
  }
  const Ref* const from = refs(range);
  const BinGrid grid = make_grid(range.bounds.centroids, n);
  const bool whole = n <= kSubtreeSize;
  Bins bins(grid.bins);
  std::vector<Bins> chunk_bins(whole ? 0 : chunks_of(range));
  if (whole) {
    bins.fill(from, from + n, grid);
  } else {
    for_chunks(range, parallel_, [&](uint32_t c, uint32_t first, uint32_t last) {
      chunk_bins[c].fill(from + first, from + last, grid);
    });
    for (const Bins& b : chunk_bins) bins.add(b);
  }
  const Cut cut = choose_cut(bins, grid);
  const float area = range.bounds.box.half_area();
  if (n <= kBvhWidth && !(kTraversalCost * area + cut.cost < area)) return false;
  if (cut.axis < 0) {
    halve(range, left, right);
    return true;
  }
  take_boxes(bins, grid, cut, left, right);
  Ref* const to = array_[left.second] + range.begin;
  if (!whole) {
    distribute_chunks(range, parallel_, from, to, chunk_bins, grid, cut, left, right);
    return true;
  }
  Parts parts{to, to + n - 1, -1};
  distribute(from, from + n, grid, cut, parts);
  left.bounds.centroids = parts.left_centroids, right.bounds.centroids = parts.right_centroids;
  return true;
}

}  // namespace spanray::bvh
