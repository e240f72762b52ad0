#include <gtest/gtest.h>

#include <cmath>

#include "image/false_color.h"
#include "image/metrics.h"
#include "image/ssim.h"
#include "math/color.h"
#include "support/random.h"

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

Metrics measured(const PictureView& reference, const PictureView& picture, MetricMaps* maps = nullptr) {
  Parallel parallel(2);
  const Result<Metrics> m = measure_pictures(reference, picture, parallel, maps);
  EXPECT_TRUE(m) << m.error().to_string();
  return m ? m.value() : Metrics{};
}

Image noise(int width, int height, uint32_t seed) {
  TestRandom random(seed);
  Image image = gray(width, height, 0);
  for (size_t i = 0; i < image.rgba.size(); ++i)
    if (i % 4 != 3) image.rgba[i] = static_cast<uint8_t>(random.uniform(0, 256));
  return image;
}

TEST(ImageMetrics, OfEqualPictures) {
  const Image a = noise(40, 30, 1);
  const Metrics m = measured(a, a);
  EXPECT_EQ(m.max, 0);
  EXPECT_EQ(m.p99_9, 0);
  EXPECT_EQ(m.over_1, 0);
  EXPECT_EQ(m.rmse_linear, 0);
  EXPECT_EQ(m.relmse, 0);
  EXPECT_EQ(m.flip, 0);
  EXPECT_DOUBLE_EQ(m.ssim, 1);
  EXPECT_TRUE(std::isinf(m.psnr_db) && m.psnr_db > 0);
}

TEST(ImageMetrics, OfBlackAndWhite) {
  const Metrics m = measured(gray(20, 20, 0), gray(20, 20, 255)), n = measured(gray(20, 20, 255), gray(20, 20, 0));
  EXPECT_EQ(m.max, 255);
  EXPECT_EQ(m.p99_9, 255);
  EXPECT_EQ(m.over_1, 1);
  EXPECT_EQ(m.psnr_db, 0);
  EXPECT_DOUBLE_EQ(m.rmse_linear, 1);
  EXPECT_NEAR(m.relmse, 1 / 0.01, 1e-9);
  EXPECT_NEAR(n.relmse, 1 / 1.01, 1e-9) << "relative to the reference, which comes first";
  EXPECT_NEAR(m.ssim, 6.5025 / (255 * 255 + 6.5025), 1e-12);
  EXPECT_NEAR(m.flip, 0.967, 0.001);
}

// One pixel in a thousand is what p99.9 leaves out, not two.
TEST(ImageMetrics, CountsPixelsAndPercentile) {
  const Image a = gray(50, 20, 100);
  Image b = a;
  b.rgba[4 * 7 + 1] = 130;
  MetricMaps maps;
  Metrics m = measured(a, b, &maps);
  EXPECT_EQ(m.max, 30);
  EXPECT_EQ(m.p99_9, 0);
  EXPECT_EQ(m.over_1, 1.0 / 1000);
  EXPECT_EQ(maps.difference[7], 30);
  EXPECT_EQ(maps.difference[8], 0);
  EXPECT_GT(maps.flip[7], maps.flip[12]);
  const auto linear = [](double code) { return std::pow((code / 255 + 0.055) / 1.055, 2.4); };
  const double d = linear(130) - linear(100);
  EXPECT_NEAR(m.rmse_linear, std::sqrt(d * d / 3000), 1e-12);
  EXPECT_NEAR(m.relmse, d * d / (linear(100) * linear(100) + 0.01) / 3000, 1e-12);
  b.rgba[4 * 700] = 99, b.rgba[4 * 701] = 101, b.rgba[4 * 702] = 102;
  m = measured(a, b);
  EXPECT_EQ(m.p99_9, 2) << "the second largest of a thousand";
  EXPECT_EQ(m.over_1, 2.0 / 1000) << "off by one is not counted";
}

TEST(ImageMetrics, FloatsAreSeenAsADisplayShowsThem) {
  FloatImage a{16, 16, std::vector<float>(16 * 16 * 3, 4.0f)}, b = a;
  for (float& v : b.rgb) v = 2.0f;
  const Metrics m = measured(a, b);
  EXPECT_EQ(m.max, 0);
  EXPECT_EQ(m.flip, 0);
  EXPECT_DOUBLE_EQ(m.ssim, 1);
  EXPECT_DOUBLE_EQ(m.rmse_linear, 2) << "but linear light counts beyond white";
  // A picture and its own bytes, decoded: at most half a code apart.
  TestRandom random(9);
  for (float& v : a.rgb) v = static_cast<float>(random.uniform());
  Image bytes = gray(16, 16, 0);
  for (size_t i = 0; i < a.rgb.size(); ++i) bytes.rgba[i / 3 * 4 + i % 3] = srgb8_from_linear(a.rgb[i]);
  const Metrics rounded = measured(a, bytes);
  EXPECT_LE(rounded.max, 0.5001);
  EXPECT_GT(rounded.max, 0.45);
  EXPECT_EQ(rounded.over_1, 0);
}

