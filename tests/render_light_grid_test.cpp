// When a renderer makes light grids, and that no picture shows it.
#include <gtest/gtest.h>

#include <algorithm>

#include "spanray/render.h"
#include "support/scene_files.h"

namespace spanray {
namespace {

uint64_t count(const FrameStats& stats, const char* name) {
  const auto found = std::find_if(stats.counts.begin(), stats.counts.end(), [&](const auto& c) { return c.first == name; });
  EXPECT_NE(found, stats.counts.end()) << name;
  return found == stats.counts.end() ? 0 : found->second;
}

struct Drawn {
  std::vector<uint8_t> bytes;
  FrameStats stats;
};

Drawn draw(Renderer& renderer, const Scene& scene, const Settings& settings) {
  Framebuffer out;
  Result<FrameStats> stats = renderer.render(scene, scene.cameras()[0], settings, out, FrameRequest());
  EXPECT_TRUE(stats) << stats.error().to_string();
  return {{out.color.rgba.begin(), out.color.rgba.end()}, stats ? stats.value() : FrameStats()};
}

Settings small(LightGridUse use) {
  Settings settings;
  settings.width = 200, settings.height = 120, settings.threads = 2, settings.light_grids = use;
  return settings;
}

Scene shipped(const char* name) {
  return must_load(std::string(SPANRAY_SOURCE_DIR) + "/assets/" + name + ".toml").loaded.scene;
}

TEST(RenderLightGrid, SecondFrameHasThemAndLooksTheSame) {
  const Scene scene = shipped("columns");
  Renderer renderer, none, at_once;
  const Drawn first = draw(renderer, scene, small(LightGridUse::kAuto)), second = draw(renderer, scene, small(LightGridUse::kAuto));
  EXPECT_EQ(count(first.stats, "light_grids"), 0u);
  EXPECT_EQ(first.stats.ms.light_grid_build, 0);
  EXPECT_EQ(count(second.stats, "light_grids"), 3u);
  EXPECT_GT(count(second.stats, "light_grid_bytes"), 10'000u);
  EXPECT_GT(second.stats.ms.light_grid_build, 0);
  EXPECT_GT(second.stats.memory_bytes, first.stats.memory_bytes + count(second.stats, "light_grid_bytes") / 2);
  EXPECT_EQ(second.bytes, first.bytes);
  for (int frame = 0; frame < 3; ++frame) EXPECT_EQ(count(draw(none, scene, small(LightGridUse::kNever)).stats, "light_grids"), 0u);
  const Drawn always = draw(at_once, scene, small(LightGridUse::kAlways));
  EXPECT_EQ(count(always.stats, "light_grids"), 3u);
  EXPECT_EQ(always.bytes, first.bytes);
  const Drawn without = draw(at_once, scene, small(LightGridUse::kNever));
  EXPECT_EQ(count(without.stats, "light_grids"), 0u) << "they take memory";
  EXPECT_EQ(without.bytes, first.bytes);
}

// Trees change with the quality asked for, and with what counts as opaque; places of triangles in them do, too.
TEST(RenderLightGrid, FollowTheTreesThatTheyAreMadeFrom) {
  const Scene scene = shipped("glass");
  Renderer renderer;
  for (int round = 0; round < 2; ++round)
    for (const TreeQuality tree : {TreeQuality::kFast, TreeQuality::kHigh})
      for (const Transparency transparency : {Transparency::kScene, Transparency::kNone, Transparency::kScreenDoor}) {
        Settings settings = small(LightGridUse::kAlways);
        settings.tree = tree, settings.transparency = transparency;
        Renderer fresh;
        Settings plain = settings;
        plain.light_grids = LightGridUse::kNever;
        const Drawn with = draw(renderer, scene, settings);
        EXPECT_GT(count(with.stats, "light_grids"), 0u);
        EXPECT_EQ(with.bytes, draw(fresh, scene, plain).bytes);
      }
  const Scene other = shipped("cornell");
  Renderer fresh;
  EXPECT_EQ(draw(renderer, other, small(LightGridUse::kAlways)).bytes, draw(fresh, other, small(LightGridUse::kNever)).bytes) << "of another scene";
}

TEST(RenderLightGrid, NoneWhereSomethingMovesOrNothingIsShadowed) {
  Renderer renderer;
  const Scene moving = shipped("orrery");
  for (int frame = 0; frame < 3; ++frame) EXPECT_EQ(count(draw(renderer, moving, small(LightGridUse::kAlways)).stats, "light_grids"), 0u);
  const Scene scene = shipped("spheres");
  Settings settings = small(LightGridUse::kAlways);
  settings.shadows = Shadows::kNone;
  for (int frame = 0; frame < 3; ++frame) EXPECT_EQ(count(draw(renderer, scene, settings).stats, "light_grids"), 0u);
  const auto line = [&](const Scene& of, const Settings& with) {
    for (const PlanLine& l : plan_frame(of, with))
      if (l.stage == "light grids") return l;
    ADD_FAILURE() << "no line of the plan";
    return PlanLine();
  };
  EXPECT_TRUE(line(scene, small(LightGridUse::kAuto)).needed);
  EXPECT_FALSE(line(scene, settings).needed);
  EXPECT_FALSE(line(scene, small(LightGridUse::kNever)).needed);
  EXPECT_EQ(line(moving, small(LightGridUse::kAuto)).reason, "something moves");
}

}  // namespace
}  // namespace spanray
