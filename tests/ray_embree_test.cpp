// Embree as an independent judge: it says the same as we do of every ray, except where brute force in extended precision says that one
// of the two is wrong. Ours never is.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "embree_tracer.h"
#include "ray_classes.h"
#include "support/ray_answers.h"
#include "support/ray_judge.h"
#include "support/scene_files.h"

namespace spanray::peers {
namespace {

struct Tally {
  uint64_t rays = 0, same = 0, ties = 0, both_right = 0, ours_wrong = 0, embree_wrong = 0;
  void print(const std::string& what) const {
    const auto n = [](uint64_t v) { return static_cast<unsigned long long>(v); };
    std::printf("%-36s %8llu rays: %8llu same, %5llu ties, %4llu within rounding, ours wrong %llu, Embree wrong %llu\n",
                what.c_str(), n(rays), n(same), n(ties), n(both_right), n(ours_wrong), n(embree_wrong));
  }
};

void judge_closest(const TracedScene& ours, const EmbreeTracer& embree, EmbreeMode mode, const RayBatch& rays, Tally& tally) {
  const size_t n = static_cast<size_t>(rays.count);
  std::vector<uint32_t> a(n), b(n);
  std::vector<float> t(n);
  trace_closest(ours.frame, ours.bvh, rays, a.data());
  embree.closest(mode, rays, b.data(), t.data());
  const SceneData& scene = ours.scene.data();
  tally.rays += n;
  for (size_t i = 0; i < n; ++i) {
    if (a[i] == b[i]) { ++tally.same; continue; }
    const int ray = static_cast<int>(i);
    if (a[i] != kNoPrimitive && b[i] != kNoPrimitive) {
      const RayOracleHit mine = oracle_hit(scene, a[i], ray_origin(rays, ray), ray_direction(rays, ray));
      const bool same_distance = std::fabs(mine.t - static_cast<long double>(t[i])) <= RayJudge::kTie * std::fabs(mine.t);
      if (same_distance && (mine.hit || mine.margin <= RayJudge::kDoubt)) { ++tally.ties; continue; }
    }
    const RayJudge judge(scene, rays, ray);
    const bool mine = judge.closest_is_right(a[i]), theirs = judge.closest_is_right(b[i]);
    tally.both_right += mine && theirs, tally.ours_wrong += !mine, tally.embree_wrong += !theirs;
    if (!mine)
      std::printf("  ours is wrong: %u, Embree %u at %g\n", a[i], b[i], static_cast<double>(t[i]));
  }
}

void judge_any(const TracedScene& ours, const EmbreeTracer& embree, EmbreeMode mode, const RayBatch& rays, Tally& tally) {
  const size_t n = static_cast<size_t>(rays.count);
  std::vector<uint32_t> a(n / 32 + 1), b(n / 32 + 1);
  trace_any(ours.frame, ours.bvh, rays, a.data());
  embree.any(mode, rays, b.data());
  tally.rays += n;
  for (size_t i = 0; i < n; ++i) {
    const bool x = (a[i / 32] >> (i % 32)) & 1u, y = (b[i / 32] >> (i % 32)) & 1u;
    if (x == y) { ++tally.same; continue; }
    const RayJudge judge(ours.scene.data(), rays, static_cast<int>(i));
    const bool mine = judge.any_is_right(x), theirs = judge.any_is_right(y);
    tally.both_right += mine && theirs, tally.ours_wrong += !mine, tally.embree_wrong += !theirs;
    if (!mine) std::printf("  ours is wrong: any hit %d, Embree %d\n", x, y);
  }
}

glm::dvec3 place_in(const SceneData& scene, TestRandom& random) {
  glm::dvec3 p;
  for (int k = 0; k < 3; ++k) p[k] = random.uniform(double{scene.bounds_min[k]}, double{scene.bounds_max[k]});
  return p;
}

// Anywhere in the scene's box, in any direction; every third one short.
RayClass random_class(const SceneData& scene, int n) {
  TestRandom random(91);
  RayBatch rays = make_rays(n);
  for (int i = 0; i < n; ++i) {
    const glm::dvec3 o = place_in(scene, random), d = place_in(scene, random) - o;
    set_ray(rays, i, o, d, i % 3 == 0 ? static_cast<float>(random.uniform(0, 1)) : kInfinity);
  }
  RayClass c{"random", false, {}};
  c.parts.push_back(std::move(rays));
  return c;
}

// Where tracers err: at vertices, along and across edges, in the plane of a triangle.
RayClass grazing_class(const SceneData& scene, int n) {
  TestRandom random(92);
  RayBatch rays = make_rays(n);
  for (int i = 0; i < n; ++i) {
    const uint32_t p = static_cast<uint32_t>(random.below(static_cast<int>(scene.triangles.size())));
    const glm::dvec3 a = scene_vertex(scene, p, 0), b = scene_vertex(scene, p, 1), c = scene_vertex(scene, p, 2);
    const glm::dvec3 target = i % 4 == 0 ? a : a + (b - a) * random.uniform(0, 1);
    glm::dvec3 o = place_in(scene, random);
    if (i % 4 == 2) o = a + (b - a) * random.uniform(-9, 9) + (c - a) * random.uniform(-9, 9);  // in the plane
    if (i % 4 == 3) o = target + (b - a) * random.uniform(-9, -1);                             // along the edge
    set_ray(rays, i, o, target - o);
  }
  RayClass c{"grazing", false, {}};
  c.parts.push_back(std::move(rays));
  return c;
}

// All kinds of rays of a small frame against one tree of Embree's.
void judge_scene(const TracedScene& ours, const std::vector<RayClass>& classes, bool robust, const std::string& name) {
  const auto embree = EmbreeTracer::create(ours.scene.data(), robust, 1, 1);
  ASSERT_TRUE(embree) << embree.error().to_string();
  uint64_t all = 0;
  for (const RayClass& c : classes) {
    Tally tally;
    for (const EmbreeMode mode : {EmbreeMode::kSingle, EmbreeMode::kCoherent16})
      for (const RayBatch& part : c.parts)
        c.any_hit ? judge_any(ours, *embree.value(), mode, part, tally) : judge_closest(ours, *embree.value(), mode, part, tally);
    tally.print(name + (robust ? ", robust, " : ", fast, ") + c.name);
    EXPECT_EQ(0u, tally.ours_wrong) << name << " " << c.name;
    EXPECT_EQ(tally.rays, tally.same + tally.ties + tally.both_right + tally.embree_wrong) << name << " " << c.name;
    // Rays that start in a corner may meet its other wall at t = 0, or not; rays along edges are all doubtful.
    const bool grazing = c.name == "grazing";
    EXPECT_LE(tally.both_right, tally.rays / (grazing ? 4 : 50)) << name << " " << c.name;
    EXPECT_LE(tally.embree_wrong, tally.rays / (grazing ? 4 : 500)) << name << " " << c.name;
    all += tally.rays;
  }
  EXPECT_GT(all, 20000u) << name;
}

void judge(const std::string& path) {
  LoadOptions options;
  options.allow_outside = true;
  const Loaded loaded = must_load(path, options);
  const std::string name = std::filesystem::path(path).stem().string();
  Settings settings = loaded.loaded.scene.settings();
  settings.width = 160, settings.height = 90;
  Parallel parallel(1);
  const TracedScene ours(loaded.loaded.scene, loaded.loaded.scene.cameras()[0], settings, parallel, 1);
  std::vector<RayClass> classes = make_ray_classes(ours);
  classes.push_back(random_class(ours.scene.data(), 20000));
  classes.push_back(grazing_class(ours.scene.data(), 4000));
  for (const bool robust : {true, false}) judge_scene(ours, classes, robust, name);
}

// A floor at y = 0 and a larger one at y = -1; rays from above.
TEST(RayJudgeItself, SeesWhoIsWrong) {
  const auto t = frame_of({soup_triangle({-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}), soup_triangle({-8, -1, -8}, {-8, -1, 8}, {8, -1, 8})});
  RayBatch rays = make_rays(5);
  set_ray(rays, 0, {-0.5, 2, 0.25}, {0, -4, 0});        // through both
  set_ray(rays, 1, {-0.5, 2, 0.25}, {0, -4, 0}, 0.25f);  // too short for either
  set_ray(rays, 2, {-1, 2, 0.25}, {0, -1, 0});          // on the edge of the upper one
  set_ray(rays, 3, {-3, 2, 0.25}, {0, -1, 0});          // through the lower one
  set_ray(rays, 4, {-3, 2, 0.25}, {0, 1, 0});           // away
  const auto right = [&](int ray, uint32_t primitive) { return RayJudge(t->scene, rays, ray).closest_is_right(primitive); };
  const auto any_right = [&](int ray, bool found) { return RayJudge(t->scene, rays, ray).any_is_right(found); };
  const bool closest[5][3] = {{true, false, false}, {false, false, true}, {true, true, false}, {false, true, false}, {false, false, true}};
  const bool any[5][2] = {{false, true}, {true, false}, {false, true}, {false, true}, {true, false}};
  for (int ray = 0; ray < 5; ++ray) {
    EXPECT_EQ(closest[ray][0], right(ray, 0)) << ray;
    EXPECT_EQ(closest[ray][1], right(ray, 1)) << ray;
    EXPECT_EQ(closest[ray][2], right(ray, kNoPrimitive)) << ray;
    EXPECT_EQ(any[ray][0], any_right(ray, false)) << ray;
    EXPECT_EQ(any[ray][1], any_right(ray, true)) << ray;
  }
}

class RayEmbree : public ::testing::TestWithParam<const char*> {};
TEST_P(RayEmbree, SaysTheSameOrIsWrong) { judge(std::string(SPANRAY_SOURCE_DIR) + "/assets/" + GetParam() + ".toml"); }
INSTANTIATE_TEST_SUITE_P(Shipped, RayEmbree, ::testing::Values("cornell", "columns", "spheres", "glass", "gauze", "hall"));

class RayEmbreeOutside : public ::testing::TestWithParam<const char*> {};
TEST_P(RayEmbreeOutside, SaysTheSameOrIsWrong) {
  const char* folder = std::getenv("SPANRAY_SCENES");
  if (folder == nullptr) GTEST_SKIP() << "SPANRAY_SCENES is not set";
  const std::string path = std::string(folder) + "/" + GetParam();
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  judge(path);
}
INSTANTIATE_TEST_SUITE_P(Scenes, RayEmbreeOutside,
                         ::testing::Values("breakfast-room/breakfast-room.obj", "grey-white-room/grey-white-room.obj",
                                           "small-pine/small-pine.obj", "sponza-dabrovic/sponza.obj",
                                           "stanford-bunny/stanford-bunny.obj", "cornell-box/CornellBox-Sphere.obj"));

}  // namespace
}  // namespace spanray::peers
