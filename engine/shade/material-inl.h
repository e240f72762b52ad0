// Materials of resolved hits: their constants, and what maps do to them. Include inside a *_kernel.cpp.
#if defined(SPANRAY_MATERIAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_MATERIAL_INL_H_
#undef SPANRAY_MATERIAL_INL_H_
#else
#define SPANRAY_MATERIAL_INL_H_
#endif

#include "shade/bump-inl.h"
#include "shade/surface_group-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace surface_lanes {

// A kind of map: its word in Material, and its bit in PlanFlags::maps.
struct MapSlot { int word; MaterialMaps bit; };
inline constexpr MapSlot kAmbientSlot{SPANRAY_WORD(map_ambient), kMapAmbient}, kDiffuseSlot{SPANRAY_WORD(map_diffuse), kMapDiffuse},
    kSpecularSlot{SPANRAY_WORD(map_specular), kMapSpecular}, kShininessSlot{SPANRAY_WORD(map_shininess), kMapShininess},
    kEmissionSlot{SPANRAY_WORD(map_emission), kMapEmission}, kOpacitySlot{SPANRAY_WORD(map_opacity), kMapOpacity};

// visit(map lanes, raw sample) if some lane has a map of this kind.
template <int kChannels, class Visit> HWY_INLINE void sample_map(const Materials& g, const UvLanes& uv, const MapSlot& slot, const Visit& visit) {
  if ((g.frame.plan.maps & slot.bit) == 0) return;
  const SceneData& scene = *g.frame.scene;
  const I32 map = material_map(g, slot.word);
  if (!has_use(scene, map, g.valid)) return;
  const UseLanes use = open_use(scene, map, g.material.uniform, g.valid, uv);
  visit(use, sample<kChannels>(scene, use, g.frame.settings.filter));
}

// The texture of a map where all lanes have it, or nullptr.
HWY_INLINE const PlainTexture* shared_texture(const Materials& g, int word) {
  if (!g.material.uniform) return nullptr;
  const int32_t use = uniform_map(g, word);
  return use < 0 ? nullptr : &g.plain->open(*g.frame.scene, use);
}

// Finds in *g.sample where the map of this kind is read, if all lanes have one and its texture is plain; it may be there already.
HWY_INLINE bool find_shared_sample(const Materials& g, const UvLanes& uv, const MapSlot& slot) {
  const Filter filter = g.frame.settings.filter;
  if ((g.frame.plan.maps & slot.bit) == 0 || filter == Filter::kNearest) return false;
  const PlainTexture* const texture = shared_texture(g, slot.word);
  if (texture == nullptr || !texture->plain) return false;
  if (g.sample->use != texture->use) find_plain_sample(*texture, uv, g.valid, filter, *g.sample);
  return true;
}

// visit(lanes that have a map of this kind, its color) if there are any.
template <class Visit>
HWY_INLINE void sample_color(const Materials& g, const UvLanes& uv, const MapSlot& slot, const Visit& visit) {
  if (find_shared_sample(g, uv, slot)) return visit(g.valid, read_plain_sample(*g.frame.scene, *g.sample));
  sample_map<3>(g, uv, slot, [&](const MapLanes& map, const RawSample& raw) HWY_ATTR {
    visit(map.active, color_of(*g.frame.scene, map, raw));
  });
}

// color times the map, in lanes that have it.
HWY_INLINE void modulate(Mask active, V3f& color, const V3f& map) {
  color = select(active, V3f{color.x * map.x, color.y * map.y, color.z * map.z}, color);
}

// value times the map, held in [0, most], in lanes that have it.
HWY_INLINE void modulate(Mask active, F32& value, F32 map, float most) {
  value = select(active, clamp_(value * map, F32::zero(), f32(most)), value);
}

// Diffuse and ambient share map_Kd unless there is a map_Ka. Specular and mirror share map_Ks: the mirror weight comes from Ks.
HWY_INLINE void modulate_colors(const Materials& g, const UvLanes& uv, MaterialLanes& m) {
  const PlanFlags& plan = g.frame.plan;
  sample_color(g, uv, kDiffuseSlot, [&](Mask active, const V3f& color) HWY_ATTR {
    modulate(active, m.diffuse, color);
    if (plan.ambient) modulate(active & (material_map(g, kAmbientSlot.word) < i32(0)), m.ambient, color);
  });
  if (plan.ambient)
    sample_color(g, uv, kAmbientSlot, [&](Mask active, const V3f& color) HWY_ATTR { modulate(active, m.ambient, color); });
  if (plan.specular || plan.bounces)
    sample_color(g, uv, kSpecularSlot, [&](Mask active, const V3f& color) HWY_ATTR {
      if (plan.specular) modulate(active, m.specular, color);
      if (plan.bounces) modulate(active, m.mirror, color);
    });
  if (plan.emission)
    sample_color(g, uv, kEmissionSlot, [&](Mask active, const V3f& color) HWY_ATTR { modulate(active, m.emission, color); });
}

HWY_INLINE V3f bumped_normal(const Materials& g, const UvLanes& uv, V3f normal) {
  const SceneData& scene = *g.frame.scene;
  const I32 heights = material_map(g, SPANRAY_WORD(map_bump)), normals = material_map(g, SPANRAY_WORD(map_normal));
  const Filter filter = g.frame.settings.filter;
  const PlainTexture* const texture = shared_texture(g, SPANRAY_WORD(map_bump));
  if (texture != nullptr && texture->heights)
    normal = apply_plain_heights(scene, *texture, g.valid, filter, uv, normal);
  else if (has_use(scene, heights, g.valid))
    normal = apply_height_map(scene, open_use(scene, heights, g.material.uniform, g.valid, uv), filter, uv, normal);
  if (has_use(scene, normals, g.valid))
    normal = apply_normal_map(scene, open_use(scene, normals, g.material.uniform, g.valid, uv), filter, uv, normal);
  return normal;
}

// What the maps do to the constants of the materials. opacity: whether that of layers is wanted.
HWY_INLINE void apply_maps(const Materials& g, const UvLanes& uv, MaterialLanes& m, bool opacity) {
  const SceneData& scene = *g.frame.scene;
  const PlanFlags& plan = g.frame.plan;
  if (plan.textures) modulate_colors(g, uv, m);
  if (plan.textures && plan.specular)
    sample_map<4>(g, uv, kShininessSlot, [&](const MapLanes& map, const RawSample& raw) HWY_ATTR {
      modulate(map.active, m.shininess, scalar_of(scene, map, raw), 1e4f);
    });
  if (opacity)
    sample_map<4>(g, uv, kOpacitySlot, [&](const MapLanes& map, const RawSample& raw) HWY_ATTR {
      modulate(map.active, m.opacity, scalar_of(scene, map, raw), 1.0f);
    });
}

#undef SPANRAY_WORD

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_MATERIAL_INL_H_
