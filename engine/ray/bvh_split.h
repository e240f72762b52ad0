// Binned surface-area splits of ranges of primitive references: what bvh_build.cpp assembles nodes from.
#pragma once
#include <cstdint>
#include <vector>

#include "core/parallel.h"

namespace spanray::bvh {

struct Box {
  float lo[3], hi[3];
  static Box empty();
  void add(const Box& o);
  float half_area() const;  // of a non-empty box; may be infinite
};

struct Ref {
  Box box;
  uint32_t primitive;
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
