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

// Lanes i .. i + kLanes - 1 that are valid and below count.
HWY_INLINE Mask active_lanes(const SurfaceBatch& s, int i) {
  const Mask valid = I32::load(s.valid + i) != I32::zero();
  const int left = s.count - i;
  return left < kLanes ? valid & first_lanes(left) : valid;
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

HWY_INLINE I32 reflectance_models(const SceneData& scene, I32 material) {
  const int32_t* base = reinterpret_cast<const int32_t*>(scene.materials.data());
  const uint32_t first = static_cast<uint32_t>(first_lane(material));
  if (all(material == i32(first))) return i32(scene.materials[first].reflectance);
  return gather(base + offsetof(Material, reflectance) / 4, material * i32(kMaterialStride));
}

// The same, and whether all lanes have the one of the first: then nothing is asked lane by lane.
struct Models {
  I32 lanes;
  bool one;
};
HWY_INLINE Models models_of(const SceneData& scene, I32 material) {
  const I32 lanes = reflectance_models(scene, material);
  return {lanes, all(lanes == i32(first_lane(lanes)))};
}
HWY_INLINE F32 material_shininess(const SceneData& scene, I32 material) {
  const float* base = reinterpret_cast<const float*>(scene.materials.data());
  return gather(base + offsetof(Material, shininess) / 4, material * i32(kMaterialStride));
}

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

// The same; lanes outside `active` may get anything.
HWY_INLINE Reflected reflect_any(const Models& models, Mask active, bool specular, const Cosines& c) {
  if (!models.one) return reflect(models.lanes, active, specular, c);
  switch (first_lane(models.lanes)) {
#define SPANRAY_CATALOG_ENTRY(index, name) \
  case index: return {formula::reflectance::name::diffuse(c), specular ? formula::reflectance::name::specular(c) : F32::zero()};
#include "catalog_reflectance_list.inc"
#undef SPANRAY_CATALOG_ENTRY
  }
  return {F32::zero(), F32::zero()};
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

// Those that shading lights. With lifted rays, shadow bits (known) say all; without, either of the two is enough.
HWY_INLINE Mask reached(const Frame& frame, const SurfaceBatch& s, int i, const Incidence& incidence, bool known) {
  if (!frame.plan.lifted_rays) return in_front(s, i, incidence);
  if (known) return first_lanes(kLanes);
  return in_front(s, i, incidence) | in_front_lifted(s, i, incidence);
}

// radiance + intensity * (Kd * diffuse + Ks * specular) in the active lanes.
HWY_INLINE V3 plus_light(const V3& radiance, Mask active, const Light& light, const Reflected& factor, const V3& diffuse,
                         const V3& highlight, bool specular) {
  const auto channel = [&](F32 sum, float intensity, F32 kd, F32 ks) HWY_ATTR {
    F32 reflected = kd * factor.diffuse;
    if (specular) reflected = mul_add(ks, factor.specular, reflected);
    return select(active, mul_add(f32(intensity), reflected, sum), sum);
  };
  return {channel(radiance.x, light.intensity[0], diffuse.x, highlight.x), channel(radiance.y, light.intensity[1], diffuse.y, highlight.y),
          channel(radiance.z, light.intensity[2], diffuse.z, highlight.z)};
}

// ambient * scene ambient + emission.
// Input:    plan.ambient and plan.emission: parts that are off are not read.
// Contract: one rounding for emission-free surfaces, two else.
HWY_INLINE V3 ambient_radiance(const Frame& frame, const V3& ambient, const V3& emission) {
  const float* const scene = frame.scene->ambient_radiance;
  const V3 sum = frame.plan.emission ? emission : V3{F32::zero(), F32::zero(), F32::zero()};
  if (!frame.plan.ambient) return sum;
  return {mul_add(ambient.x, f32(scene[0]), sum.x), mul_add(ambient.y, f32(scene[1]), sum.y), mul_add(ambient.z, f32(scene[2]), sum.z)};
}

// Radiance of count surfaces, from entry i on. The caller's arrays need not be padded.
HWY_INLINE V3 load_radiance(float* const radiance[3], int i, int count) {
  if (i + kLanes <= count) return load3(radiance, i);
  float lanes[3][kLanes] = {};
  for (int c = 0; c < 3; ++c)
    for (int k = 0; i + k < count; ++k) lanes[c][k] = radiance[c][i + k];
  return {F32::load(lanes[0]), F32::load(lanes[1]), F32::load(lanes[2])};
}
HWY_INLINE void store_radiance(const V3& value, float* const radiance[3], int i, int count) {
  if (i + kLanes <= count) {
    value.x.store(radiance[0] + i), value.y.store(radiance[1] + i), value.z.store(radiance[2] + i);
    return;
  }
  float lanes[3][kLanes];
  value.x.store(lanes[0]), value.y.store(lanes[1]), value.z.store(lanes[2]);
  for (int c = 0; c < 3; ++c)
    for (int k = 0; i + k < count; ++k) radiance[c][i + k] = lanes[c][k];
}

// A vector of a batch of surfaces: what all lights ask of it.
struct Receiver {
  int at;
  Mask valid;
  V3 position, diffuse, specular;
};
HWY_INLINE Receiver receiver_at(const SurfaceBatch& s, int at) {
  return {at, active_lanes(s, at), load3(s.position, at), load3(s.diffuse, at), load3(s.specular, at)};
}

// Before any light: ambient and emission, 0 for surfaces that are not valid, or (onto) what stands in radiance.
HWY_INLINE V3 start_radiance(const Frame& frame, const SurfaceBatch& s, const Receiver& r, bool onto, float* const radiance[3]) {
  if (onto) return load_radiance(radiance, r.at, s.count);
  const V3 ambient = ambient_radiance(frame, load3(s.ambient, r.at), load3(s.emission, r.at));
  return select3(r.valid, ambient, {F32::zero(), F32::zero(), F32::zero()});
}

// Those of r that light number `light` of a range has found.
HWY_INLINE Mask lit_lanes(const Receiver& r, const LightRange& lights, int light) {
  const uint32_t* const lit = lights.bits(light);
  return lit == nullptr ? r.valid : r.valid & mask_from_bits(lit[r.at >> 5] >> (r.at & 31));
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace light_lanes
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_LIGHT_LANES_INL_H_
