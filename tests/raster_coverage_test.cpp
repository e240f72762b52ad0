// Exact coverage against the 128-bit oracle, on every instruction set.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "frame/tiles.h"
#include "raster/fixed_point.h"
#include "support/coverage_oracle.h"
#include "support/random.h"
#include "support/test_frame.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster_coverage_test.cpp"
#include "hwy/foreach_target.h"
#include "simd/dispatch.h"
#include "simd/lanes-inl.h"
#include "raster/walk_columns-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
// Pixels [x0[k], x1[k]) of row k of the 64 x 64 pixels from (column, row) on, as the walker of columns finds them; empty where not set.
void scan(const ScreenTriangle& t, int column, int row, int32_t* x0, int32_t* x1) {
  const TileFrame tile{column, row, kTileSize, kTileSize};
  const CornerLanes corners = load_corners(tile, &t, I32::zero());
  const BoxLanes box = box_of(tile, corners);
  if (first_lane(box.x0) >= first_lane(box.x1) || first_lane(box.y0) >= first_lane(box.y1)) return;
  WalkSetups setups;
  setup_walk(corners, box, load_depth(tile, &t, I32::zero()), setups);
  WalkRows rows;
  const int y0 = setups.y0[0], count = setups.y1[0] - y0;
  const uint64_t filled = scan_rows<false>(setups, 0, row + 0.5, rows);
  for (int k = 0; k < count; ++k)
    if ((filled >> k & 1u) != 0) x0[y0 + k] = column + rows.begin[k], x1[y0 + k] = x0[y0 + k] + rows.length[k];
  if (count > kSmallRows) return;
  WalkRows again;
  const uint64_t same = scan_rows<true>(setups, 0, row + 0.5, again);
  for (int k = 0; k < count; ++k)  // a difference shows as a row that nobody expects
    if ((same >> k & 1u) != (filled >> k & 1u) || ((same >> k & 1u) != 0 && (again.begin[k] != rows.begin[k] || again.length[k] != rows.length[k])))
      x0[y0 + k] = column - kTileSize, x1[y0 + k] = column + 2 * kTileSize;
}
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {
namespace {

using ScanFn = void (*)(const ScreenTriangle&, int, int, int32_t*, int32_t*);
const ScanFn kScan[kIsaCount] = SPANRAY_KERNEL_TABLE(scan);

struct Point { int32_t x, y; };
ScreenTriangle triangle(Point a, Point b, Point c) {
  ScreenTriangle t{};
  const Point p[3] = {a, b, c};
  for (int i = 0; i < 3; ++i) t.x_24_8[i] = p[i].x, t.y_24_8[i] = p[i].y;
  return t;
}

// Coverage of one 64 x 64 block: row k has pixels [x0[k], x1[k]).
struct Block {
  int column, row;  // of its first pixel
  int32_t x0[kTileSize], x1[kTileSize];
  bool covers(int x, int y) const { return x >= x0[y - row] && x < x1[y - row]; }
  int pixels() const {
    int n = 0;
    for (int k = 0; k < kTileSize; ++k) n += std::max(0, x1[k] - x0[k]);
    return n;
  }
  bool operator==(const Block& o) const {
    for (int k = 0; k < kTileSize; ++k) {
      const bool empty = x0[k] >= x1[k], other_empty = o.x0[k] >= o.x1[k];
      if (empty != other_empty || (!empty && (x0[k] != o.x0[k] || x1[k] != o.x1[k]))) return false;
    }
    return true;
  }
};

Block scan_block(Isa isa, const ScreenTriangle& t, int column = 0, int row = 0) {
  Block block{column, row, {}, {}};
  kScan[isa_index(isa)](t, column, row, block.x0, block.x1);
  return block;
}

// Every pixel of the block as the oracle has it, on every instruction set. Returns the number of covered pixels.
int expect_oracle(const ScreenTriangle& t, int column, int row) {
  std::vector<Block> blocks;
  for (const Isa isa : supported_isas()) blocks.push_back(scan_block(isa, t, column, row));
  int covered = 0, wrong = 0;
  for (int y = row; y < row + kTileSize; ++y)
    for (int x = column; x < column + kTileSize; ++x) {
      const bool want = oracle_covers(t, x, y);
      covered += want;
      for (const Block& b : blocks) wrong += b.covers(x, y) != want;
    }
  EXPECT_EQ(wrong, 0) << "(" << t.x_24_8[0] << "," << t.y_24_8[0] << ") (" << t.x_24_8[1] << "," << t.y_24_8[1] << ") ("
                      << t.x_24_8[2] << "," << t.y_24_8[2] << ") block " << column << "," << row;
  return covered;
}

constexpr int kCenter = 128;

TEST(RasterCoverage, R1_VerticesOnPixelCenters) {
  const Point a{10 * 256 + kCenter, 5 * 256 + kCenter}, b{30 * 256 + kCenter, 5 * 256 + kCenter};
  const Point c{30 * 256 + kCenter, 45 * 256 + kCenter}, d{10 * 256 + kCenter, 45 * 256 + kCenter};
  for (const Isa isa : supported_isas())
    for (const bool other_diagonal : {false, true}) {
      const Block first = scan_block(isa, other_diagonal ? triangle(a, b, d) : triangle(a, b, c));
      const Block second = scan_block(isa, other_diagonal ? triangle(b, c, d) : triangle(a, c, d));
      for (int y = 0; y < kTileSize; ++y)
        for (int x = 0; x < kTileSize; ++x) {
          // The top and left sides belong to the quad, the bottom and right ones do not.
          const int want = x >= 10 && x < 30 && y >= 5 && y < 45;
          ASSERT_EQ(first.covers(x, y) + second.covers(x, y), want) << x << "," << y;
        }
    }
}

TEST(RasterCoverage, R2_SharedEdgesWhateverTheOrder) {
  TestRandom random(2);
  for (int n = 0; n < 100000; ++n) {
    // Half of them on a half-pixel grid, so that edges run through pixel centers.
    const int grid = n % 2 ? 1 : 128;
    const auto point = [&] { return Point{random.between(-200, 64 * 256 + 200) / grid * grid, random.between(-200, 64 * 256 + 200) / grid * grid}; };
    const Point p[4] = {point(), point(), point(), point()};
    const auto side = [&](Point q) { return int64_t{p[1].x - p[0].x} * (q.y - p[0].y) - int64_t{p[1].y - p[0].y} * (q.x - p[0].x); };
    if ((side(p[2]) > 0) == (side(p[3]) > 0) || side(p[2]) == 0 || side(p[3]) == 0) continue;
    for (const Isa isa : supported_isas()) {
      const Block a = scan_block(isa, triangle(p[0], p[1], p[2])), b = scan_block(isa, triangle(p[1], p[0], p[3]));
      const int order[5][3] = {{1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}};
      const int* o = order[n % 5];
      ASSERT_TRUE(a == scan_block(isa, triangle(p[o[0]], p[o[1]], p[o[2]])));
      for (int k = 0; k < kTileSize; ++k) {
        const bool a_any = a.x0[k] < a.x1[k], b_any = b.x0[k] < b.x1[k];
        if (a_any && b_any) { ASSERT_TRUE(a.x1[k] <= b.x0[k] || b.x1[k] <= a.x0[k]) << n << " row " << k; }
        // Between the two, on the shared edge, no pixel is left out.
        const int64_t y = k * 256 + kCenter, low = std::min(p[0].y, p[1].y), high = std::max(p[0].y, p[1].y);
        if (a_any && b_any && y >= low && y < high) { ASSERT_TRUE(a.x1[k] == b.x0[k] || b.x1[k] == a.x0[k]) << n << " row " << k; }
      }
    }
    if (n % 100 == 0) expect_oracle(triangle(p[0], p[1], p[2]), 0, 0);
  }
}

TEST(RasterCoverage, R4_ThousandSliceFanAroundAPixelCenter) {
  constexpr int kSlices = 1000;
  const Point center{32 * 256 + kCenter, 32 * 256 + kCenter};
  for (const Isa isa : supported_isas()) {
    std::vector<int> count(kTilePixels, 0);
    for (int i = 0; i < kSlices; ++i) {
      const auto rim = [&](int k) {
        const double angle = 2 * 3.141592653589793 * (k % kSlices) / kSlices;
        return Point{center.x + static_cast<int32_t>(std::lround(6000 * std::cos(angle))), center.y + static_cast<int32_t>(std::lround(6000 * std::sin(angle)))};
      };
      const Block b = scan_block(isa, triangle(center, rim(i), rim(i + 1)));
      for (int y = 0; y < kTileSize; ++y)
        for (int x = b.x0[y]; x < b.x1[y]; ++x) ++count[static_cast<size_t>(y * kTileSize + x)];
    }
    for (int y = 0; y < kTileSize; ++y)
      for (int x = 0; x < kTileSize; ++x) {
        const double r = 256 * std::hypot(x - 32, y - 32);
        const int n = count[static_cast<size_t>(y * kTileSize + x)];
        if (r < 5900) { ASSERT_EQ(n, 1) << x << "," << y; }
        ASSERT_LE(n, 1);
        if (r > 6100) { ASSERT_EQ(n, 0); }
      }
  }
}

TEST(RasterCoverage, R5_SliversAreTheOracle) {
  TestRandom random(5);
  int covered = 0;
  for (int n = 0; n < 24; ++n) {
    // 4096 pixels long, 1/256 wide at one end; from straight along an axis to any slope.
    const Point a{random.between(0, 512), random.between(0, 512)};
    const int slope = n < 4 ? 0 : random.between(-4096 * 256, 4096 * 256);
    const bool tall = n % 2;
    const Point b = tall ? Point{a.x + slope, a.y + 4096 * 256} : Point{a.x + 4096 * 256, a.y + slope};
    const Point c = tall ? Point{b.x + 1, b.y} : Point{b.x, b.y + 1};
    const ScreenTriangle t = triangle(a, b, c);
    for (int block = 0; block < 64; block += 3) {
      const int along = block * kTileSize, across = static_cast<int>(int64_t{slope} * block / 64 / 256) + 1 - 32;
      covered += expect_oracle(t, tall ? across : along, tall ? along : across);
    }
  }
  EXPECT_GT(covered, 50);
}

TEST(RasterCoverage, R6_NoAreaNoFragment) {
  TestRandom random(6);
  for (int n = 0; n < 2000; ++n) {
    const Point a{random.between(0, 16000), random.between(0, 16000)};
    const int dx = random.between(-40, 40), dy = random.between(-40, 40), k = random.between(-90, 90);
    const Point b{a.x + 90 * dx, a.y + 90 * dy};
    const Point c = n % 3 == 0 ? a : n % 3 == 1 ? b : Point{a.x + k * dx, a.y + k * dy};
    for (const Isa isa : supported_isas()) ASSERT_EQ(scan_block(isa, triangle(a, b, c)).pixels(), 0);
  }
}

TEST(RasterCoverage, R8_WholePixelShiftsMoveSpansOnly) {
  TestRandom random(8);
  for (int n = 0; n < 3000; ++n) {
    Point p[3];
    for (Point& q : p) q = {random.between(-20000, 40000), random.between(-20000, 40000)};
    const int sx = random.between(-30000, 30000), sy = random.between(-30000, 30000);
    const auto move = [&](Point q) { return Point{q.x + sx * 256, q.y + sy * 256}; };
    for (const Isa isa : supported_isas()) {
      const Block still = scan_block(isa, triangle(p[0], p[1], p[2]));
      Block moved = scan_block(isa, triangle(move(p[0]), move(p[1]), move(p[2])), sx, sy);
      for (int k = 0; k < kTileSize; ++k) {
        if (moved.x0[k] >= moved.x1[k]) continue;
        moved.x0[k] -= sx, moved.x1[k] -= sx;
      }
      ASSERT_TRUE(still == moved) << n;
    }
  }
}

TEST(RasterCoverage, R9_ExtentsUpToTheGuardBandAreTheOracle) {
  TestRandom random(9);
  for (const int32_t extent : {128 * 256, 4096 * 256, kMax_24_8}) {
    int covered = 0, pixels = 0;
    for (int n = 0; n < 150; ++n) {
      const auto coordinate = [&](int32_t e) { return n % 5 == 0 ? (random.bits() % 2 ? e : -e) : random.between(-e, e); };
      const int column = random.between(-(extent / 256), extent / 256 - 64), row = random.between(-(extent / 256), extent / 256 - 64);
      // The first edge runs through the block, mostly.
      const Point through{column * 256 + random.below(64 * 256), row * 256 + random.below(64 * 256)};
      const Point a{coordinate(extent), coordinate(extent)}, c{coordinate(extent), coordinate(extent)};
      const double room = std::min({std::abs((through.x > a.x ? extent - through.x : extent + through.x) / (through.x - a.x + 0.5)),
                                    std::abs((through.y > a.y ? extent - through.y : extent + through.y) / (through.y - a.y + 0.5)), 1e3});
      const auto clamp = [&](double v) { return static_cast<int32_t>(std::clamp(v, -1.0 * extent, 1.0 * extent)); };
      const Point b{clamp(through.x + room * (through.x - a.x)), clamp(through.y + room * (through.y - a.y))};
      covered += expect_oracle(triangle(a, b, c), column, row);
      pixels += kTilePixels;
    }
    EXPECT_GT(covered, pixels / 10);
    EXPECT_LT(covered, pixels * 9 / 10);
  }
}

}  // namespace
}  // namespace spanray
#endif
