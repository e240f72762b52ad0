// The largest pictures. Needs some GiB of memory and a minute of CPU.
#include <gtest/gtest.h>

#include "support/program.h"
#include "support/small_scene.h"

namespace spanray {
namespace {

TEST(ProgramLargest, PicturesOf16384PixelsASideAreRenderedOrRefusedInWords) {
  TempFolder folder;
  const std::string scene = write_small_scene(folder);
  for (const char* size : {"16384x16384", "16384x1", "1x16384"}) {
    const Ran ran = run_program({"render", scene, "--camera", kSmallSceneCamera, "--size", size, "--shading", "flat", "--shadows",
                                 "none", "--reflections", "none", "--hash", "--out", "a.png"}, folder.path(), {}, 500);
    if (ran.code == 1) {
      EXPECT_NE(std::string::npos, ran.error.find("memory")) << ran.error;
      EXPECT_FALSE(std::filesystem::exists(folder.file("a.png")));
      continue;
    }
    EXPECT_EQ(0, ran.code) << ran.error;
    EXPECT_EQ(17u, ran.out.size()) << ran.out;
    EXPECT_TRUE(std::filesystem::remove(folder.file("a.png")));
  }
}

}  // namespace
}  // namespace spanray
