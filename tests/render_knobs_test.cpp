// Settings::normals and Settings::powers: what they change, by how much, and where they change nothing.
#include <gtest/gtest.h>

#include <cmath>

#include "image/metrics.h"
#include "render/plan.h"
#include "render/trace_pixel.h"
#include "support/sample_pictures.h"
#include "support/scene_files.h"

namespace spanray {
namespace {

class Knobs : public ::testing::Test {
 protected:
  void load(const std::string& name) {
    Result<LoadedScene> loaded = load_scene(std::string(SPANRAY_SOURCE_DIR) + "/assets/" + name);
    ASSERT_TRUE(loaded) << loaded.error().to_string();
    scene_ = loaded.value().scene, camera_ = scene_.cameras()[0], settings_ = scene_.settings();
    settings_.width = 160, settings_.height = 90, settings_.threads = 1;
  }
  Framebuffer render(const Settings& settings) const {
    Renderer renderer;
    Framebuffer out;
    FrameRequest request;
    request.normal = request.radiance = request.primitive = true;
    const auto stats = renderer.render(scene_, camera_, settings, out, request);
    EXPECT_TRUE(stats);
    return out;
  }
  Framebuffer with(Normals normals) const {
    Settings s = settings_;
    s.normals = normals;
    return render(s);
  }
  Framebuffer with(Powers powers) const {
    Settings s = settings_;
    s.powers = powers;
    return render(s);
  }
  bool needed(const Settings& settings, const std::string& stage) const {
    for (const PlanLine& line : plan_frame(scene_, settings))
      if (line.stage == stage) return line.needed;
    ADD_FAILURE() << "no line " << stage;
    return false;
  }
  Scene scene_;
  Camera camera_;
  Settings settings_;
};

double length(const float* v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

// The same direction, no longer than 1, and shorter where corners differ: of both engines.
TEST_F(Knobs, InterpolatedNormalsAreThoseOfTheCornersAsBlended) {
  ASSERT_NO_FATAL_FAILURE(load("spheres.toml"));
  settings_.bump = false;
  for (const Visibility engine : kEngines) {
    settings_.visibility = engine;
    const Framebuffer unit = with(Normals::kRenormalized), raw = with(Normals::kInterpolated);
    double shortest = 1;
    size_t shorter = 0;
    for (size_t i = 0; i < unit.primitive.size(); ++i) {
      if (unit.primitive[i] == 0xffffffffu) continue;
      const float *u = &unit.normal[3 * i], *r = &raw.normal[3 * i];
      const double size = length(r);
      ASSERT_NEAR(length(u), 1, 1e-6);
      ASSERT_LE(size, 1 + 1e-6);
      for (int k = 0; k < 3; ++k) ASSERT_NEAR(r[k] / size, u[k], 2e-6) << i % 160 << "," << i / 160;
      shortest = std::min(shortest, size), shorter += size < 0.999;
    }
    EXPECT_LT(shortest, 0.99);
    EXPECT_GT(shorter, 200u);
    EXPECT_NE(unit.color.rgba, raw.color.rgba);
  }
}

// What mirrors show has them, too: a mirror ray that meets a triangle with different corners.
TEST_F(Knobs, InterpolatedNormalsOfMirroredSurfaces) {
  ASSERT_NO_FATAL_FAILURE(load("spheres.toml"));
  settings_.normals = Normals::kInterpolated, settings_.bump = false;
  bool found = false;
  for (int k = 0; k < 60 && !found; ++k) {
    const auto trace = trace_pixel(scene_, camera_, settings_, 20 + k * 2, 30 + k * 7 % 40);
    ASSERT_TRUE(trace);
    const std::vector<LevelTrace>& levels = trace.value().slots[0].levels;
    for (size_t bounce = 1; bounce < levels.size(); ++bounce)
      found |= levels[bounce].surface.valid && length(levels[bounce].surface.normal) < 0.9999;
  }
  EXPECT_TRUE(found);
}

// The price of leaving out the division: highlights fade between corners. Bounded, so that a change for the worse is seen.
TEST_F(Knobs, InterpolatedNormalsDarkenHighlights) {
  ASSERT_NO_FATAL_FAILURE(load("spheres.toml"));
  settings_.reflections = Reflections::kNone;
  const Framebuffer unit = with(Normals::kRenormalized), raw = with(Normals::kInterpolated);
  double most_unit = 0, most_raw = 0, sum_unit = 0, sum_raw = 0;
  for (size_t i = 0; i < unit.radiance.size(); ++i) {
    most_unit = std::max<double>(most_unit, unit.radiance[i]), most_raw = std::max<double>(most_raw, raw.radiance[i]);
    sum_unit += unit.radiance[i], sum_raw += raw.radiance[i];
  }
  EXPECT_LT(most_raw, most_unit);
  EXPECT_LT(sum_raw, sum_unit);
  Parallel parallel(1);
  const auto error = measure_pictures(unit.color, raw.color, parallel);
  ASSERT_TRUE(error);
  std::printf("FLIP %.5f, RMSE of linear light %.5f\n", error.value().flip, error.value().rmse_linear);
  EXPECT_GT(error.value().flip, 0.001);
  EXPECT_LT(error.value().flip, 0.05);
}

TEST_F(Knobs, NormalsChangeNothingWhereNothingIsInterpolated) {
  ASSERT_NO_FATAL_FAILURE(load("spheres.toml"));
  settings_.normals = Normals::kInterpolated;
  EXPECT_TRUE(needed(settings_, "normals as interpolated"));
  settings_.shading = Shading::kFlat;
  EXPECT_FALSE(needed(settings_, "normals as interpolated"));
  EXPECT_EQ(with(Normals::kRenormalized).color.rgba, with(Normals::kInterpolated).color.rgba);
  ASSERT_NO_FATAL_FAILURE(load("cornell.toml"));  // walls and boxes: each triangle has one normal
  settings_.normals = Normals::kInterpolated;
  EXPECT_FALSE(needed(settings_, "normals as interpolated"));
  EXPECT_EQ(with(Normals::kRenormalized).radiance, with(Normals::kInterpolated).radiance);
}

TEST_F(Knobs, FastPowersErrByAStepAtMost) {
  for (const char* name : {"spheres.toml", "columns.toml", "hall.toml"})
    for (const Shading shading : {Shading::kPhong, Shading::kGouraud}) {
      ASSERT_NO_FATAL_FAILURE(load(name));
      settings_.shading = shading;
      const Framebuffer exact = with(Powers::kExact), fast = with(Powers::kFast);
      EXPECT_NE(exact.radiance, fast.radiance) << name;
      Parallel parallel(1);
      const auto error = measure_pictures(exact.color, fast.color, parallel);
      ASSERT_TRUE(error);
      const Metrics& m = error.value();
      std::printf("%s: max %.0f, PSNR %.1f dB, FLIP %.6f\n", name, m.max, m.psnr_db, m.flip);
      EXPECT_LE(error.value().max, 2) << name;
      EXPECT_GE(error.value().psnr_db, 74) << name;  // root mean square 0.05 of 255
      EXPECT_LE(error.value().flip, 0.0005) << name;
    }
}

TEST_F(Knobs, PowersChangeNothingWithoutHighlights) {
  ASSERT_NO_FATAL_FAILURE(load("spheres.toml"));
  settings_.powers = Powers::kFast;
  EXPECT_TRUE(needed(settings_, "fast powers"));
  settings_.powers = Powers::kExact;
  EXPECT_FALSE(needed(settings_, "fast powers"));
  const TempFolder folder;
  folder.write("a.mtl", "newmtl m\nKd 0.5 0.5 0.5\nillum 1\n");
  scene_ = must_load(folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n")).loaded.scene;
  camera_ = scene_.cameras()[0];
  settings_.powers = Powers::kFast;
  EXPECT_FALSE(needed(settings_, "fast powers"));
  EXPECT_EQ(with(Powers::kExact).radiance, with(Powers::kFast).radiance);
}

}  // namespace
}  // namespace spanray
