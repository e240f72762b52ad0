// Materials of resolved hits: constants of the material times its maps. Include inside a *_kernel.cpp.
#if defined(SPANRAY_MATERIAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_MATERIAL_INL_H_
#undef SPANRAY_MATERIAL_INL_H_
#else
#define SPANRAY_MATERIAL_INL_H_
#endif

#include "shade/bump-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace surface_lanes {

// What a group of lanes hands from stage to stage.
struct Group {
  const Frame& frame;
  Mask valid;
  RecordLanes material;
  const UvLanes* uv;  // nullptr: no stage of this frame reads textures
  int at;             // first entry in the batch
};

HWY_INLINE void put(const Group& g, float* field, F32 value) { select(g.valid, value, F32::zero()).store(field + g.at); }
HWY_INLINE void put(const Group& g, float* const field[3], const V3f& v) {
  put(g, field[0], v.x), put(g, field[1], v.y), put(g, field[2], v.z);
}
HWY_INLINE void put(const Group& g, uint32_t* field, I32 value) { select(g.valid, value, I32::zero()).store(field + g.at); }

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

// Diffuse and ambient share map_Kd unless there is a map_Ka.
void resolve_diffuse(const Group& g, const SurfaceBatch& out) {
  const SceneData& scene = *g.frame.scene;
  V3f diffuse = material_color(g, SPANRAY_WORD(diffuse)), ambient = material_color(g, SPANRAY_WORD(ambient));
  if (g.uv != nullptr && g.frame.plan.textures) {
    const Filter filter = g.frame.settings.filter;
    const I32 map = material_map(g, SPANRAY_WORD(map_diffuse)), own = material_map(g, SPANRAY_WORD(map_ambient));
    if (has_use(scene, map, g.valid)) {
      const UseLanes use = open_use(scene, map, g.material.uniform, g.valid, *g.uv);
      const V3f color = sample_color(scene, use, filter);
      diffuse = modulate(diffuse, use, color);
      ambient = select(use.active & (own < i32(0)), multiply(ambient, color), ambient);
    }
    if (g.frame.plan.ambient && has_use(scene, own, g.valid)) {
      const UseLanes use = open_use(scene, own, g.material.uniform, g.valid, *g.uv);
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
    if (has_use(scene, map, g.valid)) {
      const UseLanes use = open_use(scene, map, g.material.uniform, g.valid, *g.uv);
      const V3f color = sample_color(scene, use, g.frame.settings.filter);
      specular = modulate(specular, use, color);
      mirror = modulate(mirror, use, color);
    }
    if (plan.specular && has_use(scene, exponent_map, g.valid)) {
      const UseLanes use = open_use(scene, exponent_map, g.material.uniform, g.valid, *g.uv);
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
    if (g.uv != nullptr && g.frame.plan.textures && has_use(scene, map, g.valid)) {
      const UseLanes use = open_use(scene, map, g.material.uniform, g.valid, *g.uv);
      emission = modulate(emission, use, sample_color(scene, use, g.frame.settings.filter));
    }
  }
  F32 opacity = material_real(g, SPANRAY_WORD(opacity));
  if (g.uv != nullptr && g.frame.plan.translucents) {
    const I32 map = material_map(g, SPANRAY_WORD(map_opacity));
    if (has_use(scene, map, g.valid)) {
      const UseLanes use = open_use(scene, map, g.material.uniform, g.valid, *g.uv);
      const F32 scaled = opacity * sample_scalar(scene, use, g.frame.settings.filter);
      opacity = select(use.active, clamp_(scaled, F32::zero(), f32(1.0f)), opacity);
    }
  }
  put(g, out.emission, emission);
  put(g, out.opacity, opacity);
}

HWY_INLINE V3f bumped_normal(const Group& g, V3f normal) {
  const SceneData& scene = *g.frame.scene;
  const I32 heights = material_map(g, SPANRAY_WORD(map_bump)), normals = material_map(g, SPANRAY_WORD(map_normal));
  const Filter filter = g.frame.settings.filter;
  if (has_use(scene, heights, g.valid))
    normal = apply_height_map(scene, open_use(scene, heights, g.material.uniform, g.valid, *g.uv), filter, *g.uv, normal);
  if (has_use(scene, normals, g.valid))
    normal = apply_normal_map(scene, open_use(scene, normals, g.material.uniform, g.valid, *g.uv), filter, *g.uv, normal);
  return normal;
}

#undef SPANRAY_WORD

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_MATERIAL_INL_H_
