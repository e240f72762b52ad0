// Which slots of a level hit something: packed into a batch, and what the batch became spread over the slots again. The same on
// every instruction set. All arrays have the padding of an AlignedBuffer, and whole vectors are written.
#pragma once
#include <cstdint>

#include "simd/isa.h"

namespace spanray {

// Packs the slots with primitive[slot] != kNoPrimitive, in order: their numbers, primitives and pixels. Returns how many; the outputs
// have room for all.
int pick_slots(Isa isa, const uint32_t* primitive, const uint32_t* pixel, int slots, uint32_t* slot, uint32_t* hit_primitive,
               uint32_t* hit_pixel);

// The way back: one value a hit -> one value a slot, `miss` where nothing is hit.
void spread_hits(Isa isa, const uint32_t* primitive, int slots, const float* hits, float miss, float* out);
void spread_hits(Isa isa, const uint32_t* primitive, int slots, const uint32_t* hits, uint32_t miss, uint32_t* out);

using PickSlotsFn = int (*)(const uint32_t* primitive, const uint32_t* pixel, int slots, uint32_t* slot, uint32_t* hit_primitive,
                            uint32_t* hit_pixel);
using SpreadHitsFn = void (*)(const uint32_t* primitive, int slots, const uint32_t* hits, uint32_t miss, uint32_t* out);
extern const PickSlotsFn kPickSlots[kIsaCount];
extern const SpreadHitsFn kSpreadHits[kIsaCount];

}  // namespace spanray
