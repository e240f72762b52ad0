// Maps of the materials of resolved hits, one after the other for a block of surfaces. Include inside a
// *_kernel.cpp.
#if defined(SPANRAY_MATERIAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_MATERIAL_INL_H_
#undef SPANRAY_MATERIAL_INL_H_
#else
#define SPANRAY_MATERIAL_INL_H_
#endif

#include "shade/bump-inl.h"
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

// field times the map, held in [0, most], in lanes that have it.
HWY_INLINE void modulate(const Group& g, Mask active, float* field, F32 map, float most) {
  const F32 value = F32::load(field + g.at);
  put(g, field, select(active, clamp_(value * map, F32::zero(), f32(most)), value));
}

// Diffuse and ambient share map_Kd unless there is a map_Ka. Specular and mirror share map_Ks: the mirror weight comes from Ks.
HWY_INLINE void modulate_colors(const SurfaceBlock& block, MapBlock& samples) {
  const SceneData& scene = *block.frame.scene;
  const PlanFlags& plan = block.frame.plan;
  const SurfaceBatch& out = block.out;
  each_sample<3>(block, kDiffuseSlot, samples, [&](const Group& g, const MapLanes& map, const RawSample& raw) HWY_ATTR {
    const V3f color = color_of(scene, map, raw);
    modulate(g, map.active, out.diffuse, color);
    if (plan.ambient) modulate(g, map.active & (material_map(g, kAmbientSlot.word) < i32(0)), out.ambient, color);
  });
  if (plan.ambient)
    each_sample<3>(block, kAmbientSlot, samples, [&](const Group& g, const MapLanes& map, const RawSample& raw) HWY_ATTR {
      modulate(g, map.active, out.ambient, color_of(scene, map, raw));
    });
  if (plan.specular || plan.bounces)
    each_sample<3>(block, kSpecularSlot, samples, [&](const Group& g, const MapLanes& map, const RawSample& raw) HWY_ATTR {
      const V3f color = color_of(scene, map, raw);
      if (plan.specular) modulate(g, map.active, out.specular, color);
      if (plan.bounces) modulate(g, map.active, out.mirror, color);
    });
  if (plan.emission)
    each_sample<3>(block, kEmissionSlot, samples, [&](const Group& g, const MapLanes& map, const RawSample& raw) HWY_ATTR {
      modulate(g, map.active, out.emission, color_of(scene, map, raw));
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
  const SceneData& scene = *block.frame.scene;
  const PlanFlags& plan = block.frame.plan;
  MapBlock samples;
  if (plan.bump) bump_normals(block);
  if (plan.textures) modulate_colors(block, samples);
  if (plan.textures && plan.specular)
    each_sample<4>(block, kShininessSlot, samples, [&](const Group& g, const MapLanes& map, const RawSample& raw) HWY_ATTR {
      modulate(g, map.active, block.out.shininess, scalar_of(scene, map, raw), 1e4f);
    });
  if (plan.translucents)
    each_sample<4>(block, kOpacitySlot, samples, [&](const Group& g, const MapLanes& map, const RawSample& raw) HWY_ATTR {
      modulate(g, map.active, block.out.opacity, scalar_of(scene, map, raw), 1.0f);
    });
}

#undef SPANRAY_WORD

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_MATERIAL_INL_H_
