// What a group of rays takes into the tree with it: that it is little, where little is in the way. (That nothing is missing: ray_entrance_test.cpp.)
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ray/bvh_data.h"
#include "support/awkward_rays.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ray_shaft_test.cpp"
#include "hwy/foreach_target.h"
#include "ray/entrance-inl.h"
#include "simd/dispatch.h"
HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// out: is there a shaft, entries and triangles of its entrance.
void entrance_kernel(const Bvh::Data& data, const RayBatch& rays, int out[3], std::vector<uint32_t>& primitives) {
  Shaft shaft;
  Entrance entrance;
  out[0] = make_shaft(data, rays, 0, rays.count, shaft);
  if (out[0] == 0) return;
  find_entrance(data, shaft, entrance);
  out[1] = entrance.entries, out[2] = entrance.triangles;
  primitives.assign(entrance.few.primitive, entrance.few.primitive + entrance.triangles);
}

}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();
#if HWY_ONCE
namespace spanray {
namespace {

using EntranceFn = void (*)(const Bvh::Data&, const RayBatch&, int[3], std::vector<uint32_t>&);
const EntranceFn kEntrance[kIsaCount] = SPANRAY_KERNEL_TABLE(entrance_kernel);

struct Found {
  bool shaft;
  int entries, triangles;
  std::vector<uint32_t> primitives;
};
Found entrance_of(const Bvh& bvh, const RayBatch& rays, Isa isa) {
  int out[3] = {0, 0, 0};
  Found found{};
  kEntrance[isa_index(isa)](bvh.data(), rays, out, found.primitives);
  found.shaft = out[0] != 0, found.entries = out[1], found.triangles = out[2];
  std::sort(found.primitives.begin(), found.primitives.end());
  return found;
}

// A floor of 32 x 32 squares around the origin, and above it, at height 1, one triangle (the last primitive).
std::vector<SoupTriangle> floor_and_roof(double scale) {
  std::vector<SoupTriangle> soup;
  for (int y = -16; y < 16; ++y)
    for (int x = -16; x < 16; ++x) {
      const glm::dvec3 p(x * scale, y * scale, 0), dx(scale, 0, 0), dy(0, scale, 0);
      soup.push_back(soup_triangle(p, p + dx, p + dx + dy));
      soup.push_back(soup_triangle(p, p + dx + dy, p + dy));
    }
  soup.push_back(soup_triangle(glm::dvec3(0, 0, scale), glm::dvec3(2 * scale, 0, scale), glm::dvec3(0, 2 * scale, scale)));
  return soup;
}

// From 16 x 16 points of the floor, as far off it as origins are moved, to a light above.
RayBatch shadow_rays(const glm::dvec3& corner, double scale) {
  RayBatch rays = make_rays(256);
  const glm::dvec3 light(-3 * scale, -2 * scale, 20 * scale);
  for (int i = 0; i < 256; ++i) {
    const glm::dvec3 o = corner * scale + glm::dvec3(i % 16, i / 16, 0) * (scale / 16) + glm::dvec3(0, 0, 1e-6 * scale);
    set_ray(rays, i, o, light - o, 1);
  }
  return rays;
}

TEST(RayShaft, ClearRaysAreProvenClearAndOthersMeetTheirOccluder) {
  for (const double scale : {0x1p-20, 1.0, 0x1p20}) {
    const std::vector<SoupTriangle> soup = floor_and_roof(scale);
    auto t = frame_of(soup);
    const Bvh bvh = build_bvh(t->scene, t->material_flags.data(), 0, 0, *t->parallel);
    for (const Isa isa : supported_isas()) {
      const Found clear = entrance_of(bvh, shadow_rays({-6.3, -5.2, 0}, scale), isa);
      EXPECT_TRUE(clear.shaft) << isa_name(isa);
      EXPECT_EQ(clear.entries + clear.triangles, 0) << isa_name(isa) << ": the floor itself is in nobody's way";
      const Found dark = entrance_of(bvh, shadow_rays({0.4, 0.3, 0}, scale), isa);
      EXPECT_TRUE(dark.shaft) << isa_name(isa);
      EXPECT_EQ(dark.entries, 0) << isa_name(isa);
      EXPECT_EQ(dark.primitives, std::vector<uint32_t>{static_cast<uint32_t>(soup.size() - 1)}) << isa_name(isa);
    }
  }
}

TEST(RayShaft, RaysWithoutCommonDirectionAndNumbersOutOfRangeHaveNone) {
  auto t = frame_of(floor_and_roof(1));
  const Bvh bvh = build_bvh(t->scene, t->material_flags.data(), 0, 0, *t->parallel);
  TestRandom random(7);
  RayBatch around = shadow_rays({0, 0, 0}, 1), far = shadow_rays({0, 0, 0}, 1), bad = shadow_rays({0, 0, 0}, 1);
  for (int i = 0; i < 256; ++i) set_ray(around, i, ray_origin(around, i), random_point(random));
  set_ray(far, 200, {1e12, 0, 0}, {1, 1, 1});
  set_ray(bad, 255, {0, 0, 1}, {0, std::nan(""), 1});
  for (const Isa isa : supported_isas())
    for (const RayBatch* rays : {&around, &far, &bad}) EXPECT_FALSE(entrance_of(bvh, *rays, isa).shaft) << isa_name(isa);
}

}  // namespace
}  // namespace spanray
#endif
