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

struct PlaceLanes { F64 x, y; };  // in pixels

// Of entries at .. at + kLanes - 1 of primary hits, whose pixels are given.
HWY_INLINE PlaceLanes places_of(const Frame& frame, const HitBatch& hits, I32 pixel, int at) {
  const F64 x = to_f64(pixel & i32(0xffff)), y = to_f64(shift_right_logical<16>(pixel));
  if (hits.place.empty()) return {x + f64(0.5), y + f64(0.5)};
  const I32 place = I32::load(hits.place.data() + at) & i32(kPlaceMask);  // entries past the last hold anything
  return {x + gather(frame.places.x, place), y + gather(frame.places.y, place)};
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_PLACE_INL_H_
