// Real scenes, where the environment variable SPANRAY_SCENES names their folder: counts as in its README.md.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "scene/scene_data.h"
#include "spanray/scene.h"

namespace spanray {
namespace {

struct RealScene {
  const char* file;
  size_t triangles, materials, texture_files;
};
constexpr RealScene kRealScenes[] = {
    {"sponza-dabrovic/sponza.obj", 66445, 19, 15},          {"breakfast-room/breakfast-room.obj", 269538, 15, 3},
    {"grey-white-room/grey-white-room.obj", 143163, 19, 5}, {"small-pine/small-pine.obj", 1650, 2, 4},
    {"stanford-bunny/stanford-bunny.obj", 69451, 1, 0},  // one default material
    {"cornell-box/CornellBox-Original.obj", 36, 8, 0},      {"cornell-box/CornellBox-Empty-CO.obj", 12, 8, 0},
    {"cornell-box/CornellBox-Water.obj", 7088, 9, 0},       {"cornell-box/CornellBox-Sphere.obj", 2188, 8, 0},
};

class RealSceneTest : public ::testing::TestWithParam<RealScene> {};

TEST_P(RealSceneTest, CountsAreThoseOfItsReadme) {
  const char* folder = std::getenv("SPANRAY_SCENES");
  if (folder == nullptr) GTEST_SKIP() << "SPANRAY_SCENES is not set";
  const std::string path = std::string(folder) + "/" + GetParam().file;
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const Result<LoadedScene> loaded = load_scene(path);
  ASSERT_TRUE(loaded) << loaded.error().to_string();
  for (const std::string& m : loaded.value().messages) std::printf("%s\n", m.c_str());
  const SceneData& scene = loaded.value().scene.data();
  EXPECT_EQ(scene.triangles.size(), GetParam().triangles);
  EXPECT_EQ(scene.materials.size(), GetParam().materials);
  EXPECT_EQ(scene.textures.size(), GetParam().texture_files);
  std::printf("vertices %zu texels %zu hash %016llx\n", scene.vertices.size(), scene.texels.size(),
              static_cast<unsigned long long>(scene.hash));
}

INSTANTIATE_TEST_SUITE_P(Scenes, RealSceneTest, ::testing::ValuesIn(kRealScenes));

}  // namespace
}  // namespace spanray
