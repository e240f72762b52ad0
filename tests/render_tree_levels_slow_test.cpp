// Enough copies that trees for rays have two levels: what is said of them before a frame and after, and that questions have the answers of one tree.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "render/ray_trees.h"
#include "spanray/query.h"
#include "support/frame_count.h"
#include "support/instance_scene.h"
#include "support/plane_scenes.h"

namespace spanray {
namespace {

constexpr int kSide = 160, kPlaces = 84;  // 83 copies spare 4.25 million triangles

// Waves of 51,200 triangles, in rows of ten.
SceneData scene_of(int places) {
  std::vector<SoupTriangle> part;
  const auto wave = [](int x, int z) { return glm::dvec3(x / 160.0, (x % 8) * (z % 5) / 4000.0, z / 160.0); };
  for (int x = 0; x < kSide; ++x)
    for (int z = 0; z < kSide; ++z) {
      part.push_back(soup_triangle(wave(x, z), wave(x, z + 1), wave(x + 1, z)));
      part.push_back(soup_triangle(wave(x + 1, z), wave(x, z + 1), wave(x + 1, z + 1)));
    }
  InstanceScene maker;
  maker.add_part({});
  maker.add_part(part);
  TestRandom random(91);
  for (int i = 0; i < places; ++i)
    maker.place(1, random_map(random, glm::dvec3(i % 2 == 0 ? 0.9 : -0.8), glm::dvec3(i % 10 * 1.1, 0, -1.1 * (i / 10))));
  SceneData data = maker.build();
  add_plane(plane_at({0, -2, 0}, {0, 1, 0}), data);
  add_lamp(data, {5, 4, 0}, 60);
  return data;
}

TEST(RenderTreeLevels, AreTwoWhereCopiesAreMany) {
  for (const int places : {kPlaces - 3, kPlaces}) {
    const Scene scene = finish(scene_of(places));
    Settings s = test_settings(64, 36, Isa::kAuto, 2);
    const RayTrees::Makeup trees = tree_makeup(scene.data(), s);
    EXPECT_EQ(trees.levels, places == kPlaces ? 2 : 1);
    EXPECT_EQ(trees.instances, places == kPlaces ? 84u : 0u);
    EXPECT_EQ(trees.bytes > 100'000'000, places != kPlaces) << trees.bytes;
    Renderer renderer;
    Framebuffer out;
    const Result<FrameStats> stats = renderer.render(scene, from_to({5, 3, 4}, {5, 0, -3}), s, out, {});
    ASSERT_TRUE(stats);
    EXPECT_EQ(count(stats.value(), "bvh_levels"), static_cast<uint64_t>(trees.levels));
    EXPECT_EQ(count(stats.value(), "bvh_instances"), trees.instances);
    EXPECT_EQ(count(stats.value(), "bvh_bytes"), trees.bytes);
  }
}

bool same(const double (&a)[3], const double (&b)[3]) { return std::equal(a, a + 3, b); }
bool same(const TriangleName& a, const TriangleName& b) {
  return a.triangle == b.triangle && a.material == b.material && a.object == b.object && a.group == b.group;
}
bool same(const RayHit& a, const RayHit& b) {
  return same(a.name, b.name) && a.t == b.t && a.distance == b.distance && same(a.position, b.position) && same(a.normal, b.normal) &&
         a.front == b.front;
}
bool same(const SweepHit& a, const SweepHit& b) {
  return same(a.name, b.name) && a.time == b.time && a.distance == b.distance && same(a.center, b.center) &&
         same(a.position, b.position) && same(a.normal, b.normal);
}
bool same(const SphereTouch& a, const SphereTouch& b) {
  return same(a.name, b.name) && a.distance == b.distance && same(a.position, b.position) && same(a.normal, b.normal);
}
template <class Hit> bool same(const Result<std::optional<Hit>>& a, const Result<std::optional<Hit>>& b) {
  if (!a || !b || a.value().has_value() != b.value().has_value()) return false;
  return !a.value() || same(*a.value(), *b.value());
}

TEST(RenderTreeLevels, QuestionsHaveTheAnswersOfOneTree) {
  const SceneQuery two{finish(scene_of(kPlaces))};
  SceneData data = scene_of(kPlaces);
  data.instances.clear(), data.instanced_parts.clear();  // written out
  const SceneQuery flat{finish(std::move(data))};
  ASSERT_TRUE(two.tree() && flat.tree());
  EXPECT_EQ(two.tree().value().levels, 2);
  EXPECT_EQ(two.tree().value().instances, 84u);
  EXPECT_LT(two.tree().value().bytes, 10'000'000u);
  EXPECT_EQ(flat.tree().value().levels, 1);
  EXPECT_EQ(flat.tree().value().instances, 0u);
  EXPECT_GT(flat.tree().value().bytes, 100'000'000u);
  TestRandom random(92);
  const auto place = [&] { return glm::dvec3(random.uniform(-1, 11), random.uniform(-1.5, 1.5), random.uniform(-9, 1)); };
  const auto store = [](const glm::dvec3& from, auto (&to)[3]) {
    for (int k = 0; k < 3; ++k) to[k] = static_cast<std::remove_reference_t<decltype(to[0])>>(from[k]);
  };
  std::vector<Ray> rays;
  int hits = 0, stopped = 0, touched = 0, seen = 0;
  const Camera camera = from_to({5, 3, 4}, {5, 0, -3});
  const Settings frame = test_settings(64, 36);
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 from = place(), to = place();
    Ray ray;
    store(from, ray.origin), store(to - from, ray.direction);
    if (i % 3 == 0) ray.t_max = 1;
    if (i % 4 == 0) ray.t_min = 0.25f;
    rays.push_back(ray);
    const auto met = two.closest(ray);
    ASSERT_TRUE(same(met, flat.closest(ray))) << i;
    ASSERT_EQ(met.value().has_value(), two.any(ray).value()) << i;
    ASSERT_EQ(met.value().has_value(), flat.any(ray).value()) << i;
    SphereSweep sphere;
    store(from, sphere.start), store(to, sphere.end), sphere.radius = i % 9 == 0 ? 0 : std::ldexp(1.0, random.between(-20, 1));
    const auto swept = two.sweep(sphere);
    ASSERT_TRUE(same(swept, flat.sweep(sphere))) << i;
    const double around = i % 2 == 0 ? sphere.radius * 0.1 : 0.3;
    const auto near = two.touching(sphere.start, around), plain = flat.touching(sphere.start, around);
    ASSERT_TRUE(near && plain) << i;
    ASSERT_TRUE(std::equal(near.value().begin(), near.value().end(), plain.value().begin(), plain.value().end(),
                           [](const SphereTouch& a, const SphereTouch& b) { return same(a, b); })) << i;
    hits += met.value().has_value(), stopped += swept.value().has_value(), touched += !near.value().empty();
    const auto pixel = two.pixel(camera, frame, i % 64, i / 64 % 36);
    ASSERT_TRUE(same(pixel, flat.pixel(camera, frame, i % 64, i / 64 % 36))) << i;
    seen += pixel.value().has_value() && !pixel.value()->name.plane;
  }
  const auto many = two.closest(rays), plain = flat.closest(rays);
  ASSERT_TRUE(many && plain);
  for (size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(many.value()[i].has_value(), plain.value()[i].has_value()) << i;
    ASSERT_TRUE(!many.value()[i] || same(*many.value()[i], *plain.value()[i])) << i;
  }
  for (const int n : {hits, stopped, touched, seen}) EXPECT_GT(n, 200);
}

}  // namespace
}  // namespace spanray
