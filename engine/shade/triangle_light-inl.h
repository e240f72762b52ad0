// Light that depends on the triangle alone: at its corners, to be interpolated (Gouraud), or on its face (flat). Include inside a *_kernel.cpp.
#if defined(SPANRAY_TRIANGLE_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_TRIANGLE_LIGHT_INL_H_
#undef SPANRAY_TRIANGLE_LIGHT_INL_H_
#else
#define SPANRAY_TRIANGLE_LIGHT_INL_H_
#endif

#include "shade/light_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace light_lanes {

// One corner of each lane's triangle.
struct Corner { V3 position, normal, view; };

// What the triangle's material says of all of its corners; textures multiply Kd and Ks later, per pixel.
struct CornerMaterial { F32 shininess; I32 model; };
HWY_INLINE CornerMaterial corner_material(const SceneData& scene, I32 material) {
  return {material_shininess(scene, material), reflectance_models(scene, material)};
}

// Attenuation times reflectance times cosine of one light at corners, for the side of the surface that the light is on, with the
// sign of n.l.
// Contract: depends on the corner, its material, the viewer and the light only, never on the lane.
template <class Kind>
HWY_INLINE Reflected light_corner(const Frame& frame, const LightLanes& light, const Corner& corner, const CornerMaterial& material,
                                  Mask active) {
  const Incidence incidence = Kind::incidence(light, corner.position);
  const F32 signed_n_l = formula::dot(corner.normal, incidence.direction);
  const V3 n = select3(signed_n_l < F32::zero(), -corner.normal, corner.normal);
  const F32 n_l = abs_(signed_n_l);
  active = active & (n_l > F32::zero());
  const bool specular = frame.plan.specular, fast_powers = frame.settings.powers == Powers::kFast;
  Cosines c = formula::cosines(n, incidence.direction, corner.view, n_l, material.shininess, fast_powers);
  if (specular) formula::add_half_way(c, n, incidence.direction, corner.view);
  const Reflected r = reflect(material.model, active, specular, c);
  return {copysign_(r.diffuse * incidence.attenuation, signed_n_l), copysign_(r.specular * incidence.attenuation, signed_n_l)};
}

// The side of the triangle that is seen: the three normals are turned as one, by the sign of their sum against the geometric normal,
// whatever the winding says, and without a jump where one of them alone lies below the horizon.
HWY_INLINE Mask normals_in_front(const Corner (&corner)[3], const V3& geometric_normal) {
  const V3 none = {F32::zero(), F32::zero(), F32::zero()};
  return formula::dot(none + corner[0].normal + corner[1].normal + corner[2].normal, geometric_normal) >= F32::zero();
}

// Light at the three corners, as the side that is seen reflects it.
struct CornerLight { Reflected at[3]; };
template <class Kind>
HWY_INLINE CornerLight light_corners(const Frame& frame, const LightLanes& light, const Corner (&corner)[3],
                                     const CornerMaterial& material, Mask front, Mask active) {
  CornerLight r;
  for (int j = 0; j < 3; ++j) {
    const Reflected both = light_corner<Kind>(frame, light, corner[j], material, active);
    r.at[j] = {formula::shading::gouraud::seen_from(front, both.diffuse), formula::shading::gouraud::seen_from(front, both.specular)};
  }
  return r;
}

HWY_INLINE Reflected interpolate_corners(const V3& weight, const CornerLight& c) {
  using formula::shading::gouraud::interpolate;
  return {interpolate(weight, c.at[0].diffuse, c.at[1].diffuse, c.at[2].diffuse),
          interpolate(weight, c.at[0].specular, c.at[1].specular, c.at[2].specular)};
}

// Where light is evaluated for a surface.
struct Site { V3 position, normal, view; };

// The centroid of the face, with the face normal: equal for all pixels of a face, up to the rounding of its normal.
HWY_INLINE Site face_site(const V3 (&corner)[3], const V3& geometric_normal, const Viewer& viewer) {
  using formula::shading::flat::centroid;
  Site site;
  site.position = {centroid(corner[0].x, corner[1].x, corner[2].x), centroid(corner[0].y, corner[1].y, corner[2].y),
                   centroid(corner[0].z, corner[1].z, corner[2].z)};
  site.normal = geometric_normal;
  site.view = view_from(viewer, site.position);
  return site;
}

HWY_INLINE Site face_site(const SceneData& scene, I32 primitive, const V3& geometric_normal, const Viewer& viewer) {
  V3 corner[3];
  for (int j = 0; j < 3; ++j) corner[j] = vertex_position(scene, corner_vertex(scene, primitive, j));
  return face_site(corner, geometric_normal, viewer);
}

// Attenuation times reflectance times cosine at a site that the light falls on with cosine n_l. specular: of it too.
HWY_INLINE Reflected light_site(const Frame& frame, const Site& site, const Incidence& incidence, F32 n_l, F32 shininess, I32 model, Mask active,
                                bool specular) {
  const bool fast_powers = frame.settings.powers == Powers::kFast;
  Cosines c = formula::cosines(site.normal, incidence.direction, site.view, n_l, shininess, fast_powers);
  if (specular) formula::add_half_way(c, site.normal, incidence.direction, site.view);
  const Reflected r = reflect(model, active, specular, c);
  return {r.diffuse * incidence.attenuation, r.specular * incidence.attenuation};
}

// One light on faces that the eye sees.
template <class Kind>
HWY_INLINE Reflected light_face(const Frame& frame, const LightLanes& light, const Site& site, const CornerMaterial& material) {
  const Incidence incidence = Kind::incidence(light, site.position);
  const F32 n_l = formula::dot(site.normal, incidence.direction), zero = F32::zero();
  const Mask lit = n_l > zero;
  const Reflected r = light_site(frame, site, incidence, n_l, material.shininess, material.model, lit, frame.plan.specular);
  return {select(lit, r.diffuse, zero), select(lit, r.specular, zero)};
}

// One light of triangles that anyone looks at, interpolated at one point of each.
template <class Kind>
HWY_INLINE Reflected light_triangles(const Frame& frame, const LightLanes& light, I32 primitive, I32 material, const Viewer& viewer,
                                     const V3& geometric_normal, const V3& weight, Mask active) {
  const SceneData& scene = *frame.scene;
  Corner corner[3];
  for (int j = 0; j < 3; ++j) {
    const I32 v = corner_vertex(scene, primitive, j);
    corner[j].position = vertex_position(scene, v), corner[j].normal = vertex_normal(scene, v);
    corner[j].view = view_from(viewer, corner[j].position);
  }
  const Mask front = normals_in_front(corner, geometric_normal);
  return interpolate_corners(weight, light_corners<Kind>(frame, light, corner, corner_material(scene, material), front, active));
}

// One light on the faces of triangles that the viewer sees.
template <class Kind>
HWY_INLINE Reflected light_faces(const Frame& frame, const LightLanes& light, I32 primitive, I32 material, const Viewer& viewer,
                                 const V3& geometric_normal) {
  return light_face<Kind>(frame, light, face_site(*frame.scene, primitive, geometric_normal, viewer), corner_material(*frame.scene, material));
}

// visit(kind) with the LightKind_ of a light.
template <class Visit> HWY_INLINE void with_kind(const Light& light, const Visit& visit) {
  switch (light.kind) {
#define SPANRAY_CATALOG_ENTRY(index, name) \
  case index: return visit(LightKind_##name());
#include "catalog_lights_list.inc"
#undef SPANRAY_CATALOG_ENTRY
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace light_lanes
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_TRIANGLE_LIGHT_INL_H_
