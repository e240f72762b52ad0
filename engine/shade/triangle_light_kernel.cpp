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

// Adds one light, interpolated from the corners, to each surface.
// Source:   catalog/shading/gouraud.inl.
// Input:    surfaces that carry this light (SurfaceBatch::triangle_light), as flat ones may too; or Gouraud ones that do not: their
//           corners are lit here, seen from the origin of each ray. The bits are the same.
// Contract: corners count as lit on the side that the pixel's ray sees. The geometric normal cuts off light per pixel, but for lifted
//           rays. At a vertex: Phong (HARD-CASES S6).
template <class Kind>
void add_triangle_light(const Frame& frame, const SurfaceBatch& s, const HitBatch& hits, int light_index, const uint32_t* lit,
                       float* const radiance[3]) {
  const Light& light = light_of(frame, light_index);
  const LightLanes lanes = broadcast_light(light);
  const bool specular = frame.plan.specular;
  const float *const diffuse = s.triangle_light(light_index, 0), *const highlight = s.triangle_light(light_index, 1);
  for (int i = 0; i < s.count; i += kLanes) {
    Mask active = active_lanes(s, i, lit);
    if (!any(active)) continue;
    active = active & reached(frame, s, i, Kind::incidence(lanes, load3(s.position, i)), lit);
    if (!any(active)) continue;
    if (diffuse != nullptr) {
      accumulate(s, i, active, light, {F32::load(diffuse + i), specular ? F32::load(highlight + i) : F32::zero()}, specular, radiance);
      continue;
    }
    const I32 primitive = select(active, I32::load(s.primitive + i), I32::zero());
    const I32 material = select(active, I32::load(s.material + i), I32::zero());
    const Reflected factor = light_triangles<Kind>(frame, lanes, primitive, material, viewer_of(frame, s, hits, active, i),
                                                   load3(s.geometric_normal, i), load3(s.weight, i), active);
    accumulate(s, i, active, light, factor, specular, radiance);
  }
}

}  // namespace

void shade_triangle_light_entry(const Frame& frame, const SurfaceBatch& s, const HitBatch& hits, int light,
                               const uint32_t* lit, float* const radiance[3]) {
  with_kind(light_of(frame, light), [&](auto kind) HWY_ATTR { add_triangle_light<decltype(kind)>(frame, s, hits, light, lit, radiance); });
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {
const ShadeLightFn kShadeTriangleLight[kIsaCount] = SPANRAY_KERNEL_TABLE(shade_triangle_light_entry);
}  // namespace spanray
#endif
