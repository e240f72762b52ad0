// What the kernels of light share: surfaces and lights as lanes, light kinds and reflectances of the catalog by index.
// Included once per target by shade/*_kernel.cpp.
#if defined(SPANRAY_LIGHT_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_LIGHT_LANES_INL_H_
#undef SPANRAY_LIGHT_LANES_INL_H_
#else
#define SPANRAY_LIGHT_LANES_INL_H_
#endif

#include <cstddef>

#include "catalog/formulas-inl.h"
#include "shade/light_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace light_lanes {

using V3 = formula::Vec3<F32>;
using Cosines = formula::Cosines<F32>;
using Incidence = formula::Incidence<F32>;
using LightLanes = formula::LightLanes<F32>;
using Segment = formula::Segment<F32>;

HWY_INLINE V3 load3(float* const p[3], int i) { return {F32::load(p[0] + i), F32::load(p[1] + i), F32::load(p[2] + i)}; }
HWY_INLINE V3 broadcast3(const float v[3]) { return {f32(v[0]), f32(v[1]), f32(v[2])}; }
HWY_INLINE V3 gather3(const float* base, I32 index) {
  return {gather(base, index), gather(base + 1, index), gather(base + 2, index)};
}
HWY_INLINE V3 select3(Mask m, const V3& yes, const V3& no) {
  return {select(m, yes.x, no.x), select(m, yes.y, no.y), select(m, yes.z, no.z)};
}
HWY_INLINE V3 unit_or_zero(const V3& v) { return formula::divide_or_zero(v, formula::length(v)); }

HWY_INLINE LightLanes broadcast_light(const Light& light) {
  return {broadcast3(light.position), broadcast3(light.direction), broadcast3(light.attenuation)};
}

// Lanes i .. i + kLanes - 1 that are valid, below count, and lit. lit: nullptr = all.
HWY_INLINE Mask active_lanes(const SurfaceBatch& s, int i, const uint32_t* lit) {
  const Mask valid = I32::load(s.valid + i) != I32::zero();
  const int left = s.count - i;
  const Mask inside = left < kLanes ? valid & first_lanes(left) : valid;
  if (lit == nullptr) return inside;
  return inside & mask_from_bits(lit[i >> 5] >> (i & 31));
}

// One type a light kind of the catalog, so that kernels are compiled per kind.
#define SPANRAY_CATALOG_ENTRY(index, name)                                                    \
  struct LightKind_##name {                                                                   \
    static HWY_INLINE Incidence incidence(const LightLanes& light, const V3& position) {      \
      return formula::lights::name::incidence(light, position);                               \
    }                                                                                         \
    static HWY_INLINE Segment segment(const LightLanes& light, const V3& origin) {            \
      return formula::lights::name::segment(light, origin);                                   \
    }                                                                                         \
  };
#include "catalog_lights_list.inc"
#undef SPANRAY_CATALOG_ENTRY

// Reflectance times cosine: to be multiplied by Kd and by Ks.
struct Reflected { F32 diffuse, specular; };

// Each reflectance model of the catalog for the lanes that use it. Lanes outside `active` get 0.
HWY_INLINE Reflected reflect(I32 model, Mask active, bool specular, const Cosines& c) {
  Reflected r = {F32::zero(), F32::zero()};
#define SPANRAY_CATALOG_ENTRY(index, name)                                                                   \
  {                                                                                                          \
    const Mask mine = active & (model == i32(index));                                                        \
    if (any(mine)) {                                                                                         \
      r.diffuse = select(mine, formula::reflectance::name::diffuse(c), r.diffuse);                           \
      if (specular) r.specular = select(mine, formula::reflectance::name::specular(c), r.specular);          \
    }                                                                                                        \
  }
#include "catalog_reflectance_list.inc"
#undef SPANRAY_CATALOG_ENTRY
  return r;
}

HWY_INLINE I32 reflectance_models(const SceneData& scene, I32 material) {
  const int32_t* base = reinterpret_cast<const int32_t*>(scene.materials.data());
  const uint32_t first = static_cast<uint32_t>(first_lane(material));
  if (all(material == i32(first))) return i32(scene.materials[first].reflectance);
  return gather(base + offsetof(Material, reflectance) / 4, material * i32(kMaterialStride));
}
HWY_INLINE F32 material_shininess(const SceneData& scene, I32 material) {
  const float* base = reinterpret_cast<const float*>(scene.materials.data());
  return gather(base + offsetof(Material, shininess) / 4, material * i32(kMaterialStride));
}

