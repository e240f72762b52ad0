#include <gtest/gtest.h>

#include <cmath>

#include "image/metrics.h"

namespace spanray {
namespace {

Image gray(int width, int height, uint8_t value) {
  Image image{width, height, std::vector<uint8_t>(4 * static_cast<size_t>(width) * static_cast<size_t>(height), value)};
  for (size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  return image;
}

TEST(ImageMetrics, EqualPicturesAreZeroApart) {
  const Result<ImageDifference> d = compare_images(gray(5, 4, 9), gray(5, 4, 9));
  ASSERT_TRUE(d);
  EXPECT_EQ(d.value().max, 0);
  EXPECT_EQ(d.value().rmse, 0);
  EXPECT_TRUE(std::isinf(d.value().psnr_db) && d.value().psnr_db > 0);
  EXPECT_EQ(d.value().wrong_pixels, 0u);
  EXPECT_EQ(d.value().pixels_over_1, 0u);
  EXPECT_EQ(d.value().x, -1);
  EXPECT_EQ(d.value().y, -1);
}

TEST(ImageMetrics, CountsAndTheWorstPixel) {
  const Image a = gray(10, 10, 100);
  Image b = a;
  b.rgba[4 * 13 + 1] = 101;  // pixel (3, 1), one step
  b.rgba[4 * 27 + 2] = 90;   // pixel (7, 2), ten steps
  b.rgba[4 * 45 + 0] = 110;  // pixel (5, 4), ten steps again: the first stays the worst
  b.rgba[4 * 60 + 3] = 253;  // pixel (0, 6): alpha counts, but not for RMSE
  for (const bool swapped : {false, true}) {
    const Result<ImageDifference> d = swapped ? compare_images(b, a) : compare_images(a, b);
    ASSERT_TRUE(d);
    EXPECT_EQ(d.value().max, 10);
    EXPECT_EQ(d.value().wrong_pixels, 4u);
    EXPECT_EQ(d.value().pixels_over_1, 3u);
    EXPECT_EQ(d.value().x, 7);
    EXPECT_EQ(d.value().y, 2);
    EXPECT_DOUBLE_EQ(d.value().rmse, std::sqrt(201.0 / 300));
    EXPECT_NEAR(d.value().psnr_db, 20 * std::log10(255 / std::sqrt(201.0 / 300)), 1e-12);
  }
}

TEST(ImageMetrics, BlackAgainstWhiteIsTheWorst) {
  const Result<ImageDifference> d = compare_images(gray(3, 3, 0), gray(3, 3, 255));
  ASSERT_TRUE(d);
  EXPECT_EQ(d.value().max, 255);
  EXPECT_EQ(d.value().rmse, 255);
  EXPECT_EQ(d.value().psnr_db, 0);
  EXPECT_EQ(d.value().wrong_pixels, 9u);
}

TEST(ImageMetrics, OtherSizesAreAnErrorWithBothSizes) {
  const Result<ImageDifference> d = compare_images(gray(3, 4, 0), gray(4, 3, 0));
  ASSERT_FALSE(d);
  EXPECT_NE(d.error().message.find("3 x 4"), std::string::npos);
  EXPECT_NE(d.error().message.find("4 x 3"), std::string::npos);
  EXPECT_FALSE(compare_images(gray(3, 4, 0), Image{3, 4, {}}));
}

TEST(ImageMetrics, DifferencePictureShowsOneStepAndKeepsTheRestDark) {
  const Image a = gray(4, 4, 240);
  Image b = a;
  b.rgba[4 * 5 + 1] = 241;
  b.rgba[4 * 6 + 0] = 0;
  const Image d = difference_picture(a, b);
  ASSERT_EQ(d.rgba.size(), a.rgba.size());
  for (size_t i = 0; i < 16; ++i) {
    const uint8_t* p = d.rgba.data() + 4 * i;
    EXPECT_EQ(p[3], 255);
    if (i == 5) EXPECT_EQ(std::vector<int>(p, p + 3), (std::vector<int>{0, 64, 0}));
    else if (i == 6) EXPECT_EQ(std::vector<int>(p, p + 3), (std::vector<int>{255, 0, 0}));
    else EXPECT_EQ(std::vector<int>(p, p + 3), (std::vector<int>{40, 40, 40}));
  }
}

TEST(ImageMetrics, DifferencePictureOfOtherSizesMarksWhatIsMissing) {
  const Image d = difference_picture(gray(2, 3, 50), gray(3, 2, 50));
  ASSERT_EQ(d.width, 3);
  ASSERT_EQ(d.height, 3);
  int magenta = 0;
  for (size_t i = 0; i < 9; ++i) magenta += d.rgba[4 * i] == 255 && d.rgba[4 * i + 1] == 0 && d.rgba[4 * i + 2] == 255;
  EXPECT_EQ(magenta, 5);
}

}  // namespace
}  // namespace spanray
