// exp2_, log2_ and pow_ of math/elementary-inl.h against libm's long double (64-bit significand), on every instruction set.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <random>
#include <vector>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "math_elementary_lanes_test.cpp"
#include "hwy/foreach_target.h"
#include "math/elementary-inl.h"
#include "simd/dispatch.h"
#include "simd/lanes-inl.h"
HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
void exp2_kernel(const float* a, const float*, float* out, size_t n) {
  for (size_t i = 0; i < n; i += kLanes) exp2_(F32::load(a + i)).store(out + i);
}
void log2_kernel(const float* a, const float*, float* out, size_t n) {
  for (size_t i = 0; i < n; i += kLanes) log2_(F32::load(a + i)).store(out + i);
}
void pow_kernel(const float* a, const float* b, float* out, size_t n) {
  for (size_t i = 0; i < n; i += kLanes) pow_(F32::load(a + i), F32::load(b + i)).store(out + i);
}
void highlight_pow_kernel(const float* a, const float* b, float* out, size_t n) {
  for (size_t i = 0; i < n; i += kLanes) highlight_pow_(F32::load(a + i), F32::load(b + i)).store(out + i);
}
void fast_pow_kernel(const float* a, const float* b, float* out, size_t n) {
  for (size_t i = 0; i < n; i += kLanes) fast_pow_(F32::load(a + i), F32::load(b + i)).store(out + i);
}
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();
#if HWY_ONCE
namespace spanray {
namespace {

using Fn = void (*)(const float*, const float*, float*, size_t);
const Fn kExp2[kIsaCount] = SPANRAY_KERNEL_TABLE(exp2_kernel);
const Fn kLog2[kIsaCount] = SPANRAY_KERNEL_TABLE(log2_kernel);
const Fn kPow[kIsaCount] = SPANRAY_KERNEL_TABLE(pow_kernel);
const Fn kHighlightPow[kIsaCount] = SPANRAY_KERNEL_TABLE(highlight_pow_kernel);
const Fn kFastPow[kIsaCount] = SPANRAY_KERNEL_TABLE(fast_pow_kernel);
constexpr float kInf = std::numeric_limits<float>::infinity();
const float kNan = std::numeric_limits<float>::quiet_NaN();

float from_bits(uint32_t bits) {
  float f;
  std::memcpy(&f, &bits, 4);
  return f;
}
uint32_t to_bits(float f) {
  uint32_t bits;
  std::memcpy(&bits, &f, 4);
  return bits;
}

uint32_t random_bits(std::mt19937& rng) { return static_cast<uint32_t>(rng()); }

struct Table {
  std::vector<float> a, b;
  void add(float x, float y = 0) { a.push_back(x), b.push_back(y); }
  void pad() { while (a.size() % 16 != 0) add(1, 1); }
};

// Distance of `got` from the exact value, in units of the last place of floats at that value (2^-149 below 2^-126).
double ulp_error(float got, long double exact) {
  if (std::isinf(got)) return exact >= 0x1.ffffffp127L ? 0.0 : 1e30;
  int e;
  std::frexp(exact, &e);
  return static_cast<double>(std::fabs((static_cast<long double>(got) - exact) / std::ldexp(1.0L, std::max(e - 24, -149))));
}

// Runs on each supported instruction set, asserts that all give the same bits; returns the scalar result.
std::vector<float> run_everywhere(const Fn (&kernel)[kIsaCount], const Table& t) {
  std::vector<float> first(t.a.size()), out(t.a.size());
  kernel[0](t.a.data(), t.b.data(), first.data(), t.a.size());
  for (int isa = 1; isa < kIsaCount; ++isa) {
    if (!isa_supported(static_cast<Isa>(isa + 1))) continue;
    kernel[isa](t.a.data(), t.b.data(), out.data(), t.a.size());
    for (size_t i = 0; i < out.size(); ++i)
      if (to_bits(out[i]) != to_bits(first[i])) {
        ADD_FAILURE() << isa_name(static_cast<Isa>(isa + 1)) << " differs at (" << t.a[i] << ", " << t.b[i] << "): " << out[i]
                      << " instead of " << first[i];
        break;
      }
  }
  return first;
}

// The worst ratio of the error in ulp to allowed(exact result).
template <class Exact, class Allowed>
double worst_error(const Fn (&kernel)[kIsaCount], Table& t, const Exact& exact, const Allowed& allowed) {
  t.pad();
  const std::vector<float> got = run_everywhere(kernel, t);
  double worst = 0;
  size_t at = 0;
  for (size_t i = 0; i < got.size(); ++i) {
    const long double want = exact(t.a[i], t.b[i]);
    const double error = ulp_error(got[i], want) / allowed(want);
    if (std::isnan(error) || std::isnan(got[i])) return 1e30;
    if (error > worst) worst = error, at = i;
  }
  std::printf("worst error %.6f times the allowed one at (%a, %a): %a\n", worst, t.a[at], t.b[at], got[at]);
  return worst;
}
template <class Exact> double worst_ulp(const Fn (&kernel)[kIsaCount], Table& t, const Exact& exact) {
  return worst_error(kernel, t, exact, [](long double) { return 1.0; });
}
// Of pow_: 2.5 (1 + |log2(result)|) ulp as if exponents had no end, and half a step of subnormal numbers.
double pow_ulp(long double result) {
  if (result == 0 || std::isinf(result)) return 1;
  int e;
  std::frexp(result, &e);
  const long double octaves = std::min(std::fabs(std::log2(result)), 150.0L);
  const long double allowed = 2.5L * (1 + octaves) * std::ldexp(1.0L, e - 24) + std::ldexp(0.5L, -149);
  return static_cast<double>(allowed / std::ldexp(1.0L, std::max(e - 24, -149)));
}

long double exact_pow(float x, float y) { return std::pow(static_cast<long double>(x), static_cast<long double>(y)); }

}  // namespace

TEST(ElementaryLanes, Exp2WithinBound) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> wide(-151, 128), narrow(-1, 1);
  Table t;
  for (int i = 0; i < 60000; ++i) t.add(wide(rng)), t.add(narrow(rng));
  for (int i = -150; i <= 128; ++i) t.add(static_cast<float>(i)), t.add(static_cast<float>(i) + 0.5f);
  EXPECT_LE(worst_ulp(kExp2, t, [](float x, float) { return std::exp2(static_cast<long double>(x)); }), 0.5001);
}

