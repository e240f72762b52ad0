// Light on batches of surfaces, flat and Phong: ambient and emission, then one light after the other.
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

// radiance = ambient * scene ambient + emission; 0 for invalid surfaces.
// Input:    plan.ambient and plan.emission: parts that are off are not read.
// Contract: one rounding for emission-free surfaces, two else.
void shade_ambient_kernel(const Frame& frame, const SurfaceBatch& s, float* const radiance[3]) {
  for (int i = 0; i < s.count; i += kLanes) {
    const Mask valid = active_lanes(s, i, nullptr);
    for (int c = 0; c < 3; ++c) {
      F32 sum = frame.plan.emission ? F32::load(s.emission[c] + i) : F32::zero();
      if (frame.plan.ambient) sum = mul_add(F32::load(s.ambient[c] + i), f32(frame.scene->ambient_radiance[c]), sum);
      sum = select(valid, sum, F32::zero());
      if (i + kLanes <= s.count) {
        sum.store(radiance[c] + i);
      } else {  // the caller's arrays need not be padded
        float lanes[kLanes];
        sum.store(lanes);
        for (int k = 0; i + k < s.count; ++k) radiance[c][i + k] = lanes[k];
      }
    }
  }
}

// Adds one light to each surface: intensity * attenuation * (Kd * diffuse + Ks * specular) (catalog/reflectance).
// Input:    surfaces, the bits of those that the light reaches; plan.specular off: Ks is not read.
// Contract: a surface whose geometric normal does not face the light gets nothing, but by lifted rays. Entries are independent: equal bits
//           for every split of the batch. Against double: within 1/255 after encoding (tests/shade_light_test.cpp).
template <class Kind> class AddLight {
 public:
  AddLight(const Frame& frame, const SurfaceBatch& s, const HitBatch& hits, const Light& light, const uint32_t* lit,
           float* const radiance[3])
      : frame_(frame), s_(s), hits_(hits), light_(light), lanes_(broadcast_light(light)), lit_(lit), radiance_(radiance) {}

  void all() {
    constexpr int kTogether = 16;
    Met met[kTogether];
    for (int i = 0; i < s_.count;) {
      int n = 0;
      for (; n < kTogether && i < s_.count; i += kLanes) n += meet(i, met[n]);
      for (int k = 0; k < n; ++k) reflect(met[k]);
    }
  }

 private:
  HWY_INLINE Site site_of(int i, Mask active) const {
    if (frame_.settings.shading != Shading::kFlat) return {load3(s_.position, i), load3(s_.normal, i), load3(s_.view, i)};
    const I32 primitive = select(active, I32::load(s_.primitive + i), I32::zero());
    return face_site(*frame_.scene, primitive, load3(s_.geometric_normal, i), viewer_of(frame_, s_, hits_, active, i));
  }

  HWY_INLINE bool meet(int i, Met& met) const {
    Mask active = active_lanes(s_, i, lit_);
    if (!any(active)) return false;
    Incidence incidence = Kind::incidence(lanes_, load3(s_.position, i));
    active = active & reached(frame_, s_, i, incidence, lit_);
    if (!any(active)) return false;
    const Site site = site_of(i, active);
    if (frame_.settings.shading == Shading::kFlat) incidence = Kind::incidence(lanes_, site.position);
    const auto highlight = [&]() HWY_ATTR {
      return max_(max_(F32::load(s_.specular[0] + i), F32::load(s_.specular[1] + i)), F32::load(s_.specular[2] + i));
    };
    met.at = i;
    return meet_light(frame_, site, incidence, active, highlight, met);
  }

  HWY_INLINE void reflect(const Met& met) const {
    const Site site = site_of(met.at, met.active);
    const V3 direction = Kind::incidence(lanes_, site.position).direction;
    const Reflected factor =
        reflect_light(frame_, site, direction, met, I32::load(s_.material + met.at), F32::load(s_.shininess + met.at));
    accumulate(s_, met.at, met.active, light_, factor, met.specular, radiance_);
  }

  const Frame& frame_;
  const SurfaceBatch& s_;
  const HitBatch& hits_;
  const Light& light_;
  const LightLanes lanes_;
  const uint32_t* const lit_;
  float* const* const radiance_;
};

void shade_light_kernel(const Frame& frame, const SurfaceBatch& s, const HitBatch& hits, int light, const uint32_t* lit,
                        float* const radiance[3]) {
  with_kind(light_of(frame, light), [&](auto kind) HWY_ATTR {
    AddLight<decltype(kind)>(frame, s, hits, light_of(frame, light), lit, radiance).all();
  });
}

}  // namespace
void shade_ambient_entry(const Frame& f, const SurfaceBatch& s, float* const r[3]) { shade_ambient_kernel(f, s, r); }
void shade_light_entry(const Frame& f, const SurfaceBatch& s, const HitBatch& h, int l, const uint32_t* lit, float* const r[3]) {
  shade_light_kernel(f, s, h, l, lit, r);
}
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {
const ShadeAmbientFn kShadeAmbient[kIsaCount] = SPANRAY_KERNEL_TABLE(shade_ambient_entry);
const ShadeLightFn kShadeLight[kIsaCount] = SPANRAY_KERNEL_TABLE(shade_light_entry);
}  // namespace spanray
#endif
