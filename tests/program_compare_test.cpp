// `compare`: what it measures, and when it fails.
#include <gtest/gtest.h>

#include <cmath>

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
  EXPECT_EQ(2, run({"a.png", "b.png", "--diff", "d.jpg"}).code);
  EXPECT_EQ(2, run({"a.png", "b.png", "--diff", "d.png", "--flip-map", "./d.png"}).code);
}

TEST_F(ProgramCompare, EveryMetricIsPrintedAndMayBeBounded) {
  Image b = gray(50, 20, 100);
  b.rgba[4 * 37 + 1] = 130;
  write("a.png", gray(50, 20, 100)), write("b.png", b);
  const Ran ran = run({"a.png", "b.png", "--max-error", "max=30", "--max-error", "p99.9=0"});
  EXPECT_EQ(0, ran.code) << ran.error << "pixels that differ are not counted then";
  for (const char* word : {"max           30 of 255\n", "p99.9         0 of 255\n", "over_1        0.001 ", "rmse          ", "rmse_linear   0.00",
                           "relmse        ", "psnr_db       53.", "ssim          0.9", "flip          0.00", "wrong_pixels  1 of 1000"})
    EXPECT_NE(std::string::npos, ran.out.find(word)) << word << "\n" << ran.out;
  for (const char* kept : {"over_1=0.001", "rmse_linear=0.01", "relmse=0.1", "psnr_db=53", "ssim=0.9", "FLIP=0.02"})
    EXPECT_EQ(0, run({"a.png", "b.png", "--max-error", kept}).code) << kept;
  for (const char* broken : {"max=29", "over_1=0.0009", "rmse_linear=1e-6", "relmse=0", "psnr_db=60", "ssim=0.99999", "flip=0.0001"}) {
    const Ran past = run({"a.png", "b.png", "--max-error", "max=255", "--max-error", broken});
    EXPECT_EQ(1, past.code) << broken;
    EXPECT_NE(std::string::npos, past.error.find(", allowed is at ")) << past.error;
  }
  EXPECT_EQ(1, run({"a.png", "b.png", "--max-error", "max=30", "--max-wrong", "0"}).code) << "asked for both, both decide";
  EXPECT_EQ(0, run({"a.png", "b.png", "--max-error", "max=30", "--max-wrong", "1"}).code);
  for (const char* nonsense : {"max", "max=", "max=x", "nothing=1", "flip=nan", "=1"}) {
    const Ran bad = run({"a.png", "b.png", "--max-error", nonsense});
    EXPECT_EQ(2, bad.code) << nonsense;
    EXPECT_EQ("", bad.out);
  }
  for (const char* impossible : {"flip=-1", "flip=1.5", "ssim=2", "max=256"}) EXPECT_EQ(2, run({"a.png", "b.png", "--max-error", impossible}).code) << impossible;
  EXPECT_NE(std::string::npos, run({"a.png", "b.png", "--max-error", "flop=1"}).error.find("did you mean 'flip'?"));
}

TEST_F(ProgramCompare, MapsAreWrittenWithALegend) {
  Image b = gray(200, 40, 100);
  for (size_t i = 4 * 200 * 20; i < 4 * 200 * 21; ++i)
    if (i % 4 != 3) b.rgba[i] = 180;
  write("a.png", gray(200, 40, 100)), write("b.png", b);
  EXPECT_EQ(0, run({"a.png", "b.png", "--max", "255", "--error-map", "e.png", "--flip-map", "f.png"}).code);
  for (const char* name : {"e.png", "f.png"}) {
    const Result<Image> map = read_png(folder_.file(name));
    ASSERT_TRUE(map);
    EXPECT_EQ(200, map.value().width);
    EXPECT_EQ(64, map.value().height);
    const auto red = [&](size_t y) { return int{map.value().rgba[4 * (200 * y + 100)]}; };
    EXPECT_GT(red(20), 100) << name;
    EXPECT_LT(red(2), 10) << name;
  }
  EXPECT_EQ(1, run({"a.png", "b.png", "--flip-map", "no/f.png"}).code);
  EXPECT_EQ(2, run({"a.png", "b.png", "--flip-map", "b.png"}).code);
}

TEST_F(ProgramCompare, RadianceIsComparedAsItIsShown) {
  const auto pfm = [&](const std::string& name, float value) {
    std::string text = "PF\n2 1\n-1.0\n";
    for (int i = 0; i < 6; ++i) text.append(reinterpret_cast<const char*>(&value), 4);
    folder_.write(name, text);
  };
  pfm("a.pfm", 0.5f), pfm("b.pfm", 0.25f), pfm("c.pfm", 0.2501f), pfm("n.pfm", NAN);
  write("a.png", gray(2, 1, 188));  // sRGB of 0.5
  Ran ran = run({"a.pfm", "b.pfm"});
  EXPECT_EQ(1, ran.code);
  EXPECT_NE(std::string::npos, ran.out.find("rmse_linear   0.25\n")) << ran.out;
  ran = run({"b.pfm", "c.pfm"});
  EXPECT_EQ(0, ran.code) << "the same bytes";
  EXPECT_NE(std::string::npos, ran.out.find("rmse_linear   9.9")) << ran.out;
  EXPECT_EQ(1, run({"b.pfm", "c.pfm", "--max-error", "rmse_linear=0.00001"}).code);
  EXPECT_EQ(0, run({"a.png", "a.pfm"}).code);
  EXPECT_EQ(std::string::npos, ran.out.find("past_white")) << ran.out;
  pfm("w.pfm", 2.0f), pfm("v.pfm", 3.0f);
  ran = run({"w.pfm", "v.pfm"});
  EXPECT_NE(std::string::npos, ran.out.find("flip          0.000000\n")) << ran.out;
  EXPECT_NE(std::string::npos, ran.out.find("rmse_linear   1\n")) << ran.out;
  EXPECT_NE(std::string::npos, ran.error.find("flip is 0, and yet")) << ran.error;
  ran = run({"a.pfm", "v.pfm"});
  EXPECT_NE(std::string::npos, ran.out.find("past_white    0 pixels of A, ")) << ran.out;
  EXPECT_EQ(std::string::npos, ran.error.find("flip is 0")) << ran.error;
  ran = run({"a.pfm", "n.pfm"});
  EXPECT_EQ(1, ran.code);
  EXPECT_NE(std::string::npos, ran.error.find("pixel 0,0 of the second picture is not finite")) << ran.error;
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
  EXPECT_EQ(2, run({"l.json", "l.json", "--max-error", "flip=1"}).code);
  EXPECT_EQ(2, run({"a.png"}).code);
  EXPECT_EQ(2, run({"a.png", "a.png", "--max", "256"}).code);
  EXPECT_EQ(2, run({"a.png", "a.png", "--max-wrong", "-1"}).code);
}

}  // namespace
}  // namespace spanray
