// Every operation of simd/lanes-inl.h on floats, integers, masks and memory, on every instruction set, against a scalar model.
// Doubles: simd_double_test.cpp. The hard cases of the fused multiply-add: simd_fma_test.cpp.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "support/every_isa.h"
#include "support/hard_floats.h"
#include "support/random.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd_lanes_test.cpp"
#include "hwy/foreach_target.h"
#include "simd/dispatch.h"
#include "simd/lanes-inl.h"
HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

int lanes() { return kLanes; }
I32 from_mask(Mask m) { return select(m, i32(1), i32(0)); }

// Results as bits, so that one signature serves all. Names of operations: kFloatOps below.
HWY_INLINE I32 float_op(int op, F32 a, F32 b, F32 c) {
  switch (op) {
    case 0: return bits_of(a + b);
    case 1: return bits_of(a - b);
    case 2: return bits_of(a * b);
    case 3: return bits_of(a / b);
    case 4: return bits_of(sqrt_(a));
    case 5: return bits_of(mul_add(a, b, c));
    case 6: return bits_of(neg_mul_add(a, b, c));
    case 7: return bits_of(-a);
    case 8: return bits_of(abs_(a));
    case 9: return bits_of(copysign_(a, b));
    case 10: return bits_of(min_(a, b));
    case 11: return bits_of(max_(a, b));
    case 12: return bits_of(clamp_(a, b, c));
    case 13: return bits_of(floor_(a));
    case 14: return to_i32(a);
    case 15: return round_i32(a);
    case 16: return from_mask(a < b);
    case 17: return from_mask(a <= b);
    case 18: return from_mask(a > b);
    case 19: return from_mask(a >= b);
    case 20: return from_mask(a == b);
    case 21: return bits_of(select(a < b, b, c));
    default: return bits_of(float_from_bits(bits_of(a)));
  }
}
void float_kernel(int op, const float* a, const float* b, const float* c, uint32_t* out, size_t n) {
  for (size_t i = 0; i < n; i += kLanes) float_op(op, F32::load(a + i), F32::load(b + i), F32::load(c + i)).store(out + i);
}

HWY_INLINE I32 integer_op(int op, I32 a, I32 b) {
  switch (op) {
    case 0: return a + b;
    case 1: return a - b;
    case 2: return a * b;
    case 3: return a & b;
    case 4: return a | b;
    case 5: return a ^ b;
    case 6: return shift_left<1>(a);
    case 7: return shift_left<16>(a);
    case 8: return shift_left<31>(a);
    case 9: return shift_right<1>(a);
    case 10: return shift_right<8>(a);
    case 11: return shift_right<31>(a);
    case 12: return shift_right_logical<1>(a);
    case 13: return shift_right_logical<17>(a);
    case 14: return shift_right_logical<31>(a);
    case 15: return from_mask(a == b);
    case 16: return from_mask(a != b);
    case 17: return from_mask(a < b);
    case 18: return from_mask(a > b);
    case 19: return min_(a, b);
    case 20: return max_(a, b);
    case 21: return select(a < b, b, a);
    default: return bits_of(to_f32(a));
  }
}
void integer_kernel(int op, const int32_t* a, const int32_t* b, uint32_t* out, size_t n) {
  for (size_t i = 0; i < n; i += kLanes) integer_op(op, I32::load(a + i), I32::load(b + i)).store(out + i);
}

// out: to_bits of the masks x, y (from bits), of !x, x & y, x | y, and_not(x, y), first_lanes(n); any, all, count of x.
void mask_kernel(uint32_t x, uint32_t y, int n, uint32_t* out) {
  const Mask a = mask_from_bits(x), b = mask_from_bits(y);
  const Mask masks[] = {a, b, !a, a & b, a | b, and_not(a, b), first_lanes(n)};
  for (const Mask m : masks) *out++ = to_bits(m);
  *out++ = any(a), *out++ = all(a), *out++ = static_cast<uint32_t>(count(a));
  int32_t chosen[kLanes];  // the lane order of bits is that of memory
  select(a, lane_iota(100), lane_iota(-50)).store(chosen);
  uint32_t bits = 0;
  for (int i = 0; i < kLanes; ++i) bits |= (chosen[i] == 100 + i ? 1u : chosen[i] == i - 50 ? 0u : 0x80000000u) << i;
  *out++ = bits;
}

