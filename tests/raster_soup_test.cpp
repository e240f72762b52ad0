// Depth and id buffers against the scalar oracle, bit for bit, on random soups, on every instruction set.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "support/random.h"
#include "support/visibility_oracle.h"

namespace spanray {
namespace {

uint32_t accept_some(const Frame&, uint32_t primitive, int x0, int y, uint32_t candidates, int) {
  uint32_t bits = 0;
  for (int i = 0; i < 32; ++i) bits |= static_cast<uint32_t>((x0 + i) * 5 + y * 3 + static_cast<int>(primitive % 7) > 0 && ((x0 + i + y) % 3) != 0) << i;
  return bits & candidates;
}

glm::dvec3 random_point(TestRandom& random, double x, double y, double z) {
  return {random.uniform(-x, x), random.uniform(-y, y), random.uniform(-z, z)};
}

// Every kind there is: from a hundredth of a pixel to the guard band, slivers, copies in one place, whole layers of equal depth,
// behind the eye, outside. `small` moves the sizes down.
std::vector<SoupTriangle> hard_soup(TestRandom& random, int n, double smallest, double largest) {
  std::vector<SoupTriangle> soup;
  while (static_cast<int>(soup.size()) < n) {
    const glm::dvec3 center = random_point(random, 3, 2, 2.5);
    const double size = std::exp(random.uniform(std::log(smallest), std::log(largest)));
    glm::dvec3 p[3];
    for (glm::dvec3& q : p) q = center + random_point(random, size, size, size);
    const uint32_t material = static_cast<uint32_t>(random.below(4) == 0);
    switch (random.below(8)) {
      case 0: p[2] = p[0] + (p[1] - p[0]) * random.uniform(-1, 2) + random_point(random, 1e-3, 1e-3, 1e-3); break;  // sliver
      case 1: for (glm::dvec3& q : p) q.z = 0.5; break;                                   // facing the eye: equal depths
      case 2: for (glm::dvec3& q : p) q = {std::round(q.x * 8) / 8, std::round(q.y * 8) / 8, 0.0}; break;
      case 3: p[0] *= 100.0; break;
      default: break;
    }
    soup.push_back(soup_triangle(p[0], p[1], p[2], material));
    if (random.below(4) == 0) {
      SoupTriangle copy = soup[static_cast<size_t>(random.below(static_cast<int>(soup.size())))];
      std::swap(copy.corner[0], copy.corner[1 + random.below(2)]);
      copy.material = static_cast<uint32_t>(random.below(4) == 0);
      soup.push_back(copy);
    }
  }
  return soup;
}

struct Soup { int triangles, width, height; double smallest, largest; };

void expect_oracle(uint32_t seed, const Soup& s) {
  TestRandom random(seed);
  Material mask;
  mask.transparency = static_cast<int32_t>(MaterialTransparency::kMask);
  mask.opacity = 0.5f;
  const std::vector<SoupTriangle> soup = hard_soup(random, s.triangles, s.smallest, s.largest);
  Camera camera;
  const glm::dvec3 eye = random_point(random, 0.5, 0.5, 0.2) + glm::dvec3(0, 0, 3);
  for (int k = 0; k < 3; ++k) camera.eye[k] = eye[k], camera.target[k] = 0.1 * k;
  Picture want;
  for (const Isa isa : supported_isas()) {
    Settings settings = test_settings(s.width, s.height, isa);
    settings.culling = seed % 3 == 0 ? Culling::kBack : Culling::kNone;
    const auto t = make_test_frame(make_test_scene(soup, {Material{}, mask}), camera, settings);
    t->frame.accept_row = accept_some;
    const FrontEnd front = run_front_end(t->frame);
    if (want.width == 0) {
      want = oracle_picture(t->frame, front.vertices);
      int seen = 0;
      for (const uint32_t id : want.primitive) seen += id != kNoPrimitive;
      EXPECT_GT(seen, s.width * s.height / 50);
    }
    const Picture got = rasterize(t->frame, front.bins);
    int wrong = 0;
    for (size_t i = 0; i < want.primitive.size(); ++i)
      wrong += got.primitive[i] != want.primitive[i] || std::memcmp(&got.depth[i], &want.depth[i], 4) != 0;
    ASSERT_EQ(wrong, 0) << "seed " << seed << " on " << isa_name(isa) << ": pixels that differ";
  }
}

TEST(RasterSoup, DepthAndIdsAreTheOracles) {
  const Soup kinds[] = {{2500, 200, 150, 1e-3, 3},     // all sizes
                        {6000, 150, 130, 1e-3, 0.05},  // tiny ones
                        {3000, 130, 190, 0.05, 0.4},   // middling ones
                        {300, 193, 65, 0.5, 30},       // large ones, layer upon layer
                        {3000, 64, 64, 0.02, 2}};      // one tile, deep
  uint32_t seed = 100;
  for (const Soup& s : kinds)
    for (int n = 0; n < 2; ++n) expect_oracle(++seed, s);
}

}  // namespace
}  // namespace spanray
