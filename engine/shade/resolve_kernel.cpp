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
void store_footprint(const Group& g, float* const field[3], const V3d& derivative) {
  const F32 limit = f32(0x1p62f);
  const V3f d = to_f32(derivative);
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

// Everything about kLanes hits of rays that are not primary.
HWY_INLINE PointLanes secondary_point(const Frame& frame, const HitLanes& hits) {
  const SceneData& scene = *frame.scene;
  const RayLanes ray = load_rays(frame, hits);
  const TriangleLanes t = load_triangles(scene, hits);
  const SurfaceLanes s = resolve_lanes(ray, t);
  const F64 distance = hit_t(s, ray);
  PointLanes point;
  point.position = to_f32(s.position);
  point.position_error = position_error(s, t);
  point.t = to_f32(distance);
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
    const DifferentialLanes d = load_differentials(frame, hits);
    point.dpdx = transfer(d.origin_dx, d.direction_dx, distance, ray, s.normal);
    point.dpdy = transfer(d.origin_dy, d.direction_dy, distance, ray, s.normal);
    if (reads_textures(frame)) point.uv = resolve_uv(frame, t, s, point.dpdx, point.dpdy);
  }
  point.material = t.bits & i32(kTriangleMaterialMask);
  return point;
}

void store_surface(const Frame& frame, const HitBatch& hits, int at, Mask valid, const PointLanes& point, SurfaceBatch& out) {
  Group g{frame, valid, {}, reads_textures(frame) ? &point.uv : nullptr, at};
  g.material = record_lanes(point.material, kMaterialStride, all(point.material == i32(first_lane(point.material))));
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
  put(g, out.pixel, I32::load(hits.pixel.data() + at));
  put(g, out.ray, secondary(hits.rays) != nullptr ? I32::load(hits.ray.data() + at) : i32(0));
  put(g, out.primitive, I32::load(hits.primitive.data() + at));
  put(g, out.material, point.material);
  put(g, out.valid, i32(1));
  put(g, out.view, point.view);
  put(g, out.geometric_normal, point.geometric);
  const V3f normal = frame.plan.bump ? bumped_normal(g, point.normal) : point.normal;
  put(g, out.normal, clamp_to_horizon(normal, point.geometric));
  resolve_diffuse(g, out);
  resolve_specular(g, out);
  resolve_emission_and_opacity(g, out);
}

void resolve_primary(const Frame& frame, const HitBatch& hits, SurfaceBatch& out) {
  SetupBlock block;
  for (int begin = 0; begin < hits.count; begin += kBlockHits) {
    const int count = hits.count - begin < kBlockHits ? hits.count - begin : kBlockHits;
    set_up_block(frame, hits, begin, count, block);
    for (int i = 0; i < count; i += kLanes) {
      const int at = begin + i;
      const Mask valid = first_lanes(count - i) & (I32::load(hits.primitive.data() + at) != i32(kNoPrimitive));
      if (!any(valid)) {
        store_zeros(Group{frame, valid, {}, nullptr, at}, out);
        continue;
      }
      const PlaceLanes place = places_of(frame, hits, I32::load(hits.pixel.data() + at), at);
      store_surface(frame, hits, at, valid, primary_point(frame, load_setup(block, i), place), out);
    }
  }
}

}  // namespace

// Recomputes the surface of every hit of a batch, kLanes at a time.
// Source:   DESIGN 1; the steps cite theirs.
// Input:    hits.count entries; out.count == hits.count.   Output: every field of out.
// Contract: each entry is a function of its own ray, primitive and the frame alone: lanes, order and batch size change no bit.
void resolve(const Frame& frame, const HitBatch& hits, SurfaceBatch& out) {
  if (secondary(hits.rays) == nullptr && !frame.scene->triangles.empty()) return resolve_primary(frame, hits, out);
  for (int at = 0; at < hits.count; at += kLanes) {
    const HitLanes lanes = load_hits(hits, at);
    if (any(lanes.valid)) store_surface(frame, hits, at, lanes.valid, secondary_point(frame, lanes), out);
    else store_zeros(Group{frame, lanes.valid, {}, nullptr, at}, out);
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
