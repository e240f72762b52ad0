// Coverage of every walker, triangle by triangle, against exact integers.
#include "support/walker_fuzz.h"

namespace spanray {
namespace {

TEST(RasterWalkers, R9_CoverageOfRandomTrianglesIsTheOracles) { fuzz_walkers(9, 30000, 1); }
TEST(RasterWalkers, R9_CoverageAtSamplesIsTheOracles) { fuzz_walkers(10, 10000, 16); }

// The oracle of the fuzzer is the 128-bit one, only faster.
TEST(RasterWalkers, OraclesAgree) {
  TestRandom random(11);
  const TileGrid grid(150, 141);
  for (int n = 0; n < 300; ++n) {
    const int tile = random.below(grid.count());
    const ScreenTriangle t = fuzzed_triangle(random, grid, tile);
    const TileRows rows = oracle_rows(t, grid, tile, 0, 0);
    for (int y = grid.y0(tile); y < grid.y1(tile); ++y)
      for (int x = grid.x0(tile); x < grid.x1(tile); ++x)
        ASSERT_EQ(rows[static_cast<size_t>(y - grid.y0(tile))] >> (x - grid.x0(tile)) & 1, oracle_covers(t, x, y)) << n << " " << x << "," << y;
  }
}

}  // namespace
}  // namespace spanray
