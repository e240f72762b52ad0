// Whole pictures against the oracle of color in long double, given the ids: shaded colors are the nearest bytes, nearly everywhere.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>

#include "spanray/render.h"
#include "support/color_oracle.h"

namespace spanray {
namespace {

struct Picture { const char* scene; size_t camera; };
void PrintTo(const Picture& p, std::ostream* out) { *out << p.scene << " " << p.camera; }

class ShadeColor : public ::testing::TestWithParam<Picture> {};

// Direct light, no shadows, mirrors or layers: what is left is resolve, textures, light and encoding.
TEST_P(ShadeColor, BytesAreThoseOfTheOracle) {
  const Result<LoadedScene> loaded = load_scene(std::string(SPANRAY_SOURCE_DIR) + "/assets/" + GetParam().scene);
  ASSERT_TRUE(loaded) << loaded.error().to_string();
  const Scene& scene = loaded.value().scene;
  Settings settings;
  settings.width = 480, settings.height = 270;
  settings.shadows = Shadows::kNone, settings.reflections = Reflections::kNone, settings.transparency = Transparency::kNone;
  settings.bump = false;
  const Camera camera = scene.cameras()[GetParam().camera];
  Framebuffer out;
  FrameRequest request;
  request.primitive = true;
  const Result<FrameStats> stats = Renderer().render(scene, camera, settings, out, request);
  ASSERT_TRUE(stats) << stats.error().to_string();

  const SceneData& data = scene.data();
  Frame frame;
  frame.primary = make_primary_rays(camera, settings.width, settings.height);
  const ColorOracle oracle(data, frame);
  std::array<size_t, 256> histogram{};  // of pixels by their largest difference
  size_t pixels = 0;
  std::string worst;
  int worst_difference = 1;
  for (size_t i = 0; i < out.primitive.size(); ++i) {
    if (out.primitive[i] == kNoPrimitive) continue;
    const uint32_t x = static_cast<uint32_t>(i % 480), y = static_cast<uint32_t>(i / 480);
    const glm::dvec3 want = oracle.radiance(pack_pixel(x, y), out.primitive[i]);
    int difference = 0;
    for (int c = 0; c < 3; ++c)
      difference = std::max(difference, std::abs(out.color.rgba[4 * i + static_cast<size_t>(c)] -
                                                 static_cast<int>(std::lround(255 * oracle_srgb(want[c])))));
    if (difference > worst_difference)
      worst_difference = difference, worst = std::to_string(x) + "," + std::to_string(y) + " of primitive " + std::to_string(out.primitive[i]);
    ++histogram[static_cast<size_t>(difference)], ++pixels;
  }
  std::printf("%s, camera %zu: of %zu pixels", GetParam().scene, GetParam().camera, pixels);
  for (size_t d = 0; d < histogram.size(); ++d)
    if (histogram[d] > 0) std::printf(", %zu off by %zu", histogram[d], d);
  std::printf("\n");
  EXPECT_GT(pixels, 10000u);
  EXPECT_LE(worst_difference, 1) << worst;
  EXPECT_GE(static_cast<double>(histogram[0]), 0.999 * static_cast<double>(pixels));
}

INSTANTIATE_TEST_SUITE_P(Scenes, ShadeColor,
                         ::testing::Values(Picture{"cornell.toml", 0}, Picture{"spheres.toml", 0}, Picture{"columns.toml", 0},
                                           Picture{"gauze.toml", 0}, Picture{"glass.toml", 0}, Picture{"hall.toml", 0},
                                           Picture{"hall.toml", 1}, Picture{"hall.toml", 2}));

}  // namespace
}  // namespace spanray
