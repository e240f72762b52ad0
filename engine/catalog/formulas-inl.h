// All formulas of the catalog for the lanes of one target: included once per target by a *_kernel.cpp, after its other headers.
#if defined(SPANRAY_FORMULAS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_FORMULAS_INL_H_
#undef SPANRAY_FORMULAS_INL_H_
#else
#define SPANRAY_FORMULAS_INL_H_
#endif

#include "catalog/catalog.h"
#include "math/elementary-inl.h"
#include "scene/scene_data.h"
#include "simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace formula {
template <class F> SPANRAY_FORMULA F number(float x) { return f32(x); }
#include "catalog/vocabulary.inl"
#include "catalog_reflectance.inc"
#include "catalog_lights.inc"
#include "catalog_shading.inc"
#include "catalog_transparency.inc"
}  // namespace formula
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_FORMULAS_INL_H_
