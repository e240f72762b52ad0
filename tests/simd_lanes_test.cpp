#include <gtest/gtest.h>
#include <cmath>
#include <cstring>
#include <random>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd_lanes_test.cpp"
#include "hwy/foreach_target.h"
#include "simd/dispatch.h"
#include "simd/lanes-inl.h"
HWY_BEFORE_NAMESPACE();
namespace spanray { namespace HWY_NAMESPACE {
void fma_kernel(const float* a, const float* b, const float* c, float* out) {
  mul_add(F32::load(a), F32::load(b), F32::load(c)).store(out);
}
} }
HWY_AFTER_NAMESPACE();
#if HWY_ONCE
namespace spanray {
using Fn = void (*)(const float*, const float*, const float*, float*);
const Fn kFma[kIsaCount] = SPANRAY_KERNEL_TABLE(fma_kernel);
TEST(Lanes, FmaIsExact) {
  std::mt19937 rng(1);
  for (int isa = 0; isa < kIsaCount; ++isa) {
    if (!isa_supported(static_cast<Isa>(isa + 1))) continue;
    for (int n = 0; n < 200000; ++n) {
      float a[16], b[16], c[16], out[16];
      for (int i = 0; i < 16; ++i) { uint32_t r[3] = {uint32_t(rng()), uint32_t(rng()), uint32_t(rng())};
        memcpy(a + i, r, 4); memcpy(b + i, r + 1, 4); memcpy(c + i, r + 2, 4);
        if (n & 1) c[i] = -a[i] * b[i]; }
      kFma[isa](a, b, c, out);
      const float want = std::fma(a[0], b[0], c[0]);
      if (std::isnan(want)) { ASSERT_TRUE(std::isnan(out[0])); continue; }
      ASSERT_EQ(0, memcmp(&want, &out[0], 4)) << isa << " " << a[0] << " " << b[0] << " " << c[0] << " " << want << " " << out[0];
    }
  }
}
}
#endif
