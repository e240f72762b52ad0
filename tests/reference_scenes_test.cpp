// The fast path against the reference, on the shipped scenes: two programs that share the scene and nothing else.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>

#include "reference/reference.h"
#include "spanray/render.h"
#include "support/temp_folder.h"

namespace spanray {
namespace {

struct Case {
  const char* name;
  const char* scene;
  void (*change)(Settings&);
  // Shares of the pixels: that see other triangles; of the others, more than 1 of 255 off, and exactly equal.
  double most_wrong_ids, most_over_1, least_equal;
  size_t camera = 0;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class ReferenceScenes : public ::testing::TestWithParam<Case> {};

TEST_P(ReferenceScenes, AgreeWithTheFastPath) {
  const Case& c = GetParam();
  const Result<LoadedScene> loaded = load_scene(std::string(SPANRAY_SOURCE_DIR) + "/assets/" + c.scene + ".toml");
  ASSERT_TRUE(loaded) << loaded.error().to_string();
  const Scene& scene = loaded.value().scene;
  Settings settings = scene.settings();
  settings.width = 240, settings.height = 135;
  c.change(settings);
  const Camera& camera = scene.cameras()[c.camera];
  Framebuffer truth, fast;
  FrameRequest request;
  request.primitive = true;
  ASSERT_TRUE(render_reference(scene, camera, settings, {}, truth));
  ASSERT_TRUE(Renderer().render(scene, camera, settings, fast, request));

  std::array<size_t, 256> histogram{};  // of pixels with the same id by their largest difference
  size_t wrong_ids = 0, over_1 = 0;
  const size_t pixels = fast.primitive.size();
  for (size_t i = 0; i < pixels; ++i) {
    if (settings.samples == 1 && truth.primitive[i] != fast.primitive[i]) {
      ++wrong_ids;
      continue;
    }
    int most = 0;
    for (size_t k = 4 * i; k < 4 * i + 4; ++k) most = std::max(most, std::abs(truth.color.rgba[k] - fast.color.rgba[k]));
    ++histogram[static_cast<size_t>(most)], over_1 += most > 1;
  }
  std::printf("%s: of %zu pixels %zu see another triangle; of the others", c.name, pixels, wrong_ids);
  for (size_t d = 0; d < histogram.size(); ++d)
    if (histogram[d] > 0) std::printf(" %zu:%zu", d, histogram[d]);
  std::printf("\n");
  const double n = static_cast<double>(pixels), same = n - static_cast<double>(wrong_ids);
  EXPECT_LE(static_cast<double>(wrong_ids), c.most_wrong_ids * n);
  EXPECT_LE(static_cast<double>(over_1), c.most_over_1 * same);
  EXPECT_GE(static_cast<double>(histogram[0]), c.least_equal * same);
}

void as_it_is(Settings&) {}
void lifted(Settings& s) { s.shadow_terminator = ShadowTerminator::kLifted; }

INSTANTIATE_TEST_SUITE_P(
    Shipped, ReferenceScenes,
    ::testing::Values(
        Case{"cornell", "cornell", as_it_is, 0.002, 0.0002, 0.99}, Case{"spheres", "spheres", as_it_is, 0.002, 0.0002, 0.96},
        Case{"columns", "columns", as_it_is, 0.002, 0.0002, 0.96}, Case{"gauze", "gauze", as_it_is, 0.002, 0.0002, 0.96},
        Case{"glass", "glass", as_it_is, 0.002, 0.0002, 0.96}, Case{"hall", "hall", as_it_is, 0.002, 0.0002, 0.97},
        Case{"molecule", "molecule", as_it_is, 0.002, 0.0002, 0.97},
        Case{"molecule, from within", "molecule", as_it_is, 0.002, 0.0002, 0.97, 1},
        Case{"henge", "henge", as_it_is, 0.002, 0.0002, 0.97}, Case{"henge, low", "henge", as_it_is, 0.002, 0.0002, 0.97, 1},
        Case{"hall, camera 1", "hall", as_it_is, 0.002, 0.0002, 0.97, 1},
        Case{"spheres, Gouraud", "spheres", [](Settings& s) { s.shading = Shading::kGouraud; }, 0.002, 0.0002, 0.96},
        Case{"columns, flat", "columns", [](Settings& s) { s.shading = Shading::kFlat; }, 0.002, 0.0002, 0.96},
        Case{"columns, bilinear", "columns", [](Settings& s) { s.filter = Filter::kBilinear; }, 0.002, 0.01, 0.97},
        Case{"columns, nearest", "columns", [](Settings& s) { s.filter = Filter::kNearest; }, 0.002, 0.01, 0.97},
        Case{"glass, screen-door", "glass", [](Settings& s) { s.transparency = Transparency::kScreenDoor; }, 0.002, 0.0002,
             0.96},
        Case{"gauze, blended", "gauze", [](Settings& s) { s.transparency = Transparency::kAlpha; }, 0.002, 0.0005, 0.96},
        Case{"glass, opaque", "glass", [](Settings& s) { s.transparency = Transparency::kNone; }, 0.002, 0.0002, 0.96},
        Case{"columns, 4 samples", "columns", [](Settings& s) { s.samples = 4, s.antialiasing = Antialiasing::kSupersample; },
             0, 0.003, 0.98},
        Case{"gauze, 8 samples", "gauze", [](Settings& s) { s.samples = 8, s.antialiasing = Antialiasing::kSupersample; }, 0,
             0.003, 0.98},
        Case{"spheres, culled, one bounce", "spheres", [](Settings& s) { s.culling = Culling::kBack, s.max_bounces = 1; },
             0.002, 0.0002, 0.96},
        Case{"gauze, culled", "gauze", [](Settings& s) { s.culling = Culling::kBack; }, 0.002, 0.0002, 0.96},
        Case{"spheres, lifted", "spheres", lifted, 0.002, 0.0002, 0.96},
        Case{"hall, lifted", "hall", lifted, 0.002, 0.0002, 0.97}, Case{"glass, lifted", "glass", lifted, 0.002, 0.0002, 0.96},
        Case{"columns, lifted, Gouraud", "columns",
             [](Settings& s) { lifted(s), s.shading = Shading::kGouraud; }, 0.002, 0.0002, 0.96},
        Case{"hall, lifted, no shadows", "hall", [](Settings& s) { lifted(s), s.shadows = Shadows::kNone; }, 0.002, 0.0002, 0.97},
        Case{"hall, plain", "hall", [](Settings& s) { s.textures = s.bump = false, s.shadows = Shadows::kNone; }, 0.002, 0.0002,
             0.97}));

// Threads change nothing; progress ends at 1.
TEST(ReferenceScenes, ThreadsChangeNothing) {
  const Result<LoadedScene> loaded = load_scene(SPANRAY_SOURCE_DIR "/assets/cornell.toml");
  ASSERT_TRUE(loaded);
  Settings settings = loaded.value().scene.settings();
  settings.width = 70, settings.height = 50;
  Framebuffer one, three;
  ReferenceOptions options;
  double last = 0;
  options.threads = 1;
  options.progress = [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
  };
  ASSERT_TRUE(render_reference(loaded.value().scene, loaded.value().scene.cameras()[0], settings, options, one));
  EXPECT_EQ(last, 1);
  last = 0, options.threads = 3;
  ASSERT_TRUE(render_reference(loaded.value().scene, loaded.value().scene.cameras()[0], settings, options, three));
  EXPECT_EQ(one.radiance, three.radiance);
  EXPECT_EQ(one.primitive, three.primitive);
}

}  // namespace
}  // namespace spanray
