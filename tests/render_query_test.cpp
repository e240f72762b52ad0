// Questions outside of frames: the hits of frames, with names; errors instead of crashes; the same from every thread and tree.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <thread>

#include "spanray/query.h"
#include "spanray/render.h"
#include "support/random.h"
#include "support/scene_files.h"
#include "support/small_scene.h"
#include "support/temp_folder.h"
#include "support/test_frame.h"

namespace spanray {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

Scene load(const std::string& path) {
  Result<LoadedScene> loaded = load_scene(path);
  EXPECT_TRUE(loaded) << loaded.error().to_string();
  return loaded ? loaded.value().scene : Scene();
}
Scene shipped(const char* name) { return load(std::string(SPANRAY_SOURCE_DIR) + "/assets/" + name); }

Ray ray_from(float ox, float oy, float oz, float dx, float dy, float dz) { return {{ox, oy, oz}, {dx, dy, dz}}; }

TEST(Query, NamesOfMaterialObjectAndGroup) {
  const TempFolder folder;
  folder.write("two.mtl", "newmtl stone\nKd 1 1 1\nnewmtl wood\nKd 1 0 0\n");
  const Scene scene = load(folder.write("two.obj",
                                        "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\n"
                                        "o  the table \nusemtl wood\nf 2 4 3\ng left leg\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf 5 6 7\n"
                                        "usemtl stone\no\nv 9 0 0\nv 10 0 0\nv 9 1 0\nf 8 9 10\n"
                                        "o dropped\nv 1e31 0 0\nf 8 9 11\ng\no the table\nv 13 0 0\nv 14 0 0\nv 13 1 0\nf 12 13 14\n"));
  const SceneQuery query(scene);
  struct { float x; uint32_t triangle; const char *material, *object, *group; } const want[] = {
      {0.2f, 0, "(default)", "", ""}, {0.9f, 1, "wood", "the table", ""}, {5.2f, 2, "wood", "the table", "left leg"},
      {9.2f, 3, "stone", "", "left leg"}, {13.2f, 4, "stone", "the table", ""}};
  for (const auto& w : want) {
    const auto hit = query.closest(ray_from(w.x, 0.2f, 2, 0, 0, -4));
    ASSERT_TRUE(hit && hit.value()) << w.x;
    const RayHit& h = *hit.value();
    EXPECT_EQ(w.triangle, h.name.triangle) << w.x;
    EXPECT_EQ(w.material, h.name.material) << w.x;
    EXPECT_EQ(w.object, h.name.object) << w.x;
    EXPECT_EQ(w.group, h.name.group) << w.x;
    EXPECT_NEAR(0.5, h.t, 1e-12);
    EXPECT_NEAR(2, h.distance, 1e-12);
    EXPECT_NEAR(w.x, h.position[0], 1e-6);
    EXPECT_NEAR(0, h.position[2], 1e-12);
    EXPECT_EQ(1, h.normal[2]);
    EXPECT_TRUE(h.front);
  }
  const auto behind = query.closest(ray_from(0.2f, 0.2f, -3, 0, 0, 1));
  ASSERT_TRUE(behind && behind.value());
  EXPECT_FALSE(behind.value()->front);
  EXPECT_EQ(1, behind.value()->normal[2]) << "of the front, whoever asks";
}

// Masks, screen-doors and panes included: the ids of a frame whose primary rays are traced.
TEST(Query, APixelIsWhatTheFrameShowsThere) {
  for (const char* name : {"cornell.toml", "gauze.toml", "glass.toml"}) {
    const Scene scene = shipped(name);
    Settings settings = scene.settings();
    settings.width = 96, settings.height = 54, settings.visibility = Visibility::kRay, settings.shadows = Shadows::kNone;
    settings.reflections = Reflections::kNone;
    Renderer renderer;
    Framebuffer frame;
    FrameRequest request;
    request.primitive = request.depth = true;
    ASSERT_TRUE(renderer.render(scene, scene.cameras()[0], settings, frame, request));
    QueryOptions opaque;
    opaque.translucent = false;  // ids are those of opaque surfaces
    const SceneQuery query(scene, opaque), panes(scene);
    int hits = 0, nearer = 0;
    for (int i = 0; i < 96 * 54; ++i) {
      const auto hit = query.pixel(scene.cameras()[0], settings, i % 96, i / 96);
      const auto any = panes.pixel(scene.cameras()[0], settings, i % 96, i / 96);
      ASSERT_TRUE(hit && any);
      const uint32_t id = frame.primitive[static_cast<size_t>(i)];
      ASSERT_EQ(id, hit.value() ? hit.value()->name.triangle : kNoPrimitive) << name << " pixel " << i;
      nearer += any.value() && (!hit.value() || any.value()->t < hit.value()->t);
      if (!hit.value()) continue;
      ++hits;
      ASSERT_TRUE(any.value() && any.value()->t <= hit.value()->t);
      const double near = scene.cameras()[0].near_plane, depth = near / (hit.value()->t + near);
      ASSERT_NEAR(frame.depth[static_cast<size_t>(i)], depth, 1e-5 * depth) << name << " pixel " << i;
    }
    EXPECT_GT(hits, 1000) << name;
    EXPECT_EQ(std::string(name) == "glass.toml", nearer > 100) << name << ": panes";
  }
}

// t_min goes through all layers; any and closest agree; a batch answers as single rays do; so does every instruction set.
TEST(Query, RaysAgreeWithEachOther) {
  const Scene scene = shipped("spheres.toml");
  const SceneQuery query(scene);
  TestRandom random(5);
  std::vector<Ray> rays;
  for (int i = 0; i < 400; ++i) {
    Ray ray;
    for (int k = 0; k < 3; ++k) {
      ray.origin[k] = static_cast<float>(random.uniform(-4, 4));
      ray.direction[k] = static_cast<float>(random.uniform(-1, 1));
    }
    if (i % 3 == 0) ray.t_max = static_cast<float>(random.uniform(0, 4));
    rays.push_back(ray);
  }
  const auto batch = query.closest(rays);
  ASSERT_TRUE(batch);
  int hits = 0, layers = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    Ray ray = rays[i];
    const auto single = query.closest(ray);
    ASSERT_TRUE(single);
    ASSERT_EQ(batch.value()[i].has_value(), single.value().has_value());
    ASSERT_EQ(single.value().has_value(), query.any(ray).value());
    if (!single.value()) continue;
    ++hits;
    ASSERT_EQ(batch.value()[i]->name.triangle, single.value()->name.triangle);
    ASSERT_EQ(batch.value()[i]->t, single.value()->t);
    double before = 0;
    for (auto hit = single; hit && hit.value(); hit = query.closest(ray)) {
      ASSERT_GE(hit.value()->t, static_cast<double>(ray.t_min));
      ASSERT_GT(hit.value()->t, before);
      ASSERT_TRUE(query.any(ray).value());
      before = hit.value()->t, ++layers;
      ray.t_min = std::nextafter(static_cast<float>(before), kInf);
      if (ray.t_min > ray.t_max) break;
    }
    for (const Isa isa : supported_isas()) {
      QueryOptions options;
      options.isa = isa;
      static std::map<Isa, SceneQuery> by_isa;
      const SceneQuery& other = by_isa.try_emplace(isa, scene, options).first->second;
      const auto again = other.closest(rays[i]);
      ASSERT_TRUE(again && again.value());
      ASSERT_EQ(again.value()->name.triangle, single.value()->name.triangle) << isa_name(isa);
      ASSERT_EQ(again.value()->t, single.value()->t);
    }
  }
  EXPECT_GT(hits, 100);
  EXPECT_GT(layers, hits + 20);
}

