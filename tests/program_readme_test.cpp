// The scene file that the README shows: loads without a warning and is worth looking at.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "spanray/image.h"
#include "support/program.h"

namespace spanray {
namespace {

TEST(ProgramReadme, TheSceneFileLoadsAndIsWellFramedAndLit) {
  const std::string readme = read_text(SPANRAY_SOURCE_DIR "/README.md"), fence = "```toml\n", obj = "\"gauze.obj\"";
  const size_t begin = readme.find(fence), end = readme.find("```", begin + fence.size());
  ASSERT_NE(std::string::npos, end);
  std::string text = readme.substr(begin + fence.size(), end - begin - fence.size());
  ASSERT_NE(std::string::npos, text.find(obj));
  text.replace(text.find(obj), obj.size(), "\"" SPANRAY_SOURCE_DIR "/assets/gauze.obj\"");
  const TempFolder folder;
  folder.write("scene.toml", text);
  for (const char* camera : {"front", "-0.4,1.3,2.5,0.3,1.0,-1.0,45"}) {  // where the path begins and ends
    const Ran ran = run_program({"render", "scene.toml", "--strict", "--size", "160x90", "--camera", camera, "--out", "a.png"}, folder.path());
    EXPECT_EQ(0, ran.code);
    EXPECT_EQ("", ran.error);
    const Result<Image> picture = read_png(folder.file("a.png"));
    ASSERT_TRUE(picture);
    const std::vector<uint8_t>& bytes = picture.value().rgba;
    std::set<uint32_t> colors;
    size_t dark = 0, white = 0;
    for (size_t i = 0; i < bytes.size(); i += 4) {
      colors.insert(bytes[i] * 65536u + bytes[i + 1] * 256u + bytes[i + 2]);
      const int most = std::max({bytes[i], bytes[i + 1], bytes[i + 2]});
      dark += most < 24, white += most == 255;
    }
    EXPECT_GT(colors.size(), 1000u) << camera;
    EXPECT_LT(dark, bytes.size() / 4 / 10) << camera << ": unlit";
    EXPECT_LT(white, bytes.size() / 4 / 10) << camera << ": overexposed, or empty";
  }
}

}  // namespace
}  // namespace spanray
