// Ambiguity masks as files, and pictures judged by them.
#include "image/mask.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/temp_folder.h"

namespace spanray {
namespace {

// All pixels may be from 10 to 20.
AmbiguityMask plain(int width, int height) {
  const size_t values = 3 * static_cast<size_t>(width * height);
  AmbiguityMask mask;
  mask.width = width, mask.height = height, mask.least.assign(values, 10), mask.greatest.assign(values, 20);
  return mask;
}
Image gray(int width, int height, uint8_t value) {
  return {width, height, std::vector<uint8_t>(static_cast<size_t>(4 * width * height), value)};
}

TEST(Mask, FilesKeepEveryBit) {
  const TempFolder folder;
  AmbiguityMask mask = plain(5, 3);
  for (size_t i = 0; i < mask.least.size(); ++i)
    mask.least[i] = 0.1f * static_cast<float>(i), mask.greatest[i] = 255 - 0.3f * static_cast<float>(i);
  const std::string file = folder.file("m.pfm");
  ASSERT_TRUE(write_mask(file, mask));
  const Result<AmbiguityMask> read = read_mask(file);
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read.value().width, 5);
  EXPECT_EQ(read.value().height, 3);
  EXPECT_EQ(read.value().least, mask.least);
  EXPECT_EQ(read.value().greatest, mask.greatest);
  // As a picture, the least colors stand on top.
  const Result<FloatImage> picture = read_pfm(file);
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture.value().height, 6);
  EXPECT_EQ(picture.value().rgb[0], mask.least[0]);
}

TEST(Mask, BrokenOnesAreErrorsThatSayWhere) {
  const TempFolder folder;
  const std::string file = folder.file("m.pfm");
  const auto error_of = [&](int height, size_t value, float v) {
    FloatImage both{2, height, std::vector<float>(static_cast<size_t>(6 * height), 10)};
    both.rgb[value] = v;
    EXPECT_TRUE(write_pfm(file, both));
    const Result<AmbiguityMask> read = read_mask(file);
    return read ? std::string() : read.error().to_string();
  };
  EXPECT_EQ(error_of(4, 0, 9), "");
  EXPECT_NE(error_of(3, 0, 9).find("3 rows"), std::string::npos);
  EXPECT_NE(error_of(4, 10, 11).find("pixel 1,1 the least color is above the greatest"), std::string::npos);
  for (const float bad : {NAN, INFINITY, -0.5f, 255.5f}) {
    EXPECT_NE(error_of(4, 3, bad).find("pixel 1,0 stands a value that is no code"), std::string::npos) << bad;
    EXPECT_NE(error_of(4, 12, bad).find("pixel 0,0 stands a value that is no code"), std::string::npos) << bad;
  }
  EXPECT_NE(error_of(4, 3, NAN).find(file), std::string::npos);
  EXPECT_FALSE(read_mask(folder.file("none.pfm")));
  AmbiguityMask wrong = plain(2, 2);
  wrong.greatest.pop_back();
  EXPECT_FALSE(write_mask(file, wrong));
  const Result<void> high = write_mask(file, plain(1, 8193));
  ASSERT_FALSE(high);
  EXPECT_NE(high.error().to_string().find("8192 rows"), std::string::npos);
}

TEST(Mask, PicturesAreJudgedPixelByPixel) {
  const AmbiguityMask mask = plain(4, 2);
  Image image = gray(4, 2, 10);
  image.rgba[0] = 20;
  EXPECT_EQ(compare_with_mask(image, mask).value().outside, 0u) << "both ends belong to it; alpha is not looked at";
  image.rgba[4 * 1 + 2] = 21, image.rgba[4 * 6] = 7, image.rgba[4 * 6 + 1] = 22;
  const Result<MaskDifference> d = compare_with_mask(image, mask);
  ASSERT_TRUE(d);
  EXPECT_EQ(d.value().outside, 2u);
  EXPECT_EQ(d.value().worst[0], 3);
  EXPECT_EQ(d.value().worst[1], 2);
  EXPECT_EQ(d.value().worst[2], 1);
  ASSERT_EQ(d.value().first.size(), 2u);
  const MaskDifference::Pixel& p = d.value().first[1];
  EXPECT_EQ(p.x, 2);
  EXPECT_EQ(p.y, 1);
  EXPECT_EQ(p.channel, 0);
  EXPECT_EQ(p.code, 7);
  EXPECT_EQ(p.least, 10);
  EXPECT_EQ(p.greatest, 20);
  EXPECT_EQ(d.value().excess, (std::vector<float>{0, 1, 0, 0, 0, 0, 3, 0}));
  EXPECT_EQ(compare_with_mask(gray(4, 2, 30), mask).value().first.size(), MaskDifference::kMostListed);
  EXPECT_FALSE(compare_with_mask(gray(2, 4, 10), mask));
  // What is not a number is outside.
  const FloatImage nan{4, 2, std::vector<float>(24, NAN)};
  EXPECT_EQ(compare_with_mask(nan, mask).value().outside, 8u);
}

TEST(Mask, WidthsAreThoseOfTheWidestChannel) {
  AmbiguityMask mask = plain(2, 2);
  mask.greatest[4] = 28, mask.least[11] = 0;
  EXPECT_EQ(mask_widths(mask), (std::vector<float>{10, 18, 10, 20}));
  EXPECT_EQ(share_wider(mask, 10), 0.5);
  EXPECT_EQ(share_wider(mask, 9), 1);
  EXPECT_EQ(share_wider(mask, 18), 0.25);
  EXPECT_EQ(share_wider({}, 1), 0);
}

}  // namespace
}  // namespace spanray
