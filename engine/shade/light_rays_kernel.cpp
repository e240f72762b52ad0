// Rays that surfaces ask for: shadow rays to a light, mirror rays.
#include "shade/light_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/light_rays_kernel.cpp"
#include "hwy/foreach_target.h"
#include "shade/light_lanes-inl.h"
#include "shade/place-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace {
using namespace light_lanes;

// The next float in the direction of the sign of `toward`; x itself where that is 0.
HWY_INLINE F32 step_toward(F32 x, F32 toward) {
  const F32 zero = F32::zero();
  const F32 start = x + zero;  // -0 becomes +0
  const I32 one = i32(1);
  const I32 bits = bits_of(start);
  const I32 up = select(start >= zero, bits + one, bits - one);
  const I32 down = select(start > zero, bits - one, select(start == zero, i32(int32_t{-0x7fffffff}), bits + one));
  return select(toward > zero, float_from_bits(up), select(toward < zero, float_from_bits(down), start));
}

// Moves a point off its surface, to the side of the unit normal n, so that the true point of the surface, which lies within
// `error` of it in each coordinate, stays strictly behind.
// Source:   Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 6.8.6.
// Contract: origin - true point has a positive component along the exact normal, also when n is off by 2^-21.
HWY_INLINE V3 offset_origin(const V3& position, const V3& n, F32 error) {
  const F32 distance = error * (abs_(n.x) + abs_(n.y) + abs_(n.z)) * f32(1.0f + 0x1p-18f);
  return {step_toward(mul_add(distance, n.x, position.x), n.x), step_toward(mul_add(distance, n.y, position.y), n.y),
          step_toward(mul_add(distance, n.z, position.z), n.z)};
}

struct NewRay { V3 origin, direction; F32 t_max; I32 from; };
struct Differentials { V3 origin_dx, origin_dy, direction_dx, direction_dy; };

// The active lanes, or all, to the entries from n on. Writes whole vectors: up to kLanes entries past them.
template <bool kAll> struct Appender {
  Mask active;
  int n;
  template <class Lanes, class Word> HWY_INLINE void put(const Lanes& value, AlignedBuffer<Word>& to) const {
    if constexpr (kAll) value.store(to.data() + n);
    else compress_store(value, active, to.data() + n);
  }
  HWY_INLINE void put(const V3& v, AlignedBuffer<float> (&to)[3]) const { put(v.x, to[0]), put(v.y, to[1]), put(v.z, to[2]); }
};

// The rays of active lanes of surfaces i .., as rays n and on. d: nullptr, or for batches that have differentials.
HWY_INLINE void append(const SurfaceBatch& s, int i, Mask active, const NewRay& ray, const Differentials* d, RayBatch& rays,
                       AlignedBuffer<uint32_t>& surface_of_ray, int& n) {
  const auto append_by = [&](const auto& to) HWY_ATTR {
    to.put(ray.origin, rays.origin), to.put(ray.direction, rays.direction);
    to.put(ray.t_max, rays.t_max), to.put(I32::load(s.pixel + i), rays.pixel), to.put(ray.from, rays.from);
    to.put(lane_iota(i), surface_of_ray);
    if (d == nullptr) return;
    to.put(d->origin_dx, rays.origin_dx), to.put(d->origin_dy, rays.origin_dy);
    to.put(d->direction_dx, rays.direction_dx), to.put(d->direction_dy, rays.direction_dy);
  };
  if (all(active)) append_by(Appender<true>{active, n});
  else append_by(Appender<false>{active, n});
  n += count(active);
}

void resize_rays(int n, bool differentials, RayBatch& rays, AlignedBuffer<uint32_t>& surface_of_ray) {
  rays.resize(n, differentials);
  rays.from.resize(static_cast<size_t>(n));
  surface_of_ray.resize(static_cast<size_t>(n));
}

