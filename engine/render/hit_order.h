// The order in which a batch of hits is shaded: all hits of a primitive side by side, so that most vectors of lanes see one
// triangle and one material, whose data are then broadcast instead of gathered.
#pragma once
#include <cstdint>
#include <vector>

#include "core/aligned.h"

namespace spanray {

class HitOrder {
 public:
  // Slots that hit something (primitive != kNoPrimitive), by primitive and, within one, by slot. count: at most 2^16 slots.
  // Contract: only the order of shading; an entry's surface and light do not depend on its place (shade/resolve_kernel.cpp).
  void sort(const uint32_t* primitive, int count, AlignedBuffer<uint32_t>& slot_of_hit);
  size_t memory_bytes() const { return runs_.capacity() * sizeof(uint64_t); }

 private:
  std::vector<uint64_t> runs_;  // primitive, first slot, length: 32, 16 and 16 bits
};

}  // namespace spanray
