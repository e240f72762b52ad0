// Asks the filter accept(hit) for a vector of pixels. Included once per target.
#if defined(SPANRAY_ACCEPT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_ACCEPT_INL_H_
#undef SPANRAY_ACCEPT_INL_H_
#else
#define SPANRAY_ACCEPT_INL_H_
#endif

#include "frame/frame.h"
#include "simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// Of the candidates, those that the primitive's mask lets through. Lanes are the pixels (x + lane, y) of the picture.
HWY_INLINE Mask ask_accept(const Frame& frame, uint32_t primitive, int x, int y, Mask candidates, int place) {
  const uint32_t bits = to_bits(candidates);
  return bits == 0 ? candidates : mask_from_bits(frame.accept_row(frame, primitive, x, y, bits, place) & bits);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_ACCEPT_INL_H_
