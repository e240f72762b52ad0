// Coverage of triangles that are on the screen already, in 24.8, against exact integers (R1, R2, R4, R5, R6, R8, R9).
#include "cases.h"

#include <cmath>

#include "support/fuzzed_triangle.h"
#include "support/tile_probe.h"

namespace spanray::hard {
namespace {

struct Point { int32_t x, y; };
constexpr int kCenter = 128;  // of a pixel

ScreenTriangle triangle(Point a, Point b, Point c) {
  ScreenTriangle t{};
  const Point p[3] = {a, b, c};
  for (int i = 0; i < 3; ++i) t.x_24_8[i] = p[i].x, t.y_24_8[i] = p[i].y;
  t.depth0 = 0.5, t.depth_min = 0.25f, t.depth_max = 0.75f;
  return t;
}

Point on_center(int column, int row) { return {column * 256 + kCenter, row * 256 + kCenter}; }

TileRows exact(const TileProbe& probe, const ScreenTriangle& t, int tile) { return oracle_rows(t, probe.grid(), tile, 0, 0); }

}  // namespace

// The top and left sides belong to the quad, the bottom and right ones do not.
Finding r1_vertices_on_centers(const Effort& effort) {
  TileProbe probe(150, 141);
  Tally pixels;
  for (const Isa isa : supported_isas()) {
    probe.frame().isa = isa;
    TestRandom random(1);
    for (int n = 0; n < effort.count(isa, 600, 60); ++n) {
      const int x0 = random.between(0, 90), y0 = random.between(0, 90), x1 = x0 + random.between(1, 59), y1 = y0 + random.between(1, 50);
      const Point a = on_center(x0, y0), b = on_center(x1, y0), c = on_center(x1, y1), d = on_center(x0, y1);
      std::vector<int> count;
      probe.add(n % 2 != 0 ? triangle(a, b, d) : triangle(a, b, c), count);
      probe.add(n % 2 != 0 ? triangle(b, c, d) : triangle(a, c, d), count);
      for (int y = 0; y < 141; ++y)
        for (int x = 0; x < 150; ++x)
          pixels.check(count[static_cast<size_t>(y * 150 + x)] == int{x >= x0 && x < x1 && y >= y0 && y < y1});
    }
  }
  return none_wrong(pixels, "pixels", 1000000);
}

// Both triangles as the oracle has them, none over the other, whatever the order of the vertices.
Finding r2_shared_edges(const Effort& effort) {
  TileProbe probe(64, 64);
  Tally edges;
  uint64_t covered = 0;
  for (const Isa isa : supported_isas()) {
    probe.frame().isa = isa;
    TestRandom random(2);
    for (int n = 0, edge = 0; edge < effort.count(isa, 100000, 10000); ++n) {
      const int grid = n % 2 != 0 ? 1 : 128;  // half of them on half pixels, so that edges run through centers
      const auto coordinate = [&] { return random.between(-200, 64 * 256 + 200) / grid * grid; };
      Point p[4];
      for (Point& q : p) q.x = coordinate(), q.y = coordinate();
      const auto side = [&](Point q) { return int64_t{p[1].x - p[0].x} * (q.y - p[0].y) - int64_t{p[1].y - p[0].y} * (q.x - p[0].x); };
      if ((side(p[2]) > 0) == (side(p[3]) > 0) || side(p[2]) == 0 || side(p[3]) == 0) continue;
      ++edge;
      const ScreenTriangle one = triangle(p[0], p[1], p[2]), other = triangle(p[1], p[0], p[3]);
      const int order[5][3] = {{1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}};
      const int* const o = order[n % 5];
      const TileRows a = probe.rows(one, 0), b = probe.rows(other, 0);
      int wrong = count_differences(a, exact(probe, one, 0)) + count_differences(b, exact(probe, other, 0)) +
                  count_differences(a, probe.rows(triangle(p[o[0]], p[o[1]], p[o[2]]), 0));
      for (size_t row = 0; row < kTileSize; ++row) wrong += __builtin_popcountll(a[row] & b[row]);
      covered += static_cast<uint64_t>(count_bits(a) + count_bits(b));
      edges.check(wrong == 0);
    }
  }
  return none_wrong(edges, "edges", 10000, grouped(covered) + " pixels covered");
}

Finding r4_fan(const Effort&) {
  constexpr int kSlices = 1000;
  TileProbe probe(64, 64);
  const Point center = on_center(32, 32);
  Tally pixels;
  for (const Isa isa : supported_isas()) {
    probe.frame().isa = isa;
    std::vector<int> count;
    const auto rim = [&](int k) {
      const double angle = 2 * 3.141592653589793 * (k % kSlices) / kSlices;
      return Point{center.x + static_cast<int32_t>(std::lround(6000 * std::cos(angle))),
                   center.y + static_cast<int32_t>(std::lround(6000 * std::sin(angle)))};
    };
    for (int i = 0; i < kSlices; ++i) probe.add(triangle(center, rim(i), rim(i + 1)), count);
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        const double r = 256 * std::hypot(x - 32, y - 32);
        const int n = count[static_cast<size_t>(y * 64 + x)];
        pixels.check(n <= 1 && (r > 5900 || n == 1) && (r < 6100 || n == 0));
      }
  }
  return none_wrong(pixels, "pixels", 4096);
}

