// Light on batches of surfaces, flat and Phong: a vector of surfaces meets all lights before the next.
#include "shade/light_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/light_kernel.cpp"
#include "hwy/foreach_target.h"
#include "shade/surface_light-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace {
using namespace light_lanes;

constexpr int kTogether = 16;  // pairs of a vector and a light in one go

// A vector of surfaces, and where light is evaluated for them.
struct Surfaces : Receiver {
  Site site;  // for flat shading not at Receiver::position
  Models models;
  F32 shininess, highlight;
};

struct MetLight : Met { int light; };

// Adds lights to each surface, one after the other: intensity * attenuation * (Kd * diffuse + Ks * specular) (catalog/reflectance).
// Input:    surfaces, the bits of those that each light reaches; plan.specular off: Ks is not read.
// Contract: a surface whose geometric normal does not face the light gets nothing, but by lifted rays. Entries are independent: equal bits
//           for every split of the batch and of the lights. Against double: within 1/255 after encoding (tests/shade_light_test.cpp).
class AddLights {
 public:
  AddLights(const Frame& frame, const SurfaceBatch& s, const HitBatch& hits, const LightRange& lights, bool onto, float* const radiance[3])
      : frame_(frame), s_(s), hits_(hits), lights_(lights), onto_(onto), radiance_(radiance) {}

  // At most kTogether lights. Vectors are loaded for each of the two steps: all that a vector is stays in registers from light to light.
  void all() const {
    const int vectors = lights_.count > 1 ? kTogether / lights_.count : kTogether;
    MetLight met[kTogether];
    for (int from = 0; from < s_.count; from += vectors * kLanes) {
      const int end = s_.count < from + vectors * kLanes ? s_.count : from + vectors * kLanes;
      int n = 0, done = 0;
      for (int i = from; i < end; i += kLanes) n += meet_all(i, met + n);
      for (int i = from; i < end; i += kLanes) done += reflect_all(i, met + done, n - done);
    }
  }

 private:
  HWY_INLINE Surfaces surfaces_at(int i) const {
    Surfaces v;
    static_cast<Receiver&>(v) = receiver_at(s_, i);
    v.site = site_of(v);
    v.models = models_of(*frame_.scene, select(v.valid, I32::load(s_.material + v.at), I32::zero()));
    v.shininess = F32::load(s_.shininess + v.at);
    v.highlight = max_(max_(v.specular.x, v.specular.y), v.specular.z);
    return v;
  }

  HWY_INLINE Site site_of(const Surfaces& v) const {
    if (frame_.settings.shading != Shading::kFlat) return {v.position, load3(s_.normal, v.at), load3(s_.view, v.at)};
    const I32 primitive = select(v.valid, I32::load(s_.primitive + v.at), I32::zero());
    return face_site(*frame_.scene, primitive, load3(s_.geometric_normal, v.at), viewer_of(frame_, s_, hits_, v.valid, v.at));
  }

  // How many lights give something to surfaces i .., with what they see of each.
  HWY_INLINE int meet_all(int i, MetLight* met) const {
    if (!any(active_lanes(s_, i))) return 0;  // there may be no triangle at all, whose corners flat shading would read
    const Surfaces v = surfaces_at(i);
    int n = 0;
    for (int l = 0; l < lights_.count; ++l) {
      const Mask active = lit_lanes(v, lights_, l);
      if (!any(active)) continue;
      met[n].at = i, met[n].light = lights_.first + l;
      n += meet(v, active, met[n]);
    }
    return n;
  }

  HWY_INLINE bool meet(const Surfaces& v, Mask active, MetLight& met) const {
    const Light& light = light_of(frame_, met.light);
    bool any_left = false;
    with_kind(light, [&](auto kind) HWY_ATTR {
      using Kind = decltype(kind);
      const LightLanes lanes = broadcast_light(light);
      Incidence incidence = Kind::incidence(lanes, v.position);
      active = active & reached(frame_, s_, v.at, incidence, lights_.lit != nullptr);
      if (!any(active)) return;
      if (frame_.settings.shading == Shading::kFlat) incidence = Kind::incidence(lanes, v.site.position);
      any_left = meet_light(frame_, v.site, incidence, active, [&]() HWY_ATTR { return v.highlight; }, met);
    });
    return any_left;
  }

  // What they give, of at most n lights. Returns how many of them are those of surfaces i ...
  HWY_INLINE int reflect_all(int i, const MetLight* met, int n) const {
    V3 sum = start_radiance(frame_, s_, receiver_at(s_, i), onto_, radiance_);
    int k = 0;
    if (n > 0 && met->at == i) {
      const Surfaces v = surfaces_at(i);
      for (; k < n && met[k].at == i; ++k) sum = reflect(v, sum, met[k]);
    }
    store_radiance(sum, radiance_, i, s_.count);
    return k;
  }

  HWY_INLINE V3 reflect(const Surfaces& v, const V3& sum, const MetLight& met) const {
    const Light& light = light_of(frame_, met.light);
    V3 direction = {F32::zero(), F32::zero(), F32::zero()};
    with_kind(light, [&](auto kind) HWY_ATTR { direction = decltype(kind)::incidence(broadcast_light(light), v.site.position).direction; });
    const Reflected factor = reflect_light(frame_, v.site, direction, met, v.models, v.shininess);
    return plus_light(sum, met.active, light, factor, v.diffuse, v.specular, met.specular);
  }

  const Frame& frame_;
  const SurfaceBatch& s_;
  const HitBatch& hits_;
  const LightRange& lights_;
  const bool onto_;
  float* const* const radiance_;
};

}  // namespace

void shade_lights_entry(const Frame& frame, const SurfaceBatch& s, const HitBatch& hits, const LightRange& lights, bool onto,
                        float* const radiance[3]) {
  for (int done = 0; done < lights.count; done += kTogether) {
    const int left = lights.count - done;
    const LightRange some = {lights.first + done, left < kTogether ? left : kTogether, lights.bits(done), lights.words};
    AddLights(frame, s, hits, some, onto || done > 0, radiance).all();
  }
  if (lights.count == 0 && !onto) AddLights(frame, s, hits, lights, false, radiance).all();
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {
const ShadeLightsFn kShadeLights[kIsaCount] = SPANRAY_KERNEL_TABLE(shade_lights_entry);
}  // namespace spanray
#endif
