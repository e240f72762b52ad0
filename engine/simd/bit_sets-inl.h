// Sets of up to 64 things as words, out of bytes of bits. Included like simd/lanes-inl.h.
#if defined(SPANRAY_BIT_SETS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_BIT_SETS_INL_H_
#undef SPANRAY_BIT_SETS_INL_H_
#else
#define SPANRAY_BIT_SETS_INL_H_
#endif

#include <cstdint>
#include <cstring>

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// Bit i of the result is bit b of bytes[i], for 64 bytes that are aligned to 64.
HWY_INLINE uint64_t set_of_bit(const uint8_t* bytes, int b) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::CappedTag<uint8_t, 64> d;
  uint64_t set = 0;
  for (size_t i = 0; i < 64; i += hn::Lanes(d)) {
    uint8_t mask[8] = {};  // the processors of simd/isa.h are little-endian
    hn::StoreMaskBits(d, hn::TestBit(hn::Load(d, bytes + i), hn::Set(d, static_cast<uint8_t>(1u << b))), mask);
    uint64_t word;
    std::memcpy(&word, mask, sizeof word);
    set |= word << i;
  }
  return set;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_BIT_SETS_INL_H_