TEST(Query, ASphereOfNoSizeIsARay) {
  const Scene scene = shipped("gauze.toml");
  QueryOptions solid;
  solid.cutouts = false;
  const SceneQuery query(scene), walls(scene, solid);
  TestRandom random(6);
  int hits = 0;
  for (int i = 0; i < 500; ++i) {
    SphereSweep sphere;
    Ray ray;
    ray.t_max = 1;
    for (int k = 0; k < 3; ++k) {
      ray.origin[k] = static_cast<float>(random.uniform(-3, 3)), sphere.start[k] = ray.origin[k];
      ray.direction[k] = static_cast<float>(random.uniform(-4, 4)), sphere.end[k] = sphere.start[k] + ray.direction[k];
    }
    const auto met = walls.closest(ray);
    const auto swept = query.sweep(sphere);
    ASSERT_TRUE(met && swept);
    for (int k = 0; k < 3; ++k) ray.direction[k] = static_cast<float>(sphere.end[k] - sphere.start[k]);
    ASSERT_EQ(met.value().has_value(), swept.value().has_value()) << i;
    if (!met.value()) continue;
    ++hits;
    EXPECT_EQ(met.value()->name.triangle, swept.value()->name.triangle);
    EXPECT_EQ(met.value()->t, swept.value()->time);
    // A tiny sphere comes to nearly the same place.
    sphere.radius = 1e-6;
    const auto tiny = query.sweep(sphere);
    ASSERT_TRUE(tiny && tiny.value());
    EXPECT_LE(tiny.value()->distance, met.value()->distance + 1e-9);
  }
  EXPECT_GT(hits, 100);
}

