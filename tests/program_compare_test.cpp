// `compare`: what it measures, and when it fails.
#include <gtest/gtest.h>

#include "spanray/image.h"
#include "support/program.h"

namespace spanray {
namespace {

class ProgramCompare : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const Image& image, const std::vector<std::pair<std::string, std::string>>& text = {}) {
    EXPECT_TRUE(write_png(folder_.file(name), image, text));
    return name;
  }
  static Image gray(int width, int height, uint8_t value) {
    Image image{width, height, std::vector<uint8_t>(static_cast<size_t>(width * height) * 4, value)};
    for (size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
    return image;
  }
  Ran run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "compare");
    return run_program(std::move(arguments), folder_.path());
  }
  TempFolder folder_;
};

TEST_F(ProgramCompare, EqualPicturesPass) {
  write("a.png", gray(5, 3, 100)), write("b.png", gray(5, 3, 100));
  const Ran ran = run({"a.png", "b.png"});
  EXPECT_EQ(0, ran.code) << ran.error;
  EXPECT_NE(std::string::npos, ran.out.find("max           0 of 255")) << ran.out;
  EXPECT_NE(std::string::npos, ran.out.find("wrong_pixels  0 of 15")) << ran.out;
  EXPECT_NE(std::string::npos, ran.out.find("inf")) << ran.out;
}

TEST_F(ProgramCompare, ToleranceDecides) {
  Image b = gray(10, 10, 100);
  b.rgba[4 * 37 + 1] = 103;  // pixel 7,3
  b.rgba[4 * 50] = 101;
  write("a.png", gray(10, 10, 100)), write("b.png", b);
  const Ran ran = run({"a.png", "b.png"});
  EXPECT_EQ(1, ran.code);
  for (const char* word : {"max           3 of 255", "wrong_pixels  2 of 100 (2.0000 %)", "worst_pixel   7,3: 100 100 100 255 against 100 103 100 255"})
    EXPECT_NE(std::string::npos, ran.out.find(word)) << ran.out;
  EXPECT_EQ(0, run({"a.png", "b.png", "--max", "3"}).code);
  EXPECT_EQ(1, run({"a.png", "b.png", "--max", "2"}).code);
  EXPECT_EQ(0, run({"a.png", "b.png", "--max", "2", "--max-wrong", "1"}).code);
  EXPECT_EQ(0, run({"a.png", "b.png", "--max-wrong", "2"}).code);
  EXPECT_EQ(1, run({"a.png", "b.png", "--max-wrong", "1"}).code);
}

TEST_F(ProgramCompare, DifferencePictureIsWritten) {
  Image b = gray(4, 4, 100);
  b.rgba[4 * 5] = 200;
  write("a.png", gray(4, 4, 100)), write("b.png", b);
  EXPECT_EQ(1, run({"a.png", "b.png", "--diff", "d.png"}).code);
  Result<Image> diff = read_png(folder_.file("d.png"));
  ASSERT_TRUE(diff);
  EXPECT_EQ(4, diff.value().width);
  const auto pixel = [&](size_t i) { return std::string(diff.value().rgba.begin() + 4 * static_cast<long>(i), diff.value().rgba.begin() + 4 * static_cast<long>(i) + 4); };
  EXPECT_NE(pixel(5), pixel(6));
  EXPECT_EQ(pixel(6), pixel(7));
  EXPECT_EQ(1, run({"a.png", "b.png", "--diff", "no/d.png"}).code);
}

TEST_F(ProgramCompare, SizesMustAgree) {
  write("a.png", gray(4, 4, 1)), write("b.png", gray(4, 5, 1));
  const Ran ran = run({"a.png", "b.png"});
  EXPECT_EQ(1, ran.code);
  EXPECT_NE(std::string::npos, ran.error.find("4x4 and 4x5")) << ran.error;
}

TEST_F(ProgramCompare, OtherScenesAndContractsAreMentioned) {
  write("a.png", gray(2, 2, 1), {{"numeric_contract", "1"}, {"scene_hash", "aaaa"}});
  write("b.png", gray(2, 2, 1), {{"numeric_contract", "2"}, {"scene_hash", "bbbb"}});
  const Ran ran = run({"a.png", "b.png"});
  EXPECT_EQ(0, ran.code) << "equal pixels are equal";
  EXPECT_NE(std::string::npos, ran.error.find("different numeric_contract: 1 and 2")) << ran.error;
  EXPECT_NE(std::string::npos, ran.error.find("different scene_hash: aaaa and bbbb")) << ran.error;
}

TEST_F(ProgramCompare, BadInput) {
  write("a.png", gray(2, 2, 1));
  folder_.write("text.png", "no picture");
  folder_.write("l.json", "{}");
  EXPECT_EQ(1, run({"a.png", "missing.png"}).code);
  EXPECT_EQ(1, run({"a.png", "text.png"}).code);
  EXPECT_EQ(1, run({"l.json", "l.json"}).code);
  EXPECT_EQ(2, run({"a.png", "l.json"}).code);
  EXPECT_EQ(2, run({"l.json", "l.json", "--diff", "d.png"}).code);
  EXPECT_EQ(2, run({"a.png"}).code);
  EXPECT_EQ(2, run({"a.png", "a.png", "--max", "256"}).code);
  EXPECT_EQ(2, run({"a.png", "a.png", "--max-wrong", "-1"}).code);
}

}  // namespace
}  // namespace spanray
