// Binned surface-area splits of ranges of primitive references: what bvh_build.cpp assembles nodes from.
#pragma once
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/parallel.h"

namespace spanray::bvh {

// Four numbers in a register, on every x86-64: the compilers' own vectors (GCC and Clang), with IEEE arithmetic lane by lane.
using F4 = float __attribute__((vector_size(16)));
using I4 = int32_t __attribute__((vector_size(16)));
inline F4 least(F4 a, F4 b) { return a < b ? a : b; }
inline F4 greatest(F4 a, F4 b) { return b < a ? a : b; }

// The fourth lane is not part of the box.
struct Box {
  F4 lo, hi;
  static Box empty() {
    constexpr float inf = std::numeric_limits<float>::infinity();
    const F4 far = {inf, inf, inf, inf};
    return {far, -far};
  }
  static Box of(F4 point) { return {point, point}; }
  void add(const Box& o) { lo = least(o.lo, lo), hi = greatest(o.hi, hi); }
  // Of a non-empty box; may be infinite.
  float half_area() const {
    const float x = hi[0] - lo[0], y = hi[1] - lo[1], z = hi[2] - lo[2];
    return x * y + y * z + z * x;
  }
};

// A box with the number of its primitive in the mantissas of the fourth numbers, half here, half there: as numbers they are of ordinary size.
struct Ref {
  Box box;
  void set_primitive(uint32_t p) { box.lo[3] = ordinary(p & kMantissa), box.hi[3] = ordinary(p >> 23); }
  uint32_t primitive() const { return mantissa(box.lo[3]) | mantissa(box.hi[3]) << 23; }

 private:
  static constexpr uint32_t kMantissa = 0x7fffff;
  static float ordinary(uint32_t m) { return std::bit_cast<float>(0x3f800000u | m); }
  static uint32_t mantissa(float x) { return std::bit_cast<uint32_t>(x) & kMantissa; }
};

// A range of references with the way to split it.
struct Range {
  uint32_t begin = 0, end = 0;
  Box box;
  int axis = -1;              // -1: no plane separates the centroids, split in the middle
  int bin = 0;                // references in bins up to this one go left
  float origin = 0, scale = 0;  // bin = (centroid - origin) * scale
  bool leaf = false;
  uint32_t count() const { return end - begin; }
};

// Splits ranges of one array of references in place. Results depend on the references only: ranges above a fixed size are
// worked on in fixed chunks, merged by exact minima, maxima and integer sums, by however many threads there are.
class Splitter {
 public:
  // `parallel` may be null: then everything runs in the calling thread, with the same result.
  Splitter(Ref* refs, Ref* scratch, Parallel* parallel) : refs_(refs), scratch_(scratch), parallel_(parallel) {}

  // Bounds and best split of [begin, end), begin < end. by_median: no surface-area split, for trees that grow too deep.
  Range analyse(uint32_t begin, uint32_t end, bool by_median) const;
  // Reorders a non-leaf range; returns the first index of its right part, begin < middle < end.
  uint32_t partition(const Range& range) const;

 private:
  uint32_t partition_parallel(const Range& range) const;
  Ref* refs_;
  Ref* scratch_;
  Parallel* parallel_;
};

inline constexpr uint32_t kSubtreeSize = 8192;  // ranges up to this size are one task; larger ones are split in parallel

}  // namespace spanray::bvh