TEST(Query, SpheresTellWhereAndWhat) {
  const TempFolder folder;
  const SceneQuery query(load(write_small_scene(folder)));
  SphereSweep sphere{{1, 1.5, 1.5}, {1, -8.5, 1.5}, 0.25};
  const auto hit = query.sweep(sphere);
  ASSERT_TRUE(hit && hit.value());
  EXPECT_EQ("floor", hit.value()->name.material);
  EXPECT_NEAR(0.125, hit.value()->time, 1e-12);
  EXPECT_NEAR(1.25, hit.value()->distance, 1e-12);
  EXPECT_NEAR(0.25, hit.value()->center[1], 1e-12);
  EXPECT_NEAR(0, hit.value()->position[1], 1e-12);
  EXPECT_NEAR(1, hit.value()->normal[1], 1e-12);
  const auto pane = query.sweep({{-0.7, 0.6, 3}, {-0.7, 0.6, 0}, 0.1});
  ASSERT_TRUE(pane && pane.value());
  EXPECT_EQ("glass", pane.value()->name.material) << "panes are solid";
  const auto touching = query.touching({-1.9, 0.05, -1.85}, 0.2);
  ASSERT_TRUE(touching);
  ASSERT_GE(touching.value().size(), 2u);
  EXPECT_EQ("floor", touching.value()[0].name.material);
  EXPECT_NEAR(0.05, touching.value()[0].distance, 1e-7);
  EXPECT_EQ("mirror", touching.value().back().name.material);
  EXPECT_NEAR(1, touching.value().back().normal[2], 1e-7);
  EXPECT_TRUE(query.touching({0, 50, 0}, 1).value().empty());
}

