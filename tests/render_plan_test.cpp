// The plan: what a frame does not need is named, allocates nothing, and runs nothing (instruction counts: plan_callgrind_test).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "render/plan.h"
#include "scene/scene_builder.h"
#include "spanray/render.h"

namespace spanray {
namespace {

SoupTriangle triangle(float z, uint32_t material) {
  SoupTriangle t;
  const float xy[3][2] = {{-1, -1}, {1, -1}, {0, 1}};
  for (int i = 0; i < 3; ++i) t.corner[i] = {{xy[i][0], xy[i][1], z}, {0, 0, 1}, {0, 0}};
  t.material = material;
  return t;
}

// One matte triangle and one of `second`, one light.
Scene scene_with(const Material& second) {
  auto data = std::make_shared<SceneData>(make_test_scene({triangle(0, 0), triangle(0.5f, 1)}, {Material(), second}));
  Light light;
  light.position[2] = 4;
  light.intensity[0] = light.intensity[1] = light.intensity[2] = 20;
  data->lights.push_back(light);
  hash_scene(*data);
  return Scene(data);
}

Settings small() {
  Settings s;
  s.width = 64, s.height = 48, s.threads = 1;
  return s;
}

const PlanLine& line(const std::vector<PlanLine>& lines, const std::string& stage) {
  const auto it = std::find_if(lines.begin(), lines.end(), [&](const PlanLine& l) { return l.stage == stage; });
  if (it == lines.end()) throw std::runtime_error("no line " + stage);
  return *it;
}

TEST(Plan, NeedsWhatTheUsedMaterialsAsk) {
  Material mirror;
  mirror.mirror[0] = 0.5f;
  EXPECT_TRUE(line(plan_frame(scene_with(mirror), small()), "bounce rays").needed);
  EXPECT_FALSE(line(plan_frame(scene_with(Material()), small()), "bounce rays").needed);
  Material glass;
  glass.opacity = 0.5f;
  glass.transparency = static_cast<int32_t>(MaterialTransparency::kAlpha);
  EXPECT_TRUE(line(plan_frame(scene_with(glass), small()), "composite").needed);
  Material shiny;
  shiny.specular[1] = 0.1f;
  EXPECT_TRUE(line(plan_frame(scene_with(shiny), small()), "specular").needed);
  EXPECT_FALSE(line(plan_frame(scene_with(Material()), small()), "specular").needed);
}

TEST(Plan, CoarseShadingNeedsPixelsThatAreShadedOnce) {
  const auto needed = [&](ShadingRate rate, int samples, Antialiasing mode) {
    Settings s = small();
    s.shading_rate = rate, s.samples = samples, s.antialiasing = mode;
    return line(plan_frame(scene_with(Material()), s), "shading rate 2x2").needed;
  };
  EXPECT_FALSE(needed(ShadingRate::k1x1, 1, Antialiasing::kMultisample));
  EXPECT_TRUE(needed(ShadingRate::k2x2, 1, Antialiasing::kSupersample)) << "one sample: the pixel itself";
  EXPECT_TRUE(needed(ShadingRate::k2x2, 4, Antialiasing::kMultisample));
  EXPECT_FALSE(needed(ShadingRate::k2x2, 4, Antialiasing::kSupersample));
}

TEST(Plan, UnusedMaterialsCostNothing) {
  auto data = std::make_shared<SceneData>(make_test_scene({triangle(0, 0)}, {Material(), Material()}));
  data->materials[1].mirror[0] = 1;
  EXPECT_FALSE(line(plan_frame(Scene(data), small()), "bounce rays").needed);
}

TEST(Plan, EveryLineHasAReason) {
  for (const PlanLine& l : plan_frame(scene_with(Material()), small())) EXPECT_FALSE(l.reason.empty()) << l.stage;
}

// Each technique switched off by hand, on a scene that does not need it: the same bytes, the same memory.
TEST(Plan, WhatIsNotNeededAllocatesNothing) {
  const Scene scene = scene_with(Material());
  const auto run = [&](const Settings& s) {
    Renderer renderer;
    Framebuffer out;
    const auto stats = renderer.render(scene, scene.cameras()[0], s, out);
    EXPECT_TRUE(stats);
    return std::pair(stats.value().memory_bytes, hash_image(out.color));
  };
  Settings s = small();
  s.shadows = Shadows::kNone;
  const auto plain = run(s);
  Settings off = s;
  off.reflections = Reflections::kNone, off.textures = false, off.bump = false, off.transparency = Transparency::kNone;
  EXPECT_EQ(run(off), plain);
  // And the check can fail: shadow rays need a tree.
  s.shadows = Shadows::kRay;
  EXPECT_GT(run(s).first, plain.first);
}

TEST(Render, RefusesWhatIsOutOfRange) {
  const Scene scene = scene_with(Material());
  Renderer renderer;
  Framebuffer out;
  const auto error = [&](auto change) {
    Settings s = small();
    Camera c;
    change(s, c);
    const auto stats = renderer.render(scene, c, s, out);
    return stats ? std::string() : stats.error().message;
  };
  EXPECT_EQ(error([](Settings&, Camera&) {}), "");
  EXPECT_NE(error([](Settings& s, Camera&) { s.width = 0; }), "");
  EXPECT_NE(error([](Settings& s, Camera&) { s.height = 16385; }), "");
  EXPECT_NE(error([](Settings& s, Camera&) { s.threads = -1; }), "");
  EXPECT_NE(error([](Settings& s, Camera&) { s.max_bounces = 65; }), "");
  EXPECT_NE(error([](Settings&, Camera& c) { c.near_plane = 0; }), "");
  EXPECT_NE(error([](Settings&, Camera& c) { c.fov_y_degrees = 180; }), "");
  EXPECT_NE(error([](Settings&, Camera& c) { c.eye[0] = std::nan(""); }), "");
  EXPECT_NE(error([](Settings&, Camera& c) { c.target[2] = 5; }), "");
  const auto stats = renderer.render(Scene(), Camera(), small(), out);
  EXPECT_FALSE(stats);
}

}  // namespace
}  // namespace spanray