void gather_kernel(const float* f, const int32_t* s, const uint32_t* u, const int32_t* index, uint32_t* out) {
  const I32 i = I32::load(index);
  bits_of(gather(f, i)).store(out);
  gather(s, i).store(out + kLanes);
  gather(u, i).store(out + 2 * kLanes);
}

}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();
#if HWY_ONCE
namespace spanray {
namespace {

const auto kLaneCount = std::array<int (*)(), kIsaCount> SPANRAY_KERNEL_TABLE(lanes);
using FloatFn = void (*)(int, const float*, const float*, const float*, uint32_t*, size_t);
using IntegerFn = void (*)(int, const int32_t*, const int32_t*, uint32_t*, size_t);
const FloatFn kFloat[kIsaCount] = SPANRAY_KERNEL_TABLE(float_kernel);
const IntegerFn kInteger[kIsaCount] = SPANRAY_KERNEL_TABLE(integer_kernel);
const auto kMask = std::array<void (*)(uint32_t, uint32_t, int, uint32_t*), kIsaCount> SPANRAY_KERNEL_TABLE(mask_kernel);
const auto kGather = std::array<void (*)(const float*, const int32_t*, const uint32_t*, const int32_t*, uint32_t*), kIsaCount>
    SPANRAY_KERNEL_TABLE(gather_kernel);

uint32_t bits(float f) { return std::bit_cast<uint32_t>(f); }
uint32_t word(int64_t x) { return static_cast<uint32_t>(x); }
constexpr float kIntegerLimit = 2147483520.0f;

int32_t model_to_i32(double a) {
  if (!(a > -static_cast<double>(kIntegerLimit))) return -2147483520;
  return a >= static_cast<double>(kIntegerLimit) ? 2147483520 : static_cast<int32_t>(a);
}
float model_floor(float a) { return std::fabs(a) < kIntegerLimit ? std::floor(a) + 0.0f : a; }

const char* const kFloatOps[] = {"+", "-", "*", "/", "sqrt_", "mul_add", "neg_mul_add", "-a", "abs_", "copysign_", "min_", "max_",
                                 "clamp_", "floor_", "to_i32", "round_i32", "<", "<=", ">", ">=", "==", "select", "bits"};
constexpr int kFloatOpCount = 23, kFirstExactBitsOp = 7;

uint32_t float_model(int op, float a, float b, float c) {
  switch (op) {
    case 0: return bits(a + b);
    case 1: return bits(a - b);
    case 2: return bits(a * b);
    case 3: return bits(a / b);
    case 4: return bits(std::sqrt(a));
    case 5: return bits(std::fma(a, b, c));
    case 6: return bits(std::fma(-a, b, c));
    case 7: return bits(a) ^ 0x80000000u;
    case 8: return bits(a) & 0x7fffffffu;
    case 9: return (bits(a) & 0x7fffffffu) | (bits(b) & 0x80000000u);
    case 10: return bits(a < b ? a : b);
    case 11: return bits(a > b ? a : b);
    case 12: {
      const float low = a > b ? a : b;
      return bits(low < c ? low : c);
    }
    case 13: return bits(model_floor(a));
    case 14: return word(model_to_i32(a));
    case 15: return word(model_to_i32(std::floor(static_cast<double>(a) + 0.5)));
    case 16: return a < b;
    case 17: return a <= b;
    case 18: return a > b;
    case 19: return a >= b;
    case 20: return a == b;
    case 21: return bits(a < b ? b : c);
    default: return bits(a);
  }
}

struct Triples {
  std::vector<float> a, b, c;
  void add(float x, float y, float z) { a.push_back(x), b.push_back(y), c.push_back(z); }
  void pad() { while (a.size() % 16 != 0) add(1, 2, 3); }
};

// Any NaN will do where the result is arithmetic (which NaN is left open by IEEE); bits must agree everywhere else.
void check_float_op(int op, Triples& t) {
  t.pad();
  std::vector<uint32_t> out(t.a.size()), want(t.a.size());
  for (size_t i = 0; i < out.size(); ++i) want[i] = float_model(op, t.a[i], t.b[i], t.c[i]);
  on_every_isa([&](int isa) {
    kFloat[isa](op, t.a.data(), t.b.data(), t.c.data(), out.data(), out.size());
    for (size_t i = 0; i < out.size(); ++i) {
      if (out[i] == want[i]) continue;
      const bool both_nan = std::isnan(float_of(out[i])) && std::isnan(float_of(want[i]));
      if (op < kFirstExactBitsOp && both_nan) continue;
      FAIL() << kFloatOps[op] << std::hexfloat << "(" << t.a[i] << ", " << t.b[i] << ", " << t.c[i] << ") = " << std::hex << out[i]
             << ", not " << want[i];
    }
  });
}

}  // namespace

TEST(Lanes, CountsAreThoseOfTheTargets) {
  const int want[] = {1, 4, 8, 16};
  on_every_isa([&](int isa) { EXPECT_EQ(kLaneCount[static_cast<size_t>(isa)](), want[isa]); });
}

TEST(Lanes, EveryFloatOperationOnHardCasesEqualsItsModel) {
  const std::vector<float> hard = hard_floats();
  Triples t;
  for (size_t i = 0; i < hard.size(); ++i)
    for (size_t k = 0; k < hard.size(); ++k) t.add(hard[i], hard[k], hard[(i * 7 + k * 5 + 3) % hard.size()]);
  for (int op = 0; op < kFloatOpCount; ++op) check_float_op(op, t);
}

TEST(Lanes, EveryFloatOperationOnRandomBitsEqualsItsModel) {
  TestRandom random(1);
  Triples t;
  const auto quiet = [](uint32_t b) { return float_of((b & 0x7f800000u) == 0x7f800000u ? b | 0x00400000u : b); };
  for (int i = 0; i < 40000; ++i) t.add(quiet(random.bits()), quiet(random.bits()), quiet(random.bits()));
  for (int i = 0; i < 40000; ++i)  // of one size, so that sums and comparisons are close
    t.add(quiet(0x3f000000u + random.bits() % 0x2000000u), quiet(0xbf000000u + random.bits() % 0x2000000u), quiet(0x3f000000u + random.bits() % 0x1000000u));
  for (int op = 0; op < kFloatOpCount; ++op) check_float_op(op, t);
}

TEST(Lanes, FloorAndRoundAroundEveryHalf) {
  Triples t;
  for (int i = -3000; i <= 3000; ++i)
    for (int d = -2; d <= 2; ++d) t.add(float_of(bits(static_cast<float>(i) * 0.5f) + static_cast<uint32_t>(d)), 0, 0);
  for (uint32_t i = 0; i < 2000; ++i) t.add(float_of(0x4afffc00u + i), 0, 0), t.add(float_of(0xcafffc00u + i), 0, 0), t.add(float_of(0x4efffc00u + i), 0, 0), t.add(float_of(0xcefffc00u + i), 0, 0);
  for (float& x : t.a) if (std::isnan(x)) x = 0;  // below zero and around -0 the bits above wrap
  for (const int op : {13, 14, 15}) check_float_op(op, t);
}

TEST(Lanes, EveryIntegerOperationEqualsItsModel) {
  TestRandom random(4);
  std::vector<int32_t> a, b;
  for (const int32_t x : hard_integers())
    for (const int32_t y : hard_integers()) a.push_back(x), b.push_back(y);
  for (int i = 0; i < 20000; ++i) a.push_back(static_cast<int32_t>(random.bits())), b.push_back(i % 8 ? static_cast<int32_t>(random.bits()) : a.back());
  while (a.size() % 16 != 0) a.push_back(1), b.push_back(2);
  const auto model = [](int op, int32_t x, int32_t y) -> uint32_t {
    const uint32_t u = static_cast<uint32_t>(x), v = static_cast<uint32_t>(y);
    switch (op) {
      case 0: return u + v;
      case 1: return u - v;
      case 2: return u * v;
      case 3: return u & v;
      case 4: return u | v;
      case 5: return u ^ v;
      case 6: return u << 1;
      case 7: return u << 16;
      case 8: return u << 31;
      case 9: return word(x >> 1);
      case 10: return word(x >> 8);
      case 11: return word(x >> 31);
      case 12: return u >> 1;
      case 13: return u >> 17;
      case 14: return u >> 31;
      case 15: return x == y;
      case 16: return x != y;
      case 17: return x < y;
      case 18: return x > y;
      case 19: return word(std::min(x, y));
      case 20: return word(std::max(x, y));
      case 21: return word(x < y ? y : x);
      default: return bits(static_cast<float>(x));
    }
  };
  std::vector<uint32_t> out(a.size());
  on_every_isa([&](int isa) {
    for (int op = 0; op <= 22; ++op) {
      kInteger[isa](op, a.data(), b.data(), out.data(), out.size());
      for (size_t i = 0; i < out.size(); ++i) ASSERT_EQ(out[i], model(op, a[i], b[i])) << "operation " << op << " of " << a[i] << ", " << b[i];
    }
  });
}

TEST(Lanes, MasksAreTheirBits) {
  TestRandom random(5);
  on_every_isa([&](int isa) {
    const int lanes = kLaneCount[static_cast<size_t>(isa)]();
    const uint32_t every = (1u << lanes) - 1;
    for (int i = 0; i < 5000; ++i) {
      const uint32_t x = i == 0 ? 0 : i == 1 ? ~0u : i < 18 ? 1u << (i - 2) : random.bits(), y = random.bits();
      const int counts[] = {0, 1, -1, lanes, lanes + 1, 255, 256, 257, 65536, 2147483647, -2147483647, random.between(0, lanes)};
      const int n = counts[i % 12], kept = std::max(0, std::min(n, lanes));
      uint32_t out[11];
      kMask[static_cast<size_t>(isa)](x, y, n, out);
      const uint32_t want[] = {x & every, y & every, ~x & every, x & y & every, (x | y) & every, ~x & y & every, (1u << kept) - 1,
                               (x & every) != 0, (x & every) == every, static_cast<uint32_t>(__builtin_popcount(x & every)), x & every};
      for (int k = 0; k < 11; ++k) ASSERT_EQ(out[k], want[k]) << "result " << k << " of " << std::hex << x << ", " << y << ", " << n;
    }
  });
}

TEST(Lanes, GatherReadsTheIndexedElementsAlsoBeforeTheBase) {
  TestRandom random(6);
  std::vector<float> f(2000);
  std::vector<int32_t> s(2000);
  std::vector<uint32_t> u(2000);
  for (size_t i = 0; i < 2000; ++i) f[i] = float_of(random.bits()), s[i] = static_cast<int32_t>(random.bits()), u[i] = random.bits();
  on_every_isa([&](int isa) {
    const int lanes = kLaneCount[static_cast<size_t>(isa)]();
    for (int round = 0; round < 500; ++round) {
      int32_t index[16];
      uint32_t out[48];
      for (int& i : index) i = round % 5 == 0 ? (random.bits() & 1 ? 999 : -1000) : random.between(-1000, 999);
      kGather[static_cast<size_t>(isa)](f.data() + 1000, s.data() + 1000, u.data() + 1000, index, out);
      for (int i = 0; i < lanes; ++i) {
        const size_t at = static_cast<size_t>(1000 + index[i]);
        ASSERT_EQ(out[i], std::bit_cast<uint32_t>(f[at]));
        ASSERT_EQ(out[lanes + i], static_cast<uint32_t>(s[at]));
        ASSERT_EQ(out[2 * lanes + i], u[at]);
      }
    }
  });
}

}  // namespace spanray
#endif
