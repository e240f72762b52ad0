// Whole meshes, pictures of all sizes, one result everywhere (R6, R7, R15, R16, R17).
#include <algorithm>
#include <cmath>
#include <cstring>

#include "cases.h"
#include "core/hash.h"
#include "support/camera_at.h"
#include "support/coverage_oracle.h"
#include "support/random.h"
#include "support/raster_front_end.h"
#include "support/raster_soup.h"

namespace spanray::hard {
namespace {

// Looks along -z with a right angle of view: pixel (x, y) lies at ((x - half) / half, (half - y) / half, -1).
constexpr int kSide = 256;
Camera right_angle_camera() {
  Camera camera = camera_at({0, 0, 0}, {0, 0, -1});
  camera.fov_y_degrees = 90;
  return camera;
}
glm::dvec3 at_pixel(double x, double y) { return {(x - kSide / 2) / (kSide / 2), (kSide / 2 - y) / (kSide / 2), -1}; }

}  // namespace

// In 24.8, and triangles of the world that lose their area only by snapping: corners within 0.4 of 1/256 pixel of a line of 24.8 points.
Finding r6_no_area(const Effort& effort) {
  Tally triangles;
  check_no_area(effort, triangles);
  TestRandom random(61);
  for (int batch = 0; batch < effort.count(20, 2); ++batch) {
    std::vector<SoupTriangle> soup;
    for (int n = 0; n < 1000; ++n) {
      const double x = random.between(0, 200 * 256), y = random.between(0, 200 * 256), dx = random.between(-1000, 1000),
                   dy = random.between(-1000, 1000);
      const auto near_line = [&](double s) {
        const glm::dvec3 off = random_point(random, 0.4);
        return at_pixel((x + s * dx + off.x) / 256, (y + s * dy + off.y) / 256);
      };
      const glm::dvec3 a = near_line(0), b = near_line(3);
      soup.push_back(soup_triangle(a, b, near_line(n % 3)));
    }
    for (const Isa isa : supported_isas()) {
      const auto t = make_test_frame(make_test_scene(soup, {translucent_material()}), right_angle_camera(),
                                     test_settings(kSide, kSide, isa));
      const FrontEnd front = run_front_end(t->frame);
      triangles.add(front.counts.triangles_drawn, front.counts.triangles_in);
    }
  }
  return none_wrong(triangles, "triangles", 10000);
}

// A jittered grid with a third of a pixel between vertices, larger than the picture.
Finding r7_sub_pixel_mesh(const Effort& effort) {
  Tally pixels;
  uint64_t most = 0;
  for (const Isa isa : supported_isas()) {
    const int cells = isa == supported_isas().back() ? effort.count(708, 330) : 200, side = cells * 107 / 330;
    TestRandom random(7);
    const double extent = std::tan(22.5 * 3.14159265358979 / 180) * 1.03, step = 2 * extent / cells;
    std::vector<glm::dvec3> grid;
    for (int j = 0; j <= cells; ++j)
      for (int i = 0; i <= cells; ++i) {
        const glm::dvec3 off = random_point(random, 0.2);
        grid.emplace_back(-extent + (i + off.x) * step, -extent + (j + off.y) * step, 0);
      }
    std::vector<SoupTriangle> soup;
    const auto corner = [&](int i, int j) { return grid[static_cast<size_t>(j * (cells + 1) + i)]; };
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i) {
        soup.push_back(soup_triangle(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)));
        soup.push_back(soup_triangle(corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)));
      }
    most = std::max<uint64_t>(most, soup.size());
    const auto t = make_test_frame(make_test_scene(soup, {translucent_material()}), camera_at({0, 0, 1}, {0, 0, 0}),
                                   test_settings(side, side, isa));
    const FrontEnd front = run_front_end(t->frame);
    for (const int n : count_fragments(t->frame, front.bins)) pixels.check(n == 1);
    pixels.check(front.counts.triangles_in == front.counts.triangles_drawn + front.counts.triangles_culled());
  }
  return none_wrong(pixels, "pixels", 10000, grouped(most) + " triangles");
}

