// Hits -> surfaces.
#include <cstddef>

#include "shade/surface_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/resolve_kernel.cpp"
#include "hwy/foreach_target.h"
#include "shade/bump-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
using namespace surface_lanes;
namespace {

// What a group of lanes hands from stage to stage.
struct Group {
  const Frame& frame;
  HitLanes hits;
  RecordLanes material;
  I32 material_index;
  const UvLanes* uv;  // nullptr: no stage of this frame reads textures
  int at;             // first entry in the batch
};

HWY_INLINE void put(const Group& g, float* field, F32 value) { select(g.hits.valid, value, F32::zero()).store(field + g.at); }
HWY_INLINE void put(const Group& g, float* const field[3], const V3f& v) {
  put(g, field[0], v.x), put(g, field[1], v.y), put(g, field[2], v.z);
}
HWY_INLINE void put(const Group& g, uint32_t* field, I32 value) { select(g.hits.valid, value, I32::zero()).store(field + g.at); }

#define SPANRAY_WORD(field) static_cast<int>(offsetof(Material, field) / 4)

HWY_INLINE F32 material_real(const Group& g, int k) {
  return g.material.real(reinterpret_cast<const float*>(g.frame.scene->materials.data()), k);
}
HWY_INLINE V3f material_color(const Group& g, int k) {
  return {material_real(g, k), material_real(g, k + 1), material_real(g, k + 2)};
}
HWY_INLINE I32 material_map(const Group& g, int k) {
  return g.material.word(reinterpret_cast<const uint32_t*>(g.frame.scene->materials.data()), k);
}
HWY_INLINE V3f multiply(const V3f& a, const V3f& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

// color times the map in lanes that have it.
HWY_INLINE V3f modulate(const V3f& color, const UseLanes& use, const V3f& map) {
  return select(use.active, multiply(color, map), color);
}

void store_zeros(const Group& g, const SurfaceBatch& out) {
  const V3f zero{F32::zero(), F32::zero(), F32::zero()};
  for (float* const* v : {out.position, out.geometric_normal, out.normal, out.view, out.weight, out.dpdx, out.dpdy, out.ambient,
                          out.diffuse, out.specular, out.emission, out.mirror})
    put(g, v, zero);
  for (float* f : {out.position_error, out.t, out.shininess, out.opacity}) put(g, f, zero.x);
  for (uint32_t* w : {out.pixel, out.ray, out.primitive, out.material, out.valid}) put(g, w, I32::zero());
}

// Diffuse and ambient share map_Kd unless there is a map_Ka.
void resolve_diffuse(const Group& g, const SurfaceBatch& out) {
  const SceneData& scene = *g.frame.scene;
  V3f diffuse = material_color(g, SPANRAY_WORD(diffuse)), ambient = material_color(g, SPANRAY_WORD(ambient));
  if (g.uv != nullptr && g.frame.plan.textures) {
    const Filter filter = g.frame.settings.filter;
    const I32 map = material_map(g, SPANRAY_WORD(map_diffuse)), own = material_map(g, SPANRAY_WORD(map_ambient));
    if (has_use(scene, map, g.hits.valid)) {
      const UseLanes use = open_use(scene, map, g.hits.valid, *g.uv);
      const V3f color = sample_color(scene, use, filter);
      diffuse = modulate(diffuse, use, color);
      ambient = select(use.active & (own < i32(0)), multiply(ambient, color), ambient);
    }
    if (g.frame.plan.ambient && has_use(scene, own, g.hits.valid)) {
      const UseLanes use = open_use(scene, own, g.hits.valid, *g.uv);
      ambient = modulate(ambient, use, sample_color(scene, use, filter));
    }
  }
  const V3f zero{F32::zero(), F32::zero(), F32::zero()};
  put(g, out.diffuse, diffuse);
  put(g, out.ambient, g.frame.plan.ambient ? ambient : zero);
}

// Specular and mirror share map_Ks: the mirror weight comes from Ks.
void resolve_specular(const Group& g, const SurfaceBatch& out) {
  const SceneData& scene = *g.frame.scene;
  const PlanFlags& plan = g.frame.plan;
  const V3f zero{F32::zero(), F32::zero(), F32::zero()};
  V3f specular = plan.specular ? material_color(g, SPANRAY_WORD(specular)) : zero;
  V3f mirror = plan.bounces ? material_color(g, SPANRAY_WORD(mirror)) : zero;
  F32 shininess = plan.specular ? material_real(g, SPANRAY_WORD(shininess)) : zero.x;
  if (g.uv != nullptr && plan.textures && (plan.specular || plan.bounces)) {
    const I32 map = material_map(g, SPANRAY_WORD(map_specular)), exponent_map = material_map(g, SPANRAY_WORD(map_shininess));
    if (has_use(scene, map, g.hits.valid)) {
      const UseLanes use = open_use(scene, map, g.hits.valid, *g.uv);
      const V3f color = sample_color(scene, use, g.frame.settings.filter);
      specular = modulate(specular, use, color);
      mirror = modulate(mirror, use, color);
    }
    if (plan.specular && has_use(scene, exponent_map, g.hits.valid)) {
      const UseLanes use = open_use(scene, exponent_map, g.hits.valid, *g.uv);
      const F32 scaled = shininess * sample_scalar(scene, use, g.frame.settings.filter);
      shininess = select(use.active, clamp_(scaled, zero.x, f32(1e4f)), shininess);
    }
  }
  put(g, out.specular, specular);
  put(g, out.mirror, mirror);
  put(g, out.shininess, shininess);
}

void resolve_emission_and_opacity(const Group& g, const SurfaceBatch& out) {
  const SceneData& scene = *g.frame.scene;
  V3f emission{F32::zero(), F32::zero(), F32::zero()};
  if (g.frame.plan.emission) {
    emission = material_color(g, SPANRAY_WORD(emission));
    const I32 map = material_map(g, SPANRAY_WORD(map_emission));
    if (g.uv != nullptr && g.frame.plan.textures && has_use(scene, map, g.hits.valid)) {
      const UseLanes use = open_use(scene, map, g.hits.valid, *g.uv);
      emission = modulate(emission, use, sample_color(scene, use, g.frame.settings.filter));
    }
  }
  F32 opacity = material_real(g, SPANRAY_WORD(opacity));
  if (g.uv != nullptr && g.frame.plan.translucents) {
    const I32 map = material_map(g, SPANRAY_WORD(map_opacity));
    if (has_use(scene, map, g.hits.valid)) {
      const UseLanes use = open_use(scene, map, g.hits.valid, *g.uv);
      const F32 scaled = opacity * sample_scalar(scene, use, g.frame.settings.filter);
      opacity = select(use.active, clamp_(scaled, F32::zero(), f32(1.0f)), opacity);
    }
  }
  put(g, out.emission, emission);
  put(g, out.opacity, opacity);
}

// The interpolated vertex normal, on the side that is seen; the geometric one where opposed normals leave nothing. The three corners
// turn as one, by the sign of their sum against the geometric normal, whatever the winding says: files disagree about it (as Gouraud).
HWY_INLINE V3f interpolated_normal(const SceneData& scene, const TriangleLanes& t, F32 b1, F32 b2, const V3f& geometric) {
  const float* vertices = reinterpret_cast<const float*>(scene.vertices.data());
  F32 n[3], sum[3];
  for (int k = 0; k < 3; ++k) {
    const F32 n0 = t.vertex[0].real(vertices, 3 + k), n1 = t.vertex[1].real(vertices, 3 + k), n2 = t.vertex[2].real(vertices, 3 + k);
    n[k] = mul_add(b2, n2 - n0, mul_add(b1, n1 - n0, n0));
    sum[k] = n0 + n1 + n2;
  }
  const V3f interpolated{n[0], n[1], n[2]};
  const Mask away = dot(V3f{sum[0], sum[1], sum[2]}, geometric) < F32::zero();
  return unit_or(select(away, -interpolated, interpolated), 1e-6f, geometric);
}

V3f bumped_normal(const Group& g, V3f normal) {
  const SceneData& scene = *g.frame.scene;
  const I32 heights = material_map(g, SPANRAY_WORD(map_bump)), normals = material_map(g, SPANRAY_WORD(map_normal));
  const Filter filter = g.frame.settings.filter;
  if (has_use(scene, heights, g.hits.valid))
    normal = apply_height_map(scene, open_use(scene, heights, g.hits.valid, *g.uv), filter, *g.uv, normal);
  if (has_use(scene, normals, g.hits.valid))
    normal = apply_normal_map(scene, open_use(scene, normals, g.hits.valid, *g.uv), filter, *g.uv, normal);
  return normal;
}

// Source:   facing() of frame/frame.h: the side of the original triangle that the ray's origin is on.
// Contract: edge-on counts as the front; a triangle without area faces the viewer.
void resolve_normals(const Group& g, const RayLanes& ray, const TriangleLanes& t, const SurfaceLanes& s, const SurfaceBatch& out) {
  const F64 zero = f64(0.0);
  const V3f none{F32::zero(), F32::zero(), F32::zero()};
  // From the shaded point, not along the ray: a ray whose weights were clamped may pass below the triangle's horizon.
  V3f view = unit_or(ray.origin - s.position, none);
  const Mask at_origin = !(dot(view, view) > F32::zero());
  if (any(at_origin)) view = select(at_origin, unit_or(-ray.direction, none), view);
  const V3f unit = unit_or(s.normal, none);
  const F64 side = -dot(s.normal, s.from_origin);
  const Mask flipped = t.bits < i32(0);
  const Mask back = (flipped & (zero < side)) | and_not(flipped, side < zero);
  const Mask turned = and_not(flipped, back) | and_not(back, flipped);
  const Mask has_area = dot(unit, unit) > F32::zero();
  const V3f geometric = select(has_area, select(turned, -unit, unit), view);
  V3f normal = geometric;
  if (g.frame.settings.shading != Shading::kFlat)
    normal = interpolated_normal(*g.frame.scene, t, to_f32(s.b1), to_f32(s.b2), geometric);
  if (g.uv != nullptr && g.frame.plan.bump) normal = bumped_normal(g, normal);
  put(g, out.view, view);
  put(g, out.geometric_normal, geometric);
  put(g, out.normal, clamp_to_horizon(normal, geometric));
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
  alignas(64) uint32_t primitive[16];
  h.primitive.store(primitive);
  h.first_primitive = primitive[0];
  return h;
}

void resolve_group(const Frame& frame, const HitBatch& hits, int at, SurfaceBatch& out) {
  Group g{frame, load_hits(hits, at), {}, i32(0), nullptr, at};
  if (!any(g.hits.valid)) return store_zeros(g, out);
  const SceneData& scene = *frame.scene;
  const PlanFlags& plan = frame.plan;
  const RayLanes ray = load_rays(frame, g.hits);
  const TriangleLanes t = load_triangles(scene, g.hits);
  const SurfaceLanes s = resolve_lanes(ray, t);
  const F64 distance = hit_t(s, ray);
  g.material_index = t.bits & i32(kTriangleMaterialMask);
  g.material = record_lanes(g.material_index, kMaterialStride, g.hits.uniform);

  const bool reads_textures = plan.textures || plan.bump || plan.translucents;
  UvLanes uv;
  V3d dpdx{f64(0.0), f64(0.0), f64(0.0)}, dpdy = dpdx;
  if (reads_textures || plan.bounces) {
    const DifferentialLanes d = load_differentials(frame, g.hits);
    dpdx = transfer(d.origin_dx, d.direction_dx, distance, ray, s.normal);
    dpdy = transfer(d.origin_dy, d.direction_dy, distance, ray, s.normal);
  }
  if (reads_textures) {
    uv = resolve_uv(scene, t, s, dpdx, dpdy);
    g.uv = &uv;
  }
  put(g, out.position, to_f32(s.position));
  put(g, out.position_error, position_error(s, t));
  put(g, out.t, to_f32(distance));
  put(g, out.weight, {to_f32(s.b0), to_f32(s.b1), to_f32(s.b2)});
  store_footprint(g, out.dpdx, dpdx);
  store_footprint(g, out.dpdy, dpdy);
  put(g, out.pixel, g.hits.pixel);
  put(g, out.ray, g.hits.ray);
  put(g, out.primitive, g.hits.primitive);
  put(g, out.material, g.material_index);
  put(g, out.valid, i32(1));
  resolve_normals(g, ray, t, s, out);
  resolve_diffuse(g, out);
  resolve_specular(g, out);
  resolve_emission_and_opacity(g, out);
}

}  // namespace

// Recomputes the surface of every hit of a batch, kLanes at a time.
// Source:   DESIGN 1; the steps cite theirs.
// Input:    hits.count entries; out.count == hits.count.   Output: every field of out.
// Contract: each entry is a function of its own ray, primitive and the frame alone: lanes, order and batch size change no bit.
void resolve(const Frame& frame, const HitBatch& hits, SurfaceBatch& out) {
  for (int at = 0; at < hits.count; at += kLanes) resolve_group(frame, hits, at, out);
}

#undef SPANRAY_WORD

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