TEST(ElementaryLanes, Log2WithinBound) {
  std::mt19937 rng(2);
  Table t;
  for (int i = 0; i < 60000; ++i) t.add(from_bits(1 + random_bits(rng) % 0x7f7fffffu));
  for (uint32_t i = 0; i < 20000; ++i) t.add(from_bits(0x3f800000u + i)), t.add(from_bits(0x3f800000u - i));  // around 1
  for (uint32_t i = 1; i < 1000; ++i) t.add(from_bits(i)), t.add(from_bits(0x3f3504f3u - 500 + i));  // subnormal; sqrt(1/2)
  EXPECT_LE(worst_ulp(kLog2, t, [](float x, float) { return std::log2(static_cast<long double>(x)); }), 0.5001);
}

TEST(ElementaryLanes, S1_PowOfSpecularWithinBound) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<float> unit(0, 1), log_exponent(-3, 4);
  Table t;
  for (int i = 0; i < 40000; ++i) {
    const float n = std::pow(10.0f, log_exponent(rng));
    t.add(unit(rng), n);
    t.add(1.0f - unit(rng) * 50.0f / (n + 50.0f), n);  // where the highlight is not black
    t.add(from_bits(0x3f800000u + 8 - random_bits(rng) % 64), n);  // around 1, a few ulp beyond it
  }
  for (uint32_t i = 0; i < 200; ++i) t.add(from_bits(0x3f800008u - i), 1e4f), t.add(from_bits(0x3f800008u - i), 1.0f);
  EXPECT_LE(worst_error(kPow, t, exact_pow, pow_ulp), 1);
}

