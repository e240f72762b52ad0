// What the stages of shading hand to each other: a block of surfaces, and groups of lanes in it. Include inside a *_kernel.cpp.
#if defined(SPANRAY_SURFACE_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_SURFACE_BLOCK_INL_H_
#undef SPANRAY_SURFACE_BLOCK_INL_H_
#else
#define SPANRAY_SURFACE_BLOCK_INL_H_
#endif

#include "shade/point-inl.h"

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

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_SURFACE_BLOCK_INL_H_
