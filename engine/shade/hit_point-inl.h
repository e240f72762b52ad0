// From hits to points, before their materials: of primary rays by planes, of all others one by one. Include inside a *_kernel.cpp.
#if defined(SPANRAY_HIT_POINT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_HIT_POINT_INL_H_
#undef SPANRAY_HIT_POINT_INL_H_
#else
#define SPANRAY_HIT_POINT_INL_H_
#endif

#include "shade/plane_finder-inl.h"
#include "shade/primary-inl.h"
#include "shade/texture_use-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace surface_lanes {

// Entries at .. at + kLanes - 1 of a batch.
HWY_INLINE HitLanes load_hits(const SceneData& scene, const HitBatch& hits, int at) {
  HitLanes h;
  h.rays = hits.rays;
  h.primitive = I32::load(hits.primitive.data() + at);
  h.valid = triangles_at(scene, hits, at);
  h.pixel = I32::load(hits.pixel.data() + at);
  h.ray = secondary(hits.rays) != nullptr ? select(h.valid, I32::load(hits.ray.data() + at), i32(0)) : i32(0);
  const uint32_t lanes = to_bits(h.valid);
  // Lanes without a hit follow the first that has one: any primitive that may be read.
  h.first_primitive = lanes == 0 ? 0 : hits.primitive[static_cast<size_t>(at + __builtin_ctz(lanes))];
  h.primitive = select(h.valid, h.primitive, i32(h.first_primitive));
  h.uniform = all(h.primitive == i32(h.first_primitive));
  h.first_primitive = static_cast<uint32_t>(first_lane(h.primitive));
  return h;
}

// Everything about kLanes hits of any rays, each from its own setup in double. differentials(): only called where they are used.
// forward: t is the view depth; nullptr: the distance along the ray.
template <class Differentials>
HWY_INLINE PointLanes point_of(const Frame& frame, const HitLanes& hits, const RayLanes& ray, const glm::dvec3* forward,
                               const Differentials& differentials) {
  const SceneData& scene = *frame.scene;
  const TriangleLanes t = load_triangles(scene, hits);
  const SurfaceLanes s = resolve_lanes(ray, t);
  const F64 distance = hit_t(s, ray);
  PointLanes point;
  point.position = to_f32(s.position);
  point.position_error = position_error(s, t);
  point.t = to_f32(forward != nullptr ? dot(s.position - ray.origin, broadcast(*forward)) : distance);
  point.weight = {to_f32(s.b0), to_f32(s.b1), to_f32(s.b2)};
  // From the shaded point, not along the ray: a ray whose weights were clamped may pass below the triangle's horizon.
  const V3f none{F32::zero(), F32::zero(), F32::zero()};
  point.view = unit_or(ray.origin - s.position, none);
  const Mask at_origin = !(dot(point.view, point.view) > F32::zero());
  if (any(at_origin)) point.view = select(at_origin, unit_or(-ray.direction, none), point.view);
  const V3f unit = geometric_normal(t, s.normal, s.from_origin);
  point.geometric = select(dot(unit, unit) > F32::zero(), unit, point.view);
  point.normal = point.geometric;
  if (frame.settings.shading != Shading::kFlat)
    point.normal = interpolated_normal(frame, corner_normals(scene, t, point.geometric), point.weight.y, point.weight.z,
                                       point.geometric);
  point.material = t.bits & i32(kTriangleMaterialMask);
  const I32 flags = reads_textures(frame) ? flags_of_materials(frame, point.material) : I32::zero();
  point.mapped = any_flag(flags, kMaterialMapped);
  if (point.mapped || frame.plan.bounces) {
    const DifferentialLanes d = differentials();
    const V3d dpdx = transfer(d.origin_dx, d.direction_dx, distance, ray, s.normal);
    const V3d dpdy = transfer(d.origin_dy, d.direction_dy, distance, ray, s.normal);
    if (point.mapped) point.uv = resolve_uv(scene, t, s, dpdx, dpdy, frame.plan.bump && any_flag(flags, kMaterialBumped));
    point.dpdx = to_f32(dpdx), point.dpdy = to_f32(dpdy);
  }
  return point;
}