// Without pow_'s special cases; with its bits.
TEST(ElementaryLanes, HighlightPowIsPow) {
  std::mt19937 rng(7);
  std::uniform_real_distribution<float> unit(0, 1), log_exponent(-3, 4);
  Table t;
  for (int i = 0; i < 60000; ++i) {
    const float base = i % 3 == 0 ? 1 - unit(rng) * 0x1p-10f : i % 3 == 1 ? unit(rng) : std::ldexp(1 + unit(rng), -126 + i % 126);
    t.add(std::min(base, 1.0f), i % 50 == 0 ? 0.0f : std::pow(10.0f, log_exponent(rng)));
  }
  for (const float n : {0.0f, 0.5f, 1.0f, 32.0f, 1e4f}) t.add(1, n), t.add(0x1p-126f, n);
  t.pad();
  const std::vector<float> expected = run_everywhere(kPow, t), got = run_everywhere(kHighlightPow, t);
  for (size_t i = 0; i < t.a.size(); ++i) {
    if (t.a[i] < 0x1p-126f) continue;
    ASSERT_EQ(to_bits(got[i]), to_bits(expected[i])) << t.a[i] << " ^ " << t.b[i];
  }

  Table below;
  for (const float n : {0.0f, 1e-3f, 0.5f, 1.0f, 1e4f}) below.add(0, n), below.add(0x1p-149f, n), below.add(0x1p-126f, n);
  below.pad();
  const std::vector<float> r = run_everywhere(kHighlightPow, below);
  for (size_t i = 0; i + 2 < 15; i += 3) {
    EXPECT_EQ(r[i], 0) << "0 ^ " << below.b[i];
    EXPECT_EQ(to_bits(r[i + 1]), to_bits(r[i + 2])) << "2^-149 ^ " << below.b[i];
  }
}

// Relative error, as documented, of results that are not tiny; tiny ones stay so, and no result is subnormal.
TEST(ElementaryLanes, FastPowWithinBound) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<float> unit(0, 1), log_exponent(-3, 4);
  Table t;
  for (int i = 0; i < 60000; ++i) {
    const float n = std::pow(10.0f, log_exponent(rng));
    t.add(unit(rng), n), t.add(1.0f - unit(rng) * 50.0f / (n + 50.0f), n);
    t.add(from_bits(0x3f800000u - random_bits(rng) % 64), n);
  }
  for (const float x : {0.0f, from_bits(1), 0x1p-126f, 0x1.6a09e6p-1f, 1.0f})  // subnormal; beside sqrt(1/2)
    for (const float n : {0.0f, 1e-3f, 1.0f, 1e4f}) t.add(x, n);
  t.pad();
  const std::vector<float> got = run_everywhere(kFastPow, t);
  double worst = 0;
  for (size_t i = 0; i < got.size(); ++i) {
    const long double want = exact_pow(t.a[i], t.b[i]);
    ASSERT_GE(got[i], 0x1p-65f) << t.a[i] << "^" << t.b[i];
    if (want < 0x1p-64L || t.a[i] < 0x1p-126f) {
      const long double most = std::max(0x1p-63L, 1.01L * exact_pow(std::max(t.a[i], 0x1p-126f), t.b[i]));
      ASSERT_LE(got[i], most) << t.a[i] << "^" << t.b[i];
      continue;
    }
    const long double allowed = std::exp2(-9.1L) * (1 - std::log2(want) / 7);
    worst = std::max(worst, static_cast<double>(std::fabs(got[i] / want - 1) / allowed));
  }
  std::printf("fast_pow_: worst relative error %.4f of the bound\n", worst);
  EXPECT_LE(worst, 1);
  EXPECT_GE(worst, 0.5) << "the bound is looser than it need be";
}

