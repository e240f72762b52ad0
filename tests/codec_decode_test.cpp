#include <gtest/gtest.h>

#include <sys/stat.h>

#include "codec/decode.h"
#include "support/encode_fixture.h"
#include "support/random.h"
#include "support/temp_folder.h"

namespace spanray {
namespace {

std::vector<std::string> random_rows(TestRandom& random, int height, int bytes) {
  std::vector<std::string> rows;
  for (int y = 0; y < height; ++y) {
    rows.emplace_back();
    for (int i = 0; i < bytes; ++i) rows.back().push_back(static_cast<char>(random.bits() & 0xff));
  }
  return rows;
}
int byte_at(const std::string& s, size_t i) { return static_cast<unsigned char>(s[i]); }

bool consistent(const RawImage& image) {
  return image.samples.size() == static_cast<size_t>(image.width) * static_cast<size_t>(image.height * image.channels);
}

std::string noise(TestRandom& random, size_t n) {
  std::string s;
  for (size_t i = 0; i < n; ++i) s.push_back(static_cast<char>(random.bits() & 0xff));
  return s;
}

TEST(CodecPng, EightAndSixteenBitSamplesAreExact) {
  TestRandom random(1);
  const int colors[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGB_ALPHA};
  for (const int bits : {8, 16})
    for (int channels = 1; channels <= 4; ++channels)
      for (const bool interlaced : {false, true})
        for (const int width : {1, 2, 13, 33}) {
          const int height = 34 - width, bytes = bits / 8;
          PngFixture f{width, height, bits, colors[channels - 1], interlaced};
          f.gamma = 0.2;  // must be ignored
          const auto rows = random_rows(random, height, width * channels * bytes);
          const Result<RawImage> image = decode_image(encode_png_fixture(f, rows));
          ASSERT_TRUE(image) << image.error().message;
          ASSERT_EQ(image.value().width, width);
          ASSERT_EQ(image.value().height, height);
          ASSERT_EQ(image.value().channels, channels);
          ASSERT_EQ(image.value().bits, bits);
          ASSERT_EQ(image.value().samples.size(), static_cast<size_t>(width * height * channels));
          for (size_t y = 0, i = 0; y < rows.size(); ++y)
            for (size_t b = 0; b < rows[y].size(); b += static_cast<size_t>(bytes), ++i)
              ASSERT_EQ(image.value().samples[i], bits == 8 ? byte_at(rows[y], b) : byte_at(rows[y], b) * 256 + byte_at(rows[y], b + 1));
        }
}

TEST(CodecPng, PalettesAndSmallGraysAreExpanded) {
  PngFixture f{4, 1, 2, PNG_COLOR_TYPE_PALETTE, false, {{1, 2, 3}, {40, 50, 60}, {255, 0, 128}, {7, 7, 7}}};
  Result<RawImage> image = decode_image(encode_png_fixture(f, {std::string("\x1b", 1)}));  // indices 0 1 2 3
  ASSERT_TRUE(image);
  EXPECT_EQ(image.value().channels, 3);
  EXPECT_EQ(image.value().samples, (std::vector<uint16_t>{1, 2, 3, 40, 50, 60, 255, 0, 128, 7, 7, 7}));
  f.palette_alpha = {9, 255};
  image = decode_image(encode_png_fixture(f, {std::string("\x1b", 1)}));
  ASSERT_TRUE(image);
  EXPECT_EQ(image.value().channels, 4);
  EXPECT_EQ(image.value().samples, (std::vector<uint16_t>{1, 2, 3, 9, 40, 50, 60, 255, 255, 0, 128, 255, 7, 7, 7, 255}));
  image = decode_image(encode_png_fixture({8, 1, 1, PNG_COLOR_TYPE_GRAY}, {std::string("\xa5", 1)}));
  ASSERT_TRUE(image);
  EXPECT_EQ(image.value().samples, (std::vector<uint16_t>{255, 0, 255, 0, 0, 255, 0, 255}));
  image = decode_image(encode_png_fixture({2, 1, 4, PNG_COLOR_TYPE_GRAY}, {std::string("\x3f", 1)}));
  ASSERT_TRUE(image);
  EXPECT_EQ(image.value().samples, (std::vector<uint16_t>{51, 255}));
}

std::vector<uint16_t> hostile_samples(const std::string& name) {
  const Result<RawImage> image = decode_image_file(SPANRAY_SOURCE_DIR "/tests/hostile/" + name);
  EXPECT_TRUE(image) << image.error().to_string();
  return image ? image.value().samples : std::vector<uint16_t>{};
}

TEST(CodecPng, TransparentColorsAndForeignPaletteIndices) {
  EXPECT_EQ(hostile_samples("png/gray8_key.png"), (std::vector<uint16_t>{1, 255, 2, 255, 3, 0, 4, 255, 5, 255, 6, 255, 7, 255, 8, 255}));
  EXPECT_EQ(hostile_samples("png/rgb16_key.png"), (std::vector<uint16_t>{0x0102, 0x0304, 0x0506, 0}));
  // Of two entries; indices 1 to 8.
  const std::vector<uint16_t> palette = hostile_samples("png/palette_index_out.png");
  ASSERT_EQ(palette.size(), 24u);
  EXPECT_EQ((std::vector<uint16_t>(palette.begin(), palette.begin() + 3)), (std::vector<uint16_t>{'d', 'e', 'f'}));
  for (size_t i = 3; i < palette.size(); ++i) EXPECT_EQ(palette[i], 0) << "past the palette is black";
}

TEST(CodecPng, GammaProfilesTextAndTrailingBytesChangeNothing) {
  const std::vector<uint16_t> plain = {1, 2, 3, 4, 5, 6, 7, 8};
  for (const char* name : {"gamma_and_profile", "gamma_zero", "text_bomb", "many_idat", "unknown_ancillary", "bytes_after_end",
                           "too_many_rows"})
    EXPECT_EQ(hostile_samples("png/" + std::string(name) + ".png"), plain) << name;
}

TEST(CodecPng, EveryTruncationIsAnError) {
  TestRandom random(2);
  for (const bool interlaced : {false, true}) {
    const std::string whole = encode_png_fixture({20, 20, 8, PNG_COLOR_TYPE_RGB, interlaced}, random_rows(random, 20, 60));
    ASSERT_TRUE(decode_image(whole));
    for (size_t n = 0; n < whole.size(); ++n) {
      const Result<RawImage> image = decode_image(std::string_view(whole).substr(0, n));
      ASSERT_FALSE(image) << n << " of " << whole.size();
      ASSERT_NE(image.error().message.find(n > 0 ? "truncated" : "empty"), std::string::npos) << n << ": " << image.error().message;
    }
  }
}

// One flipped byte: an error or a picture of the declared size, never a crash. (Most flips fail a checksum.)
TEST(CodecPng, DamagedBytesNeverCrash) {
  TestRandom random(3);
  const std::string whole = encode_png_fixture({16, 16, 8, PNG_COLOR_TYPE_RGB_ALPHA, true}, random_rows(random, 16, 64));
  int errors = 0;
  for (size_t i = 0; i < whole.size(); ++i) {
    std::string bad = whole;
    bad[i] = static_cast<char>(bad[i] ^ (1 << random.below(8)));
    const Result<RawImage> image = decode_image(bad);
    ASSERT_TRUE(!image || consistent(image.value()));
    errors += !image;
  }
  EXPECT_GT(errors, static_cast<int>(whole.size() * 9 / 10));
}

// IHDR with sizes that it does not have data for.
std::string with_png_size(std::string png, uint32_t width, uint32_t height) {
  for (int i = 0; i < 4; ++i) png[16 + static_cast<size_t>(i)] = static_cast<char>(width >> (24 - 8 * i)), png[20 + static_cast<size_t>(i)] = static_cast<char>(height >> (24 - 8 * i));
  uint32_t crc = 0xffffffffu;
  for (size_t i = 12; i < 29; ++i) {
    crc ^= static_cast<unsigned char>(png[i]);
    for (int k = 0; k < 8; ++k) crc = (crc >> 1) ^ ((crc & 1) ? 0xedb88320u : 0);
  }
  crc = ~crc;
  for (int i = 0; i < 4; ++i) png[29 + static_cast<size_t>(i)] = static_cast<char>(crc >> (24 - 8 * i));
  return png;
}

TEST(CodecPng, SizesAreLimitedAndHugeClaimsAreCheap) {
  TestRandom random(4);
  const std::string png = encode_png_fixture({4, 4, 8, PNG_COLOR_TYPE_RGB}, random_rows(random, 4, 12));
  const Result<RawImage> wide = decode_image(with_png_size(png, 16385, 1));
  ASSERT_FALSE(wide);
  EXPECT_NE(wide.error().message.find("16385 x 1"), std::string::npos) << wide.error().message;
  EXPECT_FALSE(decode_image(with_png_size(png, 1, 16385)));
  EXPECT_FALSE(decode_image(with_png_size(png, 0, 4)));
  EXPECT_FALSE(decode_image(with_png_size(png, 0xffffffffu, 4)));
  EXPECT_FALSE(decode_image(with_png_size(png, 16384, 16384)));  // allowed size, but the data ends
  const Result<RawImage> widest = decode_image(encode_png_fixture({16384, 1, 8, PNG_COLOR_TYPE_GRAY}, random_rows(random, 1, 16384)));
  EXPECT_TRUE(widest);
}

TEST(CodecJpeg, FlatColorsAndGraysAreNearlyExact) {
  for (const bool progressive : {false, true})
    for (const int channels : {1, 3}) {
      const int width = 37, height = 19;
      std::string samples;
      for (int i = 0; i < width * height * channels; ++i) samples.push_back(static_cast<char>(i % channels == 0 ? 200 : i % channels == 1 ? 60 : 90));
      const Result<RawImage> image = decode_image(encode_jpeg_fixture(width, height, channels, progressive, samples));
      ASSERT_TRUE(image) << image.error().message;
      ASSERT_EQ(image.value().width, width);
      ASSERT_EQ(image.value().height, height);
      ASSERT_EQ(image.value().channels, channels);
      ASSERT_EQ(image.value().bits, 8);
      ASSERT_EQ(image.value().samples.size(), samples.size());
      for (size_t i = 0; i < samples.size(); ++i) ASSERT_NEAR(image.value().samples[i], byte_at(samples, i), 3) << i;
    }
}

TEST(CodecJpeg, TruncationIsAnErrorAndDamageNeverCrashes) {
  TestRandom random(5);
  for (const bool progressive : {false, true}) {
    const std::string whole = encode_jpeg_fixture(40, 40, 3, progressive, noise(random, 4800));
    ASSERT_TRUE(decode_image(whole));
    for (size_t n = 0; n + 2 < whole.size(); n += 7) ASSERT_FALSE(decode_image(std::string_view(whole).substr(0, n))) << n;
    for (size_t i = 0; i < whole.size(); i += 3) {
      std::string bad = whole;
      bad[i] = static_cast<char>(bad[i] ^ (1 << random.below(8)));
      const Result<RawImage> image = decode_image(bad);
      ASSERT_TRUE(!image || consistent(image.value()));
    }
  }
}

TEST(CodecJpeg, CmykIsRefusedInWords) {
  const Result<RawImage> image = decode_image(encode_jpeg_fixture(8, 8, 4, false, std::string(256, '\x40')));
  ASSERT_FALSE(image);
  EXPECT_NE(image.error().message.find("CMYK"), std::string::npos);
}

TEST(CodecFile, BadFilesAreErrorsThatNameThem) {
  const TempFolder folder;
  ASSERT_EQ(0, ::mkfifo(folder.file("pipe.png").c_str(), 0600));
  std::filesystem::create_directory(folder.file("folder.png"));
  const std::string paths[] = {folder.file("missing.png"), folder.file("pipe.png"), folder.file("folder.png"),
                               folder.write("empty.png", ""), folder.write("text.png", "P6 1 1 255 abc"),
                               folder.write("start.png", "\x89PNG\r\n"), folder.write("start.jpg", "\xff\xd8\xff")};
  const char* const causes[] = {"No such file", "not a regular file", "folder", "empty", "neither", "truncated", "truncated"};
  for (size_t i = 0; i < std::size(paths); ++i) {
    const Result<RawImage> image = decode_image_file(paths[i]);
    ASSERT_FALSE(image) << paths[i];
    EXPECT_EQ(image.error().file, paths[i]);
    EXPECT_NE(image.error().message.find(causes[i]), std::string::npos) << image.error().to_string();
  }
  EXPECT_FALSE(decode_image_file(""));
}

TEST(CodecFile, TheFirstBytesDecideNotTheName) {
  TestRandom random(6);
  const TempFolder folder;
  const std::string png = encode_png_fixture({4, 4, 8, PNG_COLOR_TYPE_RGB}, random_rows(random, 4, 12));
  EXPECT_TRUE(decode_image_file(folder.write("picture.jpg", png)));
  EXPECT_TRUE(decode_image_file(folder.write("picture", encode_jpeg_fixture(4, 4, 3, false, noise(random, 48)))));
}

}  // namespace
}  // namespace spanray
