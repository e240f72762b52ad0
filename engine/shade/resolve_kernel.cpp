// Hits -> surfaces: the two ways of resolving, then the material of either.
#include <cstddef>

#include "shade/exact_surface.h"
#include "shade/surface_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/resolve_kernel.cpp"
#include "hwy/foreach_target.h"
#include "shade/lift-inl.h"
#include "shade/material-inl.h"
#include "shade/primary-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
using namespace surface_lanes;
namespace {

// Zeros in lanes that are not valid.
HWY_NOINLINE void clear_misses(const SurfaceBatch& out, int at, Mask valid) {
  const auto clear = [&](float* field) HWY_ATTR { select(valid, F32::load(field + at), F32::zero()).store(field + at); };
  for (float* const* v : {out.position, out.geometric_normal, out.normal, out.view, out.weight, out.dpdx, out.dpdy, out.ambient,
                          out.diffuse, out.specular, out.emission, out.mirror, out.lift, out.smooth_normal})
    for (int k = 0; k < 3; ++k) clear(v[k]);
  for (float* f : {out.position_error, out.t, out.shininess, out.opacity}) clear(f);
  for (uint32_t* w : {out.pixel, out.ray, out.primitive, out.material, out.valid})
    select(valid, I32::load(w + at), I32::zero()).store(w + at);
}

// Footprint, held below the square root of the largest float so that its length is finite.
HWY_INLINE void store_footprint(const Group& g, float* const field[3], const V3f& d) {
  const F32 limit = f32(0x1p62f);
  put(g, field, {clamp_(d.x, -limit, limit), clamp_(d.y, -limit, limit), clamp_(d.z, -limit, limit)});
}

HitLanes load_hits(const SceneData& scene, const HitBatch& hits, int at) {
  HitLanes h;
  h.rays = hits.rays;
  h.primitive = I32::load(hits.primitive.data() + at);
  const int left = hits.count - at;
  h.valid = first_lanes(left < kLanes ? left : kLanes) & hits_triangle(scene, h.primitive);
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
  if (reads_textures(frame) || frame.plan.bounces) {
    const DifferentialLanes d = differentials();
    const V3d dpdx = transfer(d.origin_dx, d.direction_dx, distance, ray, s.normal);
    const V3d dpdy = transfer(d.origin_dy, d.direction_dy, distance, ray, s.normal);
    if (reads_textures(frame)) point.uv = resolve_uv(frame, t, s, dpdx, dpdy);
    point.dpdx = to_f32(dpdx), point.dpdy = to_f32(dpdy);
  }
  point.material = t.bits & i32(kTriangleMaterialMask);
  return point;
}

// Lanes of primary hits that planes do not serve (primary_point).
HWY_NOINLINE void resolve_odd(const Frame& frame, const HitLanes& hits, const OffsetLanes& offset, Mask good, PointLanes& point) {
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
  if (!reads_textures(frame)) return;
  UvLanes& uv = point.uv;
  take(uv.u, odd.uv.u), take(uv.v, odd.uv.v), take(uv.whole_u, odd.uv.whole_u), take(uv.whole_v, odd.uv.whole_v);
  take(uv.du_dx, odd.uv.du_dx), take(uv.dv_dx, odd.uv.dv_dx), take(uv.du_dy, odd.uv.du_dy), take(uv.dv_dy, odd.uv.dv_dy);
  if (frame.plan.bump) take(uv.tangent_u, odd.uv.tangent_u), take(uv.tangent_v, odd.uv.tangent_v);
}

// What the material does not say. uv stays behind for its maps.
HWY_INLINE void store_point(const Frame& frame, const SurfaceBatch& out, int at, const HitLanes& lanes, const PointLanes& point, UvLanes& uv) {
  const Group g{frame, out, at, lanes.valid, {}};
  put(g, out.position, point.position);
  put(g, out.position_error, point.position_error);
  if (out.fields & kSurfaceDepth) put(g, out.t, point.t);
  if (out.fields & kSurfaceWeight) put(g, out.weight, point.weight);
  if (out.fields & kSurfaceFootprint) {
    store_footprint(g, out.dpdx, point.dpdx);
    store_footprint(g, out.dpdy, point.dpdy);
  }
  put(g, out.pixel, lanes.pixel);
  put(g, out.ray, lanes.ray);
  put(g, out.primitive, lanes.primitive);
  put(g, out.material, point.material);
  put(g, out.valid, i32(1));
  if (out.fields & kSurfaceView) put(g, out.view, point.view);
  put(g, out.geometric_normal, point.geometric);
  if (out.fields & kSurfaceNormal)
    put(g, out.normal, frame.plan.bump ? point.normal : clamp_to_horizon(point.normal, point.geometric));
  if (reads_textures(frame)) uv = point.uv;
}

// The rest of a stored point.
void store_material(const Frame& frame, const SurfaceBatch& out, int at, const HitLanes& lanes, const UvLanes& uv) {
  const I32 material = I32::load(out.material + at);
  const bool one_material = all(material == i32(first_lane(material)));
  const Group g{frame, out, at, lanes.valid, record_lanes(material, kMaterialStride, one_material)};
  if (frame.plan.bump) put(g, out.normal, clamp_to_horizon(bumped_normal(g, uv, get(g, out.normal)), get(g, out.geometric_normal)));
  MaterialLanes m = constants_of(g);
  if (reads_textures(frame)) apply_maps(g, uv, m);
  put_material(g, m);
}

// put_triangle_light (primary-inl.h) for lanes whose triangles have no area: only their hits know where these face.
HWY_NOINLINE void put_light_without_area(const Frame& frame, const SurfaceBatch& out, int at, Mask lanes, const HitLanes& hits, const PointLanes& point) {
  const light_lanes::Viewer eye = light_lanes::eye_of(frame);
  const light_lanes::V3 geometric = as_vec3(point.geometric), weight = as_vec3(point.weight);
  for (int i = 0; i < out.lights; ++i)
    light_lanes::with_kind(light_of(frame, i), [&](auto kind) HWY_ATTR {
      using Kind = decltype(kind);
      const light_lanes::LightLanes light = light_lanes::broadcast_light(light_of(frame, i));
      const light_lanes::Reflected r = frame.settings.shading == Shading::kGouraud
                                           ? light_lanes::light_triangles<Kind>(frame, light, hits.primitive, point.material, eye, geometric, weight, lanes)
                                           : light_lanes::light_faces<Kind>(frame, light, hits.primitive, point.material, eye, geometric);
      const auto put = [&](int factor, F32 value) HWY_ATTR {
        float* const to = out.triangle_light(i, factor) + at;
        select(lanes, value, F32::load(to)).store(to);
      };
      put(0, r.diffuse);
      if (frame.plan.specular) put(1, r.specular);
    });
}

template <class Planes>
HWY_INLINE void store_primary(const Frame& frame, const HitBatch& hits, const SurfaceBatch& out, int at, const HitLanes& lanes,
                              const Planes& planes, UvLanes& uv) {
  const OffsetLanes offset = offsets_of(frame, hits, at);
  PointLanes point;
  const Mask good = primary_point(frame, planes, lanes.pixel, offset, point);
  const Mask odd = and_not(good, lanes.valid);
  if (any(odd)) {
    PointLanes mended = point;  // a copy has an address, so that the point itself may stay in registers
    resolve_odd(frame, lanes, offset, good, mended);
    const Mask without_area = odd & !(dot(point.geometric, point.geometric) > F32::zero());
    point = mended;
    put_triangle_light(frame, out, at, planes, point.weight);
    if (out.lights > 0 && any(without_area)) put_light_without_area(frame, out, at, without_area, lanes, mended);
  } else {
    put_triangle_light(frame, out, at, planes, point.weight);
  }
  store_point(frame, out, at, lanes, point, uv);
}

}  // namespace

