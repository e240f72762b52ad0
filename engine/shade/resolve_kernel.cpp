// Hits -> surfaces: the two ways of resolving, then the material of either.
#include <cstddef>

#include "shade/surface_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/resolve_kernel.cpp"
#include "hwy/foreach_target.h"
#include "shade/material-inl.h"
#include "shade/primary-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
using namespace surface_lanes;
namespace {

void store_zeros(const Group& g, const SurfaceBatch& out) {
  const V3f zero{F32::zero(), F32::zero(), F32::zero()};
  for (float* const* v : {out.position, out.geometric_normal, out.normal, out.view, out.weight, out.dpdx, out.dpdy, out.ambient,
                          out.diffuse, out.specular, out.emission, out.mirror})
    put(g, v, zero);
  for (float* f : {out.position_error, out.t, out.shininess, out.opacity}) put(g, f, zero.x);
  for (uint32_t* w : {out.pixel, out.ray, out.primitive, out.material, out.valid}) put(g, w, I32::zero());
}

// Footprint, held below the square root of the largest float so that its length is finite.
void store_footprint(const Group& g, float* const field[3], const V3f& d) {
  const F32 limit = f32(0x1p62f);
  put(g, field, {clamp_(d.x, -limit, limit), clamp_(d.y, -limit, limit), clamp_(d.z, -limit, limit)});
}

HitLanes load_hits(const HitBatch& hits, int at) {
  HitLanes h;
  h.rays = hits.rays;
  h.primitive = I32::load(hits.primitive.data() + at);
  const int left = hits.count - at;
  h.valid = first_lanes(left < kLanes ? left : kLanes) & (h.primitive != i32(kNoPrimitive));
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
    point.normal = interpolated_normal(corner_normals(scene, t, point.geometric), point.weight.y, point.weight.z, point.geometric);
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
  take(point.position, odd.position), take(point.position_error, odd.position_error), take(point.t, odd.t);
  take(point.weight, odd.weight), take(point.view, odd.view), take(point.geometric, odd.geometric), take(point.normal, odd.normal);
  if (frame.plan.bounces) take(point.dpdx, odd.dpdx), take(point.dpdy, odd.dpdy);
  if (!reads_textures(frame)) return;
  UvLanes& uv = point.uv;
  take(uv.u, odd.uv.u), take(uv.v, odd.uv.v), take(uv.whole_u, odd.uv.whole_u), take(uv.whole_v, odd.uv.whole_v);
  take(uv.du_dx, odd.uv.du_dx), take(uv.dv_dx, odd.uv.dv_dx), take(uv.du_dy, odd.uv.du_dy), take(uv.dv_dy, odd.uv.dv_dy);
  if (frame.plan.bump) take(uv.tangent_u, odd.uv.tangent_u), take(uv.tangent_v, odd.uv.tangent_v);
}

// Everything but what maps say.
void store_point(SurfaceBlock& block, const HitBatch& hits, int i, Mask valid, const PointLanes& point) {
  const Frame& frame = block.frame;
  const SurfaceBatch& out = block.out;
  const bool one_material = all(point.material == i32(first_lane(point.material)));
  const Group g{frame, valid, record_lanes(point.material, kMaterialStride, one_material), block.begin + i};
  put(g, out.position, point.position);
  put(g, out.position_error, point.position_error);
  put(g, out.t, point.t);
  put(g, out.weight, point.weight);
  const V3f none{F32::zero(), F32::zero(), F32::zero()};
  if (frame.plan.bounces) {
    store_footprint(g, out.dpdx, point.dpdx);
    store_footprint(g, out.dpdy, point.dpdy);
  } else {
    put(g, out.dpdx, none);
    put(g, out.dpdy, none);
  }
  put(g, out.pixel, I32::load(hits.pixel.data() + g.at));
  put(g, out.ray, secondary(hits.rays) != nullptr ? I32::load(hits.ray.data() + g.at) : i32(0));
  put(g, out.primitive, I32::load(hits.primitive.data() + g.at));
  put(g, out.material, point.material);
  put(g, out.valid, i32(1));
  put(g, out.view, point.view);
  put(g, out.geometric_normal, point.geometric);
  put(g, out.normal, frame.plan.bump ? point.normal : clamp_to_horizon(point.normal, point.geometric));
  put_constants(g, out);
  if (reads_textures(frame)) block.uv.store(i, point.uv, frame.plan.bump);
}

// find(lanes, i, point): the points of entries i .. of the block.
template <class Find> HWY_INLINE void store_points(SurfaceBlock& block, const HitBatch& hits, const Find& find) {
  for (int i = 0; i < block.count; i += kLanes) {
    const HitLanes lanes = load_hits(hits, block.begin + i);
    if (!any(lanes.valid)) {
      store_zeros(Group{block.frame, lanes.valid, {}, block.begin + i}, block.out);
      continue;
    }
    PointLanes point;
    find(lanes, i, point);
    store_point(block, hits, i, lanes.valid, point);
  }
}

void resolve_primary(SurfaceBlock& block, const HitBatch& hits, PlaneBlock& planes) {
  const Frame& frame = block.frame;
  set_up_block(frame, hits, block.begin, block.count, planes);
  store_points(block, hits, [&](const HitLanes& lanes, int i, PointLanes& point) HWY_ATTR {
    const OffsetLanes offset = offsets_of(frame, hits, block.begin + i);
    const Mask good = primary_point(frame, planes, i, lanes.pixel, offset, point);
    if (any(and_not(good, lanes.valid))) resolve_odd(frame, lanes, offset, good, point);
  });
}

void resolve_secondary(SurfaceBlock& block, const HitBatch& hits) {
  const Frame& frame = block.frame;
  store_points(block, hits, [&](const HitLanes& lanes, int, PointLanes& point) HWY_ATTR {
    point = point_of(frame, lanes, load_rays(frame, lanes), nullptr, [&]() HWY_ATTR { return load_differentials(frame, lanes); });
  });
}

}  // namespace

// Recomputes the surface of every hit of a batch, kLanes at a time.
// Source:   DESIGN 1; the steps cite theirs.
// Input:    hits.count entries; out.count == hits.count.   Output: every field of out.
// Contract: each entry is a function of its own ray, primitive and the frame alone: lanes, order and batch size change no bit.
void resolve(const Frame& frame, const HitBatch& hits, SurfaceBatch& out) {
  const bool primary = secondary(hits.rays) == nullptr && !frame.scene->triangles.empty();
  SurfaceBlock block(frame, out);
  PlaneBlock planes;
  for (; block.begin < hits.count; block.begin += kBlockHits) {
    block.count = hits.count - block.begin < kBlockHits ? hits.count - block.begin : kBlockHits;
    if (primary) resolve_primary(block, hits, planes);
    else resolve_secondary(block, hits);
    apply_maps(block);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {

const ResolveFn kResolve[kIsaCount] = SPANRAY_KERNEL_TABLE(resolve);

void resolve_surfaces(const Frame& frame, const HitBatch& hits, SurfaceBatch& out) {
  out.resize(hits.count);
  kResolve[isa_index(frame.isa)](frame, hits, out);
}

}  // namespace spanray
#endif