// Lanes of primary hits that planes do not serve (primary_point).
[[maybe_unused]] static HWY_NOINLINE void resolve_odd(const Frame& frame, const HitLanes& hits, const OffsetLanes& offset, Mask good,
                                                      PointLanes& point) {
  const PrimaryRays& p = frame.primary;
  const auto [x, y] = places_of(hits.pixel, offset);
  const RayLanes ray = {broadcast(p.eye), broadcast(p.corner) + broadcast(p.step_x) * x + broadcast(p.step_y) * y};
  const V3d zero{f64(0.0), f64(0.0), f64(0.0)};
  const F64 side = f64(frame.footprint);
  PointLanes odd = point_of(frame, hits, ray, &p.forward, [&]() HWY_ATTR {
    return DifferentialLanes{zero, zero, broadcast(p.step_x) * side, broadcast(p.step_y) * side};
  });
  const auto take = [&](auto& field, const auto& other) HWY_ATTR { field = select(good, field, other); };
  take(point.position, odd.position), take(point.position_error, odd.position_error);
  if (frame.plan.depths) take(point.t, odd.t);
  take(point.weight, odd.weight), take(point.view, odd.view), take(point.geometric, odd.geometric), take(point.normal, odd.normal);
  if (frame.plan.bounces) take(point.dpdx, odd.dpdx), take(point.dpdy, odd.dpdy);
  if (!point.mapped || !odd.mapped) return;  // lanes without maps read nothing
  UvLanes& uv = point.uv;
  take(uv.u, odd.uv.u), take(uv.v, odd.uv.v), take(uv.whole_u, odd.uv.whole_u), take(uv.whole_v, odd.uv.whole_v);
  take(uv.du_dx, odd.uv.du_dx), take(uv.dv_dx, odd.uv.dv_dx), take(uv.du_dy, odd.uv.du_dy), take(uv.dv_dy, odd.uv.dv_dy);
  if (frame.plan.bump) take(uv.tangent_u, odd.uv.tangent_u), take(uv.tangent_v, odd.uv.tangent_v);
}

// put_triangle_light (primary-inl.h) for lanes whose triangles have no area: only their hits know where these face.
template <class To>
HWY_NOINLINE void put_light_without_area(const Frame& frame, int lights, const To& to, Mask lanes, const HitLanes& hits,
                                         const PointLanes& point) {
  const light_lanes::Viewer eye = light_lanes::eye_of(frame);
  const light_lanes::V3 geometric = as_vec3(point.geometric), weight = as_vec3(point.weight);
  for (int i = 0; i < lights; ++i)
    light_lanes::with_kind(light_of(frame, i), [&](auto kind) HWY_ATTR {
      using Kind = decltype(kind);
      const light_lanes::LightLanes light = light_lanes::broadcast_light(light_of(frame, i));
      const light_lanes::Reflected r = frame.settings.shading == Shading::kGouraud
                                           ? light_lanes::light_triangles<Kind>(frame, light, hits.primitive, point.material, eye, geometric, weight, lanes)
                                           : light_lanes::light_faces<Kind>(frame, light, hits.primitive, point.material, eye, geometric);
      const auto put = [&](int factor, F32 value) HWY_ATTR { select(lanes, value, F32::load(to(i, factor))).store(to(i, factor)); };
      put(0, r.diffuse);
      if (frame.plan.specular) put(1, r.specular);
    });
}

// The points of hits at .. at + kLanes - 1 of primary rays, those in `valid`, from their planes; with the light that their triangles carry.
// to(light, factor): where the kLanes floats of SurfaceBatch::triangle_light go, for that many lights.
template <class Planes, class To>
HWY_INLINE void resolve_primary(const Frame& frame, const HitBatch& hits, int at, Mask valid, const Planes& planes, int lights,
                                const To& to, PointLanes& point) {
  const OffsetLanes offset = offsets_of(frame, hits, at);
  const Mask good = primary_point(frame, planes, I32::load(hits.pixel.data() + at), offset, point);
  const Mask odd = and_not(good, valid);
  if (!any(odd)) return put_triangle_light(frame, lights, to, planes, point.weight);
  const HitLanes lanes = load_hits(*frame.scene, hits, at);
  PointLanes mended = point;  // a copy has an address, so that the point itself may stay in registers
  resolve_odd(frame, lanes, offset, good, mended);
  const Mask without_area = odd & !(dot(point.geometric, point.geometric) > F32::zero());
  point = mended;
  put_triangle_light(frame, lights, to, planes, point.weight);
  if (lights > 0 && any(without_area)) put_light_without_area(frame, lights, to, without_area, lanes, mended);
}

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_HIT_POINT_INL_H_
