// Sets of up to 64 things as words, out of bytes of bits, which may be those of the members only. Included like simd/lanes-inl.h.
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

// bits: eight of each member of a set, lowest member first, eight members a word. Returns the members that have bit b. There are no
// more than 8 * kWords; bits beyond the last one do not matter.
template <int kWords> HWY_INLINE uint64_t members_with(const uint64_t (&bits)[kWords], int b, uint64_t set) {
  uint64_t chosen = 0;  // bit i: member i
#if HWY_TARGET == HWY_AVX3
  for (int w = 0; w < kWords; ++w) chosen |= _pext_u64(bits[w], uint64_t{0x0101010101010101u} << b) << (8 * w);
  return _pdep_u64(chosen, set);
#else
  int i = 0;
  for (uint64_t rest = set; rest != 0; rest &= rest - 1, ++i)
    if ((bits[i / 8] >> (8 * (i % 8) + b) & 1) != 0) chosen |= rest & -rest;
  return chosen;
#endif
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_BIT_SETS_INL_H_
