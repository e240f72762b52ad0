// `walk` where it needs no display: playing a camera path.
#include <gtest/gtest.h>

#include "support/program.h"
#include "support/small_scene.h"

namespace spanray {
namespace {

class ProgramWalk : public ::testing::Test {
 protected:
  void SetUp() override {
    write_small_scene(folder_);
    folder_.write("still.toml", "obj = \"room.obj\"\n");
    folder_.write("path.toml",
                  "obj = \"room.obj\"\n[[path]]\ntime = 0.0\neye = [0.5, 1.5, 4.5]\ntarget = [0.0, 0.6, 0.0]\n"
                  "[[path]]\ntime = 0.2\neye = [1.5, 1.5, 3.5]\ntarget = [0.0, 0.6, 0.0]\n");
  }
  Ran walk(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "walk");
    arguments.insert(arguments.end(), {"--size", "64x48"});
    return run_program(arguments, folder_.path(), {"DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER", "ASAN_OPTIONS=detect_leaks=0"});
  }
  TempFolder folder_;
};

TEST_F(ProgramWalk, HeadlessPlaysThePathAndPrintsTheMedian) {
  const Ran ran = walk({"path.toml", "--path", "--headless", "--frames", "7"});
  EXPECT_EQ(0, ran.code) << ran.error;
  EXPECT_EQ(0u, ran.out.find("frames 7  median_ms ")) << ran.out;
  EXPECT_EQ(0u, walk({"path.toml", "--path", "--headless"}).out.find("frames 6 ")) << "30 a second of the path";
}

TEST_F(ProgramWalk, APathMayComeFromAnotherScene) {
  const Ran ran = walk({"still.toml", "--path", "path.toml", "--headless", "--frames", "2"});
  EXPECT_EQ(0, ran.code) << ran.error;
  EXPECT_EQ(0u, ran.out.find("frames 2  median_ms ")) << ran.out;
}

TEST_F(ProgramWalk, WithoutAPathItSaysSo) {
  const Ran ran = walk({"still.toml", "--path", "--headless"});
  EXPECT_EQ(1, ran.code);
  EXPECT_NE(std::string::npos, ran.error.find("still.toml: --path: the scene has no camera path")) << ran.error;
  EXPECT_EQ(1, walk({"path.toml", "--path", "still.toml", "--headless"}).code);
  EXPECT_EQ(1, walk({"path.toml", "--path", "missing.toml", "--headless"}).code);
  const Ran usage = walk({"path.toml", "--headless"});
  EXPECT_EQ(2, usage.code);
  EXPECT_NE(std::string::npos, usage.error.find("--path")) << usage.error;
  EXPECT_EQ(2, walk({"path.toml", "--frames", "0"}).code);
}

}  // namespace
}  // namespace spanray
