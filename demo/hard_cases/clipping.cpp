// Triangles of the world through the whole front end: clipped edges stay shared, nothing behind the eye is seen, bad vertices hurt only
// their own triangles (R3, R9 to R14).
#include <algorithm>
#include <cmath>
#include <limits>

#include "cases.h"
#include "raster/clip_polygon.h"
#include "support/camera_at.h"
#include "support/coverage_oracle.h"
#include "support/random.h"
#include "support/raster_front_end.h"
#include "support/ray_oracle.h"

namespace spanray::hard {
namespace {

std::string at(int x, int y) { return std::to_string(x) + "," + std::to_string(y); }

// A grid on the plane y = height, cells growing from the origin outward, jittered; every triangle has its own uv, so that no
// two of them share a vertex: as at an OBJ seam.
std::vector<SoupTriangle> ground(double height, int half_cells, double growth, double unit, uint32_t seed) {
  TestRandom random(seed);
  const int side = 2 * half_cells + 1;
  std::vector<glm::dvec3> grid;
  const auto place = [&](double s) { return std::copysign(unit * (std::pow(growth, std::fabs(s)) - 1), s); };
  for (int j = -half_cells; j <= half_cells; ++j)
    for (int i = -half_cells; i <= half_cells; ++i) {
      const double x = place(i + random.uniform(-0.2, 0.2));
      grid.emplace_back(x, height, place(j + random.uniform(-0.2, 0.2)));
    }
  const auto corner = [&](int i, int j) { return grid[static_cast<size_t>(j * side + i)]; };
  std::vector<SoupTriangle> soup;
  for (int j = 0; j + 1 < side; ++j)
    for (int i = 0; i + 1 < side; ++i) {
      soup.push_back(soup_triangle(corner(i, j), corner(i, j + 1), corner(i + 1, j + 1)));
      soup.push_back(soup_triangle(corner(i + 1, j), corner(i, j), corner(i + 1, j + 1)));
    }
  for (size_t i = 0; i < soup.size(); ++i)
    for (Vertex& v : soup[i].corner) v.uv[0] = static_cast<float>(i);
  return soup;
}

// Ids against brute-force rays in double, away from edges. Adds how many pixels saw something.
void check_ray_cast(const Frame& frame, Tally& pixels, int* seen = nullptr) {
  const Picture p = rasterize(frame);
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) {
      const PixelOracleHit hit = oracle_hit(frame, x, y);
      if (hit.doubtful) continue;
      pixels.check(hit.primitive == p.id(x, y), [&] { return at(x, y); });
      if (seen != nullptr) *seen += hit.primitive != kNoPrimitive;
    }
}

}  // namespace

// One view of the ground: one fragment wherever it lies in front of the near plane, none above the horizon.
static void check_ground(int n, double height, const Camera& camera, Tally& pixels, uint64_t* clipped) {
  const uint32_t seed = static_cast<uint32_t>(n);
  const std::vector<SoupTriangle> soup = n % 2 != 0 ? ground(-height, 24, 1.3, 0.1 * height, seed) : ground(-height, 6, 2.2, height, seed);
  const auto t = make_test_frame(make_test_scene(soup, {translucent_material()}), camera, test_settings(180, 140));
  const FrontEnd front = run_front_end(t->frame);
  *clipped += front.counts.triangles_clipped;
  const std::vector<int> count = count_fragments(t->frame, front.bins);
  const PrimaryRays& r = t->frame.primary;
  for (int y = 0; y < 140; ++y)
    for (int x = 0; x < 180; ++x) {
      const glm::dvec3 d = r.corner + (x + 0.5) * r.step_x + (y + 0.5) * r.step_y;
      const int fragments = count[static_cast<size_t>(y * 180 + x)];
      const double distance = -height / d.y;  // view depth of the ground there
      if (d.y > length3(r.step_x)) pixels.check(fragments == 0, [&] { return "above the horizon " + at(x, y); });
      if (d.y >= 0 || distance > 10 * height || std::fabs(distance / r.near_plane - 1) < 1e-2) continue;
      pixels.check(fragments == (distance > r.near_plane ? 1 : 0), [&] {
        return "view " + std::to_string(n) + " at " + at(x, y) + ": " + std::to_string(fragments) + " fragments";
      });
    }
}

