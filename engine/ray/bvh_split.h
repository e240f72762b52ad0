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

// A quarter of lo + hi: halves of the sum of two finite floats may overflow, and so may the range of such halves.
inline F4 centroid(const Box& b) { return 0.25f * b.lo + 0.25f * b.hi; }

// What a set of references lies in.
struct Bounds {
  Box box = Box::empty(), centroids = Box::empty();
  void add(const Ref& r) { box.add(r.box), centroids.add(Box::of(centroid(r.box))); }
  void add(const Bounds& o) { box.add(o.box), centroids.add(o.centroids); }
};

// References begin to end - 1 of one of two arrays.
struct Range {
  uint32_t begin = 0, end = 0;
  bool second = false;  // which array
  Bounds bounds;
  uint32_t count() const { return end - begin; }
};

// Splits ranges of references, which go from one array to the other on the way down. Results depend on the references only: ranges above
// kSubtreeSize are worked on in fixed chunks, merged by exact minima, maxima and integer sums, by however many threads there are.
class Splitter {
 public:
  // Two arrays of as many references, all in the first. `parallel` may be null: then everything runs in the calling thread, with the
  // same result.
  Splitter(Ref* first, Ref* second, Parallel* parallel) : array_{first, second}, parallel_(parallel) {}

  // The two parts of a range at its best split, both not empty; false if it should rather be a leaf, of at most kBvhWidth references.
  // by_median: halves by count, for trees that grow too deep.
  bool split(const Range& range, bool by_median, Range& left, Range& right) const;
  // Where the references of a range are.
  Ref* refs(const Range& range) const { return array_[range.second] + range.begin; }

 private:
  void halve(const Range& range, Range& left, Range& right) const;
  Ref* array_[2];
  Parallel* parallel_;
};

inline constexpr uint32_t kSubtreeSize = 8192;  // ranges up to this size are one task; larger ones are split in parallel

}  // namespace spanray::bvh
