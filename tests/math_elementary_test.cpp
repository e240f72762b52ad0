// The bounds stated in math/elementary.h, against libm's long double functions (64-bit significand).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "math/elementary.h"
#include "support/random.h"

namespace spanray {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
const double kNan = std::numeric_limits<double>::quiet_NaN();

double ulp_error(double got, long double exact) {
  if (std::isinf(got)) return exact >= 0x1.fffffffffffffp1023L ? 0.0 : 1e30;
  int e;
  std::frexp(exact, &e);
  return static_cast<double>(std::fabs((static_cast<long double>(got) - exact) / std::ldexp(1.0L, std::max(e - 53, -1074))));
}

struct Worst {
  double error = 0, at = 0;
  void add(double e, double x) {
    if (!(e <= error)) error = e, at = x;  // NaN is the worst
  }
  void print(const char* what, double unit = 1) const { std::printf("%s: worst error %.3f at %.17g\n", what, error / unit, at); }
};

TEST(Elementary, SinCosWithinBound) {
  TestRandom random(1);
  Worst absolute;
  for (int i = 0; i < 300000; ++i) {
    double x = random.uniform(-1, 1) * std::pow(10.0, random.uniform(-8, 6));
    if (i % 3 == 0) x = random.between(-636000, 636000) * (kPi / 2) + random.uniform(-1e-6, 1e-6);  // where the reduction cancels
    double s, c;
    sin_cos(x, &s, &c);
    absolute.add(static_cast<double>(std::fabs(s - std::sin(static_cast<long double>(x)))), x);
    absolute.add(static_cast<double>(std::fabs(c - std::cos(static_cast<long double>(x)))), x);
  }
  absolute.print("sin_cos (2^-52)", 0x1p-52);
  EXPECT_LE(absolute.error, 0x1p-52);
}

TEST(Elementary, SinCosSpecialValues) {
  double s, c;
  sin_cos(0, &s, &c);
  EXPECT_EQ(s, 0);
  EXPECT_EQ(c, 1);
  for (const double x : {kNan, kInf, -kInf, 1000001.0}) {
    sin_cos(x, &s, &c);
    EXPECT_TRUE(std::isnan(s) && std::isnan(c)) << x;
  }
  for (const double x : {1e6, -1e6}) {
    sin_cos(x, &s, &c);
    EXPECT_NEAR(s * s + c * c, 1, 1e-15);
  }
}

TEST(Elementary, TanWithinBound) {
  TestRandom random(2);
  Worst ulp;
  for (int i = 0; i < 200000; ++i) {
    double x = random.uniform(-1, 1) * std::pow(10.0, random.uniform(-8, 6));
    if (i % 3 == 0) x = random.between(-1000, 1000) * (kPi / 2) + random.uniform(-1e-6, 1e-6);
    const long double exact = std::tan(static_cast<long double>(x));
    if (std::fabs(std::cos(static_cast<long double>(x))) > 1e-8L && exact != 0) ulp.add(ulp_error(tan_(x), exact), x);
  }
  ulp.print("tan_ (ulp)");
  EXPECT_LE(ulp.error, 4);
}

TEST(Elementary, Exp2WithinBound) {
  TestRandom random(3);
  Worst ulp;
  for (int i = 0; i < 200000; ++i) {
    const double x = i % 2 ? random.uniform(-1076, 1024) : random.uniform(-2, 2);
    ulp.add(ulp_error(exp2_(x), std::exp2(static_cast<long double>(x))), x);
  }
  ulp.print("exp2_ (ulp)");
  EXPECT_LE(ulp.error, 1.5);
  for (int k = -1074; k < 1024; ++k) EXPECT_EQ(exp2_(k), std::ldexp(1.0, k));
  EXPECT_EQ(exp2_(1024), kInf);
  EXPECT_EQ(exp2_(kInf), kInf);
  EXPECT_EQ(exp2_(-1075.5), 0);
  EXPECT_EQ(exp2_(-kInf), 0);
  EXPECT_EQ(exp2_(-0.0), 1);
  EXPECT_TRUE(std::isnan(exp2_(kNan)));
}

TEST(Elementary, Log2WithinBound) {
  TestRandom random(4);
  Worst ulp;
  for (int i = 0; i < 300000; ++i) {
    double x = std::ldexp(random.uniform(1, 2), random.between(-1074, 1023));
    if (i % 3 == 0) x = 1 + random.uniform(-1, 1) * std::pow(10.0, random.uniform(-15, -0.5));
    if (x == 0) continue;
    const long double exact = std::log2(static_cast<long double>(x));
    const double error = static_cast<double>(std::fabs(log2_(x) - exact));
    if (error > 0x1p-52) ulp.add(ulp_error(log2_(x), exact), x);
  }
  ulp.print("log2_ (ulp, where not within 2^-52)");
  EXPECT_LE(ulp.error, 2);
  for (int k = -1074; k < 1024; ++k) EXPECT_EQ(log2_(std::ldexp(1.0, k)), k);
  EXPECT_EQ(log2_(0), -kInf);
  EXPECT_EQ(log2_(-0.0), -kInf);
  EXPECT_EQ(log2_(kInf), kInf);
  EXPECT_TRUE(std::isnan(log2_(-1)));
  EXPECT_TRUE(std::isnan(log2_(kNan)));
}

TEST(Elementary, S1_PowWithinBound) {
  TestRandom random(5);
  Worst relative;
  for (int i = 0; i < 200000; ++i) {
    double x = std::ldexp(random.uniform(1, 2), random.between(-1022, 1023));
    if (i % 2) x = random.uniform(1e-6, 1.0);
    const double y = i % 4 == 1 ? 2.4 : random.uniform(-1022, 1022) / static_cast<double>(std::log2(x));
    const long double exact = std::pow(static_cast<long double>(x), static_cast<long double>(y));
    if (!(std::fabs(static_cast<double>(y * std::log2(static_cast<long double>(x)))) <= 1022)) continue;
    relative.add(static_cast<double>(std::fabs(pow_(x, y) / exact - 1)), x);
  }
  relative.print("pow_ (2^-41)", 0x1p-41);
  EXPECT_LE(relative.error, 0x1p-41);
}

TEST(Elementary, S1_PowSpecialValues) {
  struct Row { double x, y, want; };
  for (const Row& r : {Row{0, 0, 1}, Row{0, 3, 0}, Row{-0.0, 3, 0}, Row{0, -1, kInf}, Row{1, 1e300, 1}, Row{1, kInf, 1}, Row{kInf, 0, 1},
                       Row{kInf, 2, kInf}, Row{kInf, -2, 0}, Row{0.5, kInf, 0}, Row{2, kInf, kInf}, Row{2, -kInf, 0}, Row{2, 10, 1024},
                       Row{4, 0.5, 2}, Row{0.5, 1e4, 0}, Row{2, 1e4, kInf}, Row{kNan, 0, 1}})
    EXPECT_EQ(pow_(r.x, r.y), r.want) << r.x << "^" << r.y;
  for (const Row& r : {Row{-1, 2, 0}, Row{kNan, 1, 0}, Row{1.5, kNan, 0}}) EXPECT_TRUE(std::isnan(pow_(r.x, r.y))) << r.x << "^" << r.y;
}

TEST(Elementary, Atan2AndAcosWithinBound) {
  TestRandom random(6);
  Worst atan2, acos;
  for (int i = 0; i < 200000; ++i) {
    const double scale = std::ldexp(1.0, random.between(-1060, 1020));
    double y = random.uniform(-1, 1) * scale, x = random.uniform(-1, 1) * scale;
    if (i % 4 == 0) x = std::ldexp(random.uniform(-1, 1), random.between(-1070, 1023));
    atan2.add(static_cast<double>(std::fabs(atan2_(y, x) - std::atan2(static_cast<long double>(y), static_cast<long double>(x)))), y);
    double c = random.uniform(-1, 1);
    if (i % 4 == 1) c = 1 - std::pow(10.0, random.uniform(-16, -1));
    if (i % 4 == 2) c = -1 + std::pow(10.0, random.uniform(-16, -1));
    acos.add(static_cast<double>(std::fabs(acos_(c) - std::acos(static_cast<long double>(c)))), c);
  }
  atan2.print("atan2_ (2^-50)", 0x1p-50);
  acos.print("acos_ (2^-50)", 0x1p-50);
  EXPECT_LE(atan2.error, 0x1p-50);
  EXPECT_LE(acos.error, 0x1p-50);
}

TEST(Elementary, Atan2AndAcosSpecialValues) {
  EXPECT_EQ(atan2_(0, 0), 0);
  EXPECT_EQ(atan2_(-0.0, -0.0), 0);
  EXPECT_EQ(atan2_(-0.0, -1), kPi);
  EXPECT_EQ(atan2_(0, 5), 0);
  EXPECT_EQ(atan2_(5, 0), kPi / 2);
  EXPECT_EQ(atan2_(-5, 0), -kPi / 2);
  EXPECT_EQ(atan2_(kInf, kInf), kPi / 4);
  EXPECT_EQ(atan2_(1, kInf), 0);
  EXPECT_EQ(atan2_(1, -kInf), kPi);
  EXPECT_EQ(atan2_(1e308, 1e308), kPi / 4);
  EXPECT_EQ(atan2_(5e-324, 5e-324), kPi / 4);
  EXPECT_TRUE(std::isnan(atan2_(kNan, 1)) && std::isnan(atan2_(1, kNan)));
  EXPECT_EQ(acos_(1), 0);
  EXPECT_EQ(acos_(2), 0);
  EXPECT_EQ(acos_(-1), kPi);
  EXPECT_EQ(acos_(-kInf), kPi);
  EXPECT_EQ(acos_(0), kPi / 2);
  EXPECT_TRUE(std::isnan(acos_(kNan)));
}

}  // namespace
}  // namespace spanray
