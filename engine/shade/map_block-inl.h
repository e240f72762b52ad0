// The maps of a block of surfaces, one map after the other: first where all samples read, then their texels. The processor looks some
// hundred instructions ahead: it overlaps what waits for memory or for long chains of arithmetic only with neighbours that do the same.
// Include inside a *_kernel.cpp.
#if defined(SPANRAY_MAP_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_MAP_BLOCK_INL_H_
#undef SPANRAY_MAP_BLOCK_INL_H_
#else
#define SPANRAY_MAP_BLOCK_INL_H_
#endif

#include "shade/bump-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace surface_lanes {

inline constexpr int kBlockHits = 256;

// uv of the surfaces of a block, field by field.
struct UvBlock {
  static constexpr int kFields = sizeof(UvLanes) / sizeof(F32);
  alignas(64) float field[kFields][kBlockHits];

  HWY_INLINE void store(int i, const UvLanes& uv, bool tangents) {
    const F32* const from[] = {&uv.u, &uv.v, &uv.whole_u, &uv.whole_v, &uv.du_dx, &uv.dv_dx, &uv.du_dy, &uv.dv_dy};
    for (int k = 0; k < 8; ++k) from[k]->store(field[k] + i);
    if (!tangents) return;
    const F32* const more[] = {&uv.tangent_u.x, &uv.tangent_u.y, &uv.tangent_u.z, &uv.tangent_v.x, &uv.tangent_v.y, &uv.tangent_v.z};
    for (int k = 0; k < 6; ++k) more[k]->store(field[8 + k] + i);
  }
  HWY_INLINE UvLanes load(int i, bool tangents) const {
    const auto get = [&](int k) HWY_ATTR { return F32::load(field[k] + i); };
    UvLanes uv;
    uv.u = get(0), uv.v = get(1), uv.whole_u = get(2), uv.whole_v = get(3);
    uv.du_dx = get(4), uv.dv_dx = get(5), uv.du_dy = get(6), uv.dv_dy = get(7);
    if (tangents) uv.tangent_u = {get(8), get(9), get(10)}, uv.tangent_v = {get(11), get(12), get(13)};
    return uv;
  }
};

// Surfaces [begin, begin + count) of a batch.
struct SurfaceBlock {
  SurfaceBlock(const Frame& f, const SurfaceBatch& batch) : frame(f), out(batch) {}
  const Frame& frame;
  const SurfaceBatch& out;
  int begin = 0, count = 0;
  UvBlock uv;  // only if reads_textures
};

// What a group of lanes hands from stage to stage.
struct Group {
  const Frame& frame;
  Mask valid;
  RecordLanes material;
  int at;  // first entry in the batch
};

// Entries i .. of the block; material and valid are stored. Without valid lanes, ask for nothing else.
HWY_INLINE Group group_of(const SurfaceBlock& block, int i) {
  const int at = block.begin + i;
  Group g{block.frame, first_lanes(block.count - i) & (I32::load(block.out.valid + at) != I32::zero()), {}, at};
  const uint32_t lanes = to_bits(g.valid);
  if (lanes == 0) return g;
  const I32 some = i32(block.out.material[at + __builtin_ctz(lanes)]), material = select(g.valid, I32::load(block.out.material + at), some);
  g.material = record_lanes(material, kMaterialStride, all(material == some));
  return g;
}

HWY_INLINE void put(const Group& g, float* field, F32 value) { select(g.valid, value, F32::zero()).store(field + g.at); }
HWY_INLINE void put(const Group& g, float* const field[3], const V3f& v) {
  put(g, field[0], v.x), put(g, field[1], v.y), put(g, field[2], v.z);
}
HWY_INLINE void put(const Group& g, uint32_t* field, I32 value) { select(g.valid, value, I32::zero()).store(field + g.at); }

HWY_INLINE F32 material_real(const Group& g, int k) {
  return g.material.real(reinterpret_cast<const float*>(g.frame.scene->materials.data()), k);
}
HWY_INLINE V3f material_color(const Group& g, int k) {
  return {material_real(g, k), material_real(g, k + 1), material_real(g, k + 2)};
}
HWY_INLINE I32 material_map(const Group& g, int k) {
  return g.material.word(reinterpret_cast<const uint32_t*>(g.frame.scene->materials.data()), k);
}

#define SPANRAY_WORD(field) static_cast<int>(offsetof(Material, field) / 4)

// The constants of the materials; maps modulate them later (material-inl.h). What the frame leaves out is 0.
HWY_INLINE void put_constants(const Group& g, const SurfaceBatch& out) {
  const PlanFlags& plan = g.frame.plan;
  const V3f zero{F32::zero(), F32::zero(), F32::zero()};
  put(g, out.diffuse, material_color(g, SPANRAY_WORD(diffuse)));
  put(g, out.ambient, plan.ambient ? material_color(g, SPANRAY_WORD(ambient)) : zero);
  put(g, out.specular, plan.specular ? material_color(g, SPANRAY_WORD(specular)) : zero);
  put(g, out.shininess, plan.specular ? material_real(g, SPANRAY_WORD(shininess)) : zero.x);
  put(g, out.mirror, plan.bounces ? material_color(g, SPANRAY_WORD(mirror)) : zero);
  put(g, out.emission, plan.emission ? material_color(g, SPANRAY_WORD(emission)) : zero);
  put(g, out.opacity, material_real(g, SPANRAY_WORD(opacity)));
}

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

// Finds the samples of map `slot` (a word of Material) for the whole block, where it is not the map in slot `same`. False if no surface has
// one.
HWY_NOINLINE bool find_samples(const SurfaceBlock& block, int slot, MapBlock& samples, int same = -1) {
  const SceneData& scene = *block.frame.scene;
  const Filter filter = block.frame.settings.filter;
  const bool nearest = filter == Filter::kNearest;
  bool some = false;
  for (int i = 0; i < block.count; i += kLanes) {
    const int vector = i / kLanes;
    samples.active[vector] = 0;
    const Group g = group_of(block, i);
    if (!any(g.valid)) continue;
    I32 map = material_map(g, slot);
    if (same >= 0) map = select(map == material_map(g, same), i32(-1), map);
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

// visit(group, map lanes, raw sample) for each vector of the block that has samples.
template <int kChannels, class Visit>
HWY_INLINE void read_samples(const SurfaceBlock& block, int slot, const MapBlock& samples, const Visit& visit) {
  const SceneData& scene = *block.frame.scene;
  const bool nearest = block.frame.settings.filter == Filter::kNearest;
  for (int i = 0; i < block.count; i += kLanes) {
    const int vector = i / kLanes;
    if (samples.active[vector] == 0) continue;
    const Group g = group_of(block, i);
    RawSample raw = blend_texels<kChannels>(scene, samples.load(i, 0, nearest), nearest);
    if (samples.blend[vector])
      blend_levels(raw, blend_texels<kChannels>(scene, samples.load(i, 1, nearest), nearest), F32::load(samples.weight + i), kChannels);
    const I32 map = max_(material_map(g, slot), i32(0));
    visit(g, MapLanes{mask_from_bits(samples.active[vector]), record_lanes(map, kTextureUseStride, g.material.uniform)}, raw);
  }
}

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_MAP_BLOCK_INL_H_
