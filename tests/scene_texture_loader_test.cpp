// Images -> textures: channels, depths, levels, and what is refused.
#include "scene/texture_loader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

namespace spanray {
namespace {

RawImage image_of(int width, int height, int channels, int bits, std::vector<uint16_t> samples) {
  return {width, height, channels, bits, std::move(samples)};
}

TEST(Textures, ChannelsAndDepths) {
  SceneData s;
  ASSERT_TRUE(append_texture(image_of(1, 1, 1, 8, {255}), false, s));
  ASSERT_TRUE(append_texture(image_of(1, 1, 2, 8, {0, 128}), true, s));
  ASSERT_TRUE(append_texture(image_of(1, 1, 4, 16, {1, 2, 3, 4}), false, s));
  ASSERT_TRUE(append_texture(image_of(1, 1, 3, 16, {65535, 0, 65535}), true, s));
  const auto is = [&](size_t i, int r, int g, int b, int a) {
    return s.texels[i].r == r && s.texels[i].g == g && s.texels[i].b == b && s.texels[i].a == a;
  };
  EXPECT_TRUE(is(0, 65535, 65535, 65535, 65535));
  EXPECT_TRUE(is(1, 0, 0, 0, 128 * 257));  // alpha is never decoded
  EXPECT_TRUE(is(2, 1, 2, 3, 4));
  EXPECT_TRUE(is(3, 65535, 0, 65535, 65535));
}

TEST(Textures, SixteenBitColorsAgreeWithEightBitOnes) {
  SceneData s;
  std::vector<uint16_t> eight, sixteen;
  for (int i = 0; i < 256; ++i) eight.push_back(static_cast<uint16_t>(i)), sixteen.push_back(static_cast<uint16_t>(i * 257));
  ASSERT_TRUE(append_texture(image_of(256, 1, 1, 8, eight), true, s));
  ASSERT_TRUE(append_texture(image_of(256, 1, 1, 16, sixteen), true, s));
  for (int i = 0; i < 256; ++i)
    EXPECT_EQ(s.texels[static_cast<size_t>(i)].r, s.texels[static_cast<size_t>(s.textures[1].offset[0] + i)].r) << i;
}

// The oracle repeats every texel dst times along each axis, so that each destination texel covers whole ones.
TEST(Textures, BoxFilterIsTheExactAreaMeanForAnySize) {
  std::mt19937 rng(11);
  for (int w = 1; w <= 9; ++w)
    for (int h = 1; h <= 9; ++h) {
      const int dw = std::max(1, w / 2), dh = std::max(1, h / 2);
      std::vector<Texel> src(static_cast<size_t>(w * h)), dst(static_cast<size_t>(dw * dh));
      for (Texel& t : src) t = {static_cast<uint16_t>(rng()), static_cast<uint16_t>(rng() & 1 ? 65535 : 0), 65535, 7};
      box_filter(src.data(), w, h, dst.data(), dw, dh);
      for (int y = 0; y < dh; ++y)
        for (int x = 0; x < dw; ++x) {
          int64_t r = 0, g = 0;
          for (int j = 0; j < h; ++j)
            for (int i = 0; i < w; ++i) {
              const Texel& t = src[static_cast<size_t>((y * h + j) / dh * w + (x * w + i) / dw)];
              r += t.r, g += t.g;
            }
          const Texel& t = dst[static_cast<size_t>(y * dw + x)];
          EXPECT_EQ(t.r, (2 * r + w * h) / (2 * w * h)) << w << "x" << h;
          EXPECT_EQ(t.g, (2 * g + w * h) / (2 * w * h)) << w << "x" << h;
          EXPECT_EQ(t.b, 65535);
          EXPECT_EQ(t.a, 7);
        }
    }
}

TEST(Textures, LevelsOfOddSizesAndLimits) {
  SceneData s;
  ASSERT_TRUE(append_texture(image_of(7, 3, 1, 8, std::vector<uint16_t>(21, 9)), false, s));
  EXPECT_EQ(s.textures[0].levels, 3);  // 7x3, 3x1, 1x1
  EXPECT_EQ(s.textures[0].offset[1], 21);
  EXPECT_EQ(s.textures[0].offset[2], 24);
  EXPECT_EQ(s.texels.size(), 25u);
  for (const Texel& t : s.texels) EXPECT_EQ(t.r, 9 * 257);
  ASSERT_TRUE(append_texture(image_of(16384, 1, 1, 8, std::vector<uint16_t>(16384, 1)), false, s));
  EXPECT_EQ(s.textures[1].levels, kMaxMipLevels);
  EXPECT_FALSE(append_texture(image_of(16385, 1, 1, 8, std::vector<uint16_t>(16385, 1)), false, s));
  EXPECT_FALSE(append_texture(image_of(0, 1, 1, 8, {}), false, s));
  EXPECT_FALSE(append_texture(image_of(2, 2, 1, 8, {1, 2, 3}), false, s));
  EXPECT_FALSE(append_texture(image_of(1, 1, 5, 8, {1, 2, 3, 4, 5}), false, s));
}

}  // namespace
}  // namespace spanray
