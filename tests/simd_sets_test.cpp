// Sets of bits (simd/bit_sets-inl.h) and vectors of two halves (simd/pairs-inl.h), on every instruction set, against a scalar model.
#include <gtest/gtest.h>

#include <bit>

#include "support/every_isa.h"
#include "support/random.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd_sets_test.cpp"
#include "hwy/foreach_target.h"
#include "simd/bit_sets-inl.h"
#include "simd/dispatch.h"
#include "simd/pairs-inl.h"
HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

void sets_kernel(const uint8_t* bytes, const uint64_t (&words)[4], uint64_t set, uint64_t* of_bytes, uint64_t* of_words) {
  for (int b = 0; b < 8; ++b) of_bytes[b] = set_of_bit(bytes, b), of_words[b] = members_with(words, b, set);
}

// False where there are no pairs.
bool pairs_kernel(const float* eight, float a, float b, float* both, float* split) {
  if (!kHasPairs) return false;
  twice(eight).store(both), halves(a, b).store(split);
  return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();
#if HWY_ONCE
namespace spanray {
namespace {

using SetsFn = void (*)(const uint8_t*, const uint64_t (&)[4], uint64_t, uint64_t*, uint64_t*);
const SetsFn kSets[kIsaCount] = SPANRAY_KERNEL_TABLE(sets_kernel);
using PairsFn = bool (*)(const float*, float, float, float*, float*);
const PairsFn kPairs[kIsaCount] = SPANRAY_KERNEL_TABLE(pairs_kernel);

uint64_t random_word(TestRandom& random) {
  uint64_t word = 0;
  for (int i = 0; i < 4; ++i) word = word << 16 | static_cast<uint64_t>(random.below(1 << 16));
  return word;
}

// Sets of no, one, few, 31 and 32 members, at both ends of the word; all bits behind the last member are random.
TEST(SimdSets, BitsOfMembersEqualBitsOfBytes) {
  TestRandom random(43);
  for (int round = 0; round < 400; ++round) {
    const int size = round % 34 == 33 ? 32 : round % 34 % 33;
    uint64_t set = 0;
    const auto place = [&]() -> uint32_t {
      if (round % 3 == 0) return random.below(64);
      return round % 3 == 1 ? random.below(33) : 63 - random.below(33);
    };
    while (std::popcount(set) < size) set |= uint64_t{1} << place();
    alignas(64) uint8_t bytes[64] = {};
    uint64_t words[4];
    for (uint64_t& word : words) word = random_word(random);
    int member = 0;
    for (uint64_t rest = set; rest != 0; rest &= rest - 1, ++member)
      bytes[std::countr_zero(rest)] = static_cast<uint8_t>(words[member / 8] >> (8 * (member % 8)));
    on_every_isa([&](int isa) {
      uint64_t of_bytes[8], of_words[8];
      kSets[isa](bytes, words, set, of_bytes, of_words);
      for (int b = 0; b < 8; ++b) {
        uint64_t want = 0;
        for (int i = 0; i < 64; ++i) want |= static_cast<uint64_t>(bytes[i] >> b & 1) << i;
        ASSERT_EQ(of_bytes[b], want) << "bit " << b;
        ASSERT_EQ(of_words[b], want) << "bit " << b << " of " << size << " members";
      }
    });
  }
}

TEST(SimdSets, HalvesOfPairs) {
  const float eight[8] = {0, -1, 2, 3, 4, 5, 6, 7};
  int with_pairs = 0;
  on_every_isa([&](int isa) {
    alignas(64) float both[16], split[16];
    if (!kPairs[isa](eight, 1.5f, -0.0f, both, split)) return;
    ++with_pairs;
    for (int i = 0; i < 16; ++i) {
      EXPECT_EQ(both[i], eight[i % 8]) << i;
      EXPECT_EQ(std::bit_cast<uint32_t>(split[i]), std::bit_cast<uint32_t>(i < 8 ? 1.5f : -0.0f)) << i;
    }
  });
  EXPECT_EQ(with_pairs, isa_supported(Isa::kAvx512) ? 1 : 0);
}

}  // namespace
}  // namespace spanray
#endif
