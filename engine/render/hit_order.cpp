#include "render/hit_order.h"

#include <algorithm>

#include "scene/scene_data.h"

namespace spanray {

void HitOrder::sort(const uint32_t* primitive, int count, AlignedBuffer<uint32_t>& slot_of_hit) {
  runs_.clear();
  size_t hits = 0;
  for (int begin = 0; begin < count;) {
    const uint32_t p = primitive[begin];
    int end = begin + 1;
    while (end < count && primitive[end] == p) ++end;
    // A run of 2^16 slots would not fit its 16 bits; its length is stored less one.
    if (p != kNoPrimitive) {
      runs_.push_back(uint64_t{p} << 32 | static_cast<uint64_t>(begin) << 16 | static_cast<uint64_t>(end - begin - 1));
      hits += static_cast<size_t>(end - begin);
    }
    begin = end;
  }
  std::sort(runs_.begin(), runs_.end());
  slot_of_hit.resize(hits);
  uint32_t* next = slot_of_hit.data();
  for (const uint64_t run : runs_) {
    const uint32_t begin = static_cast<uint32_t>(run >> 16) & 0xffffu, length = (static_cast<uint32_t>(run) & 0xffffu) + 1;
    for (uint32_t i = 0; i < length; ++i) *next++ = begin + i;
  }
}

}  // namespace spanray
