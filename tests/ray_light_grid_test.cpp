// Shadow rays that ask the grid of a light get the answers of the tree.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "ray/light_grid.h"
#include "support/ray_answers.h"

namespace spanray {
namespace {

Light point_light(const glm::dvec3& p) {
  Light light;
  light.kind = 0;
  for (int k = 0; k < 3; ++k) light.position[k] = static_cast<float>(p[k]);
  return light;
}

Light directional_light(const glm::dvec3& d) {
  Light light;
  light.kind = 1;
  const glm::dvec3 unit = normalize3(d, glm::dvec3(0, -1, 0));
  for (int k = 0; k < 3; ++k) light.direction[k] = static_cast<float>(unit[k]);
  return light;
}

// As shade/light_rays_kernel.cpp makes them, by the formulas of catalog/lights.
void add_shadow_ray(RayBatch& rays, const Light& light, const float (&origin)[3], uint32_t from = kNoPrimitive) {
  glm::dvec3 o, d;
  for (int k = 0; k < 3; ++k) o[k] = static_cast<double>(origin[k]), d[k] = static_cast<double>(light.kind == 0 ? light.position[k] - origin[k] : -light.direction[k]);
  const int i = add_ray(rays, o, d, light.kind == 0 ? 1.0f - 0x1p-16f : kInfinity, from);
  rays.pixel[static_cast<size_t>(i)] = static_cast<uint32_t>(i);
}

void add_shadow_ray(RayBatch& rays, const Light& light, const glm::dvec3& o, uint32_t from = kNoPrimitive) {
  const float origin[3] = {static_cast<float>(o.x), static_cast<float>(o.y), static_cast<float>(o.z)};
  add_shadow_ray(rays, light, origin, from);
}

std::vector<uint32_t> any_bits(const RayBatch& rays) { return std::vector<uint32_t>(static_cast<size_t>(rays.count) / 32 + 1, 0xdeadbeef); }

struct Seen { int stopped = 0, open = 0, grids = 0; };

// Every instruction set, both ways.
void compare(TestFrame& t, const std::vector<RayBatch>& batches, Seen& seen, const std::string& where) {
  const Bvh bvh = build_all(t);
  const LightGrids grids(t.scene, t.material_flags.data(), bvh, *t.parallel);
  for (size_t l = 0; l < batches.size(); ++l) {
    const LightGrid* const grid = grids.of(l);
    if (grid == nullptr) continue;
    ++seen.grids;
    const RayBatch& rays = batches[l];
    for (const Isa isa : supported_isas()) {
      t.frame.isa = isa;
      std::vector<uint32_t> want = any_bits(rays), got = any_bits(rays);
      trace_any(t.frame, bvh, rays, want.data());
      trace_to_light(t.frame, bvh, *grid, rays, got.data());
      for (int i = 0; i < rays.count; ++i) {
        const bool is = got[static_cast<size_t>(i) / 32] >> (i % 32) & 1, should = want[static_cast<size_t>(i) / 32] >> (i % 32) & 1;
        const glm::dvec3 o = ray_origin(rays, i), d = ray_direction(rays, i);
        ASSERT_EQ(is, should) << where << ", light " << l << ", " << isa_name(isa) << ", ray " << i << " of " << rays.count << ": origin " << o.x << " " << o.y << " "
                              << o.z << ", direction " << d.x << " " << d.y << " " << d.z;
        ++(should ? seen.stopped : seen.open);
      }
    }
  }
}

uint32_t find_wall(const SceneData& scene) {
  for (uint32_t p = 0; p < scene.triangles.size(); ++p)
    if (length3(scene_vertex(scene, p, 0) - scene_vertex(scene, p, 1)) > 30) return p;
  ADD_FAILURE() << "no wall";
  return 0;
}

glm::dvec3 in_triangle(TestRandom& random, const SceneData& scene, uint32_t p, int kind) {
  double w[3] = {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
  if (kind == 1) w[random.below(3)] = 0;                            // on an edge
  if (kind == 2) w[random.below(3)] = 0, w[random.below(3)] = 0;    // mostly in a corner
  const double sum = w[0] + w[1] + w[2];
  if (sum == 0) return scene_vertex(scene, p, 0);
  return (scene_vertex(scene, p, 0) * w[0] + scene_vertex(scene, p, 1) * w[1] + scene_vertex(scene, p, 2) * w[2]) / sum;
}

// From surfaces; through edges and corners of what stands between; from anywhere, also far outside; not from anywhere at all.
RayBatch shadow_rays(TestRandom& random, const SceneData& scene, const Light& light, int n, double size, const glm::dvec3& center) {
  RayBatch rays;
  const uint32_t primitives = static_cast<uint32_t>(scene.triangles.size());
  const glm::dvec3 to_light = {light.position[0], light.position[1], light.position[2]}, along = {light.direction[0], light.direction[1], light.direction[2]};
  for (int i = 0; i < n; ++i) {
    const uint32_t p = static_cast<uint32_t>(random.below(static_cast<int>(primitives)));
    const glm::dvec3 at = in_triangle(random, scene, p, random.below(3));
    if (i % 3 == 0) {
      add_shadow_ray(rays, light, at + random_point(random, size * std::exp2(-random.uniform(10, 26))), i % 2 == 0 ? p : kNoPrimitive);
    } else if (i % 3 == 1) {  // beyond it, as the light sees it
      const double away = random.uniform(0, 2);
      add_shadow_ray(rays, light, light.kind == 0 ? to_light + (at - to_light) * (1 + away) : at + along * (away * size));
    } else {
      add_shadow_ray(rays, light, center + random_point(random, i % 30 == 2 ? 50 * size : i % 4 == 0 ? 3.5 * size : 1.2 * size));
    }
  }
  const float nan = std::nanf(""), inf = static_cast<float>(kInfinity), huge = 3e38f;
  for (const float bad : {nan, inf, -inf, huge, 0.0f}) add_shadow_ray(rays, light, {bad, bad, 0.0f});
  if (light.kind == 0) add_shadow_ray(rays, light, light.position);  // in the light itself
  return rays;
}

std::vector<SoupTriangle> awkward_soup(TestRandom& random, double size, const glm::dvec3& center) {
  std::vector<SoupTriangle> soup;
  add_mesh(soup, make_sphere(2), 0.4, glm::dvec3(0.3, 0.1, -0.2));
  add_random_triangles(soup, random, 150, 0.1);
  add_random_triangles(soup, random, 20, 0.8);
  for (int i = 0; i < 30; ++i) {  // needles, points, grains
    const glm::dvec3 p = random_point(random, 1), d = random_point(random, 0.5);
    soup.push_back(soup_triangle(p, p + d, p + d * 0.5 + random_point(random, 1e-5)));
    if (i % 10 == 0) soup.push_back(soup_triangle(p, p, p)), soup.push_back(soup_triangle(p, p + d, p));
    if (i % 5 == 0) soup.push_back(soup_triangle(p, p + random_point(random, 1e-4), p + random_point(random, 1e-4)));
  }
  for (const double y : {-0.9, 0.9})  // a floor and a ceiling of two triangles each, and a wall in the plane x = 0
    soup.push_back(soup_triangle({-1, y, -1}, {1, y, -1}, {1, y, 1})), soup.push_back(soup_triangle({-1, y, -1}, {1, y, 1}, {-1, y, 1}));
  soup.push_back(soup_triangle({0, -0.9, -0.5}, {0, 0.9, -0.5}, {0, 0.9, 0.1}));
  for (SoupTriangle& t : soup)
    for (Vertex& v : t.corner)
      for (int k = 0; k < 3; ++k) v.position[k] = static_cast<float>(static_cast<double>(v.position[k]) * size + center[k]);
  return soup;
}

// Scales and places from HARD-CASES: 2^-20 to 2^20, and up to 2^20 sizes away from the origin.
TEST(RayLightGrid, AnswersAreThoseOfTheTree) {
  TestRandom random(71);
  Seen seen;
  int lights = 0;
  for (const double exponent : {0.0, -20.0, 20.0, 3.0}) {
    for (const double offset : {0.0, 0x1p10, 0x1p20}) {
      const double size = std::exp2(exponent);
      const glm::dvec3 center = glm::dvec3(1, -0.5, 0.25) * (offset * size);
      auto t = frame_of(awkward_soup(random, size, center));
      const auto at = [&](double x, double y, double z) { return point_light(center + glm::dvec3(x, y, z) * size); };
      const glm::dvec3 corner = scene_vertex(t->scene, 200, 0), middle = in_triangle(random, t->scene, 330, 0);
      t->scene.lights = {at(0.1, 0.7, 0.3), at(0, 0.5, -0.4), at(3, 5, -2), at(0.3, 0.1, -0.2), at(0.2, 0.9, 0.1), point_light(corner), point_light(middle),
                         directional_light({0, -1, 0}), directional_light({-0.3, -0.8, 0.5}), directional_light({1, 0, 0}), directional_light({0, 1e-6, 1})};
      lights += static_cast<int>(t->scene.lights.size());
      std::vector<RayBatch> batches;
      for (const Light& light : t->scene.lights) batches.push_back(shadow_rays(random, t->scene, light, 4000, size, center));
      compare(*t, batches, seen, "size 2^" + std::to_string(exponent) + ", " + std::to_string(offset) + " sizes away");
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(seen.grids, lights * 3 / 4);
  EXPECT_GT(seen.stopped, 400'000);
  EXPECT_GT(seen.open, 80'000);
}

TEST(RayLightGrid, MaskedTrianglesAreAskedAndHideNothing) {
  TestRandom random(72);
  std::vector<SoupTriangle> soup;
  add_random_triangles(soup, random, 40, 1.5, 1);
  add_random_triangles(soup, random, 200, 0.3, 0);
  std::vector<Material> materials(2);
  auto t = frame_of(soup, materials);
  t->material_flags = {0, kMaterialMasked};
  t->frame.material_flags = t->material_flags.data();
  t->frame.accept_rays = accept_every_other;
  t->scene.lights = {point_light({0.2, 0.3, 0.1}), point_light({4, 3, 2}), directional_light({-1, -1, -1})};
  std::vector<RayBatch> batches;
  for (const Light& light : t->scene.lights) batches.push_back(shadow_rays(random, t->scene, light, 6000, 1, glm::dvec3(0)));
  Seen seen;
  compare(*t, batches, seen, "masks");
  EXPECT_EQ(seen.grids, 3);
}

// What a wall hides from the light takes no room, and rays from there are known to be stopped all the same.
TEST(RayLightGrid, NothingIsKeptBehindAWall) {
  TestRandom random(73);
  const SoupTriangle wall = soup_triangle({-20, -20, 1}, {20, -20, 1}, {0, 30, 1});
  std::vector<SoupTriangle> behind;
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 p = random_point(random, 1) - glm::dvec3(0, 0, 2);
    behind.push_back(soup_triangle(p, p + random_point(random, 0.2), p + random_point(random, 0.2)));
  }
  const auto entries = [&](const std::vector<SoupTriangle>& soup) {
    auto t = frame_of(soup);
    t->scene.lights = {point_light({0, 0, 6})};
    const Bvh bvh = build_all(*t);
    const LightGrids grids(t->scene, t->material_flags.data(), bvh, *t->parallel);
    Seen seen;
    std::vector<RayBatch> batches;
    batches.push_back(shadow_rays(random, t->scene, t->scene.lights[0], 3000, 2, glm::dvec3(0, 0, -1)));
    compare(*t, batches, seen, "wall");
    return grids.of(0)->words.size() / 3;
  };
  const size_t hiding = entries({wall}), hidden = entries(behind);
  behind.push_back(wall);
  EXPECT_GT(hidden, 2000u);
  EXPECT_EQ(entries(behind), hiding);
}

TEST(RayLightGrid, NoGridWhereTheTreeMustAnswer) {
  auto t = frame_of({soup_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})});
  t->scene.lights = {point_light({0.2, 0.2, 1})};
  const Bvh bvh = build_all(*t);
  const auto count = [&] { return LightGrids(t->scene, t->material_flags.data(), bvh, *t->parallel).count(); };
  EXPECT_EQ(count(), 1u);
  t->scene.light_follows_eye = true;
  EXPECT_EQ(count(), 0u) << "a grid for every place of the eye";
  t->scene.light_follows_eye = false;
  t->scene.lights = {point_light({1e30, 0, 0})};
  EXPECT_EQ(count(), 0u) << "farther than its numbers reach";
  std::vector<SoupTriangle> fan;
  for (int i = 0; i < 9; ++i) fan.push_back(soup_triangle({0, 0, 0}, {1, 0.1 * i, 0}, {0, 1, 0.1 * i}));
  auto crowded = frame_of(fan);
  crowded->scene.lights = {point_light({0, 0, 0}), point_light({0, 0, 2})};
  const Bvh tree = build_all(*crowded);
  const LightGrids grids(crowded->scene, crowded->material_flags.data(), tree, *crowded->parallel);
  EXPECT_EQ(grids.of(0), nullptr) << "nine triangles touch the light";
  EXPECT_NE(grids.of(1), nullptr);
  EXPECT_EQ(grids.of(2), nullptr) << "no such light";
}

// Rays that leave a wall from far behind it, as no surface makes them: the wall does not stop them, what it hides does.
TEST(RayLightGrid, RaysThatLeaveAWallFromBehindMeetWhatItHides) {
  TestRandom random(75);
  std::vector<SoupTriangle> soup;
  add_random_triangles(soup, random, 300, 0.4);
  soup.push_back(soup_triangle({-20, -20, 2}, {20, -20, 2}, {0, 30, 2}));
  auto t = frame_of(soup);
  const uint32_t wall = find_wall(t->scene);
  t->scene.lights = {point_light({0, 0, 6}), directional_light({0, 0, -1})};
  std::vector<RayBatch> batches;
  for (const Light& light : t->scene.lights) {
    RayBatch rays;
    for (int i = 0; i < 4000; ++i) add_shadow_ray(rays, light, random_point(random, 1.5) + glm::dvec3(0, 0, i % 2 == 0 ? 0 : -1), i % 3 == 0 ? kNoPrimitive : wall);
    batches.push_back(std::move(rays));
  }
  Seen seen;
  compare(*t, batches, seen, "behind the wall they leave");
  EXPECT_EQ(seen.grids, 2);
  EXPECT_GT(seen.open, 1000);
}

// A scene a few units in the last place wide: the middle is no float.
TEST(RayLightGrid, SmallSceneFarFromTheOrigin) {
  const double at = 0x1p20, ulp = 0.125;
  for (const int span : {3, 7, 15, 31, 63, 99}) {
    std::vector<SoupTriangle> soup;
    for (int i = 0; i < span; ++i) {
      const double x = at + i * ulp;
      soup.push_back(soup_triangle({x, 0, -0.05}, {x + ulp, 0, -0.05}, {x + ulp, 0, 0.05})), soup.push_back(soup_triangle({x, 0, -0.05}, {x + ulp, 0, 0.05}, {x, 0, 0.05}));
    }
    auto t = frame_of(soup);
    t->scene.lights = {directional_light({0, -1, 0}), directional_light({0.1, -1, 0.02})};
    TestRandom random(76);
    std::vector<RayBatch> batches;
    for (const Light& light : t->scene.lights) {
      RayBatch rays;
      for (int i = 0; i < 600; ++i) add_shadow_ray(rays, light, glm::dvec3(at + ulp * random.below(span + 1), -random.uniform(0, 1) * 0.05 * span * ulp, random.uniform(-0.05, 0.05)));
      batches.push_back(std::move(rays));
    }
    Seen seen;
    compare(*t, batches, seen, std::to_string(span) + " units wide");
    if (HasFatalFailure()) return;
    EXPECT_GT(seen.stopped, 100);
  }
}

// Coplanar triangles in a turned plane through the light, or nearly: rays end beside it by rounding.
TEST(RayLightGrid, LightInATurnedPlane) {
  TestRandom random(77);
  for (int round = 0; round < 12; ++round) {
    const glm::dvec3 n = normalize3(random_point(random, 1), glm::dvec3(0, 1, 0)), u = normalize3(cross3(n, {0.3, 0.5, -0.8}), glm::dvec3(1, 0, 0)), v = cross3(n, u);
    const glm::dvec3 center = random_point(random, 1);
    std::vector<SoupTriangle> soup;
    for (int i = 0; i < 60; ++i) {
      const auto in_plane = [&](double x, double y) { return center + u * x + v * y; };
      const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), s = random.uniform(0.01, 0.3);
      soup.push_back(soup_triangle(in_plane(x, y), in_plane(x + s, y + 0.3 * s), in_plane(x - 0.2 * s, y + s)));
    }
    auto t = frame_of(soup);
    for (const double off : {0.0, 1e-8, -1e-7, 1e-6}) t->scene.lights.push_back(point_light(center + n * off));
    std::vector<RayBatch> batches;
    for (const Light& light : t->scene.lights) {
      RayBatch rays;
      for (int i = 0; i < 6000; ++i)
        add_shadow_ray(rays, light, center + u * random.uniform(-1, 1) + v * random.uniform(-1, 1) + n * (random.uniform(-1, 1) * std::exp2(-random.uniform(14, 30))));
      batches.push_back(std::move(rays));
    }
    Seen seen;
    compare(*t, batches, seen, "turned plane");
    if (HasFatalFailure()) return;
  }
}

// Layers that each fill every cell: the build gives up in time.
TEST(RayLightGrid, GivesUpWhereTrianglesFillAllCells) {
  std::vector<SoupTriangle> soup;
  for (int i = 0; i < 4000; ++i) soup.push_back(soup_triangle({-30, -30, 0.001 * i - 9}, {30, -30, 0.001 * i - 9}, {0, 40, 0.001 * i - 9}));
  auto t = frame_of(soup);
  t->scene.lights = {directional_light({0, 0, -1}), point_light({0, 0, -9.5})};
  const Bvh bvh = build_all(*t);
  EXPECT_EQ(LightGrids(t->scene, t->material_flags.data(), bvh, *t->parallel).count(), 0u);
}

// The same grid for any number of threads.
TEST(RayLightGrid, DoesNotDependOnThreads) {
  TestRandom random(74);
  auto t = frame_of(awkward_soup(random, 1, glm::dvec3(0)));
  t->scene.lights = {point_light({0.1, 0.7, 0.3}), directional_light({-0.3, -0.8, 0.5})};
  const Bvh bvh = build_all(*t);
  Parallel one(1), three(3);
  const LightGrids a(t->scene, t->material_flags.data(), bvh, one), b(t->scene, t->material_flags.data(), bvh, three);
  for (size_t l = 0; l < 2; ++l) {
    ASSERT_TRUE(a.of(l) != nullptr && b.of(l) != nullptr);
    EXPECT_TRUE(std::equal(a.of(l)->words.begin(), a.of(l)->words.end(), b.of(l)->words.begin(), b.of(l)->words.end()));
    EXPECT_EQ(a.of(l)->touching, b.of(l)->touching);
    ASSERT_EQ(a.of(l)->seen.size(), b.of(l)->seen.size());
    EXPECT_EQ(std::memcmp(a.of(l)->seen.data(), b.of(l)->seen.data(), a.of(l)->seen.size() * sizeof(LightGrid::Seen)), 0);
    EXPECT_TRUE(std::equal(a.of(l)->first.begin(), a.of(l)->first.end(), b.of(l)->first.begin(), b.of(l)->first.end()));
  }
}

}  // namespace
}  // namespace spanray
