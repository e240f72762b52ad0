// The maps of a block of surfaces, one map after the other: first where all samples read, then their texels. The processor looks some
// hundred instructions ahead: it overlaps what waits for memory or for long chains of arithmetic only with neighbours that do the same.
// Include inside a *_kernel.cpp.
#if defined(SPANRAY_MAP_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_MAP_BLOCK_INL_H_
#undef SPANRAY_MAP_BLOCK_INL_H_
#else
#define SPANRAY_MAP_BLOCK_INL_H_
#endif

#include "shade/surface_block-inl.h"
#include "shade/texture-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace surface_lanes {

// Where the samples of a map read: two levels, and how they blend.
class MapBlock {
 public:
  HWY_INLINE void store(int i, int level, const TexelLanes& t, bool nearest) {
    t.index[0].store(index_[level][0] + i);
    if (nearest) return;
    for (int k = 1; k < 4; ++k) t.index[k].store(index_[level][k] + i);
    (t.fx | shift_left<8>(t.fy)).store(fraction_[level] + i);
  }
  HWY_INLINE TexelLanes load(int i, int level, bool nearest) const {
    TexelLanes t;
    t.index[0] = I32::load(index_[level][0] + i);
    if (nearest) return t;
    for (int k = 1; k < 4; ++k) t.index[k] = I32::load(index_[level][k] + i);
    const I32 f = I32::load(fraction_[level] + i);
    t.fx = f & i32(255), t.fy = shift_right_logical<8>(f);
    return t;
  }

  alignas(64) float weight[kBlockHits];
  uint32_t active[kBlockHits];  // by vector: the lanes that have the map; 0: nothing is stored
  bool blend[kBlockHits];       // by vector: the second level counts

 private:
  alignas(64) uint32_t index_[2][4][kBlockHits], fraction_[2][kBlockHits];
};

// A kind of map: its word in Material, and its bit in PlanFlags::maps.
struct MapSlot { int word; MaterialMaps bit; };
inline constexpr MapSlot kAmbientSlot{SPANRAY_WORD(map_ambient), kMapAmbient}, kDiffuseSlot{SPANRAY_WORD(map_diffuse), kMapDiffuse},
    kSpecularSlot{SPANRAY_WORD(map_specular), kMapSpecular}, kShininessSlot{SPANRAY_WORD(map_shininess), kMapShininess},
    kEmissionSlot{SPANRAY_WORD(map_emission), kMapEmission}, kOpacitySlot{SPANRAY_WORD(map_opacity), kMapOpacity};

// Finds the samples of one kind of map for the whole block. False if no surface has one.
HWY_NOINLINE bool find_samples(const SurfaceBlock& block, const MapSlot& slot, MapBlock& samples) {
  if ((block.frame.plan.maps & slot.bit) == 0) return false;
  const SceneData& scene = *block.frame.scene;
  const Filter filter = block.frame.settings.filter;
  const bool nearest = filter == Filter::kNearest;
  bool some = false;
  for (int i = 0; i < block.count; i += kLanes) {
    const int vector = i / kLanes;
    samples.active[vector] = 0;
    const Group g = group_of(block, i);
    if (!any(g.valid)) continue;
    const I32 map = material_map(g, slot.word);
    if (!has_use(scene, map, g.valid)) continue;
    const UseLanes use = open_use(scene, map, g.material.uniform, g.valid, block.uv.load(i, false));
    const LevelLanes levels = choose_levels(scene, use, filter);
    samples.active[vector] = to_bits(use.active), samples.blend[vector] = levels.blend;
    samples.store(i, 0, find_texels(scene, use, levels.level, nearest), nearest);
    if (levels.blend) {
      samples.store(i, 1, find_texels(scene, use, levels.next, nearest), nearest);
      levels.weight.store(samples.weight + i);
    }
    some |= samples.active[vector] != 0;
  }
  return some;
}

// visit(group, map lanes, raw sample) for each vector of the block that has a map of this kind.
template <int kChannels, class Visit>
HWY_INLINE void each_sample(const SurfaceBlock& block, const MapSlot& slot, MapBlock& samples, const Visit& visit) {
  if (!find_samples(block, slot, samples)) return;
  const SceneData& scene = *block.frame.scene;
  const bool nearest = block.frame.settings.filter == Filter::kNearest;
  for (int i = 0; i < block.count; i += kLanes) {
    const int vector = i / kLanes;
    if (samples.active[vector] == 0) continue;
    const Group g = group_of(block, i);
    RawSample raw = blend_texels<kChannels>(scene, samples.load(i, 0, nearest), nearest);
    if (samples.blend[vector])
      blend_levels(raw, blend_texels<kChannels>(scene, samples.load(i, 1, nearest), nearest), F32::load(samples.weight + i), kChannels);
    const I32 map = max_(material_map(g, slot.word), i32(0));
    visit(g, MapLanes{mask_from_bits(samples.active[vector]), record_lanes(map, kTextureUseStride, g.material.uniform)}, raw);
  }
}

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_MAP_BLOCK_INL_H_
