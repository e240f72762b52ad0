// `reference --mask` and `compare --mask`: a golden picture for other renderers.
#include <gtest/gtest.h>

#include "image/mask.h"
#include "support/program.h"
#include "support/small_scene.h"

namespace spanray {
namespace {

class ProgramMask : public ::testing::Test {
 protected:
  void SetUp() override { scene_ = write_small_scene(folder_); }
  Ran run(std::vector<std::string> arguments) { return run_program(std::move(arguments), folder_.path()); }
  Ran picture(const std::string& command, const std::string& file, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {command, scene_, "--size", "60x40", "--camera", kSmallSceneCamera, "--out", file};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(std::move(arguments));
  }
  TempFolder folder_;
  std::string scene_;
};

TEST_F(ProgramMask, AnotherPictureIsJudgedByTheMaskAndByNothingElse) {
  EXPECT_EQ(0, picture("render", "golden.png").code);
  const Ran made = picture("reference", "truth.png", {"--mask", "m.pfm"});
  ASSERT_EQ(0, made.code) << made.error;
  EXPECT_NE(made.out.find("ambiguous "), std::string::npos) << made.out;
  Ran ran = run({"compare", "truth.png", "--golden", "golden.png", "--mask", "m.pfm"});
  EXPECT_EQ(0, ran.code) << ran.out << ran.error;
  EXPECT_NE(ran.out.find("outside       0 of 2400 (0.0000 %)"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("left_open "), std::string::npos) << ran.out;
  EXPECT_EQ(0, picture("render", "dark.png", {"--shadows", "none"}).code);
  ran = run({"compare", "dark.png", "--golden", "golden.png", "--mask", "m.pfm", "--mask-map", "map.png"});
  EXPECT_EQ(1, ran.code);
  EXPECT_NE(ran.out.find("outside_pixel "), std::string::npos) << ran.out;
  EXPECT_NE(ran.error.find("outside of the mask, allowed are 0"), std::string::npos) << ran.error;
  EXPECT_EQ(ran.error.find("differ by more than"), std::string::npos) << "wrong pixels are not counted";
  const Result<Image> map = read_png(folder_.file("map.png"));
  ASSERT_TRUE(map);
  EXPECT_EQ(160, map.value().width);
  EXPECT_EQ(64, map.value().height);
  EXPECT_EQ(0, run({"compare", "golden.png", "dark.png", "--mask", "m.pfm", "--max-outside", "2400"}).code);
  EXPECT_EQ(1, run({"compare", "golden.png", "dark.png", "--mask", "m.pfm", "--max-outside", "2400", "--max-wrong", "0"}).code)
      << "asked for both";
  EXPECT_EQ(
      1, run({"compare", "golden.png", "dark.png", "--mask", "m.pfm", "--max-outside", "2400", "--max-error", "max=0"}).code);
  // The wrong golden is told.
  ran = run({"compare", "golden.png", "--golden", "dark.png", "--mask", "m.pfm"});
  EXPECT_EQ(0, ran.code) << ran.error;
  EXPECT_NE(ran.error.find("of the reference itself are outside of the mask"), std::string::npos) << ran.error;
}

TEST_F(ProgramMask, BoundsAreOptions) {
  for (const auto& [file, more] : {std::pair<const char*, std::vector<std::string>>{"a.pfm", {}},
                                   {"b.pfm", {"--mask-codes", "3"}},
                                   {"c.pfm", {"--mask-any-footprint"}}}) {
    std::vector<std::string> arguments = {"--mask", file};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(0, picture("reference", "truth.png", arguments).code);
  }
  const Result<AmbiguityMask> a = read_mask(folder_.file("a.pfm")), b = read_mask(folder_.file("b.pfm")),
                              c = read_mask(folder_.file("c.pfm"));
  ASSERT_TRUE(a && b && c);
  const double share = share_wider(a.value(), 4);
  EXPECT_LT(share, 0.1);
  EXPECT_EQ(share_wider(b.value(), 4), 1) << "two codes more on either side";
  EXPECT_EQ(c.value().least, a.value().least) << "there is no texture in this scene";
}

TEST_F(ProgramMask, WrongUseAndBrokenMasksAreErrors) {
  EXPECT_EQ(0, picture("render", "a.png").code);
  EXPECT_EQ(0, picture("reference", "t.png", {"--mask", "m.pfm"}).code);
  for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--mask", "m.png"},
                                                {"--mask", "m.exr"},
                                                {"--mask-codes", "1"},
                                                {"--mask-any-footprint"},
                                                {"--mask", "n.pfm", "--mask-codes", "-1"},
                                                {"--mask", "n.pfm", "--paths", "1"}})
    EXPECT_EQ(2, picture("reference", "u.png", wrong).code) << wrong.back();
  EXPECT_EQ(2, picture("reference", "u.pfm", {"--mask", "./u.pfm"}).code);
  EXPECT_EQ(1, picture("reference", "u.png", {"--mask", "no/m.pfm"}).code);
  EXPECT_FALSE(read_png(folder_.file("u.png"))) << "told before rendering";
  const std::vector<std::string> same = {"compare", "a.png", "--golden", "a.png"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), same.begin(), same.end());
    return run(std::move(more));
  };
  EXPECT_EQ(2, with({"--max-outside", "1"}).code);
  EXPECT_EQ(2, with({"--mask-map", "v.png"}).code);
  EXPECT_EQ(2, with({"--mask", "m.pfm", "--mask-map", "v.jpg"}).code);
  EXPECT_EQ(2, run({"compare", "a.png"}).code);
  EXPECT_EQ(2, run({"compare", "a.png", "a.png", "--golden", "a.png"}).code);
  EXPECT_EQ(2, run({"compare", "a.json", "b.json", "--mask", "m.pfm"}).code);
  EXPECT_EQ(1, with({"--mask", "none.pfm"}).code);
  folder_.write("broken.pfm", "PF\n60 40\n-1.0\nabc");
  EXPECT_EQ(1, with({"--mask", "broken.pfm"}).code);
  EXPECT_EQ(1, with({"--mask", "a.png"}).code);
  EXPECT_EQ(0, run({"render", scene_, "--size", "30x20", "--camera", kSmallSceneCamera, "--out", "small.png"}).code);
  const Ran sizes = run({"compare", "small.png", "--golden", "small.png", "--mask", "m.pfm"});
  EXPECT_EQ(1, sizes.code);
  EXPECT_NE(sizes.error.find("the picture is 30x20, the mask 60x40"), std::string::npos) << sizes.error;
  const auto before = read_text(folder_.file("m.pfm"));
  EXPECT_EQ(2, with({"--mask", "m.pfm", "--mask-map", "a.png"}).code) << "it is compared";
  EXPECT_EQ(before, read_text(folder_.file("m.pfm")));
}

}  // namespace
}  // namespace spanray