TEST(Query, BadQuestionsAreErrors) {
  const TempFolder folder;
  const SceneQuery query(load(write_small_scene(folder)));
  const auto says = [&](const Ray& ray, const char* words) {
    const auto closest = query.closest(ray);
    ASSERT_FALSE(closest) << words;
    EXPECT_NE(std::string::npos, closest.error().message.find(words)) << closest.error().message;
    EXPECT_FALSE(query.any(ray));
    const auto batch = query.closest(std::vector<Ray>{Ray{}, ray});
    ASSERT_FALSE(batch);
    EXPECT_NE(std::string::npos, batch.error().message.find(std::string("ray 1: ") + words)) << batch.error().message;
  };
  says(ray_from(0, 1, 0, 0, 0, 0), "the direction is zero");
  for (const float bad : {kNan, kInf, -kInf}) {
    says(ray_from(0, 1, 0, 1, bad, 0), "the direction is not finite");
    says(ray_from(bad, 1, 0, 1, 0, 0), "the origin is not finite");
  }
  Ray ray;
  ray.t_min = 2, ray.t_max = 1;
  says(ray, "t_min is greater than t_max");
  ray.t_min = kNan;
  says(ray, "t_min is negative or not finite");
  ray.t_min = 0, ray.t_max = -1;
  says(ray, "t_max is negative or NaN");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const SphereSweep bad_sweeps[] = {{{0, nan, 0}, {1, 1, 1}, 1}, {{0, 0, 0}, {1, HUGE_VAL, 1}, 1}, {{0, 0, 0}, {1, 1e31, 1}, 1},
                                    {{0, 0, 0}, {1, 1, 1}, -1},  {{0, 0, 0}, {1, 1, 1}, nan},      {{1, 2, 3}, {1, 2, 3}, 1}};
  for (const SphereSweep& s : bad_sweeps) {
    const auto answer = query.sweep(s);
    ASSERT_FALSE(answer);
    EXPECT_EQ(0u, answer.error().message.find("the sphere: "));
  }
  EXPECT_FALSE(query.touching({0, nan, 0}, 1));
  EXPECT_FALSE(query.touching({0, 0, 0}, HUGE_VAL));
  Settings ten;
  ten.width = ten.height = 10;
  EXPECT_FALSE(query.pixel(Camera(), ten, 10, 0));
  Camera broken;
  broken.eye[0] = nan;
  EXPECT_FALSE(query.pixel(broken, ten, 1, 1));
  ten.width = 0;
  EXPECT_FALSE(query.pixel(Camera(), ten, 0, 0));
  const SceneQuery none{Scene()};
  EXPECT_FALSE(none.prepare());
  EXPECT_FALSE(none.closest(Ray()));
  EXPECT_FALSE(none.sweep({{0, 0, 0}, {1, 1, 1}, 1}));
}

TEST(Query, AnEmptySceneAnswersNothing) {
  const TempFolder folder;
  const SceneQuery query(load(folder.write("empty.obj", "v 0 0 0\n")));
  EXPECT_TRUE(query.closest(Ray()) && !query.closest(Ray()).value());
  EXPECT_FALSE(query.any(Ray()).value());
  EXPECT_FALSE(query.sweep({{0, 0, 0}, {1, 1, 1}, 1}).value());
  EXPECT_TRUE(query.touching({0, 0, 0}, 1).value().empty());
}

TEST(Query, ManyThreadsMayAskAtOnceEvenFirst) {
  const Scene scene = shipped("cornell.toml");
  const SceneQuery query(scene), before(scene);
  Ray ray;
  for (int k = 0; k < 3; ++k) {
    ray.origin[k] = static_cast<float>(scene.cameras()[0].eye[k]);
    ray.direction[k] = static_cast<float>(scene.cameras()[0].target[k] - scene.cameras()[0].eye[k]);
  }
  const auto want = before.closest(ray);
  ASSERT_TRUE(want && want.value());
  std::vector<std::thread> threads;
  std::vector<int> right(8, 0);
  for (size_t i = 0; i < right.size(); ++i)
    threads.emplace_back([&, i] {
      const SceneQuery copy = query;
      for (int n = 0; n < 200; ++n) {
        const auto hit = copy.closest(ray);
        right[i] += hit && hit.value() && hit.value()->t == want.value()->t && hit.value()->name.material == want.value()->name.material;
      }
    });
  for (std::thread& t : threads) t.join();
  EXPECT_EQ(std::vector<int>(8, 200), right);
}

}  // namespace
}  // namespace spanray