TEST(ElementaryLanes, PowOfAnyFiniteFloatsWithinBound) {
  std::mt19937 rng(4);
  std::uniform_real_distribution<float> log_result(-155, 129);
  Table t;
  for (int i = 0; i < 60000; ++i) {
    const float x = from_bits(1 + random_bits(rng) % 0x7f7fffffu);
    t.add(x, static_cast<float>(log_result(rng) / std::log2(x)));
    t.add(x, from_bits(random_bits(rng) % 0x7f800000u | (random_bits(rng) & 0x80000000u)));
  }
  EXPECT_LE(worst_error(kPow, t, [](float x, float y) { return y == 0 ? 1.0L : exact_pow(x, y); }, pow_ulp), 1);
}

TEST(ElementaryLanes, S1_PowSpecialValues) {
  struct Row { float x, y, want; };
  const float tiny = from_bits(1), above_one = from_bits(0x3f800001), big = 3.4e38f;
  const Row rows[] = {{0, 0, 1}, {-0.0f, 0, 1}, {0, -0.0f, 1}, {0, 1, 0}, {0, tiny, 0}, {0, 1e4f, 0}, {0, -1, kInf}, {-0.0f, 3, 0},
                      {1, 0, 1}, {1, 1e4f, 1}, {1, big, 1}, {1, -big, 1}, {above_one, 0, 1},
                      {0.5f, 149, tiny}, {0.5f, 151, 0}, {0.5f, 1e4f, 0}, {tiny, 1, tiny}, {tiny, big, 0}, {tiny, -1, kInf},
                      {big, big, kInf}, {2, 127, 0x1p127f}, {2, 128, kInf}, {2, -149, tiny}, {4, 0.5f, 2},
                      {-1, 2, 0}, {-1, 0, 1}, {kNan, 0, 1}, {kNan, 2, 0}, {0.5f, kNan, 0}, {2, kNan, 0}, {1, kInf, 0},
                      {0.5f, kInf, 0}, {2, kInf, kInf}, {kInf, 1, kInf}, {kInf, -1, 0x1p-128f}, {kInf, 0, 1}};
  Table t;
  for (const Row& r : rows) t.add(r.x, r.y);
  t.pad();
  const std::vector<float> got = run_everywhere(kPow, t);
  for (size_t i = 0; i < std::size(rows); ++i) EXPECT_EQ(to_bits(got[i]), to_bits(rows[i].want)) << rows[i].x << "^" << rows[i].y << " = " << got[i];
}

TEST(ElementaryLanes, Exp2AndLog2SpecialValues) {
  Table e, l;
  for (const float x : {kNan, -kInf, -3.4e38f, -151.0f, kInf, 3.4e38f, 128.0f, 0.0f, -0.0f, 127.0f, -149.0f}) e.add(x);
  for (const float x : {0.0f, -0.0f, -1.0f, kNan, -kInf, kInf, 1.0f, 2.0f, from_bits(1)}) l.add(x);
  e.pad(), l.pad();
  const float want_e[] = {0, 0, 0, 0, kInf, kInf, kInf, 1, 1, 0x1p127f, from_bits(1)};
  const float want_l[] = {-kInf, -kInf, kNan, kNan, kNan, kInf, 0, 1, -149};
  const std::vector<float> got_e = run_everywhere(kExp2, e), got_l = run_everywhere(kLog2, l);
  for (size_t i = 0; i < std::size(want_e); ++i) EXPECT_EQ(to_bits(got_e[i]), to_bits(want_e[i])) << e.a[i];
  for (size_t i = 0; i < std::size(want_l); ++i) EXPECT_EQ(to_bits(got_l[i]), to_bits(want_l[i])) << l.a[i];
}

}  // namespace spanray
#endif
