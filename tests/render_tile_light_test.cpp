// From answers of shadow rays to bits of surfaces.
#include "render/tile_light.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "support/random.h"

namespace spanray {
namespace {

// Surfaces with rays in runs of all lengths, between gaps of all lengths.
std::vector<uint32_t> runs_of_surfaces(TestRandom& random, int longest_run, int longest_gap) {
  std::vector<uint32_t> of;
  for (uint32_t at = 0; of.size() < 700;) {
    for (int n = random.between(1, longest_run); n > 0; --n) of.push_back(at++);
    at += static_cast<uint32_t>(random.between(0, longest_gap));
  }
  return of;
}

TEST(TileLight, MarkLitIsBitByBit) {
  TestRandom random(5);
  for (const int longest_run : {1, 9, 40, 200})
    for (const int longest_gap : {0, 1, 3, 70}) {
      const std::vector<uint32_t> of = runs_of_surfaces(random, longest_run, longest_gap);
      for (const size_t rays : {size_t{0}, size_t{1}, size_t{8}, size_t{31}, size_t{32}, size_t{33}, of.size()}) {
        std::vector<uint32_t> occluded(of.size() / 32 + 2), lit(of.back() / 32 + 2, 0), want(lit);
        for (uint32_t& word : occluded) word = random.bits();
        for (size_t i = 0; i < rays; ++i)
          if ((occluded[i / 32] >> (i % 32) & 1) == 0) want[of[i] / 32] |= 1u << (of[i] % 32);
        mark_lit(of.data(), occluded.data(), static_cast<int>(rays), lit.data());
        ASSERT_EQ(lit, want) << rays << " rays, runs up to " << longest_run << ", gaps up to " << longest_gap;
      }
    }
}

}  // namespace
}  // namespace spanray
