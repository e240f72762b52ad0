// The double and 64-bit operations of simd/lanes-inl.h on every instruction set, against a scalar model.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "support/hard_floats.h"
#include "support/random.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd_double_test.cpp"
#include "hwy/foreach_target.h"
#include "simd/dispatch.h"
#include "simd/lanes64-inl.h"
HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

HWY_INLINE F64 one_if(Mask m) { return to_f64(select(m, i32(1), i32(0))); }

HWY_INLINE F64 double_op(int op, F64 a, F64 b, F64 c) {
  switch (op) {
    case 0: return a + b;
    case 1: return a - b;
    case 2: return a * b;
    case 3: return a / b;
    case 4: return sqrt_(a);
    case 5: return abs_(a);
    case 6: return -a;
    case 7: return select_lt(a, b, b, c);
    case 8: return select_eq(a, b, b, c);
    case 9: return min_(a, b);
    case 10: return max_(a, b);
    case 11: return one_if(a < b);
    case 12: return one_if(a > b);
    case 13: return one_if(a == b);
    case 14: return double_from_bits(bits_of(a) + bits_of(b));
    case 15: return double_from_bits(bits_of(a) - bits_of(b));
    case 16: return double_from_bits(bits_of(a) & bits_of(b));
    case 17: return double_from_bits(bits_of(a) | bits_of(b));
    case 18: return double_from_bits(shift_left<1>(bits_of(a)));
    case 19: return double_from_bits(shift_left<52>(bits_of(a)));
    case 20: return double_from_bits(shift_right_logical<1>(bits_of(a)));
    case 21: return double_from_bits(shift_right_logical<52>(bits_of(a)));
    case 22: return double_from_bits(bits_of(a) - i64(0x0123456789abcdef));
    default: return f64(0x1.23456789abcdep-5);
  }
}
void double_kernel(int op, const double* a, const double* b, const double* c, double* out, size_t n) {
  for (size_t i = 0; i < n; i += kLanes) double_op(op, F64::load(a + i), F64::load(b + i), F64::load(c + i)).store(out + i);
}
void to_integer_kernel(const double* a, int32_t* truncated, int32_t* up, int32_t* nearest, size_t n) {
  for (size_t i = 0; i < n; i += kLanes) {
    to_i32(F64::load(a + i)).store(truncated + i);
    ceil_i32(F64::load(a + i)).store(up + i);
    round_i32(F64::load(a + i)).store(nearest + i);
  }
}
void narrow_kernel(const double* a, float* out, size_t n) {
  for (size_t i = 0; i < n; i += kLanes) to_f32(F64::load(a + i)).store(out + i);
}
void widen_kernel(const float* a, const int32_t* b, double* out, double* out_integer, size_t n) {
  for (size_t i = 0; i < n; i += kLanes) {
    to_f64(F32::load(a + i)).store(out + i);
    to_f64(I32::load(b + i)).store(out_integer + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();
#if HWY_ONCE
namespace spanray {
namespace {

using DoubleFn = void (*)(int, const double*, const double*, const double*, double*, size_t);
using NarrowFn = void (*)(const double*, float*, size_t);
using ToIntegerFn = void (*)(const double*, int32_t*, int32_t*, int32_t*, size_t);
const ToIntegerFn kToInteger[kIsaCount] = SPANRAY_KERNEL_TABLE(to_integer_kernel);
using WidenFn = void (*)(const float*, const int32_t*, double*, double*, size_t);
const DoubleFn kDouble[kIsaCount] = SPANRAY_KERNEL_TABLE(double_kernel);
const NarrowFn kNarrow[kIsaCount] = SPANRAY_KERNEL_TABLE(narrow_kernel);
const WidenFn kWiden[kIsaCount] = SPANRAY_KERNEL_TABLE(widen_kernel);
constexpr int kOpCount = 24, kArithmeticOps = 5;

uint64_t bits(double d) { return std::bit_cast<uint64_t>(d); }
double double_of(uint64_t b) { return std::bit_cast<double>(b); }

uint64_t model(int op, double a, double b, double c) {
  switch (op) {
    case 0: return bits(a + b);
    case 1: return bits(a - b);
    case 2: return bits(a * b);
    case 3: return bits(a / b);
    case 4: return bits(std::sqrt(a));
    case 5: return bits(a) & ~(uint64_t{1} << 63);
    case 6: return bits(a) ^ (uint64_t{1} << 63);
    case 7: return bits(a < b ? b : c);
    case 8: return bits(a == b ? b : c);
    case 9: return bits(a < b ? a : b);
    case 10: return bits(b < a ? a : b);
    case 11: return bits(a < b);
    case 12: return bits(a > b);
    case 13: return bits(a == b);
    case 14: return bits(a) + bits(b);
    case 15: return bits(a) - bits(b);
    case 16: return bits(a) & bits(b);
    case 17: return bits(a) | bits(b);
    case 18: return bits(a) << 1;
    case 19: return bits(a) << 52;
    case 20: return bits(a) >> 1;
    case 21: return bits(a) >> 52;
    case 22: return bits(a) - 0x0123456789abcdefu;
    default: return bits(0x1.23456789abcdep-5);
  }
}

std::vector<double> hard_doubles() {
  std::vector<double> v;
  for (const float f : hard_floats()) v.push_back(f);
  for (const uint64_t b : {uint64_t{1}, uint64_t{0x000fffffffffffff}, uint64_t{0x0010000000000000}, uint64_t{0x3fefffffffffffff},
                           uint64_t{0x3ff0000000000001}, uint64_t{0x433fffffffffffff}, uint64_t{0x7fefffffffffffff}, uint64_t{0x7ff8000000000001}})
    v.push_back(double_of(b)), v.push_back(double_of(b | uint64_t{1} << 63));
  return v;
}

double random_double(TestRandom& random) {
  uint64_t b = uint64_t{random.bits()} << 32;
  b |= random.bits();
  if ((b & 0x7ff0000000000000) == 0x7ff0000000000000) b |= 0x0008000000000000;  // quiet
  return double_of(b);
}

}  // namespace

TEST(Doubles, EveryOperationEqualsItsModel) {
  TestRandom random(1);
  std::vector<double> a, b, c;
  const std::vector<double> hard = hard_doubles();
  for (size_t i = 0; i < hard.size(); ++i)
    for (size_t k = 0; k < hard.size(); ++k) a.push_back(hard[i]), b.push_back(hard[k]), c.push_back(hard[(3 * i + 5 * k) % hard.size()]);
  for (int i = 0; i < 20000; ++i) a.push_back(random_double(random)), b.push_back(random_double(random)), c.push_back(random_double(random));
  while (a.size() % 16 != 0) a.push_back(1), b.push_back(2), c.push_back(3);
  std::vector<double> out(a.size());
  for (int isa = 0; isa < kIsaCount; ++isa) {
    if (!isa_supported(static_cast<Isa>(isa + 1))) continue;
    for (int op = 0; op < kOpCount; ++op) {
      kDouble[isa](op, a.data(), b.data(), c.data(), out.data(), out.size());
      for (size_t i = 0; i < out.size(); ++i) {
        const uint64_t want = model(op, a[i], b[i], c[i]);
        if (op < kArithmeticOps && std::isnan(out[i]) && std::isnan(double_of(want))) continue;
        ASSERT_EQ(bits(out[i]), want) << isa_name(static_cast<Isa>(isa + 1)) << ": operation " << op << std::hexfloat << " of " << a[i] << ", " << b[i] << ", " << c[i];
      }
    }
  }
}

// Ties, subnormal results, overflow: rounded once, to nearest even, on every target.
TEST(Doubles, NarrowingRoundsToNearestEven) {
  TestRandom random(2);
  std::vector<double> a = hard_doubles();
  for (int i = 0; i < 30000; ++i) {
    a.push_back(random_double(random));
    const float f = float_of(i % 3 == 0 ? random.bits() % 0x01000000u : i % 3 == 1 ? 0x7f7fffffu - random.bits() % 4 : random.bits() % 0x7f7fffffu);
    const double next = std::nextafter(static_cast<double>(f), std::numeric_limits<double>::infinity());
    const double above = f < std::numeric_limits<float>::max() ? static_cast<double>(float_of(std::bit_cast<uint32_t>(f) + 1)) : 0x1p128;
    const double middle = (static_cast<double>(f) + above) * 0.5;
    for (const double x : {static_cast<double>(f), next, middle, std::nextafter(middle, 0.0), std::nextafter(middle, 1e300)}) a.push_back(x), a.push_back(-x);
  }
  while (a.size() % 16 != 0) a.push_back(1);
  std::vector<float> out(a.size());
  for (int isa = 0; isa < kIsaCount; ++isa) {
    if (!isa_supported(static_cast<Isa>(isa + 1))) continue;
    kNarrow[isa](a.data(), out.data(), out.size());
    for (size_t i = 0; i < out.size(); ++i) {
      const float want = static_cast<float>(a[i]);
      if (std::isnan(want) && std::isnan(out[i])) continue;
      ASSERT_EQ(std::bit_cast<uint32_t>(out[i]), std::bit_cast<uint32_t>(want)) << isa_name(static_cast<Isa>(isa + 1)) << std::hexfloat << " of " << a[i];
    }
  }
}

TEST(Doubles, IntegersSaturateAndRoundAsStated) {
  TestRandom random(4);
  std::vector<double> a = hard_doubles();
  for (int i = 0; i < 20000; ++i) {
    const double half = random.between(-100000, 100000) * 0.5;
    for (const double x : {half, std::nextafter(half, -1e9), std::nextafter(half, 1e9)}) a.push_back(x);
    a.push_back(random.uniform(-2147483647.0, 2147483647.0));
    a.push_back(random_double(random));
  }
  for (const double x : {2147483646.0, 2147483646.5, 2147483647.0, 2147483647.5, 2147483648.0, 4294967296.0, 1e300}) a.push_back(x), a.push_back(-x);
  while (a.size() % 16 != 0) a.push_back(1);
  const auto saturated = [](double x) { return !(x > -2147483647.0) ? -2147483647 : x >= 2147483647.0 ? 2147483647 : static_cast<int32_t>(x); };
  std::vector<int32_t> truncated(a.size()), up(a.size()), nearest(a.size());
  for (int isa = 0; isa < kIsaCount; ++isa) {
    if (!isa_supported(static_cast<Isa>(isa + 1))) continue;
    kToInteger[isa](a.data(), truncated.data(), up.data(), nearest.data(), a.size());
    for (size_t i = 0; i < a.size(); ++i) {
      const double floor = std::floor(a[i]);
      ASSERT_EQ(truncated[i], saturated(a[i])) << isa_name(static_cast<Isa>(isa + 1)) << std::hexfloat << " " << a[i];
      ASSERT_EQ(up[i], saturated(std::ceil(a[i]))) << isa_name(static_cast<Isa>(isa + 1)) << std::hexfloat << " " << a[i];
      ASSERT_EQ(nearest[i], std::isnan(a[i]) ? -2147483646 : saturated(a[i] - floor >= 0.5 ? floor + 1 : floor)) << isa_name(static_cast<Isa>(isa + 1)) << std::hexfloat << " " << a[i];
    }
  }
}

TEST(Doubles, WideningIsExact) {
  TestRandom random(3);
  std::vector<float> a = hard_floats();
  std::vector<int32_t> b = hard_integers();
  for (int i = 0; i < 4000; ++i) a.push_back(float_of(random.bits()));
  a.resize(4000);
  while (b.size() < a.size()) b.push_back(static_cast<int32_t>(random.bits()));
  std::vector<double> from_float(a.size()), from_integer(a.size());
  for (int isa = 0; isa < kIsaCount; ++isa) {
    if (!isa_supported(static_cast<Isa>(isa + 1))) continue;
    kWiden[isa](a.data(), b.data(), from_float.data(), from_integer.data(), a.size());
    for (size_t i = 0; i < a.size(); ++i) {
      ASSERT_EQ(from_integer[i], static_cast<double>(b[i]));
      ASSERT_TRUE(std::isnan(a[i]) ? std::isnan(from_float[i]) : bits(from_float[i]) == bits(static_cast<double>(a[i]))) << a[i];
    }
  }
}

}  // namespace spanray
#endif
