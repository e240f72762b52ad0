// sRGB encoding for lanes: see math/color.h. Included once per target, inside a *_kernel.cpp (simd/dispatch.h).
#if defined(SPANRAY_COLOR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_COLOR_INL_H_
#undef SPANRAY_COLOR_INL_H_
#else
#define SPANRAY_COLOR_INL_H_
#endif

#include "math/color.h"
#include "simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// The sRGB code (0 to 255) nearest to each encoded value; NaN -> 0. Bit for bit srgb8_from_linear.
HWY_INLINE I32 srgb8_from_linear(F32 linear, const SrgbEncodeTable& table) {
  const I32 bits = bits_of(clamp_(linear, f32(0x1p-13f), f32(1.0f)));
  const I32 bin = shift_right<16>(bits) - i32(SrgbEncodeTable::kFirstBin);
  return shift_right_logical<17>(gather(table.entry, bin) + (bits & i32(0xffff)));
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_COLOR_INL_H_