// Shadow rays of one light, appended in order of surfaces.
// Input:    Phong shading leaves out surfaces whose shading normal faces away; interpolated light (Gouraud) has no such rule.
// Contract: a surface without a ray gets nothing from this light, whatever its bit says. Rays that start above their triangle may meet
//           it like any other: it hides light that comes from far enough behind.
template <class Kind>
void shadow_rays(const Frame& frame, const SurfaceBatch& s, const Light& light, RayBatch& rays,
                 AlignedBuffer<uint32_t>& surface_of_ray) {
  const LightLanes lanes = broadcast_light(light);
  const bool by_normal = frame.settings.shading == Shading::kPhong;
  int n = rays.count;
  resize_rays(n + s.count + kLanes, false, rays, surface_of_ray);
  for (int i = 0; i < s.count; i += kLanes) {
    Mask active = active_lanes(s, i);
    if (!any(active)) continue;
    const V3 position = load3(s.position, i);
    const Incidence incidence = Kind::incidence(lanes, position);
    active = active & reached(frame, s, i, incidence, false);
    if (by_normal) active = active & (formula::dot(load3(s.normal, i), incidence.direction) > F32::zero());
    if (!any(active)) continue;
    V3 start = offset_origin(position, load3(s.geometric_normal, i), F32::load(s.position_error + i));
    I32 from = I32::load(s.primitive + i);
    if (frame.plan.lifted_rays) {
      const Mask lifted = in_front_lifted(s, i, incidence);
      start = select3(lifted, position + load3(s.lift, i), start);
      from = select(lifted, i32(kNoPrimitive), from);
    }
    const Segment segment = Kind::segment(lanes, start);
    append(s, i, active, {start, segment.direction, segment.t_max, from}, nullptr, rays, surface_of_ray, n);
  }
  resize_rays(n, false, rays, surface_of_ray);
}

// Surfaces i .. that want lifted shadow rays to one light.
HWY_INLINE Mask want_lift(const SurfaceBatch& s, int i, const V3& position, const Light& light) {
  const LightLanes lanes = broadcast_light(light);
  switch (light.kind) {
#define SPANRAY_CATALOG_ENTRY(index, name) \
  case index: return in_front_lifted(s, i, LightKind_##name::incidence(lanes, position));
#include "catalog_lights_list.inc"
#undef SPANRAY_CATALOG_ENTRY
  }
  return first_lanes(0);
}

// Unit direction of the ray that hit, and its differentials by pixel x and y.
struct RayDirection { V3 d, dx, dy; };

// Derivative of D / |D| where d = D / |D| (Igehy 1999, eq. 8).
HWY_INLINE V3 unit_derivative(const V3& d, F32 length, const V3& derivative) {
  return formula::divide_or_zero(derivative - formula::dot(d, derivative) * d, length);
}

HWY_INLINE RayDirection ray_direction(const Frame& frame, const SurfaceBatch& s, const HitBatch& hits, Mask active, int i) {
  const V3 d = -load3(s.view, i);
  if (hits.rays == nullptr) {
    const PrimaryRays& p = frame.primary;
    const auto [x, y] = places_of(I32::load(s.pixel + i), offsets_of(frame, hits, i));
    const V3 whole = {to_f32(f64(p.corner.x) + x * f64(p.step_x.x) + y * f64(p.step_y.x)),
                      to_f32(f64(p.corner.y) + x * f64(p.step_x.y) + y * f64(p.step_y.y)),
                      to_f32(f64(p.corner.z) + x * f64(p.step_x.z) + y * f64(p.step_y.z))};
    const F32 length = formula::length(whole);
    const auto step = [&](const glm::dvec3& one) HWY_ATTR -> V3 {
      return {to_f32(f64(one.x * frame.footprint)), to_f32(f64(one.y * frame.footprint)), to_f32(f64(one.z * frame.footprint))};
    };
    const V3 step_x = step(p.step_x), step_y = step(p.step_y);
    return {d, unit_derivative(d, length, step_x), unit_derivative(d, length, step_y)};
  }
  const RayBatch& rays = *hits.rays;
  const V3 zero = {F32::zero(), F32::zero(), F32::zero()};
  if (rays.direction_dx[0].empty()) return {d, zero, zero};
  const I32 ray = select(active, I32::load(s.ray + i), I32::zero());
  const auto at = [ray](const AlignedBuffer<float>* a) HWY_ATTR -> V3 {
    return {gather(a[0].data(), ray), gather(a[1].data(), ray), gather(a[2].data(), ray)};
  };
  const F32 length = formula::length(at(rays.direction));
  return {d, unit_derivative(d, length, at(rays.direction_dx)), unit_derivative(d, length, at(rays.direction_dy))};
}

// n.r of mirror rays, by the geometric normal, is at least this: a shading normal may point a mirror ray into its own surface.
constexpr float kHorizon = 0x1p-10f;

// r = d - 2 (d.n) n, lifted above the horizon of the geometric normal.
HWY_INLINE V3 mirror_direction(const V3& d, const V3& n, const V3& geometric_normal) {
  const F32 twice = f32(-2.0f) * formula::dot(d, n);
  const V3 r = {mul_add(twice, n.x, d.x), mul_add(twice, n.y, d.y), mul_add(twice, n.z, d.z)};
  const F32 missing = max_(f32(kHorizon) - formula::dot(geometric_normal, r), F32::zero());
  return r + missing * geometric_normal;
}

// dr = dd - 2 [(d.n) dn + (dd.n + d.dn) n] with dn = 0.
HWY_INLINE V3 mirror_differential(const V3& dd, const V3& n) {
  return dd + (f32(-2.0f) * formula::dot(dd, n)) * n;
}

}  // namespace

