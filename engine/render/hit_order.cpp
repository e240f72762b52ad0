#include "render/hit_order.h"

#include "scene/scene_data.h"

namespace spanray {

HitOrder::HitOrder() : table_(4096) {}

void HitOrder::make_room(size_t groups) {
  size_t size = table_.size();
  while (size < 2 * groups) size *= 2;
  if (size != table_.size()) table_.assign(size, Entry{}), epoch_ = 0;
  if (++epoch_ == 0) table_.assign(size, Entry{}), epoch_ = 1;  // wrapped around: old entries would look new
}

uint32_t HitOrder::group_of(uint32_t primitive) {
  const size_t mask = table_.size() - 1;
  for (size_t i = (primitive * 0x9e3779b9u) >> 8;; ++i) {  // Fibonacci hashing: neighbouring ids spread
    Entry& e = table_[i & mask];
    if (e.epoch == epoch_ && e.primitive == primitive) return e.group;
    if (e.epoch == epoch_) continue;
    e = {primitive, static_cast<uint32_t>(start_.size()), epoch_};
    start_.push_back(0);
    return e.group;
  }
}

void HitOrder::group(const uint32_t* primitive, int count, AlignedBuffer<uint32_t>& slot_of_hit) {
  runs_.clear();
  start_.clear();
  make_room(static_cast<size_t>(count));
  for (int begin = 0; begin < count;) {
    const uint32_t p = primitive[begin];
    int end = begin + 1;
    while (end < count && primitive[end] == p) ++end;
    if (p != kNoPrimitive) {
      const uint32_t length = static_cast<uint32_t>(end - begin), g = group_of(p);
      runs_.push_back({static_cast<uint32_t>(begin), length, g});
      start_[g] += length;
    }
    begin = end;
  }
  uint32_t hits = 0;
  for (uint32_t& s : start_) {
    const uint32_t n = s;
    s = hits;
    hits += n;
  }
  slot_of_hit.resize(hits);
  for (const Run& run : runs_) {
    uint32_t* const out = slot_of_hit.data() + start_[run.group];
    for (uint32_t i = 0; i < run.length; ++i) out[i] = run.begin + i;
    start_[run.group] += run.length;
  }
}

}  // namespace spanray
