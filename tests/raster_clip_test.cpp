// Clipping: shared edges stay shared, nothing behind the eye is seen, bad vertices hurt only their own triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "raster/clip_polygon.h"
#include "support/coverage_oracle.h"
#include "support/random.h"
#include "support/raster_front_end.h"
#include "support/ray_oracle.h"

namespace spanray {
namespace {

Camera camera_at(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up = {0, 1, 0}, double near_plane = 0.01) {
  Camera c;
  for (int k = 0; k < 3; ++k) c.eye[k] = eye[k], c.target[k] = target[k], c.up[k] = up[k];
  c.near_plane = near_plane;
  return c;
}

// A grid on the plane y = height, cells growing from the origin outward, jittered; every triangle has its own uv, so that no
// two of them share a vertex: as at an OBJ seam.
std::vector<SoupTriangle> ground(double height, int half_cells, double growth, double unit, uint32_t seed) {
  TestRandom random(seed);
  const int side = 2 * half_cells + 1;
  std::vector<glm::dvec3> grid;
  const auto place = [&](double s) { return std::copysign(unit * (std::pow(growth, std::fabs(s)) - 1), s); };
  for (int j = -half_cells; j <= half_cells; ++j)
    for (int i = -half_cells; i <= half_cells; ++i)
      grid.emplace_back(place(i + random.uniform(-0.2, 0.2)), height, place(j + random.uniform(-0.2, 0.2)));
  const auto at = [&](int i, int j) { return grid[static_cast<size_t>(j * side + i)]; };
  std::vector<SoupTriangle> soup;
  for (int j = 0; j + 1 < side; ++j)
    for (int i = 0; i + 1 < side; ++i) {
      soup.push_back(soup_triangle(at(i, j), at(i, j + 1), at(i + 1, j + 1)));
      soup.push_back(soup_triangle(at(i + 1, j), at(i, j), at(i + 1, j + 1)));
    }
  for (size_t i = 0; i < soup.size(); ++i)
    for (Vertex& v : soup[i].corner) v.uv[0] = static_cast<float>(i);
  return soup;
}

TEST(RasterClip, R3_SharedEdgesOfClippedTrianglesAreCoveredOnce) {
  TestRandom random(3);
  uint64_t clipped = 0, checked = 0;
  int outside_guard_band = 0;
  for (int n = 0; n < 80; ++n) {
    // Near planes that cut the visible ground, and one so close that its neighbourhood leaves the guard band.
    const double height = std::exp(random.uniform(-3, 3)), near_plane = height * (n % 3 == 0 ? 1.5 : n % 3 == 1 ? 0.7 : 1e-4);
    const glm::dvec3 eye{height * random.uniform(-3, 3), 0, height * random.uniform(-3, 3)};
    const glm::dvec3 target = eye + glm::dvec3(random.uniform(-1, 1), random.uniform(-1.5, 0.2), random.uniform(-1, 1));
    const glm::dvec3 up{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    Camera camera = camera_at(eye, target, up, near_plane);
    camera.fov_y_degrees = n % 4 == 2 ? 0.1 : 100;  // through a telescope the guard band is near
    const auto t = make_test_frame(make_test_scene(n % 2 ? ground(-height, 24, 1.3, 0.1 * height, static_cast<uint32_t>(n)) : ground(-height, 6, 2.2, height, static_cast<uint32_t>(n)), {translucent_material()}),
                                   camera, test_settings(180, 140));
    const FrontEnd front = run_front_end(t->frame);
    clipped += front.counts.triangles_clipped;
    for (const Triangle& triangle : t->scene.triangles) {
      uint32_t all = ~0u, any = 0;
      for (const uint32_t v : triangle.vertex) all &= front.vertices.outcode[v], any |= front.vertices.outcode[v];
      outside_guard_band += all == 0 && (any & (kOutLeft | kOutRight | kOutTop | kOutBottom)) != 0 && !(any & kOutNear);
    }
    const std::vector<int> count = count_fragments(t->frame, front.bins);
    const PrimaryRays& r = t->frame.primary;
    for (int y = 0; y < 140; ++y)
      for (int x = 0; x < 180; ++x) {
        const glm::dvec3 d = r.corner + (x + 0.5) * r.step_x + (y + 0.5) * r.step_y;
        const int fragments = count[static_cast<size_t>(y * 180 + x)];
        const double distance = -height / d.y;  // view depth of the ground there
        if (d.y >= 0) { ASSERT_EQ(d.y > length3(r.step_x) ? fragments : 0, 0) << "above the horizon, " << n << ": " << x << "," << y; }
        if (d.y >= 0 || distance > 10 * height) continue;
        if (std::fabs(distance / r.near_plane - 1) < 1e-2) continue;
        ASSERT_EQ(fragments, distance > r.near_plane ? 1 : 0) << n << ": " << x << "," << y << " at " << distance;
        ++checked;
      }
  }
  EXPECT_GT(clipped, 300u);
  EXPECT_GT(outside_guard_band, 10);
  EXPECT_GT(checked, 100000u);
}

TEST(RasterClip, R13_AnEdgeClippedFromBothSidesGivesTheSamePoints) {
  TestRandom random(13);
  int compared = 0;
  for (int n = 0; n < 40000; ++n) {
    const auto point = [&] {
      const double size = std::exp(random.uniform(0, 16)), w = random.uniform(-1, 1) * std::exp(random.uniform(-6, 3));
      return HomogeneousPoint{random.uniform(-1, 1) * size, random.uniform(-1, 1) * size, w};
    };
    const HomogeneousPoint a = point(), b = point();
    SnappedPoint edge[kMaxClipVertices];
    const HomogeneousPoint alone[3] = {a, b, b};
    const int edge_points = clip_to_guard_band(alone, 0.01, edge);  // what clipping makes of the edge itself
    for (int k = 0; k < 6; ++k) {
      const HomogeneousPoint c = point();
      HomogeneousPoint triangle[3] = {a, b, c};
      std::rotate(triangle, triangle + k % 3, triangle + 3);
      if (k >= 3) std::swap(triangle[0], triangle[1]);
      SnappedPoint polygon[kMaxClipVertices];
      const int size = clip_to_guard_band(triangle, 0.01, polygon);
      for (int i = 0; i < edge_points; ++i) {
        ASSERT_NE(std::find(polygon, polygon + size, edge[i]), polygon + size) << n << " " << k;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 50000);
}

TEST(RasterClip, PiecesCoverADentedPolygonWithoutOverlap) {
  TestRandom random(14);
  for (int n = 0; n < 5000; ++n) {
    // Corners in order of angle around an inner point: simple, seldom convex.
    SnappedPoint p[kMaxClipVertices];
    const int size = random.between(3, kMaxClipVertices);
    for (int i = 0; i < size; ++i) {
      const double angle = (i + random.uniform(0, 0.45)) * 2 * 3.14159265358979 / size, radius = random.uniform(n % 2 ? 50 : 5000, 6000);
      p[i] = {static_cast<int32_t>(radius * std::cos(angle)), static_cast<int32_t>(radius * std::sin(angle))};
    }
    const auto area2 = [&](int a, int b, int c) {
      return int64_t{p[b].x_24_8 - p[a].x_24_8} * (p[c].y_24_8 - p[a].y_24_8) - int64_t{p[c].x_24_8 - p[a].x_24_8} * (p[b].y_24_8 - p[a].y_24_8);
    };
    int64_t whole = 0, sum = 0;
    for (int i = 2; i < size; ++i) whole += area2(0, i - 1, i);
    uint8_t piece[kMaxClipVertices - 2][3];
    const int pieces = triangulate(p, size, piece);
    for (int i = 0; i < pieces; ++i) sum += std::abs(area2(piece[i][0], piece[i][1], piece[i][2]));
    ASSERT_EQ(sum, std::abs(whole)) << n;
  }
}

// Ids against brute-force rays, away from edges. Returns how many pixels saw something.
int expect_ray_cast(const Frame& frame, const char* what) {
  const Picture p = rasterize(frame);
  int seen = 0, doubtful = 0, wrong = 0;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) {
      const OracleHit hit = oracle_hit(frame, x, y);
      doubtful += hit.doubtful;
      if (hit.doubtful) continue;
      if (hit.primitive != p.id(x, y) && wrong++ == 0)
        ADD_FAILURE() << what << " at " << x << "," << y << ": " << p.id(x, y) << ", rays say " << hit.primitive << " at " << hit.t;
      seen += hit.primitive != kNoPrimitive;
    }
  EXPECT_EQ(wrong, 0) << what;
  EXPECT_LT(doubtful, p.width * p.height / 10) << what;
  return seen;
}

TEST(RasterClip, R11_BehindTheEyeAndAPlaneThroughItAreTheRayCast) {
  TestRandom random(11);
  int seen = 0;
  for (int n = 0; n < 40; ++n) {
    std::vector<SoupTriangle> soup;
    const double size = n % 4 == 0 ? 1000 : 4;
    for (int i = 0; i < 12; ++i) {
      glm::dvec3 p[3];
      for (glm::dvec3& q : p) q = {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
      if (i < 2) for (glm::dvec3& q : p) q.y = 0;  // through the eye
      soup.push_back(soup_triangle(p[0], p[1], p[2]));
    }
    const glm::dvec3 target{random.uniform(-1, 1), n % 2 ? 0 : random.uniform(-1, 1), random.uniform(-1, 1)};
    const auto t = make_test_frame(make_test_scene(soup), camera_at({0, 0, 0}, target), test_settings(80, 61));
    seen += expect_ray_cast(t->frame, "R11");
  }
  EXPECT_GT(seen, 20000);
}

TEST(RasterClip, R9_R10_HugeExtentsAreTheRayCastAndTheClippedOracle) {
  TestRandom random(10);
  int seen = 0;
  for (int n = 0; n < 30; ++n) {
    // Extents of 2^23 pixels at depth 1 (there are 73 pixels a unit), then of 1e30.
    const double size = n % 2 ? 1e30 : 1e5;
    std::vector<SoupTriangle> soup;
    for (int i = 0; i < 2; ++i) {
      const double depth = -1 - 2 * i;
      glm::dvec3 p[3];
      for (int k = 0; k < 3; ++k) {
        const double angle = (k + random.uniform(-0.4, 0.4)) * 2.0943951 + n;
        p[k] = {size * std::cos(angle), size * std::sin(angle), depth};
      }
      if (i == 1) p[0] = {random.uniform(-1, 1), random.uniform(-1, 1), depth};  // a corner in view
      soup.insert(soup.begin(), soup_triangle(p[0], p[1], p[2]));
    }
    const auto t = make_test_frame(make_test_scene(soup), camera_at({0, 0, 0}, {0, 0, -1}), test_settings(70, 60));
    const FrontEnd front = run_front_end(t->frame);
    const Picture picture = rasterize(t->frame, front.bins);
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 70; ++x) {
        bool want = false;
        for (const BinChunk& chunk : front.bins.chunks)
          for (const ScreenTriangle& s : chunk.triangles) want |= oracle_covers(s, x, y);
        ASSERT_EQ(picture.id(x, y) != kNoPrimitive, want) << n << ": " << x << "," << y;
      }
    if (size < 1e10) seen += expect_ray_cast(t->frame, "R9");
  }
  EXPECT_GT(seen, 30000);
}

TEST(RasterClip, R10_AWallOfSize1e30CoversTheView) {
  for (const Isa isa : supported_isas()) {
    const std::vector<SoupTriangle> soup = {soup_triangle({-1e30, -1e30, -2}, {1e30, -1e30, -2}, {0, 1e30, -2})};
    const auto t = make_test_frame(make_test_scene(soup), camera_at({0, 0, 0}, {0, 0, -1}), test_settings(70, 60, isa));
    const Picture p = rasterize(t->frame);
    for (const uint32_t id : p.primitive) ASSERT_EQ(id, 0u);
    for (const float z : p.depth) ASSERT_NEAR(z, 0.005, 1e-8);
  }
}

TEST(RasterClip, R12_DepthZeroDenormalTinyNegative) {
  const double tiny[] = {0.0, 4.9e-324, -4.9e-324, 1e-40, 1e-30, -1e-30, -1e-3, 1e-3};
  TestRandom random(12);
  for (const double w : tiny)
    for (int n = 0; n < 10; ++n) {
      // One or two corners at that depth, the others in front; then all behind.
      const auto at = [&](double depth) { return glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), -depth); };
      const auto t = make_test_frame(make_test_scene({soup_triangle(at(w), n % 2 ? at(w) : at(2), at(3))}), camera_at({0, 0, 0}, {0, 0, -1}), test_settings(64, 48));
      expect_ray_cast(t->frame, "R12");
      const auto behind = make_test_frame(make_test_scene({soup_triangle(at(-std::fabs(w)), at(-1), at(-2))}), camera_at({0, 0, 0}, {0, 0, -1}), test_settings(64, 48));
      const FrontEnd front = run_front_end(behind->frame);
      EXPECT_EQ(front.counts.triangles_drawn, 0u);
      EXPECT_EQ(front.counts.triangles_culled(), 1u);
    }
}

TEST(RasterClip, R14_BadVerticesLoseOnlyTheirTriangles) {
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
  std::vector<SoupTriangle> soup = ground(-1, 6, 1.5, 0.3, 14);
  for (SoupTriangle& s : soup)
    for (Vertex& v : s.corner) v.uv[0] = 0;  // vertices shared
  const Camera camera = camera_at({0, 0.5, 3}, {0, -1, 0});
  for (const float value : bad)
    for (int axis = 0; axis < 3; ++axis) {
      const auto whole = make_test_frame(make_test_scene(soup), camera, test_settings(120, 90));
      const auto hurt = make_test_frame(make_test_scene(soup), camera, test_settings(120, 90));
      const uint32_t victim = static_cast<uint32_t>(hurt->scene.vertices.size() / 2);
      hurt->scene.vertices[victim].position[axis] = value;
      const FrontEnd front = run_front_end(hurt->frame);
      const Picture a = rasterize(whole->frame), b = rasterize(hurt->frame, front.bins);
      uint64_t lost = 0, lost_pixels = 0;
      const auto is_lost = [&](uint32_t id) {
        return std::count(hurt->scene.triangles[id].vertex, hurt->scene.triangles[id].vertex + 3, victim) > 0;
      };
      for (uint32_t id = 0; id < hurt->scene.triangles.size(); ++id) lost += is_lost(id);
      EXPECT_GE(lost, 4u);
      EXPECT_EQ(front.counts.triangles_invalid, lost);
      EXPECT_EQ(front.counts.triangles_in, front.counts.triangles_invalid + front.counts.triangles_culled() + front.counts.triangles_drawn);
      for (size_t i = 0; i < a.primitive.size(); ++i) {
        const bool gone = a.primitive[i] != kNoPrimitive && is_lost(a.primitive[i]);
        lost_pixels += gone;
        ASSERT_EQ(b.primitive[i], gone ? kNoPrimitive : a.primitive[i]);
      }
      EXPECT_GT(lost_pixels, 0u);
    }
}

}  // namespace
}  // namespace spanray
