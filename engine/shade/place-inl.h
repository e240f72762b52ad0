// Where in the picture primary rays go through. Include inside a *_kernel.cpp (simd/dispatch.h), after the project headers.
#if defined(SPANRAY_PLACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_PLACE_INL_H_
#undef SPANRAY_PLACE_INL_H_
#else
#define SPANRAY_PLACE_INL_H_
#endif

#include "frame/frame.h"
#include "simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

struct OffsetLanes { F32 x, y; };  // from the upper left corner of a pixel, in pixels: exact

// Of entries at .. at + kLanes - 1 of primary hits.
HWY_INLINE OffsetLanes offsets_of(const Frame& frame, const HitBatch& hits, int at) {
  if (hits.place.empty()) return {f32(0.5f), f32(0.5f)};
  const I32 place = I32::load(hits.place.data() + at) & i32(kPlaceMask);  // entries past the last hold anything
  return {to_f32(gather(frame.places.x, place)), to_f32(gather(frame.places.y, place))};
}

// Where in the picture these are.
struct PlaceLanes { F64 x, y; };
HWY_INLINE PlaceLanes places_of(I32 pixel, const OffsetLanes& offset) {
  return {to_f64(pixel & i32(0xffff)) + to_f64(offset.x), to_f64(shift_right_logical<16>(pixel)) + to_f64(offset.y)};
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_PLACE_INL_H_