// Near planes that cut the visible ground, and one so close that its neighbourhood leaves the guard band; telescopes, whose guard band is
// near. Vertices are duplicated as at OBJ seams.
Finding r3_clipped_edges(const Effort& effort) {
  TestRandom random(3);
  Tally pixels;
  uint64_t clipped = 0;
  for (int n = 0; n < effort.count(800, 80); ++n) {
    const double height = std::exp(random.uniform(-3, 3)), near_plane = height * (n % 3 == 0 ? 1.5 : n % 3 == 1 ? 0.7 : 1e-4);
    const glm::dvec3 eye = random_point(random, 3 * height) * glm::dvec3(1, 0, 1);
    const glm::dvec3 target = eye + random_point(random) * glm::dvec3(1, 0.85, 1) - glm::dvec3(0, 0.65, 0);
    Camera camera = camera_at(eye, target, near_plane, random_point(random));
    camera.fov_y_degrees = n % 4 == 2 ? 0.1 : 100;
    check_ground(n, height, camera, pixels, &clipped);
  }
  if (clipped < 300) pixels.check(false, [] { return std::string("hardly a triangle was clipped"); });
  return none_wrong(pixels, "pixels", 100000, grouped(clipped) + " triangles clipped");
}

// A corner of one wall in view, all other corners `size` away. Coverage against exact integers on what was clipped.
static void check_huge(double size, int n, TestRandom& random, Tally& pixels, Tally* rays) {
  std::vector<SoupTriangle> soup;
  for (int i = 0; i < 2; ++i) {
    const double depth = -1 - 2 * i;
    glm::dvec3 p[3];
    for (int k = 0; k < 3; ++k) {
      const double angle = (k + random.uniform(-0.4, 0.4)) * 2.0943951 + n;
      p[k] = {size * std::cos(angle), size * std::sin(angle), depth};
    }
    if (i == 1) p[0] = random_point(random) * glm::dvec3(1, 1, 0) + glm::dvec3(0, 0, depth);  // a corner in view
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
      pixels.check((picture.id(x, y) != kNoPrimitive) == want, [&] { return at(x, y); });
    }
  if (rays != nullptr) check_ray_cast(t->frame, *rays);
}

// 24.8 triangles up to the guard band against exact integers; 2^23 pixels (there are 73 a unit at depth 1), clipped, and against rays.
Finding r9_extents(const Effort& effort) {
  const Tally triangles = fuzz_coverage(effort, 300000, 30000);
  TestRandom random(10);
  Tally pixels;
  for (int n = 0; n < effort.count(150, 15); ++n) check_huge(1e5, n, random, pixels, &pixels);
  Tally all = triangles;
  all.add(pixels);
  return none_wrong(
      all, "triangles and pixels", 30000,
      grouped(triangles.checked()) + " triangles up to 2^15 pixels, " + grouped(pixels.checked()) + " pixels of walls of 2^23");
}

Finding r10_huge_vertices(const Effort& effort) {
  TestRandom random(11);
  Tally pixels;
  for (int n = 0; n < effort.count(150, 15); ++n) check_huge(1e30, n, random, pixels, nullptr);
  const std::vector<SoupTriangle> wall = {soup_triangle({-1e30, -1e30, -2}, {1e30, -1e30, -2}, {0, 1e30, -2})};
  for (const Isa isa : supported_isas()) {  // a wall over the whole view
    const auto t = make_test_frame(make_test_scene(wall), camera_at({0, 0, 0}, {0, 0, -1}), test_settings(70, 60, isa));
    const Picture p = rasterize(t->frame);
    for (size_t i = 0; i < p.depth.size(); ++i) pixels.check(p.primitive[i] == 0 && std::fabs(p.depth[i] - 0.005) <= 1e-8);
  }
  return none_wrong(pixels, "pixels", 60000);
}

// Random triangles around the eye, two of them in planes through it.
Finding r11_behind_the_eye(const Effort& effort) {
  TestRandom random(11);
  Tally pixels;
  int seen = 0;
  for (int n = 0; n < effort.count(400, 40); ++n) {
    std::vector<SoupTriangle> soup;
    const double size = n % 4 == 0 ? 1000 : 4;
    for (int i = 0; i < 12; ++i) {
      glm::dvec3 p[3];
      for (glm::dvec3& q : p) q = random_point(random, size) * glm::dvec3(1, i < 2 ? 0 : 1, 1);
      soup.push_back(soup_triangle(p[0], p[1], p[2]));
    }
    const glm::dvec3 target = random_point(random) * glm::dvec3(1, n % 2 != 0 ? 0 : 1, 1);
    const auto t = make_test_frame(make_test_scene(soup), camera_at({0, 0, 0}, target), test_settings(80, 61));
    check_ray_cast(t->frame, pixels, &seen);
  }
  return none_wrong(pixels, "pixels", 100000, grouped(static_cast<uint64_t>(seen)) + " of them see a triangle");
}

