// sRGB: the scalar functions against libm's long double, the kernel against the scalar function.
#include <gtest/gtest.h>

#include <xmmintrin.h>

#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "image/encode.h"
#include "math/color.h"
#include "support/random.h"

namespace spanray {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
const float kNan = std::numeric_limits<float>::quiet_NaN();

long double exact_decode(long double e) { return e <= 0.04045L ? e / 12.92L : std::pow((e + 0.055L) / 1.055L, 2.4L); }
uint32_t bits_of(float f) { return std::bit_cast<uint32_t>(f); }
float from_bits(uint32_t bits) { return std::bit_cast<float>(bits); }

// Runs before any other test of this program, so that the tables are built under the poison.
TEST(AColorTables, BuiltUnderAForeignFloatingPointStateAreTheSame) {
  const unsigned saved = _mm_getcsr();
  _mm_setcsr(0x1f80u | 0x8040u | 0x4000u);  // flush to zero, denormals are zero, round up
  const SrgbEncodeTable table = srgb_encode_table();
  const uint16_t half = linear16_from_srgb8(188);
  _mm_setcsr(saved);
  for (int k = 0; k < 255; ++k) {
    const long double exact = exact_decode((k + 0.5L) / 255);
    EXPECT_GE(table.step[k], exact * (1 - 0x1p-40L)) << k;
    EXPECT_LT(from_bits(bits_of(table.step[k]) - 1), exact * (1 + 0x1p-40L)) << k;
  }
  EXPECT_EQ(half, std::lround(65535 * exact_decode(188 / 255.0L)));
}

TEST(Color, O1_CodesDecodeToTheNearest16BitValue) {
  for (int k = 0; k < 256; ++k) EXPECT_EQ(linear16_from_srgb8(static_cast<uint8_t>(k)), std::lround(65535 * exact_decode(k / 255.0L))) << k;
}

TEST(Color, O1_LinearFromSrgbWithinBound) {
  TestRandom random(1);
  double worst = 0;
  for (int i = 0; i < 100000; ++i) {
    const float x = static_cast<float>(random.uniform(0, i % 2 ? 1 : 0.05));
    const long double exact = exact_decode(x);
    int e;
    std::frexp(exact, &e);
    worst = std::max(worst, static_cast<double>(std::fabs((linear_from_srgb(x) - exact) / std::ldexp(1.0L, e - 24))));
  }
  std::printf("worst error %.6f ulp\n", worst);
  EXPECT_LE(worst, 0.5001);
  EXPECT_EQ(linear_from_srgb(1), 1);
  EXPECT_EQ(linear_from_srgb(0), 0);
  EXPECT_EQ(linear_from_srgb(-1), 0);
  EXPECT_EQ(linear_from_srgb(kNan), 0);
}

TEST(Color, O1_AllCodesRoundTrip) {
  for (int k = 0; k < 256; ++k) {
    const uint8_t code = static_cast<uint8_t>(k);
    EXPECT_EQ(srgb8_from_linear(linear16_from_srgb8(code) / 65535.0f), k);
    EXPECT_EQ(srgb8_from_linear(linear_from_srgb(static_cast<float>(k) / 255.0f)), k);
  }
}

// Every float from 0 to 2: monotone, and each step within one float of where long double puts it.
TEST(Color, O1_MonotoneOverEveryFloat) {
  int code = 0;
  for (uint32_t bits = 0; bits <= bits_of(2.0f); ++bits) {
    if (bits < bits_of(0x1p-14f)) bits += 4096;  // far below the first step
    const int next = srgb8_from_linear(from_bits(bits));
    if (next == code) continue;
    ASSERT_EQ(next, code + 1) << from_bits(bits);
    const long double step = exact_decode((code + 0.5L) / 255);
    ASSERT_GE(from_bits(bits), step * (1 - 0x1p-40L));
    ASSERT_LT(from_bits(bits - 1), step * (1 + 0x1p-40L));
    ASSERT_EQ(bits_of(srgb_encode_table().step[code]), bits);
    code = next;
  }
  EXPECT_EQ(code, 255);
}

TEST(Color, O1_O2_KernelIsTheScalarFunctionOnEveryInstructionSet) {
  std::vector<float> x = {kNan, -kNan, from_bits(0x7fa00000), kInf, -kInf, -1.0f, -0.0f, 0.0f, from_bits(1), -from_bits(1), 1.0f, 2.0f, 3e38f};
  for (const float step : srgb_encode_table().step)
    for (uint32_t i = 0; i < 64; ++i) x.push_back(from_bits(bits_of(step) - 32 + i));
  for (uint32_t bin = 0; bin < SrgbEncodeTable::kBins + 200; ++bin)
    for (uint32_t i = 0; i < 8; ++i) x.push_back(from_bits(((SrgbEncodeTable::kFirstBin - 100 + bin) << 16) - 4 + i));
  for (uint32_t bits = bits_of(0x1p-14f); bits < bits_of(1.5f); bits += 99) x.push_back(from_bits(bits));
  std::vector<uint8_t> want(x.size());
  for (size_t i = 0; i < x.size(); ++i) want[i] = srgb8_from_linear(x[i]);
  const int n = static_cast<int>(x.size()) - 2;
  const float* const planes[3] = {x.data(), x.data() + 1, x.data() + 2};
  for (int isa = 0; isa < kIsaCount; ++isa) {
    if (!isa_supported(static_cast<Isa>(isa + 1))) continue;
    std::vector<uint8_t> rgba(4 * static_cast<size_t>(n));
    encode_row(static_cast<Isa>(isa + 1), planes, n, rgba.data());
    for (size_t i = 0; i < static_cast<size_t>(n); ++i) {
      for (size_t k = 0; k < 3; ++k) ASSERT_EQ(rgba[4 * i + k], want[i + k]) << isa_name(static_cast<Isa>(isa + 1)) << " " << x[i + k];
      ASSERT_EQ(rgba[4 * i + 3], 255);
    }
  }
}

TEST(Color, EncodeRowKeepsToItsArraysAndRgbIsTheSame) {
  TestRandom random(2);
  for (int isa = 0; isa < kIsaCount; ++isa) {
    if (!isa_supported(static_cast<Isa>(isa + 1))) continue;
    for (const int count : {0, 1, 3, 4, 5, 15, 16, 17, 33, 255, 256, 257, 600}) {
      const size_t n = static_cast<size_t>(count);
      std::vector<float> planes[3], rgb(3 * n);  // exactly sized: the address sanitizer sees reads past the end
      for (size_t k = 0; k < 3; ++k) {
        planes[k].resize(n);
        for (size_t i = 0; i < n; ++i) rgb[3 * i + k] = planes[k][i] = static_cast<float>(random.uniform(-0.1, 1.1));
      }
      const float* const pointers[3] = {planes[0].data(), planes[1].data(), planes[2].data()};
      std::vector<uint8_t> a(4 * n + 8, 77), b(4 * n + 8, 77);
      encode_row(static_cast<Isa>(isa + 1), pointers, count, a.data());
      encode_row_rgb(static_cast<Isa>(isa + 1), rgb.data(), count, b.data());
      EXPECT_EQ(a, b);
      for (size_t i = 0; i < n; ++i)
        for (size_t k = 0; k < 3; ++k) ASSERT_EQ(a[4 * i + k], srgb8_from_linear(planes[k][i]));
      for (size_t i = 0; i < 8; ++i) ASSERT_EQ(a[4 * n + i], 77);
    }
  }
}

}  // namespace
}  // namespace spanray