// Corner j of the triangles of lanes i ..; lanes that are not active read triangle 0.
HWY_INLINE I32 corner_vertex(const SceneData& scene, I32 primitive, int corner) {
  const uint32_t* base = reinterpret_cast<const uint32_t*>(scene.triangles.data());
  return gather(base + corner, primitive * i32(kTriangleStride));
}
HWY_INLINE V3 vertex_position(const SceneData& scene, I32 vertex) {
  return gather3(scene.vertices.data()->position, vertex * i32(kVertexStride));
}
HWY_INLINE V3 vertex_normal(const SceneData& scene, I32 vertex) {
  return gather3(scene.vertices.data()->normal, vertex * i32(kVertexStride));
}

// Where the rays of lanes i .. started: the eye, or the origin of each ray. In double, since the eye is not a float.
struct Viewer { F64 x, y, z; };
HWY_INLINE Viewer eye_of(const Frame& frame) {
  return {f64(frame.primary.eye.x), f64(frame.primary.eye.y), f64(frame.primary.eye.z)};
}
HWY_INLINE Viewer viewer_of(const Frame& frame, const SurfaceBatch& s, const HitBatch& hits, Mask active, int i) {
  if (hits.rays == nullptr) return eye_of(frame);
  const I32 ray = select(active, I32::load(s.ray + i), I32::zero());
  const RayBatch& rays = *hits.rays;
  return {to_f64(gather(rays.origin[0].data(), ray)), to_f64(gather(rays.origin[1].data(), ray)),
          to_f64(gather(rays.origin[2].data(), ray))};
}
HWY_INLINE V3 view_from(const Viewer& viewer, const V3& position) {
  return unit_or_zero({to_f32(viewer.x - to_f64(position.x)), to_f32(viewer.y - to_f64(position.y)),
                       to_f32(viewer.z - to_f64(position.z))});
}

// The surfaces that a light may reach at all: in front of it by the geometric normal. Shadow rays and shading ask this same
// function, so a surface that had no shadow ray is not lit either (reached() says where lifted rays make a difference).
HWY_INLINE Mask in_front(const SurfaceBatch& s, int i, const Incidence& incidence) {
  return formula::dot(load3(s.geometric_normal, i), incidence.direction) > F32::zero();
}

// Those with a place for lifted rays.
HWY_INLINE Mask has_lift(const SurfaceBatch& s, int i) {
  const V3 lift = load3(s.lift, i);
  const F32 zero = F32::zero();
  return !((lift.x == zero) & (lift.y == zero) & (lift.z == zero));
}
// Those of them that it may reach by these: in front of it by the interpolated normal.
HWY_INLINE Mask in_front_lifted(const SurfaceBatch& s, int i, const Incidence& incidence) {
  return has_lift(s, i) & (formula::dot(load3(s.smooth_normal, i), incidence.direction) > F32::zero());
}

// Those that shading lights. With lifted rays, bits of `lit` say all; without shadow rays, either of the two is enough.
HWY_INLINE Mask reached(const Frame& frame, const SurfaceBatch& s, int i, const Incidence& incidence, const uint32_t* lit) {
  if (!frame.plan.lifted_rays) return in_front(s, i, incidence);
  if (lit != nullptr) return first_lanes(kLanes);
  return in_front(s, i, incidence) | in_front_lifted(s, i, incidence);
}

// radiance + intensity * (Kd * diffuse + Ks * specular) in the active lanes, of one channel.
HWY_INLINE F32 plus_light(F32 radiance, Mask active, float intensity, const Reflected& factor, F32 diffuse, F32 highlight, bool specular) {
  F32 reflected = diffuse * factor.diffuse;
  if (specular) reflected = mul_add(highlight, factor.specular, reflected);
  return select(active, mul_add(f32(intensity), reflected, radiance), radiance);
}

// plus_light of all channels of stored surfaces; other entries are not written.
HWY_INLINE void accumulate(const SurfaceBatch& s, int i, Mask active, const Light& light, const Reflected& factor,
                           bool specular, float* const radiance[3]) {
  const bool whole = i + kLanes <= s.count;
  for (int c = 0; c < 3; ++c) {
    float* const out = radiance[c] + i;
    const F32 diffuse = F32::load(s.diffuse[c] + i), highlight = F32::load(s.specular[c] + i);
    if (whole) {
      plus_light(F32::load(out), active, light.intensity[c], factor, diffuse, highlight, specular).store(out);
    } else {  // the caller's arrays need not be padded
      float lanes[kLanes] = {};
      for (int k = 0; i + k < s.count; ++k) lanes[k] = out[k];
      plus_light(F32::load(lanes), active, light.intensity[c], factor, diffuse, highlight, specular).store(lanes);
      for (int k = 0; i + k < s.count; ++k) out[k] = lanes[k];
    }
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace light_lanes
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_LIGHT_LANES_INL_H_