// An edge of one triangle meets two edges with a vertex in its middle. Exact integers say which pixels are covered; those that the snapped
// vertex opens or closes are the crack, which is inherent and reported.
Finding r15_t_junctions(const Effort& effort) {
  TestRandom random(15);
  Tally pixels;
  uint64_t cracks = 0, along = 0;
  for (int n = 0; n < effort.count(400, 40); ++n) {
    const glm::dvec3 off = random_point(random, 30);
    const double x0 = 40 + off.x, x1 = 210 + off.y, middle = random.uniform(0.2, 0.8);
    const glm::dvec3 a = at_pixel(x0, 20), b = at_pixel(x1, 240 + off.z / 4), m = a + (b - a) * middle;
    const glm::dvec3 left = at_pixel(3, 130), right = at_pixel(253, 120);
    const auto t = make_test_frame(make_test_scene({soup_triangle(a, left, b), soup_triangle(a, m, right), soup_triangle(m, b, right)},
                                                   {translucent_material()}),
                                   right_angle_camera(), test_settings(kSide, kSide));
    const FrontEnd front = run_front_end(t->frame);
    const std::vector<int> count = count_fragments(t->frame, front.bins);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        int want = 0;
        for (const BinChunk& chunk : front.bins.chunks)
          for (const ScreenTriangle& s : chunk.triangles) want += oracle_covers(s, x, y);
        pixels.check(count[static_cast<size_t>(y * kSide + x)] == want);
        const glm::dvec3 p = at_pixel(x + 0.5, y + 0.5);
        const double edge =
            std::fabs((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)) / std::hypot(b.x - a.x, b.y - a.y) * (kSide / 2);
        if (edge > 1 || p.y > a.y - 0.02 || p.y < b.y + 0.02) continue;  // beside the edge, away from its ends
        ++along, cracks += want != 1;
      }
  }
  return none_wrong(pixels, "pixels", 1000000,
                    "of " + grouped(along) + " pixels along the edges " + grouped(cracks) +
                        " lie in the crack: split the edge on both sides");
}

Finding r16_small_pictures(const Effort&) {
  const int size[][2] = {{1, 1}, {1, 200}, {200, 1}, {63, 65}, {129, 3}, {64, 64}, {2, 2}, {65, 1}};
  const std::vector<SoupTriangle> wall = {soup_triangle({-500, -500, 0}, {500, -500, 0}, {500, 500, 0}),
                                          soup_triangle({-500, -500, 0}, {500, 500, 0}, {-500, 500, 0})};
  Tally pixels;
  for (const auto& s : size)
    for (const Isa isa : supported_isas()) {
      const auto t = make_test_frame(make_test_scene(wall), camera_at({0.3, 0.2, 2}, {0.3, 0.2, 0}), test_settings(s[0], s[1], isa));
      const Picture p = rasterize(t->frame);
      for (size_t i = 0; i < p.depth.size(); ++i) pixels.check(p.primitive[i] != kNoPrimitive && std::fabs(p.depth[i] - 0.005) <= 1e-8);
    }
  return none_wrong(pixels, "pixels", 4000, "the address sanitizer is a build of its own: script/test --sanitize");
}

// Ids, depth and translucent fragments of one soup.
Finding r17_one_hash(const Effort& effort) {
  const std::vector<SoupTriangle> soup = random_soup(17, effort.count(20000, 5000), 2);
  Tally hashes;
  uint64_t first = 0;
  for (const Isa isa : supported_isas())
    for (const int threads : {1, 2, 7}) {
      const auto t = make_test_frame(make_test_scene(soup, {Material{}, translucent_material()}), camera_at({0, 0, 3}, {0.1, 0.2, 0}),
                                     test_settings(333, 217, isa, threads));
      const FrontEnd front = run_front_end(t->frame);
      const Picture p = rasterize(t->frame, front.bins);
      const FragmentList list = all_fragments(t->frame, front.bins);
      std::vector<std::pair<uint32_t, uint32_t>> fragments;
      for (size_t i = 0; i < list.pixel.size(); ++i) fragments.emplace_back(list.primitive[i], list.pixel[i]);
      std::sort(fragments.begin(), fragments.end());
      const uint64_t hash = Hash()
                                .add(p.primitive.data(), p.primitive.size() * 4)
                                .add(p.depth.data(), p.depth.size() * 4)
                                .add(fragments.data(), fragments.size() * sizeof fragments[0])
                                .value();
      if (hashes.checked() == 0) first = hash;
      hashes.check(hash == first, [&] { return std::string(isa_name(isa)) + ", " + std::to_string(threads) + " threads"; });
    }
  return none_wrong(hashes, "pictures (instruction sets x threads)", 6,
                    "hash " + hash_text(first) + "; compilers and tile sizes are builds of their own: script/test --matrix");
}

}  // namespace spanray::hard
