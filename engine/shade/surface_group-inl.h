// Entries of a batch of surfaces that are resolved at once, and their materials. Include inside a *_kernel.cpp.
#if defined(SPANRAY_SURFACE_GROUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_SURFACE_GROUP_INL_H_
#undef SPANRAY_SURFACE_GROUP_INL_H_
#else
#define SPANRAY_SURFACE_GROUP_INL_H_
#endif

#include "shade/plain_texture-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace surface_lanes {

// The materials of kLanes surfaces.
struct Materials {
  const Frame& frame;
  Mask valid;
  RecordLanes material;
  PlainTextures* plain = nullptr;  // tables of textures: where maps are read
  PlainSample* sample = nullptr;   // likewise: the last that was found for this vector
};

// kLanes entries of a batch, from `at` on. All lanes are stored, valid or not: clear_misses (resolve_kernel.cpp) comes last.
struct Group : Materials {
  const SurfaceBatch& out;
  int at;
};

HWY_INLINE void put(const Group& g, float* field, F32 value) { value.store(field + g.at); }
HWY_INLINE void put(const Group& g, float* const field[3], const V3f& v) {
  put(g, field[0], v.x), put(g, field[1], v.y), put(g, field[2], v.z);
}
HWY_INLINE void put(const Group& g, uint32_t* field, I32 value) { value.store(field + g.at); }
HWY_INLINE V3f get(const Group& g, float* const field[3]) {
  return {F32::load(field[0] + g.at), F32::load(field[1] + g.at), F32::load(field[2] + g.at)};
}

HWY_INLINE F32 material_real(const Materials& g, int k) {
  return g.material.real(reinterpret_cast<const float*>(g.frame.scene->materials.data()), k);
}
HWY_INLINE V3f material_color(const Materials& g, int k) {
  return {material_real(g, k), material_real(g, k + 1), material_real(g, k + 2)};
}
HWY_INLINE I32 material_map(const Materials& g, int k) {
  return g.material.word(reinterpret_cast<const uint32_t*>(g.frame.scene->materials.data()), k);
}

// The same where all lanes have one material.
HWY_INLINE int32_t uniform_map(const Materials& g, int k) {
  const int32_t* const words = reinterpret_cast<const int32_t*>(g.frame.scene->materials.data());
  return words[g.material.first + static_cast<uint32_t>(k)];
}

#define SPANRAY_WORD(field) static_cast<int>(offsetof(Material, field) / 4)

struct MaterialLanes {
  V3f ambient, diffuse, specular, emission, mirror;
  F32 shininess, opacity;
};

// The constants of the materials; maps modulate them (material-inl.h). What the frame leaves out is 0.
HWY_INLINE MaterialLanes constants_of(const Materials& g) {
  const PlanFlags& plan = g.frame.plan;
  const V3f none{F32::zero(), F32::zero(), F32::zero()};
  MaterialLanes m;
  m.diffuse = material_color(g, SPANRAY_WORD(diffuse));
  m.ambient = plan.ambient ? material_color(g, SPANRAY_WORD(ambient)) : none;
  m.specular = plan.specular ? material_color(g, SPANRAY_WORD(specular)) : none;
  m.shininess = plan.specular ? material_real(g, SPANRAY_WORD(shininess)) : none.x;
  m.mirror = plan.bounces ? material_color(g, SPANRAY_WORD(mirror)) : none;
  m.emission = plan.emission ? material_color(g, SPANRAY_WORD(emission)) : none;
  m.opacity = material_real(g, SPANRAY_WORD(opacity));
  return m;
}

HWY_INLINE void put_material(const Group& g, const MaterialLanes& m) {
  put(g, g.out.diffuse, m.diffuse);
  put(g, g.out.specular, m.specular);
  put(g, g.out.shininess, m.shininess);
  put(g, g.out.opacity, m.opacity);
  if (g.out.fields & kSurfaceAmbient) put(g, g.out.ambient, m.ambient);
  if (g.out.fields & kSurfaceMirror) put(g, g.out.mirror, m.mirror);
  if (g.out.fields & kSurfaceEmission) put(g, g.out.emission, m.emission);
}

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_SURFACE_GROUP_INL_H_
