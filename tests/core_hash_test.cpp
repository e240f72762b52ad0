#include <gtest/gtest.h>

#include <set>

#include "core/hash.h"

namespace spanray {
namespace {

// From a second implementation, in another language: hashes are part of the numeric contract.
TEST(Hash, KnownValues) {
  EXPECT_EQ(mix64(0), 0u);
  EXPECT_EQ(mix64(1), 0xb456bcfc34c2cb2cu);
  EXPECT_EQ(mix64(0xdeadbeefcafebabeu), 0x7082995008f0c48cu);
  EXPECT_EQ(Hash().value(), 0x1d2915560b758d0eu);
  EXPECT_EQ(Hash().add("", 0).value(), 0x7ff702837f25d99bu);
  EXPECT_EQ(Hash().add(std::string("spanray")).value(), 0x83d35b0c6bc99c23u);
  EXPECT_EQ(Hash().add(std::string("spanray!")).value(), 0x4449d8b4811c7f16u);
  EXPECT_EQ(Hash().add_word(~uint64_t{0}).value(), 0x079d464d1b5c948fu);
  unsigned char bytes[100];
  for (unsigned char i = 0; i < 100; ++i) bytes[i] = i;
  EXPECT_EQ(Hash().add(bytes, 100).value(), 0x8e881a4e3541b189u);
}

TEST(Hash, EveryBitOfTheDataCounts) {
  std::string data(37, 'a');
  std::set<uint64_t> seen = {Hash().add(data).value()};
  for (size_t i = 0; i < data.size(); ++i)
    for (int bit = 0; bit < 8; ++bit) {
      data[i] = static_cast<char>(data[i] ^ (1 << bit));
      EXPECT_TRUE(seen.insert(Hash().add(data).value()).second);
      data[i] = static_cast<char>(data[i] ^ (1 << bit));
    }
}

TEST(Hash, LengthOrderAndPartsCount) {
  std::set<uint64_t> seen;
  for (size_t n = 0; n < 40; ++n) EXPECT_TRUE(seen.insert(Hash().add(std::string(n, '\0')).value()).second) << n;
  EXPECT_NE(Hash().add_word(1).add_word(2).value(), Hash().add_word(2).add_word(1).value());
  EXPECT_NE(Hash().add(std::string("ab")).add(std::string("c")).value(), Hash().add(std::string("a")).add(std::string("bc")).value());
}

// One flipped bit of the input flips about half of the output: 32 of 64 on average, never fewer than a few.
TEST(Hash, Avalanche) {
  long flips = 0;
  int fewest = 64;
  for (uint64_t word = 1; word <= 64; ++word)
    for (int bit = 0; bit < 64; ++bit) {
      const int n = __builtin_popcountll(Hash().add_word(word).value() ^ Hash().add_word(word ^ (uint64_t{1} << bit)).value());
      flips += n;
      fewest = n < fewest ? n : fewest;
    }
  EXPECT_NEAR(static_cast<double>(flips) / (64 * 64), 32.0, 0.5);
  EXPECT_GE(fewest, 10);
}

TEST(Hash, TextIsSixteenLowerCaseDigits) {
  EXPECT_EQ(hash_text(0), "0000000000000000");
  EXPECT_EQ(hash_text(0x0123456789abcdefu), "0123456789abcdef");
  EXPECT_EQ(hash_text(~uint64_t{0}), "ffffffffffffffff");
}

}  // namespace
}  // namespace spanray
