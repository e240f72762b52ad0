#include <gtest/gtest.h>

#include <sys/stat.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <limits>

#include "core/read_file.h"
#include "image/pfm.h"
#include "spanray/image.h"
#include "support/encode_fixture.h"
#include "support/random.h"
#include "support/temp_folder.h"

namespace spanray {
namespace {

Image random_image(TestRandom& random, int width, int height) {
  Image image{width, height, std::vector<uint8_t>(4 * static_cast<size_t>(width) * static_cast<size_t>(height))};
  for (uint8_t& b : image.rgba) b = static_cast<uint8_t>(random.bits());
  return image;
}

TEST(ImagePng, RoundTripIsExact) {
  TestRandom random(1);
  const TempFolder folder;
  const std::pair<int, int> sizes[] = {{1, 1}, {1, 7}, {64, 1}, {33, 21}, {16384, 1}, {1, 16384}};
  for (const auto& [width, height] : sizes) {
    const Image image = random_image(random, width, height);
    const Result<void> written = write_png(folder.file("a.png"), image);
    ASSERT_TRUE(written) << written.error().to_string();
    const Result<Image> back = read_png(folder.file("a.png"));
    ASSERT_TRUE(back) << back.error().to_string();
    EXPECT_EQ(back.value().width, width);
    EXPECT_EQ(back.value().height, height);
    EXPECT_EQ(back.value().rgba, image.rgba);
    EXPECT_EQ(hash_image(back.value()), hash_image(image));
  }
  EXPECT_EQ(folder.entries(), 1);  // no temporary file stays
}

TEST(ImagePng, TextIsWritten) {
  TestRandom random(2);
  const TempFolder folder;
  ASSERT_TRUE(write_png(folder.file("a.png"), random_image(random, 3, 3), {{"Software", "spanray"}, {"numeric_contract", "1"}}));
  const Result<std::string> bytes = read_file(folder.file("a.png"));
  ASSERT_TRUE(bytes);
  EXPECT_NE(bytes.value().find(std::string("tEXtnumeric_contract\0" "1", 22)), std::string::npos);
  EXPECT_TRUE(read_png(folder.file("a.png")));
  EXPECT_FALSE(write_png(folder.file("b.png"), random_image(random, 3, 3), {{"", "x"}}));
  EXPECT_FALSE(write_png(folder.file("b.png"), random_image(random, 3, 3), {{std::string(80, 'k'), "x"}}));
}

TEST(ImagePng, EveryKindBecomesRgba8) {
  const TempFolder folder;
  const auto read = [&](const PngFixture& f, const std::string& row) {
    const Result<Image> image = read_png(folder.write("a.png", encode_png_fixture(f, {row})));
    EXPECT_TRUE(image);
    return image ? image.value().rgba : std::vector<uint8_t>();
  };
  using Bytes = std::vector<uint8_t>;
  EXPECT_EQ(read({2, 1, 8, PNG_COLOR_TYPE_GRAY}, "\x10\x20"), (Bytes{16, 16, 16, 255, 32, 32, 32, 255}));
  EXPECT_EQ(read({1, 1, 8, PNG_COLOR_TYPE_GRAY_ALPHA}, "\x10\x20"), (Bytes{16, 16, 16, 32}));
  EXPECT_EQ(read({1, 1, 8, PNG_COLOR_TYPE_RGB}, "\x10\x20\x30"), (Bytes{16, 32, 48, 255}));
  EXPECT_EQ(read({1, 1, 8, PNG_COLOR_TYPE_PALETTE, false, {{9, 8, 7}}, {6}}, std::string(1, '\0')), (Bytes{9, 8, 7, 6}));
  // 16 bits: the nearest of 255 * v / 65535. 0x0080 = 128 is just under half a step, 0x0081 just over it.
  EXPECT_EQ(read({1, 1, 16, PNG_COLOR_TYPE_RGB}, std::string("\x00\x80\x00\x81\xff\xff", 6)), (Bytes{0, 1, 255, 255}));
}

TEST(ImagePng, BadTargetsAreErrorsThatNameThemAndLeaveNothing) {
  TestRandom random(3);
  const TempFolder folder;
  const Image image = random_image(random, 4, 4);
  std::filesystem::create_directory(folder.file("folder"));
  const int before = folder.entries();
  for (const std::string& path : {folder.file("folder"), folder.file("missing/a.png"), std::string(), std::string("/proc/a.png")}) {
    const Result<void> written = write_png(path, image);
    ASSERT_FALSE(written) << path;
    EXPECT_EQ(written.error().file, path);
    EXPECT_FALSE(written.error().message.empty());
  }
  EXPECT_FALSE(write_png(folder.file("a.png"), Image{}));
  EXPECT_FALSE(write_png(folder.file("a.png"), Image{2, 2, std::vector<uint8_t>(15)}));
  EXPECT_FALSE(write_png(folder.file("a.png"), Image{16385, 1, std::vector<uint8_t>(4 * 16385)}));
  EXPECT_EQ(folder.entries(), before);
}

TEST(ImagePng, AFailedWriteKeepsTheOldFile) {
  TestRandom random(4);
  const TempFolder folder;
  const Image image = random_image(random, 5, 5);
  ASSERT_TRUE(write_png(folder.file("a.png"), image));
  EXPECT_FALSE(write_png(folder.file("a.png"), Image{2, 2, {}}));
  const Result<Image> kept = read_png(folder.file("a.png"));
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept.value().rgba, image.rgba);
}

TEST(ImagePng, BadFilesAreErrorsThatNameThem) {
  TestRandom random(5);
  const TempFolder folder;
  ASSERT_TRUE(write_png(folder.file("good.png"), random_image(random, 9, 9)));
  const std::string good = read_file(folder.file("good.png")).value();
  std::string flipped = good;
  flipped[good.size() / 2] = static_cast<char>(flipped[good.size() / 2] ^ 1);
  const std::string paths[] = {folder.file("missing.png"), folder.path(), folder.write("empty.png", ""), folder.write("text.png", "hello"),
                               folder.write("cut.png", good.substr(0, good.size() / 2)), folder.write("flipped.png", flipped),
                               folder.write("jpeg.png", encode_jpeg_fixture(4, 4, 3, false, std::string(48, 'x')))};
  for (const std::string& path : paths) {
    const Result<Image> image = read_png(path);
    ASSERT_FALSE(image) << path;
    EXPECT_EQ(image.error().file, path);
    EXPECT_NE(image.error().to_string().find(path), std::string::npos);
  }
}

TEST(ImageHash, SizeAndEveryByteCount) {
  TestRandom random(6);
  Image image = random_image(random, 6, 4);
  const uint64_t hash = hash_image(image);
  for (size_t i = 0; i < image.rgba.size(); ++i) {
    image.rgba[i] ^= 1;
    EXPECT_NE(hash_image(image), hash);
    image.rgba[i] ^= 1;
  }
  EXPECT_EQ(hash_image(image), hash);
  std::swap(image.width, image.height);
  EXPECT_NE(hash_image(image), hash);
}

// A picture's hash is part of the promise: it may only change together with the numeric contract.
TEST(ImageHash, KnownValue) {
  Image image{3, 2, {}};
  for (int i = 0; i < 24; ++i) image.rgba.push_back(static_cast<uint8_t>(i * 11));
  EXPECT_EQ(hash_image(image), 0x84a741c904f0b5c6u);  // from a second implementation, in another language
}

TEST(ImagePfm, RoundTripKeepsEveryBit) {
  TestRandom random(7);
  const TempFolder folder;
  FloatImage image{5, 3, {}};
  for (int i = 0; i < 45; ++i) image.rgb.push_back(std::bit_cast<float>(random.bits()));
  image.rgb[0] = std::numeric_limits<float>::infinity(), image.rgb[1] = -0.0f, image.rgb[2] = std::bit_cast<float>(0x7fc00000u);
  ASSERT_TRUE(write_pfm(folder.file("a.pfm"), image));
  const Result<FloatImage> back = read_pfm(folder.file("a.pfm"));
  ASSERT_TRUE(back) << back.error().to_string();
  ASSERT_EQ(back.value().width, 5);
  ASSERT_EQ(back.value().height, 3);
  for (size_t i = 0; i < 45; ++i) EXPECT_EQ(std::bit_cast<uint32_t>(back.value().rgb[i]), std::bit_cast<uint32_t>(image.rgb[i]));
}

TEST(ImagePfm, RowsStartAtTheBottomInBothByteOrders) {
  const TempFolder folder;
  const std::string one("\x3f\x80\x00\x00", 4), two("\x40\x00\x00\x00", 4);  // big endian
  const Result<FloatImage> big = read_pfm(folder.write("a.pfm", "Pf\n1 2\n1.0\n" + one + two));
  ASSERT_TRUE(big);
  EXPECT_EQ(big.value().rgb, (std::vector<float>{2, 2, 2, 1, 1, 1}));
  const Result<FloatImage> little = read_pfm(folder.write("b.pfm", "Pf\n1 2\n-1\n" + std::string(one.rbegin(), one.rend()) + std::string(two.rbegin(), two.rend())));
  ASSERT_TRUE(little);
  EXPECT_EQ(little.value().rgb, big.value().rgb);
}

TEST(ImagePfm, BadFilesAreErrors) {
  const TempFolder folder;
  for (const char* bytes : {"", "P", "PF", "PF\n", "PF\n1\n", "PF\nx 1\n-1\n", "PF\n1 1\n0\nabcdabcdabcd", "PF\n1 1\nnan\nabcdabcdabcd",
                            "PF\n0 1\n-1\nabcd", "PF\n-1 1\n-1\nabcd", "PF\n16385 1\n-1\nabcd", "PF\n1 1\n-1\nabcdabcdabc", "P6\n1 1\n255\nabc",
                            "PF\n16384 16384\n-1\nabcd", "PF\n99999999999 1\n-1\nabcd"}) {
    const Result<FloatImage> image = read_pfm(folder.write("a.pfm", bytes));
    ASSERT_FALSE(image) << bytes;
    EXPECT_EQ(image.error().file, folder.file("a.pfm"));
  }
  EXPECT_FALSE(read_pfm(folder.file("missing.pfm")));
  EXPECT_FALSE(read_pfm(folder.path()));
  EXPECT_FALSE(write_pfm(folder.file("b.pfm"), FloatImage{2, 2, std::vector<float>(11)}));
  EXPECT_FALSE(write_pfm(folder.path(), FloatImage{1, 1, {1, 2, 3}}));
}

}  // namespace
}  // namespace spanray
