// One light on vectors of surfaces, in two steps, so that many vectors can be in each: roots, quotients and powers wait for themselves, and
// only what is independent and near fills the time. Include inside a *_kernel.cpp.
#if defined(SPANRAY_SURFACE_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_SURFACE_LIGHT_INL_H_
#undef SPANRAY_SURFACE_LIGHT_INL_H_
#else
#define SPANRAY_SURFACE_LIGHT_INL_H_
#endif

#include "shade/triangle_light-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace light_lanes {

// What a vector of surfaces sees of a light.
struct Met {
  F32 n_l, n_h, attenuation;
  Mask active;    // lanes that it lights
  bool specular;  // highlights of some are more than 0
  int at;         // which vector, for the caller
};

// First step. active: the lanes that the light reaches by the geometric normal; then only those whose normal is turned to it as well.
// Returns whether there are any. highlight(): the brightest channel of Ks.
template <class Highlight>
HWY_INLINE bool meet_light(const Frame& frame, const Site& site, const Incidence& incidence, Mask active, const Highlight& highlight,
                           Met& met) {
  met.n_l = formula::dot(site.normal, incidence.direction), met.attenuation = incidence.attenuation;
  met.active = active & (met.n_l > F32::zero());
  if (!any(met.active)) return false;
  met.specular = frame.plan.specular && any(met.active & (highlight() > F32::zero()));  // 0 * specular adds nothing: the bits are the same
  if (!met.specular) return true;
  Cosines c{};
  formula::add_half_way(c, site.normal, incidence.direction, site.view);
  met.n_h = c.n_h;
  return true;
}

// Second step: attenuation times reflectance times cosine. Of the site and of direction, which is what the first step had, nothing is
// computed but for formulas of reflectance that ask for more cosines than n_l and n_h.
HWY_INLINE Reflected reflect_light(const Frame& frame, const Site& site, const V3& direction, const Met& met, const Models& models, F32 shininess) {
  Cosines c = formula::cosines(site.normal, direction, site.view, met.n_l, shininess, frame.settings.powers == Powers::kFast);
  if (met.specular) formula::add_half_way(c, site.normal, direction, site.view), c.n_h = met.n_h;
  const Reflected r = reflect_any(models, met.active, met.specular, c);
  return {r.diffuse * met.attenuation, r.specular * met.attenuation};
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace light_lanes
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_SURFACE_LIGHT_INL_H_