TEST(ImageMetrics, WhatCannotBeCompared) {
  Parallel parallel(1);
  const auto error = [&](const PictureView& a, const PictureView& b) {
    const Result<Metrics> m = measure_pictures(a, b, parallel);
    return m ? std::string() : m.error().message;
  };
  EXPECT_NE(error(gray(3, 4, 0), gray(4, 3, 0)).find("3 x 4 pixels against 4 x 3"), std::string::npos);
  EXPECT_NE(error(Image{}, Image{}).find("no pixel"), std::string::npos);
  EXPECT_NE(error(Image{2, 2, {}}, gray(2, 2, 0)).find("disagree"), std::string::npos);
  FloatImage wrong{4, 2, std::vector<float>(24, 0.5f)};
  wrong.rgb[3 * 6 + 2] = NAN;
  EXPECT_NE(error(gray(4, 2, 0), wrong).find("pixel 2,1 of the second picture is not finite"), std::string::npos);
}

TEST(ImageMetrics, SsimOfOneWindowIsTheFormula) {
  Parallel parallel(1);
  const Image a = noise(11, 11, 2), b = noise(11, 11, 3);
  double whole = 0, m[5] = {};
  for (int y = 0; y < 11; ++y)
    for (int x = 0; x < 11; ++x) {
      const double w = std::exp(-((x - 5) * (x - 5) + (y - 5) * (y - 5)) / 4.5);
      const auto luma = [&](const Image& i) {
        const uint8_t* p = i.rgba.data() + 4 * (11 * y + x);
        return 0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2];
      };
      const double p = luma(a), q = luma(b);
      whole += w, m[0] += w * p, m[1] += w * q, m[2] += w * p * p, m[3] += w * q * q, m[4] += w * p * q;
    }
  for (double& v : m) v /= whole;
  const double c1 = 2.55 * 2.55, c2 = 7.65 * 7.65;
  const double want = (2 * m[0] * m[1] + c1) / (m[0] * m[0] + m[1] * m[1] + c1) * (2 * (m[4] - m[0] * m[1]) + c2) /
                      (m[2] - m[0] * m[0] + m[3] - m[1] * m[1] + c2);
  EXPECT_NEAR(mean_ssim(a, b, parallel), want, 1e-9);
  EXPECT_LT(std::fabs(want), 0.3) << "noise and noise have little in common";
}

TEST(ImageMetrics, SsimHasItsLimits) {
  Parallel one(1), three(3);
  const Image a = noise(60, 90, 4);
  Image negative = a, near = a;
  for (size_t i = 0; i < a.rgba.size(); ++i)
    if (i % 4 != 3) negative.rgba[i] = static_cast<uint8_t>(255 - a.rgba[i]), near.rgba[i] = static_cast<uint8_t>(a.rgba[i] ^ 1);
  EXPECT_LT(mean_ssim(a, negative, one), -0.9);
  EXPECT_GT(mean_ssim(a, near, one), 0.999);
  EXPECT_EQ(mean_ssim(a, negative, one), mean_ssim(a, negative, three));
  EXPECT_EQ(mean_ssim(a, near, one), mean_ssim(near, a, one));
  EXPECT_NEAR(mean_ssim(gray(30, 7, 50), gray(30, 7, 150), one), (2 * 50 * 150 + 6.5025) / (50 * 50 + 150 * 150 + 6.5025), 1e-12);
}

TEST(ImageMetrics, FalseColorRisesAndHasALegend) {
  std::vector<float> values;
  for (int i = 0; i < 400; ++i) values.push_back(static_cast<float>(i) / 200.0f);  // 0 to 2, most is 1
  const Image map = false_color(values, 400, 1, 1);
  ASSERT_EQ(map.width, 400);
  ASSERT_EQ(map.height, 1 + kLegendHeight);
  const auto sum = [&](int x, int y) {
    const uint8_t* p = map.rgba.data() + 4 * (400 * y + x);
    return p[0] + p[1] + p[2];
  };
  EXPECT_EQ(sum(0, 0), 4);
  for (int x = 8; x <= 200; x += 8) EXPECT_GT(sum(x, 0), sum(x - 8, 0)) << x;
  EXPECT_EQ(sum(200, 0), 252 + 253 + 191);
  EXPECT_EQ(sum(399, 0), sum(200, 0));
  EXPECT_EQ(sum(0, 4), 4);
  EXPECT_EQ(sum(399, 4), sum(200, 0)) << "the legend goes from 0 to most";
  int written = 0;
  for (int y = 16; y < 23; ++y)
    for (int x = 0; x < 400; ++x) written += sum(x, y) == 3 * 230;
  EXPECT_GT(written, 60) << "0, 0.25, 0.5, 0.75, 1";
  EXPECT_EQ(false_color(values, 20, 20, 1).width, 160) << "numbers need room";
}

}  // namespace
}  // namespace spanray
