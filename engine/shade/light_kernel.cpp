// Light on batches of surfaces, flat and Phong: ambient and emission, then one light after the other.
#include "shade/light_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/light_kernel.cpp"
#include "hwy/foreach_target.h"
#include "shade/triangle_light-inl.h"

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
template <class Kind>
void add_light(const Frame& frame, const SurfaceBatch& s, const HitBatch& hits, int light_index, const uint32_t* lit,
               float* const radiance[3]) {
  const SceneData& scene = *frame.scene;
  const Light& light = light_of(frame, light_index);
  const LightLanes lanes = broadcast_light(light);
  const bool flat = frame.settings.shading == Shading::kFlat;
  for (int i = 0; i < s.count; i += kLanes) {
    Mask active = active_lanes(s, i, lit);
    if (!any(active)) continue;
    Site site = {load3(s.position, i), load3(s.normal, i), load3(s.view, i)};
    Incidence incidence = Kind::incidence(lanes, site.position);
    active = active & reached(frame, s, i, incidence, lit);
    if (!any(active)) continue;
    if (flat) {
      const I32 primitive = select(active, I32::load(s.primitive + i), I32::zero());
      site = face_site(scene, primitive, load3(s.geometric_normal, i), viewer_of(frame, s, hits, active, i));
      incidence = Kind::incidence(lanes, site.position);
    }
    const F32 n_l = formula::dot(site.normal, incidence.direction);
    active = active & (n_l > F32::zero());
    if (!any(active)) continue;

    bool specular = frame.plan.specular;
    if (specular) {
      const F32 brightest = max_(max_(F32::load(s.specular[0] + i), F32::load(s.specular[1] + i)), F32::load(s.specular[2] + i));
      specular = any(active & (brightest > F32::zero()));  // 0 * specular adds nothing: the bits are the same
    }
    const I32 material = select(active, I32::load(s.material + i), I32::zero());
    const I32 model = reflectance_models(scene, material);
    accumulate(s, i, active, light, light_site(frame, site, incidence, n_l, F32::load(s.shininess + i), model, active, specular), specular,
               radiance);
  }
}

void shade_light_kernel(const Frame& frame, const SurfaceBatch& s, const HitBatch& hits, int light, const uint32_t* lit,
                        float* const radiance[3]) {
  switch (light_of(frame, light).kind) {
#define SPANRAY_CATALOG_ENTRY(index, name) \
  case index: return add_light<LightKind_##name>(frame, s, hits, light, lit, radiance);
#include "catalog_lights_list.inc"
#undef SPANRAY_CATALOG_ENTRY
  }
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