// One or two corners at that depth, the others in front: as rays see it. All behind: nothing is drawn.
Finding r12_depth_zero(const Effort& effort) {
  TestRandom random(12);
  Tally pixels;
  for (const double w : {0.0, 4.9e-324, -4.9e-324, 1e-40, 1e-30, -1e-30, -1e-3, 1e-3})
    for (int n = 0; n < effort.count(60, 10); ++n) {
      const auto corner = [&](double depth) { return random_point(random) * glm::dvec3(1, 1, 0) - glm::dvec3(0, 0, depth); };
      const auto frame_of = [&](const SoupTriangle& triangle) {
        return make_test_frame(make_test_scene({triangle}), camera_at({0, 0, 0}, {0, 0, -1}), test_settings(64, 48));
      };
      check_ray_cast(frame_of(soup_triangle(corner(w), n % 2 != 0 ? corner(w) : corner(2), corner(3)))->frame, pixels);
      const auto behind = frame_of(soup_triangle(corner(-std::fabs(w)), corner(-1), corner(-2)));
      const FrontEnd front = run_front_end(behind->frame);
      pixels.check(front.counts.triangles_drawn == 0 && front.counts.triangles_culled() == 1,
                   [] { return std::string("a triangle behind the eye is drawn"); });
    }
  return none_wrong(pixels, "pixels", 100000);
}

// What clipping makes of an edge alone must be among the corners of every triangle that has the edge, in any order of its corners.
Finding r13_edges_from_both_sides(const Effort& effort) {
  TestRandom random(13);
  Tally corners;
  for (int n = 0; n < effort.count(400000, 40000); ++n) {
    const auto point = [&] {
      const double size = std::exp(random.uniform(0, 16)), x = random.uniform(-1, 1) * size, y = random.uniform(-1, 1) * size;
      const double w = random.uniform(-1, 1);
      return HomogeneousPoint{x, y, w * std::exp(random.uniform(-6, 3))};
    };
    const HomogeneousPoint a = point(), b = point();
    SnappedPoint edge[kMaxClipVertices];
    const HomogeneousPoint alone[3] = {a, b, b};
    const int edge_points = clip_to_guard_band(alone, 0.01, edge);
    for (int k = 0; k < 6; ++k) {
      HomogeneousPoint triangle[3] = {a, b, point()};
      std::rotate(triangle, triangle + k % 3, triangle + 3);
      if (k >= 3) std::swap(triangle[0], triangle[1]);
      SnappedPoint polygon[kMaxClipVertices];
      const int size = clip_to_guard_band(triangle, 0.01, polygon);
      for (int i = 0; i < edge_points; ++i) corners.check(std::find(polygon, polygon + size, edge[i]) != polygon + size);
    }
  }
  return none_wrong(corners, "clipped corners", 50000);
}

// A vertex of a mesh becomes NaN or infinite: its triangles are gone and counted, every other pixel stays.
Finding r14_bad_vertices(const Effort&) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  std::vector<SoupTriangle> soup = ground(-1, 6, 1.5, 0.3, 14);
  for (SoupTriangle& s : soup)
    for (Vertex& v : s.corner) v.uv[0] = 0;  // vertices shared
  const Camera camera = camera_at({0, 0.5, 3}, {0, -1, 0});
  Tally pixels;
  uint64_t lost_pixels = 0;
  for (const float value : {std::numeric_limits<float>::quiet_NaN(), kInf, -kInf})
    for (int axis = 0; axis < 3; ++axis) {
      const auto whole = make_test_frame(make_test_scene(soup), camera, test_settings(120, 90));
      const auto hurt = make_test_frame(make_test_scene(soup), camera, test_settings(120, 90));
      const uint32_t victim = static_cast<uint32_t>(hurt->scene.vertices.size() / 2);
      hurt->scene.vertices[victim].position[axis] = value;
      const FrontEnd front = run_front_end(hurt->frame);
      const Picture a = rasterize(whole->frame), b = rasterize(hurt->frame, front.bins);
      uint64_t lost = 0;
      const auto is_lost = [&](uint32_t id) {
        return std::count(hurt->scene.triangles[id].vertex, hurt->scene.triangles[id].vertex + 3, victim) > 0;
      };
      for (uint32_t id = 0; id < hurt->scene.triangles.size(); ++id) lost += is_lost(id);
      const FrameCounts& c = front.counts;
      pixels.check(lost >= 4 && c.triangles_invalid == lost, [] { return std::string("not counted as lost"); });
      pixels.check(c.triangles_in == c.triangles_invalid + c.triangles_culled() + c.triangles_drawn);
      for (size_t i = 0; i < a.primitive.size(); ++i) {
        const bool gone = a.primitive[i] != kNoPrimitive && is_lost(a.primitive[i]);
        lost_pixels += gone;
        pixels.check(b.primitive[i] == (gone ? kNoPrimitive : a.primitive[i]));
      }
    }
  if (lost_pixels == 0) pixels.check(false, [] { return std::string("no pixel saw the bad vertices"); });
  return none_wrong(pixels, "pixels", 90000, grouped(lost_pixels) + " of them lost with the vertex's triangles");
}

}  // namespace spanray::hard