// 4096 pixels long, 1/256 wide at one end; along an axis and at any slope. Tiles along them.
Finding r5_slivers(const Effort& effort) {
  TileProbe probe(4160, 4160);
  Tally pixels;
  uint64_t covered = 0;
  for (const Isa isa : supported_isas()) {
    probe.frame().isa = isa;
    TestRandom random(5);
    for (int n = 0; n < effort.count(isa, 400, 40); ++n) {
      const Point a{random.between(0, 512), random.between(0, 512)};
      const int slope = n % 6 == 0 ? 0 : random.between(0, 4096 * 256);
      const bool tall = n % 2 != 0;
      const Point b = tall ? Point{a.x + slope, a.y + 4096 * 256} : Point{a.x + 4096 * 256, a.y + slope};
      const ScreenTriangle t = triangle(a, b, tall ? Point{b.x + 1, b.y} : Point{b.x, b.y + 1});
      for (int block = 0; block < 64; block += 3) {
        const int across = static_cast<int>(int64_t{slope} * block / 64 / 256 / kTileSize);
        const int columns = (4160 + kTileSize - 1) / kTileSize, tile = tall ? block * columns + across : across * columns + block;
        const TileRows want = exact(probe, t, tile);
        covered += static_cast<uint64_t>(count_bits(want));
        pixels.add(static_cast<uint64_t>(count_differences(probe.rows(t, tile), want)), kTilePixels);
      }
    }
  }
  if (covered < 50) pixels.check(false, [] { return std::string("the slivers cover nothing"); });
  return none_wrong(pixels, "pixels", 1000000, grouped(covered) + " of them covered");
}

Finding r8_shifts(const Effort& effort) {
  TileProbe probe(300, 260);
  Tally pictures;
  for (const Isa isa : supported_isas()) {
    probe.frame().isa = isa;
    TestRandom random(8);
    for (int n = 0; n < effort.count(isa, 4000, 400); ++n) {
      Point p[3];
      for (Point& q : p) q.x = random.between(-20000, 50000), q.y = random.between(-20000, 50000);
      const int sx = random.between(0, 100), sy = random.between(0, 90);
      const auto move = [&](Point q) { return Point{q.x + sx * 256, q.y + sy * 256}; };
      std::vector<int> still, moved;
      probe.add(triangle(p[0], p[1], p[2]), still);
      probe.add(triangle(move(p[0]), move(p[1]), move(p[2])), moved);
      bool same = true;
      for (int y = 0; y + sy < 260; ++y)
        for (int x = 0; x + sx < 300; ++x)
          same &= still[static_cast<size_t>(y * 300 + x)] == moved[static_cast<size_t>((y + sy) * 300 + x + sx)];
      pictures.check(same);
    }
  }
  return none_wrong(pictures, "shifted triangles", 400);
}

// Random triangles of every awkward kind, extents from under a pixel to the guard band of 2^15 pixels.
Tally fuzz_coverage(const Effort& effort, int full, int few) {
  TileProbe probe(150, 141);
  Tally triangles;
  for (const Isa isa : supported_isas()) {
    probe.frame().isa = isa;
    TestRandom random(9);
    for (int n = 0; n < effort.count(isa, full, few); ++n) {
      const int tile = random.below(probe.grid().count());
      const ScreenTriangle t = fuzzed_triangle(random, probe.grid(), tile);
      triangles.check(count_differences(probe.rows(t, tile), exact(probe, t, tile)) == 0);
    }
  }
  return triangles;
}

// Repeated corners and corners on one line, in 24.8.
void check_no_area(const Effort& effort, Tally& triangles) {
  TileProbe probe(64, 64);
  for (const Isa isa : supported_isas()) {
    probe.frame().isa = isa;
    TestRandom random(6);
    for (int n = 0; n < effort.count(isa, 100000, 10000); ++n) {
      const Point a{random.between(0, 16000), random.between(0, 16000)};
      const int dx = random.between(-40, 40), dy = random.between(-40, 40), k = random.between(-90, 90);
      const Point b{a.x + 90 * dx, a.y + 90 * dy};
      const Point c = n % 3 == 0 ? a : n % 3 == 1 ? b : Point{a.x + k * dx, a.y + k * dy};
      triangles.check(count_bits(probe.rows(triangle(a, b, c), 0)) == 0);
    }
  }
}

}  // namespace spanray::hard
