// mul_add and neg_mul_add of simd/lanes-inl.h where rounding twice goes wrong, on every instruction set, against the C library.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "support/every_isa.h"
#include "support/hard_floats.h"
#include "support/random.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd_fma_test.cpp"
#include "hwy/foreach_target.h"
#include "simd/dispatch.h"
#include "simd/lanes-inl.h"
HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

void fma_kernel(bool negative, const float* a, const float* b, const float* c, float* out, size_t n) {
  for (size_t i = 0; i < n; i += kLanes) {
    const F32 x = F32::load(a + i), y = F32::load(b + i), z = F32::load(c + i);
    (negative ? neg_mul_add(x, y, z) : mul_add(x, y, z)).store(out + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();
#if HWY_ONCE
namespace spanray {
namespace {

using FmaFn = void (*)(bool, const float*, const float*, const float*, float*, size_t);
const FmaFn kFma[kIsaCount] = SPANRAY_KERNEL_TABLE(fma_kernel);

struct Triples {
  std::vector<float> a, b, c;
  void add(float x, float y, float z) { a.push_back(x), b.push_back(y), c.push_back(z); }
  void pad() { while (a.size() % 16 != 0) add(1, 2, 3); }
};

// Every bit must be right; where the result is NaN, any NaN will do.
void check_fma(Triples& t) {
  t.pad();
  std::vector<float> out(t.a.size());
  for (const bool negative : {false, true})
    on_every_isa([&](int isa) {
      kFma[isa](negative, t.a.data(), t.b.data(), t.c.data(), out.data(), out.size());
      for (size_t i = 0; i < out.size(); ++i) {
        const float want = std::fma(negative ? -t.a[i] : t.a[i], t.b[i], t.c[i]);
        if (std::bit_cast<uint32_t>(out[i]) == std::bit_cast<uint32_t>(want) || (std::isnan(out[i]) && std::isnan(want))) continue;
        FAIL() << (negative ? "neg_mul_add" : "mul_add") << std::hexfloat << "(" << t.a[i] << ", " << t.b[i] << ", " << t.c[i]
               << ") = " << out[i] << ", not " << want;
      }
    });
}

}  // namespace

// c + a b lies on, or closer than double can tell to, the middle between two floats: where rounding twice goes wrong.
TEST(Fma, TiesByConstruction) {
  TestRandom random(2);
  Triples t;
  for (int i = 0; i < 60000; ++i) {
    const uint32_t c_bits = i % 4 == 0 ? random.bits() % 0x00900000u                       // subnormal, or just above
                            : i % 4 == 1 ? 0x7f7fffffu - random.bits() % 8                 // next to overflow
                                         : 0x00800000u + random.bits() % 0x7e000000u;
    const float c = float_of(c_bits);
    int e;
    std::frexp(c, &e);
    const int half_ulp = std::max(e - 24, -149) - 1;
    const float k = static_cast<float>(random.between(0, i % 3 ? 8 : 2000)) * 0x1p-23f;
    const int split = std::max(std::min(half_ulp / 2, 100), -100);  // the product must be reached by two floats
    const float sign = (random.bits() & 1) ? -1.0f : 1.0f;
    const float a = std::ldexp(1.0f + k, split) * sign, b = std::ldexp(1.0f - k, half_ulp - split);  // half ulp (1 - k^2)
    t.add(a, b, c), t.add(a, b, -c);
    const float above = std::ldexp(1.0f + k, half_ulp - split);  // half ulp (1 + k)^2
    t.add(a, above, c), t.add(a, above, -c);
    t.add(std::ldexp(3.0f, split) * sign, std::ldexp(1.0f, half_ulp - split), c);  // exactly three halves
  }
  check_fma(t);
}

TEST(Fma, CancellationUnderflowAndOverflow) {
  TestRandom random(3);
  Triples t;
  for (int i = 0; i < 40000; ++i) {
    const float a = float_of(0x3f800000u + random.bits() % 0x00800000u), b = float_of(0x3f800000u + random.bits() % 0x00800000u);
    t.add(a, b, -(a * b));                                         // only the rounding error is left
    t.add(a * 0x1p-74f, b * 0x1p-75f, float_of(random.bits() % 16));     // subnormal sums
    t.add(a * 0x1p-120f, b * 0x1p-120f, float_of(random.bits() % 0x01000000u));  // far below: only ties could move
    t.add(a * 0x1p-120f, -b * 0x1p-120f, float_of(0x3f800000u + random.bits() % 4));
    t.add(a * 0x1p63f, b * 0x1p64f, -float_of(0x7f000000u + random.bits() % 0x00800000u));
    t.add(a * 0x1p100f, b * 0x1p100f, -float_of(0x7f7fffffu));
  }
  const std::vector<float> hard = hard_floats();
  for (const float a : hard)
    for (const float b : hard)
      for (const float c : hard) t.add(a, b, c);
  check_fma(t);
}

}  // namespace spanray
#endif
