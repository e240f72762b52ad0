// A scene without lights is lit from near the eye of each frame, so that a camera alone says what a picture shows.
#include <gtest/gtest.h>

#include "render/trace_pixel.h"
#include "spanray/render.h"
#include "support/temp_folder.h"

namespace spanray {
namespace {

constexpr int kSide = 33;

Camera camera_at(double z) {
  Camera camera;
  camera.eye[0] = 0.25, camera.eye[1] = 0.5, camera.eye[2] = z;
  camera.target[0] = camera.target[1] = camera.target[2] = 0;
  return camera;
}

TEST(EyeLight, FollowsTheCameraOfEachFrame) {
  const TempFolder folder;
  const Result<LoadedScene> loaded =
      load_scene(folder.write("wall.obj", "v -3 -3 0\nv 3 -3 0\nv 3 3 0\nv -3 3 0\nf 1 2 3 4\n"));
  ASSERT_TRUE(loaded);
  Settings settings;
  settings.width = settings.height = kSide, settings.culling = Culling::kNone;
  settings.transparency = Transparency::kScene;
  Renderer renderer;
  // A gray wall is seen from both sides; a light that stayed on one would leave the other to the ambient light (below 80).
  for (const Shading shading : {Shading::kPhong, Shading::kGouraud})
    for (const double z : {4.0, -4.0}) {
      settings.shading = shading;
      Framebuffer out;
      ASSERT_TRUE(renderer.render(loaded.value().scene, camera_at(z), settings, out));
      const uint8_t* middle = &out.color.rgba[static_cast<size_t>(kSide / 2 * kSide + kSide / 2) * 4];
      EXPECT_GT(middle[0], 170) << z;
      const Result<PixelTrace> why = trace_pixel(loaded.value().scene, camera_at(z), settings, kSide / 2, kSide / 2);
      ASSERT_TRUE(why);
      for (int k = 0; k < 3; ++k) EXPECT_EQ(middle[k], why.value().rgba[k]) << z;
    }
}

TEST(EyeLight, AGivenLightStays) {
  const TempFolder folder;
  folder.write("wall.obj", "v -3 -3 0\nv 3 -3 0\nv 3 3 0\nv -3 3 0\nf 1 2 3 4\n");
  const Result<LoadedScene> loaded = load_scene(folder.write(
      "wall.toml", "obj = \"wall.obj\"\n[[light]]\nkind = \"point\"\nposition = [0, 0, 4]\nintensity = [30, 30, 30]\n"));
  ASSERT_TRUE(loaded) << loaded.error().to_string();
  Settings settings;
  settings.width = settings.height = kSide;
  Renderer renderer;
  Framebuffer front, back;
  ASSERT_TRUE(renderer.render(loaded.value().scene, camera_at(4), settings, front));
  ASSERT_TRUE(renderer.render(loaded.value().scene, camera_at(-4), settings, back));
  const size_t middle = static_cast<size_t>(kSide / 2 * kSide + kSide / 2) * 4;
  EXPECT_GT(front.color.rgba[middle], 150);
  EXPECT_LT(back.color.rgba[middle], 80);
}

}  // namespace
}  // namespace spanray
