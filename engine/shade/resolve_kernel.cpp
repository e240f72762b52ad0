// Hits -> surfaces: the two ways of resolving, then the material of either.
#include <cstddef>

#include "shade/exact_surface.h"
#include "shade/surface_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/resolve_kernel.cpp"
#include "hwy/foreach_target.h"
#include "shade/lift-inl.h"
#include "shade/material-inl.h"
#include "shade/hit_point-inl.h"

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

// What the material does not say. uv stays behind for its maps.
HWY_INLINE void store_point(const Frame& frame, const SurfaceBatch& out, int at, const HitLanes& lanes, const PointLanes& point, UvLanes& uv) {
  const Group g{{frame, lanes.valid, {}}, out, at};
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
  if (point.mapped) uv = point.uv;
}

// The rest of a stored point.
void store_material(const Frame& frame, const SurfaceBatch& out, int at, const HitLanes& lanes, const UvLanes& uv, PlainTextures& plain) {
  const I32 material = I32::load(out.material + at);
  const bool one_material = all(material == i32(first_lane(material)));
  PlainSample sample;
  const Group g{{frame, lanes.valid, record_lanes(material, kMaterialStride, one_material), &plain, &sample}, out, at};
  if (frame.plan.bump) put(g, out.normal, clamp_to_horizon(bumped_normal(g, uv, get(g, out.normal)), get(g, out.geometric_normal)));
  MaterialLanes m = constants_of(g);
  if (reads_textures(frame)) apply_maps(g, uv, m, frame.plan.translucents);
  put_material(g, m);
}

template <class Planes>
HWY_INLINE void store_primary(const Frame& frame, const HitBatch& hits, const SurfaceBatch& out, int at, const HitLanes& lanes,
                              const Planes& planes, UvLanes& uv) {
  PointLanes point;
  resolve_primary(frame, hits, at, lanes.valid, planes, out.lights,
                  [&](int light, int factor) HWY_ATTR { return out.triangle_light(light, factor) + at; }, point);
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
  PlainTextures textures;
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
      store_material(frame, out, at, lanes, uv, textures);
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
}  // namespace

const ResolveFn kResolve[kIsaCount] = SPANRAY_KERNEL_TABLE(resolve);

// Not where a map says how sharp a flat face's highlight is, pixel by pixel.
bool triangles_carry_light(const Frame& frame) {
  const bool mapped = frame.plan.textures && frame.plan.specular && (frame.plan.maps & kMapShininess) != 0;
  return frame.settings.shading == Shading::kGouraud || (frame.settings.shading == Shading::kFlat && !mapped);
}

void resolve_surfaces(const Frame& frame, const HitBatch& hits, SurfaceBatch& out) {
  const bool carry = hits.rays == nullptr && triangles_carry_light(frame);
  out.resize(hits.count, surface_fields(frame.plan), carry ? static_cast<int>(frame.scene->lights.size()) : 0);
  if (frame.scene->has_exact()) return resolve_with_exact(frame, hits, out);
  kResolve[isa_index(frame.isa)](frame, hits, out);
}

}  // namespace spanray
#endif