void make_shadow_rays_entry(const Frame& frame, const SurfaceBatch& s, int light, RayBatch& rays,
                            AlignedBuffer<uint32_t>& surface_of_ray) {
  const Light& l = light_of(frame, light);
  switch (l.kind) {
#define SPANRAY_CATALOG_ENTRY(index, name) \
  case index: return shadow_rays<LightKind_##name>(frame, s, l, rays, surface_of_ray);
#include "catalog_lights_list.inc"
#undef SPANRAY_CATALOG_ENTRY
  }
}

// From surfaces up to where their lifted rays start, and on by 2^-10 of the way: what lies at that place itself is met by this ray,
// since a ray meets nothing where it starts.
void make_lift_rays_entry(const Frame& frame, const SurfaceBatch& s, RayBatch& rays, AlignedBuffer<uint32_t>& surface_of_ray) {
  int n = 0;
  resize_rays(s.count + kLanes, false, rays, surface_of_ray);
  for (int i = 0; i < s.count; i += kLanes) {
    const Mask liftable = has_lift(s, i) & active_lanes(s, i);
    if (!any(liftable)) continue;
    const V3 position = load3(s.position, i);
    Mask active = first_lanes(0);
    for (int light = 0; light < static_cast<int>(frame.scene->lights.size()); ++light)
      active = active | want_lift(s, i, position, light_of(frame, light));
    active = active & liftable;
    if (!any(active)) continue;
    const V3 start = offset_origin(position, load3(s.geometric_normal, i), F32::load(s.position_error + i));
    const V3 way = position + load3(s.lift, i) - start;
    append(s, i, active, {start, way, f32(1.0f + 0x1p-10f), I32::load(s.primitive + i)}, nullptr, rays, surface_of_ray, n);
  }
  resize_rays(n, false, rays, surface_of_ray);
}

// Mirror rays about the shading normal, appended in order of surfaces.
// Source:   Igehy 1999, "Tracing Ray Differentials", eqs. 13-15. The normal's own differential is taken as 0: footprints in
//           curved mirrors are those of the tangent plane's mirror.
// Output:   directions, unit length but where lifted over the horizon; t_max infinite.
// Contract: n_g.r > 0.
void make_bounce_rays_entry(const Frame& frame, const SurfaceBatch& s, const HitBatch& hits, RayBatch& rays,
                            AlignedBuffer<uint32_t>& surface_of_ray) {
  int n = rays.count;
  resize_rays(n + s.count + kLanes, true, rays, surface_of_ray);
  for (int i = 0; i < s.count; i += kLanes) {
    const V3 mirror = load3(s.mirror, i);
    const F32 zero = F32::zero();
    const Mask active = active_lanes(s, i) & ((mirror.x > zero) | (mirror.y > zero) | (mirror.z > zero));
    if (!any(active)) continue;
    const V3 normal = load3(s.normal, i), geometric_normal = load3(s.geometric_normal, i);
    const RayDirection ray = ray_direction(frame, s, hits, active, i);
    const NewRay mirrored = {offset_origin(load3(s.position, i), geometric_normal, F32::load(s.position_error + i)),
                             mirror_direction(ray.d, normal, geometric_normal), f32(kInfinity), I32::load(s.primitive + i)};
    const Differentials differentials = {load3(s.dpdx, i), load3(s.dpdy, i), mirror_differential(ray.dx, normal),
                                         mirror_differential(ray.dy, normal)};
    append(s, i, active, mirrored, &differentials, rays, surface_of_ray, n);
  }
  resize_rays(n, true, rays, surface_of_ray);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {
const MakeShadowRaysFn kMakeShadowRays[kIsaCount] = SPANRAY_KERNEL_TABLE(make_shadow_rays_entry);
const MakeLiftRaysFn kMakeLiftRays[kIsaCount] = SPANRAY_KERNEL_TABLE(make_lift_rays_entry);
const MakeBounceRaysFn kMakeBounceRays[kIsaCount] = SPANRAY_KERNEL_TABLE(make_bounce_rays_entry);
}  // namespace spanray
#endif
