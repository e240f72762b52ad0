#include "render/slots_kernel.h"

#include <bit>

#include "frame/frame.h"
#include "simd/dispatch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/slots_kernel.cpp"
#include "hwy/foreach_target.h"
#include "simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

HWY_INLINE Mask hits_at(const uint32_t* primitive, int i, int slots) {
  return first_lanes(slots - i) & (I32::load(primitive + i) != i32(kNoPrimitive));
}

int pick_slots(const uint32_t* primitive, const uint32_t* pixel, int slots, uint32_t* slot, uint32_t* hit_primitive, uint32_t* hit_pixel) {
  int hits = 0;
  for (int i = 0; i < slots; i += kLanes) {
    const Mask hit = hits_at(primitive, i, slots);
    if (all(hit)) {
      I32::load(primitive + i).store(hit_primitive + hits), I32::load(pixel + i).store(hit_pixel + hits), lane_iota(i).store(slot + hits);
      hits += kLanes;
      continue;
    }
    compress_store(I32::load(primitive + i), hit, hit_primitive + hits);
    compress_store(I32::load(pixel + i), hit, hit_pixel + hits);
    hits += compress_store(lane_iota(i), hit, slot + hits);
  }
  return hits;
}

void spread_hits(const uint32_t* primitive, int slots, const uint32_t* hits, uint32_t miss, uint32_t* out) {
  for (int i = 0; i < slots; i += kLanes) {
    const Mask hit = hits_at(primitive, i, slots);
    I32 word = i32(miss);
    if (any(hit)) {  // without hits there may be no array of them
      word = select(hit, expand_load(hits, hit), word);
      hits += count(hit);
    }
    word.store(out + i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {

const PickSlotsFn kPickSlots[kIsaCount] = SPANRAY_KERNEL_TABLE(pick_slots);
const SpreadHitsFn kSpreadHits[kIsaCount] = SPANRAY_KERNEL_TABLE(spread_hits);

int pick_slots(Isa isa, const uint32_t* primitive, const uint32_t* pixel, int slots, uint32_t* slot, uint32_t* hit_primitive,
               uint32_t* hit_pixel) {
  return kPickSlots[isa_index(isa)](primitive, pixel, slots, slot, hit_primitive, hit_pixel);
}
void spread_hits(Isa isa, const uint32_t* primitive, int slots, const uint32_t* hits, uint32_t miss, uint32_t* out) {
  kSpreadHits[isa_index(isa)](primitive, slots, hits, miss, out);
}
void spread_hits(Isa isa, const uint32_t* primitive, int slots, const float* hits, float miss, float* out) {
  spread_hits(isa, primitive, slots, reinterpret_cast<const uint32_t*>(hits), std::bit_cast<uint32_t>(miss), reinterpret_cast<uint32_t*>(out));
}

}  // namespace spanray
#endif
