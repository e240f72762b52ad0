// Depth of the rasterizer: order, ties, range, seams (D1 to D5).
#include <algorithm>
#include <cmath>

#include "cases.h"
#include "support/camera_at.h"
#include "support/raster_front_end.h"
#include "support/raster_soup.h"

namespace spanray::hard {

// Tilted walls across the view, the second a millionth nearer along every ray, drawn between two copies of the first.
Finding d1_pairs(const Effort& effort) {
  TestRandom random(1);
  Tally pixels;
  for (double z = 1e-3; z <= 1.1e6; z *= 10)
    for (int n = 0; n < effort.count(80, 8); ++n) {
      const glm::dvec3 tilt = random_point(random, 0.3);
      const auto corner = [&](double x, double y, double scale) { return glm::dvec3(x, y, -1 + x * tilt.x + y * tilt.y) * (z * scale); };
      std::vector<SoupTriangle> soup;
      for (const double scale : {1.0, 1 - 1e-6, 1.0})
        soup.push_back(soup_triangle(corner(-3, -1, scale), corner(3, -1, scale), corner(0, 2, scale)));
      const auto t = make_test_frame(make_test_scene(soup), camera_at({0, 0, 0}, {0, 0, -1}, 1e-4), test_settings(70, 70));
      for (const uint32_t id : rasterize(t->frame).primitive)
        if (id != kNoPrimitive) pixels.check(id == 1, [&] { return "at distance " + short_text(z); });
    }
  return none_wrong(pixels, "pixels", 100000, "distances 1e-3 to 1e6, near plane 1e-4");
}

// A soup and its copy, corners rotated and mirrored: every pixel belongs to the first.
Finding d2_coplanar_copies(const Effort& effort) {
  Tally pixels;
  for (int n = 0; n < effort.count(20, 2); ++n) {
    std::vector<SoupTriangle> soup = random_soup(static_cast<uint32_t>(2 + n), 300);
    const size_t first = soup.size();
    for (size_t i = 0; i < first; ++i) {
      SoupTriangle copy = soup[i];
      std::swap(copy.corner[0], copy.corner[1 + i % 2]);
      if (i % 3 == 0) std::swap(copy.corner[1], copy.corner[2]);
      soup.push_back(copy);
    }
    for (const Isa isa : supported_isas()) {
      const auto t = make_test_frame(make_test_scene(soup), camera_at({0, 0, 3}, {0, 0, 0}), test_settings(160, 120, isa));
      for (const uint32_t id : rasterize(t->frame).primitive)
        if (id != kNoPrimitive) pixels.check(id < first);
    }
  }
  return none_wrong(pixels, "pixels", 10000);
}

Finding d3_decals(const Effort&) { return not_measured("this version has no depth bias: decals must lie in front of their surface"); }

// Blades whose corners lie close to a plane through the eye, or on it.
Finding d4_edge_on(const Effort& effort) {
  TestRandom random(4);
  Tally pixels;
  for (int n = 0; n < effort.count(2000, 400); ++n) {
    const glm::dvec3 eye{0.5, 0.25, 3}, u = random_point(random, 0.3) * glm::dvec3(1, 1, 0) - glm::dvec3(0, 0, 1),
                                        v = random_point(random) * glm::dvec3(1, 1, 0);
    glm::dvec3 p[3];
    for (glm::dvec3& q : p) {
      const double w = random.uniform(1, 5), side = random.uniform(-0.3, 0.3),
                   off = n % 4 == 0 ? 0 : random.uniform(-1e-2, 1e-2) / (1 + n % 9);
      q = eye + u * w + v * side * w + glm::dvec3(v.y, -v.x, 0.0) * off;
    }
    const auto t = make_test_frame(make_test_scene({soup_triangle(p[0], p[1], p[2])}), camera_at(eye, {0.5, 0.25, 0}),
                                   test_settings(300, 300));
    float low = 1, high = 0;
    for (const Vertex& vertex : t->scene.vertices) {
      const float z = static_cast<float>(0.01 / (eye.z - static_cast<double>(vertex.position[2])));
      low = std::min(low, z), high = std::max(high, z);
    }
    for (const float z : rasterize(t->frame).depth)
      if (z != 0) pixels.check(z >= low && z <= high);
  }
  return none_wrong(pixels, "pixels", 1000);
}

// Two walls that cross in the middle of the picture: how far from the line are pixels of the wrong one?
Finding d5_crossing_planes(const Effort&) {
  Worst off;
  for (const double distance : {1e-2, 3.0, 1e3, 1e6})
    for (const double slope : {0.5, 0.05, 1e-3}) {
      std::vector<SoupTriangle> soup;
      for (const double s : {slope, -slope})
        soup.push_back(soup_triangle(glm::dvec3{-13, -13, -1 - 0.13 * s} * distance, glm::dvec3{13, -13, -1 + 0.13 * s} * distance,
                                     glm::dvec3{0, 26, -1} * distance));
      const auto t = make_test_frame(make_test_scene(soup), camera_at({0, 0, 0}, {0, 0, -1}, 1e-3), test_settings(201, 101));
      const Picture p = rasterize(t->frame);
      for (int y = 0; y < p.height; ++y)
        for (int x = 0; x < p.width; ++x) off.add(x == 100 || p.id(x, y) == (x > 100 ? 0u : 1u) ? 0 : std::abs(x - 100));
    }
  return within(off, 1, "pixels from the line", "pixels", 200000);
}

}  // namespace spanray::hard
