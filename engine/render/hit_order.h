// The order in which the hits of bounce rays are shaded: all hits of a primitive side by side, so that most vectors of lanes see one
// triangle and one material, whose data are then broadcast instead of gathered.
#pragma once
#include <cstdint>
#include <vector>

#include "core/aligned.h"

namespace spanray {

class HitOrder {
 public:
  HitOrder();
  // Slots that hit something (primitive != kNoPrimitive): primitives in order of their first slot, slots of one in order.
  // Contract: only the order of shading; an entry's surface and light do not depend on its place (shade/resolve_kernel.cpp).
  void group(const uint32_t* primitive, int count, AlignedBuffer<uint32_t>& slot_of_hit);
  size_t memory_bytes() const {
    return start_.capacity() * sizeof(uint32_t) + runs_.capacity() * sizeof(Run) +
           table_.capacity() * sizeof(Entry);
  }

 private:
  struct Run { uint32_t begin, length, group; };
  struct Entry { uint32_t primitive, group, epoch; };  // of an older epoch: empty
  uint32_t group_of(uint32_t primitive);
  void make_room(size_t groups);

  std::vector<Run> runs_;         // neighbours of one primitive
  std::vector<uint32_t> start_;   // of each group: its number of slots, then its place in the order
  std::vector<Entry> table_;      // by hash of the primitive; at most half full
  uint32_t epoch_ = 0;
};

}  // namespace spanray