// Recomputes the surface of every hit of a batch, kLanes at a time.
// Source:   DESIGN 1; the steps cite theirs.
// Input:    hits.count entries; out.count == hits.count.   Output: every field of out, of the optional ones those in out.fields;
//           0 where a ray hit no triangle.
// Contract: each entry is a function of its own ray, primitive and the frame alone: lanes, order and batch size change no bit.
void resolve(const Frame& frame, const HitBatch& hits, SurfaceBatch& out) {
  const bool primary = secondary(hits.rays) == nullptr && !frame.scene->triangles.empty();
  PlaneBlock planes(out.planes, light_fields_of(frame, out.lights));
  int misses = 0;
  for (int at = 0; at < hits.count; at += kLanes) {
    if (primary && at % kPlaneHits == 0) {
      set_up_block(frame, hits, at, planes);
      const int vectors = (planes.planes + kLanes - 1) / kLanes;
      out.plane_lanes.add({static_cast<uint64_t>(vectors * kLanes), static_cast<uint64_t>(planes.planes)});
    }
    const HitLanes lanes = load_hits(*frame.scene, hits, at);
    UvLanes uv;
    if (any(lanes.valid)) {
      if (primary)
        with_planes(planes, at % kPlaneHits, [&](const auto& of_hits) HWY_ATTR { store_primary(frame, hits, out, at, lanes, of_hits, uv); });
      else
        store_point(frame, out, at, lanes, point_of(frame, lanes, load_rays(frame, lanes), nullptr, [&]() HWY_ATTR {
                      return load_differentials(frame, lanes);
                    }), uv);
      store_material(frame, out, at, lanes, uv);
      if (out.fields & kSurfaceLift) store_lift(frame, out, at, lanes);
    }
    const int left = hits.count - at;
    const Mask missed = and_not(lanes.valid, first_lanes(left < kLanes ? left : kLanes));
    if (any(missed)) clear_misses(out, at, lanes.valid), misses += count(missed);
  }
  out.surface_lanes = {static_cast<uint64_t>((hits.count + kLanes - 1) / kLanes * kLanes), static_cast<uint64_t>(hits.count - misses)};
}

}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {

namespace {
uint32_t surface_fields(const PlanFlags& plan) {
  return (plan.ambient ? kSurfaceAmbient : 0u) | (plan.emission ? kSurfaceEmission : 0u) | (plan.bounces ? kSurfaceMirror | kSurfaceFootprint : 0u) |
         (plan.depths ? kSurfaceDepth : 0u) | (plan.weights ? kSurfaceWeight : 0u) | (plan.lifted_rays ? kSurfaceLift : 0u) |
         (plan.normals ? kSurfaceNormal : 0u) | (plan.views ? kSurfaceView : 0u);
}

// Whether light can be a matter of triangles: not where a map says how sharp a flat face's highlight is, pixel by pixel.
bool carry_light(const Frame& frame, const HitBatch& hits) {
  if (hits.rays != nullptr || frame.settings.shading == Shading::kPhong) return false;
  const bool mapped = frame.plan.textures && frame.plan.specular && (frame.plan.maps & kMapShininess) != 0;
  return frame.settings.shading == Shading::kGouraud || !mapped;
}
}  // namespace

const ResolveFn kResolve[kIsaCount] = SPANRAY_KERNEL_TABLE(resolve);

void resolve_surfaces(const Frame& frame, const HitBatch& hits, SurfaceBatch& out) {
  out.resize(hits.count, surface_fields(frame.plan), carry_light(frame, hits) ? static_cast<int>(frame.scene->lights.size()) : 0);
  if (frame.scene->has_exact()) return resolve_with_exact(frame, hits, out);
  kResolve[isa_index(frame.isa)](frame, hits, out);
}

}  // namespace spanray
#endif
