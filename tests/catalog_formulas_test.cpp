// Each formula of the catalog gives the same bits in lanes, on every instruction set, as its text evaluated for one float.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "catalog/catalog.h"
#include "catalog/scalar.h"
#include "support/random.h"
#include "support/shading_oracle.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "catalog_formulas_test.cpp"
#include "hwy/foreach_target.h"
#include "catalog/formulas-inl.h"
#include "simd/dispatch.h"

// The same list of results for any lane type; N: number of inputs that it reads.
#ifndef SPANRAY_TEST_FORMULAS
#define SPANRAY_TEST_FORMULAS
inline constexpr int kInputs = 15;
inline constexpr int kMaxOutputs = 64;
#endif

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace formula {
#include "support/catalog_evaluate.inl"
}
// in[k * 16 + lane] -> out[k * 16 + lane], kLanes lanes at a time.
int evaluate_lanes(const float* in, float* out) {
  int n = 0;
  for (int lane = 0; lane < 16; lane += kLanes) {
    F32 inputs[kInputs], outputs[kMaxOutputs];
    for (int k = 0; k < kInputs; ++k) inputs[k] = F32::load(in + k * 16 + lane);
    n = formula::evaluate_catalog(inputs, outputs);
    for (int k = 0; k < n; ++k) outputs[k].store(out + k * 16 + lane);
  }
  return n;
}
float pow_lane(float base, float exponent) {
  float out[kLanes];
  pow_(f32(base), f32(exponent)).store(out);
  return out[0];
}
float highlight_pow_lane(float base, float exponent) {
  float out[kLanes];
  highlight_pow_(f32(base), f32(exponent)).store(out);
  return out[0];
}
float fast_pow_lane(float base, float exponent) {
  float out[kLanes];
  fast_pow_(f32(base), f32(exponent)).store(out);
  return out[0];
}
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {
namespace formula_scalar {
using namespace scalar;
inline float pow_(float base, float exponent) { return N_SCALAR::pow_lane(base, exponent); }
inline float highlight_pow_(float base, float exponent) { return N_SCALAR::highlight_pow_lane(base, exponent); }
inline float fast_pow_(float base, float exponent) { return N_SCALAR::fast_pow_lane(base, exponent); }
inline double fast_pow_(double base, double exponent) { return std::pow(base, exponent); }
inline double highlight_pow_(double base, double exponent) { return base > 0 ? std::pow(base, exponent) : 0; }
inline double pow_(double base, double exponent) { return std::pow(base, exponent); }
#include "catalog/vocabulary.inl"
#include "catalog_reflectance.inc"
#include "catalog_lights.inc"
#include "catalog_shading.inc"
#include "catalog_transparency.inc"
#include "support/catalog_evaluate.inl"
}  // namespace formula_scalar

namespace {

using EvaluateFn = int (*)(const float*, float*);
const EvaluateFn kEvaluate[kIsaCount] = SPANRAY_KERNEL_TABLE(evaluate_lanes);

// Cosines, weights, alphas in [0, 1]; then exponents, positions, colors. Every fourth value is a special one.
float random_input(TestRandom& random, int k) {
  static const float special[] = {0.0f, 1.0f, 0x1p-24f, 1.0f - 0x1p-24f, 0x1p-149f, 0.5f};
  if (random.below(4) == 0) return special[random.below(6)];
  if (k < 5) return static_cast<float>(random.uniform());
  if (k == 5) return static_cast<float>(random.uniform(0, 1e4));
  return static_cast<float>(random.uniform(-10, 10));
}

TEST(CatalogFormulas, LanesEqualTheScalarFormulaOnEveryInstructionSet) {
  TestRandom random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    float in[kInputs * 16], want[kMaxOutputs * 16], got[kMaxOutputs * 16];
    for (int k = 0; k < kInputs * 16; ++k) in[k] = random_input(random, k / 16);
    int n = 0;
    for (int lane = 0; lane < 16; ++lane) {
      float inputs[kInputs], outputs[kMaxOutputs];
      for (int k = 0; k < kInputs; ++k) inputs[k] = in[k * 16 + lane];
      n = formula_scalar::evaluate_catalog(inputs, outputs);
      for (int k = 0; k < n; ++k) want[k * 16 + lane] = outputs[k];
    }
    ASSERT_GE(n, 20);
    for (int isa = 0; isa < kIsaCount; ++isa) {
      if (!isa_supported(static_cast<Isa>(isa + 1))) continue;
      ASSERT_EQ(kEvaluate[isa](in, got), n);
      for (int k = 0; k < n * 16; ++k)
        ASSERT_EQ(std::memcmp(got + k, want + k, 4), 0) << "isa " << isa << " output " << k / 16 << ": " << got[k] << " " << want[k];
    }
  }
}

// Blinn-Phong and the lights against their definitions, in double: the formula files themselves, not the kernels.
TEST(CatalogFormulas, DoubleAgreesWithTheDefinitions) {
  TestRandom random(2);
  namespace fs = formula_scalar;
  for (int trial = 0; trial < 5000; ++trial) {
    const auto unit = [&] { return normalize3(glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)), glm::dvec3(1, 0, 0)); };
    const glm::dvec3 n = unit(), l = unit(), v = unit();
    const double shininess = random.uniform(0, 100);
    if (dot3(n, l) <= 1e-9) continue;
    const fs::Vec3<double> fn{n.x, n.y, n.z}, fl{l.x, l.y, l.z}, fv{v.x, v.y, v.z};
    auto c = fs::cosines(fn, fl, fv, fs::dot(fn, fl), shininess);
    fs::add_half_way(c, fn, fl, fv);
    const OracleReflected want = oracle_reflected(n, l, v, shininess);
    EXPECT_NEAR(fs::reflectance::blinn_phong::diffuse(c), want.diffuse, 1e-7);
    EXPECT_NEAR(fs::reflectance::blinn_phong::specular(c), want.specular, 1e-7);
    EXPECT_NEAR(fs::reflectance::lambert::diffuse(c), want.diffuse, 1e-7);
    EXPECT_EQ(fs::reflectance::lambert::specular(c), 0);

    Light light;
    for (int k = 0; k < 3; ++k) light.position[k] = static_cast<float>(random.uniform(-5, 5)), light.attenuation[k] = static_cast<float>(random.uniform());
    const fs::LightLanes<double> lanes{{light.position[0], light.position[1], light.position[2]}, {0, 0, 0},
                                       {light.attenuation[0], light.attenuation[1], light.attenuation[2]}};
    const auto in = fs::lights::point::incidence(lanes, fn);
    const OracleIncidence oracle = oracle_incidence(n, light);
    EXPECT_NEAR(in.attenuation, oracle.irradiance, 1e-12 * oracle.irradiance);
    EXPECT_NEAR(in.direction.x, oracle.to_light.x, 1e-12);
  }
}

}  // namespace
}  // namespace spanray
#endif
