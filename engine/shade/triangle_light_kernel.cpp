// Light of surfaces that depends on their triangle: Gouraud and flat shading.
#include "shade/light_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/triangle_light_kernel.cpp"
#include "hwy/foreach_target.h"
#include "shade/triangle_light-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace {
using namespace light_lanes;

// Adds lights, interpolated from the corners, to each surface, one after the other.
// Source:   catalog/shading/gouraud.inl.
// Input:    surfaces that carry their light (SurfaceBatch::triangle_light), as flat ones may too; or Gouraud ones that do not: their
//           corners are lit here, seen from the origin of each ray. The bits are the same.
// Contract: corners count as lit on the side that the pixel's ray sees. The geometric normal cuts off light per pixel, but for lifted
//           rays. At a vertex: Phong (HARD-CASES S6).
class AddTriangleLights {
 public:
  AddTriangleLights(const Frame& frame, const SurfaceBatch& s, const HitBatch& hits, const LightRange& lights)
      : frame_(frame), s_(s), hits_(hits), lights_(lights) {}

  void all(bool onto, float* const radiance[3]) const {
    for (int i = 0; i < s_.count; i += kLanes) {
      const Receiver r = receiver_at(s_, i);
      V3 sum = start_radiance(frame_, s_, r, onto, radiance);
      for (int l = 0; l < lights_.count; ++l)
        with_kind(light_of(frame_, lights_.first + l), [&](auto kind) HWY_ATTR { add<decltype(kind)>(r, l, sum); });
      store_radiance(sum, radiance, i, s_.count);
    }
  }

 private:
  template <class Kind> HWY_INLINE void add(const Receiver& r, int l, V3& sum) const {
    const Light& light = light_of(frame_, lights_.first + l);
    const LightLanes lanes = broadcast_light(light);
    Mask active = lit_lanes(r, lights_, l);
    if (!any(active)) return;
    active = active & reached(frame_, s_, r.at, Kind::incidence(lanes, r.position), lights_.lit != nullptr);
    if (!any(active)) return;
    const Reflected factor = s_.lights > 0 ? carried(r, lights_.first + l) : made<Kind>(r, lanes, active);
    sum = plus_light(sum, active, light, factor, r.diffuse, r.specular, frame_.plan.specular);
  }

  HWY_INLINE Reflected carried(const Receiver& r, int light) const {
    const F32 diffuse = F32::load(s_.triangle_light(light, 0) + r.at);
    return {diffuse, frame_.plan.specular ? F32::load(s_.triangle_light(light, 1) + r.at) : F32::zero()};
  }

  template <class Kind> HWY_INLINE Reflected made(const Receiver& r, const LightLanes& lanes, Mask active) const {
    const I32 primitive = select(active, I32::load(s_.primitive + r.at), I32::zero());
    const I32 material = select(active, I32::load(s_.material + r.at), I32::zero());
    return light_triangles<Kind>(frame_, lanes, primitive, material, viewer_of(frame_, s_, hits_, active, r.at),
                                 load3(s_.geometric_normal, r.at), load3(s_.weight, r.at), active);
  }

  const Frame& frame_;
  const SurfaceBatch& s_;
  const HitBatch& hits_;
  const LightRange& lights_;
};

}  // namespace

void shade_triangle_lights_entry(const Frame& frame, const SurfaceBatch& s, const HitBatch& hits, const LightRange& lights, bool onto,
                                 float* const radiance[3]) {
  AddTriangleLights(frame, s, hits, lights).all(onto, radiance);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {
const ShadeLightsFn kShadeTriangleLights[kIsaCount] = SPANRAY_KERNEL_TABLE(shade_triangle_lights_entry);
}  // namespace spanray
#endif
