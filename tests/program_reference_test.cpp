// `reference`: the command.
#include <gtest/gtest.h>

#include <fstream>

#include "image/pfm.h"
#include "spanray/image.h"
#include "support/program.h"
#include "support/small_scene.h"

namespace spanray {
namespace {

TEST(ProgramReference, WritesPictureAndRadianceOfTheSameThing) {
  const TempFolder folder;
  const std::string scene = write_small_scene(folder);
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"reference", scene, "--size", "60x40", "--camera", kSmallSceneCamera});
    return run_program(std::move(arguments), folder.path());
  };
  for (const char* file : {"a.png", "a.pfm"}) {
    const Ran ran = run({"--out", file});
    EXPECT_EQ(0, ran.code) << ran.error;
    EXPECT_EQ("", ran.out);
  }
  EXPECT_EQ(0, run_program({"compare", "a.pfm", "a.png"}, folder.path()).code);
  EXPECT_EQ(
      0,
      run_program({"render", scene, "--size", "60x40", "--camera", kSmallSceneCamera, "--out", "f.png"}, folder.path()).code);
  const Ran compared = run_program({"compare", "a.png", "f.png", "--max-error", "p99.9=1"}, folder.path());
  EXPECT_EQ(0, compared.code) << compared.out << compared.error;
  EXPECT_EQ(0, run({"--out", "g.png", "--grid", "3"}).code);
  EXPECT_EQ(1, run_program({"compare", "a.png", "g.png"}, folder.path()).code) << "anti-aliased";
  for (const auto& wrong :
       {std::vector<std::string>{}, {"--out", "a.jpg"}, {"--out", "a.png", "--grid", "0"}, {"--out", "a.png", "--grid", "65"}})
    EXPECT_EQ(2, run(wrong).code);
  EXPECT_EQ(1, run({"--out", "no/a.png"}).code);
  EXPECT_EQ(1, run_program({"reference", "missing.obj", "--out", "a.png"}, folder.path()).code);
}

}  // namespace
}  // namespace spanray
