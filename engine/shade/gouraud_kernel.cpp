// Gouraud shading: light at vertices, and its interpolation.
#include "shade/light_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/gouraud_kernel.cpp"
#include "hwy/foreach_target.h"
#include "shade/light_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace {
using namespace light_lanes;

struct Corner { V3 position, normal, view; F32 shininess; I32 model; };

// Attenuation times reflectance times cosine of one light at corners, for the side of the surface that the light is on, with the
// sign of n.l; textures multiply Kd and Ks later, per pixel, but shininess is the material's own.
template <class Kind>
HWY_INLINE Reflected light_corner(const Frame& frame, const LightLanes& light, const Corner& corner, Mask active) {
  const Incidence incidence = Kind::incidence(light, corner.position);
  const F32 signed_n_l = formula::dot(corner.normal, incidence.direction);
  const V3 n = select3(signed_n_l < F32::zero(), -corner.normal, corner.normal);
  const F32 n_l = abs_(signed_n_l);
  active = active & (n_l > F32::zero());
  const bool specular = frame.plan.specular, fast_powers = frame.settings.powers == Powers::kFast;
  Cosines c = formula::cosines(n, incidence.direction, corner.view, n_l, corner.shininess, fast_powers);
  if (specular) formula::add_half_way(c, n, incidence.direction, corner.view);
  const Reflected r = reflect(corner.model, active, specular, c);
  return {copysign_(r.diffuse * incidence.attenuation, signed_n_l), copysign_(r.specular * incidence.attenuation, signed_n_l)};
}

// One light at a list of vertices, seen from the eye.
// Output:   pairs (diffuse, specular) at values + 2 * vertex.
// Contract: a pair depends on its vertex, material and light only, never on the list or the lane.
template <class Kind>
void light_vertices(const Frame& frame, const Light& light, const uint32_t* vertex, const uint32_t* material, int count,
                    float* values) {
  const SceneData& scene = *frame.scene;
  const LightLanes lanes = broadcast_light(light);
  const Viewer eye = eye_of(frame);
  for (int i = 0; i < count; i += kLanes) {
    const Mask active = first_lanes(count - i < kLanes ? count - i : kLanes);
    const I32 v = select(active, I32::load(vertex + i), I32::zero());
    const I32 m = select(active, I32::load(material + i), I32::zero());
    Corner corner = {vertex_position(scene, v), vertex_normal(scene, v), {}, material_shininess(scene, m),
                     reflectance_models(scene, m)};
    corner.view = view_from(eye, corner.position);
    const Reflected r = light_corner<Kind>(frame, lanes, corner, active);
    float diffuse[kLanes], specular[kLanes];
    r.diffuse.store(diffuse);
    r.specular.store(specular);
    for (int k = 0; k < kLanes && i + k < count; ++k) {
      float* const pair = values + 2 * static_cast<size_t>(vertex[i + k]);
      pair[0] = diffuse[k];
      pair[1] = specular[k];
    }
  }
}

// Adds one light, interpolated from the corners, to each surface.
// Source:   catalog/shading/gouraud.inl.
// Input:    light at vertices, or nullptr: the corners are lit here, seen from the origin of each ray.
// Contract: corners count as lit on the side that the pixel's ray sees. The three normals are turned as one, by the sign of their
//           sum against the geometric normal: whatever the winding says, and without a jump where one of them alone lies below
//           the horizon. The geometric normal cuts off light per pixel, but for lifted rays. At a vertex: Phong (HARD-CASES S6).
template <class Kind>
void add_light_gouraud(const Frame& frame, const SurfaceBatch& s, const HitBatch& hits, int light_index, const uint32_t* lit,
                       const float* corner_light, float* const radiance[3]) {
  const SceneData& scene = *frame.scene;
  const Light& light = light_of(frame, light_index);
  const LightLanes lanes = broadcast_light(light);
  const bool specular = frame.plan.specular;
  for (int i = 0; i < s.count; i += kLanes) {
    Mask active = active_lanes(s, i, lit);
    if (!any(active)) continue;
    active = active & reached(frame, s, i, Kind::incidence(lanes, load3(s.position, i)), lit);
    if (!any(active)) continue;
    const V3 geometric_normal = load3(s.geometric_normal, i);
    V3 normals = {F32::zero(), F32::zero(), F32::zero()};
    const I32 primitive = select(active, I32::load(s.primitive + i), I32::zero());
    const I32 material = select(active, I32::load(s.material + i), I32::zero());
    Corner corner = {{}, {}, {}, material_shininess(scene, material), reflectance_models(scene, material)};
    const Viewer viewer = viewer_of(frame, s, hits, active, i);
    Reflected at[3];
    for (int j = 0; j < 3; ++j) {
      const I32 v = corner_vertex(scene, primitive, j);
      corner.normal = vertex_normal(scene, v);
      if (corner_light != nullptr) {
        at[j] = {gather(corner_light, v + v), gather(corner_light + 1, v + v)};
      } else {
        corner.position = vertex_position(scene, v);
        corner.view = view_from(viewer, corner.position);
        at[j] = light_corner<Kind>(frame, lanes, corner, active);
      }
      normals = normals + corner.normal;
    }
    const Mask front = formula::dot(normals, geometric_normal) >= F32::zero();
    for (Reflected& r : at) {
      r.diffuse = formula::shading::gouraud::seen_from(front, r.diffuse);
      r.specular = formula::shading::gouraud::seen_from(front, r.specular);
    }
    const V3 weight = load3(s.weight, i);
    const Reflected factor = {
        formula::shading::gouraud::interpolate(weight, at[0].diffuse, at[1].diffuse, at[2].diffuse),
        formula::shading::gouraud::interpolate(weight, at[0].specular, at[1].specular, at[2].specular)};
    accumulate(s, i, active, light, factor, specular, radiance);
  }
}

}  // namespace

void light_vertices_entry(const Frame& frame, const uint32_t* vertex, const uint32_t* material, int count, float* values,
                          size_t light_stride) {
  for (int i = 0; i < static_cast<int>(frame.scene->lights.size()); ++i) {
    const Light& light = light_of(frame, i);
    switch (light.kind) {
#define SPANRAY_CATALOG_ENTRY(index, name)                                                    \
  case index: light_vertices<LightKind_##name>(frame, light, vertex, material, count, values); break;
#include "catalog_lights_list.inc"
#undef SPANRAY_CATALOG_ENTRY
    }
    values += light_stride;
  }
}

void shade_light_gouraud_entry(const Frame& frame, const SurfaceBatch& s, const HitBatch& hits, int light,
                               const uint32_t* lit, const float* corner_light, float* const radiance[3]) {
  switch (light_of(frame, light).kind) {
#define SPANRAY_CATALOG_ENTRY(index, name) \
  case index: return add_light_gouraud<LightKind_##name>(frame, s, hits, light, lit, corner_light, radiance);
#include "catalog_lights_list.inc"
#undef SPANRAY_CATALOG_ENTRY
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {
const LightVerticesFn kLightVertices[kIsaCount] = SPANRAY_KERNEL_TABLE(light_vertices_entry);
const ShadeLightGouraudFn kShadeLightGouraud[kIsaCount] = SPANRAY_KERNEL_TABLE(shade_light_gouraud_entry);
}  // namespace spanray
#endif
