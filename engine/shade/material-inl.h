// Maps of the materials of resolved hits, one after the other for a block of surfaces. Include inside a
// *_kernel.cpp.
#if defined(SPANRAY_MATERIAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_MATERIAL_INL_H_
#undef SPANRAY_MATERIAL_INL_H_
#else
#define SPANRAY_MATERIAL_INL_H_
#endif

#include "shade/map_block-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace surface_lanes {

HWY_INLINE V3f load3(const Group& g, float* const field[3]) {
  return {F32::load(field[0] + g.at), F32::load(field[1] + g.at), F32::load(field[2] + g.at)};
}

// field times the map, in lanes that have it.
HWY_INLINE void modulate(const Group& g, Mask active, float* const field[3], const V3f& map) {
  const V3f color = load3(g, field);
  put(g, field, select(active, V3f{color.x * map.x, color.y * map.y, color.z * map.z}, color));
}

// Diffuse and ambient share map_Kd unless there is another map_Ka.
HWY_INLINE void modulate_diffuse(const SurfaceBlock& block, MapBlock& samples) {
  const SceneData& scene = *block.frame.scene;
  const PlanFlags& plan = block.frame.plan;
  const SurfaceBatch& out = block.out;
  if ((plan.maps & kMapDiffuse) != 0 && find_samples(block, SPANRAY_WORD(map_diffuse), samples)) {
    read_samples<3>(block, SPANRAY_WORD(map_diffuse), samples, [&](const Group& g, const MapLanes& map, const RawSample& raw) HWY_ATTR {
      const V3f color = color_of(scene, map, raw);
      modulate(g, map.active, out.diffuse, color);
      if (!plan.ambient) return;
      const I32 own = material_map(g, SPANRAY_WORD(map_ambient));
      modulate(g, map.active & ((own < i32(0)) | (own == material_map(g, SPANRAY_WORD(map_diffuse)))), out.ambient, color);
    });
  }
  if (plan.ambient && (plan.maps & kMapAmbient) != 0 && find_samples(block, SPANRAY_WORD(map_ambient), samples, SPANRAY_WORD(map_diffuse))) {
    read_samples<3>(block, SPANRAY_WORD(map_ambient), samples, [&](const Group& g, const MapLanes& map, const RawSample& raw) HWY_ATTR {
      modulate(g, map.active, out.ambient, color_of(scene, map, raw));
    });
  }
}

// Specular and mirror share map_Ks: the mirror weight comes from Ks.
HWY_INLINE void modulate_specular(const SurfaceBlock& block, MapBlock& samples) {
  const SceneData& scene = *block.frame.scene;
  const PlanFlags& plan = block.frame.plan;
  const SurfaceBatch& out = block.out;
  if ((plan.specular || plan.bounces) && (plan.maps & kMapSpecular) != 0 && find_samples(block, SPANRAY_WORD(map_specular), samples)) {
    read_samples<3>(block, SPANRAY_WORD(map_specular), samples, [&](const Group& g, const MapLanes& map, const RawSample& raw) HWY_ATTR {
      const V3f color = color_of(scene, map, raw);
      modulate(g, map.active, out.specular, color);
      modulate(g, map.active, out.mirror, color);
    });
  }
  if (plan.specular && (plan.maps & kMapShininess) != 0 && find_samples(block, SPANRAY_WORD(map_shininess), samples)) {
    read_samples<4>(block, SPANRAY_WORD(map_shininess), samples, [&](const Group& g, const MapLanes& map, const RawSample& raw) HWY_ATTR {
      const F32 shininess = F32::load(out.shininess + g.at);
      put(g, out.shininess, select(map.active, clamp_(shininess * scalar_of(scene, map, raw), F32::zero(), f32(1e4f)), shininess));
    });
  }
}

HWY_INLINE void modulate_emission(const SurfaceBlock& block, MapBlock& samples) {
  const SceneData& scene = *block.frame.scene;
  if (!block.frame.plan.emission || (block.frame.plan.maps & kMapEmission) == 0) return;
  if (!find_samples(block, SPANRAY_WORD(map_emission), samples)) return;
  read_samples<3>(block, SPANRAY_WORD(map_emission), samples, [&](const Group& g, const MapLanes& map, const RawSample& raw) HWY_ATTR {
    modulate(g, map.active, block.out.emission, color_of(scene, map, raw));
  });
}

HWY_INLINE void modulate_opacity(const SurfaceBlock& block, MapBlock& samples) {
  const SceneData& scene = *block.frame.scene;
  if (!block.frame.plan.translucents || (block.frame.plan.maps & kMapOpacity) == 0) return;
  if (!find_samples(block, SPANRAY_WORD(map_opacity), samples)) return;
  read_samples<4>(block, SPANRAY_WORD(map_opacity), samples, [&](const Group& g, const MapLanes& map, const RawSample& raw) HWY_ATTR {
    const F32 opacity = F32::load(block.out.opacity + g.at);
    put(g, block.out.opacity, select(map.active, clamp_(opacity * scalar_of(scene, map, raw), F32::zero(), f32(1.0f)), opacity));
  });
}

HWY_INLINE V3f bumped_normal(const Group& g, const UvLanes& uv, V3f normal) {
  const SceneData& scene = *g.frame.scene;
  const I32 heights = material_map(g, SPANRAY_WORD(map_bump)), normals = material_map(g, SPANRAY_WORD(map_normal));
  const Filter filter = g.frame.settings.filter;
  if (has_use(scene, heights, g.valid))
    normal = apply_height_map(scene, open_use(scene, heights, g.material.uniform, g.valid, uv), filter, uv, normal);
  if (has_use(scene, normals, g.valid))
    normal = apply_normal_map(scene, open_use(scene, normals, g.material.uniform, g.valid, uv), filter, uv, normal);
  return normal;
}

// Interpolated normals -> shading normals.
HWY_INLINE void bump_normals(const SurfaceBlock& block) {
  for (int i = 0; i < block.count; i += kLanes) {
    const Group g = group_of(block, i);
    if (!any(g.valid)) continue;
    const V3f normal = bumped_normal(g, block.uv.load(i, true), load3(g, block.out.normal));
    put(g, block.out.normal, clamp_to_horizon(normal, load3(g, block.out.geometric_normal)));
  }
}

// What the maps do to surfaces with the constants of their materials.
void apply_maps(const SurfaceBlock& block) {
  MapBlock samples;
  if (block.frame.plan.bump) bump_normals(block);
  if (block.frame.plan.textures) {
    modulate_diffuse(block, samples);
    modulate_specular(block, samples);
    modulate_emission(block, samples);
  }
  modulate_opacity(block, samples);
}

#undef SPANRAY_WORD

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_MATERIAL_INL_H_
