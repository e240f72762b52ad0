// From a ray and the primitive that it met to everything that light needs, in double.
#pragma once
#include "reference/texture.h"
#include "reference/tree.h"

namespace spanray::reference {

// The catalog's reflectances that the reference knows, by index.
inline constexpr int32_t kBlinnPhong = 0, kLambert = 1;
// Least cosine of shading normals, and of mirror rays, to the geometric normal.
inline constexpr double kHorizon = 1.0 / 1024;

inline glm::dvec3 to_dvec(const float* v) { return {v[0], v[1], v[2]}; }

// What a material means to visibility under some settings (docs/decisions/0003-transparency.md).
enum class Role { kOpaque, kMask, kScreenDoor, kBlended };
Role role_of(const Material& material, const Settings& settings);

// A ray with its footprint: how origin and direction change by a pixel in x and y (Igehy 1999); zero: a point.
struct Ray {
  Line line;
  glm::dvec3 origin_dx{0}, origin_dy{0}, direction_dx{0}, direction_dy{0};
  double t_min = 0;    // its hits lie beyond: the near plane, of primary rays
  int x = 0, y = 0;    // the pixel that started it: where it stands in the screen-door pattern
  int rank_shift = 0;  // of the pattern, for the samples of a pixel
};

struct Surface {
  uint32_t primitive = kNoPrimitive;
  double t = 0, weight[3] = {};
  glm::dvec3 position{0}, geometric{0}, normal{0}, view{0};  // unit vectors; geometric: toward the ray's origin
  glm::dvec3 position_dx{0}, position_dy{0};
  glm::dvec3 ambient{0}, diffuse{0}, specular{0}, emission{0}, mirror{0};
  double shininess = 1, opacity = 1;
  double clearance = 0;  // rays that leave the surface start this far above it
  // With ShadowTerminator::kLifted: from the position to where lifted shadow rays start, in the scene's units; zero where there
  // are none. smooth: the interpolated normal, before maps bend it; unit.
  glm::dvec3 lift{0}, smooth{0};
};

class Surfaces {
 public:
  Surfaces(const SceneData& scene, const Settings& settings);

  Surface at(const Ray& ray, uint32_t primitive, const Nudge& nudge = {}) const;
  // Do cut-outs and screen-door let the surface stop the ray? And does culling?
  bool stops(const Ray& ray, uint32_t primitive) const;
  // Its parts: what culling says; the opacity that cut-outs and screen-door go by (1 for other surfaces), and what follows from
  // it.
  bool culled(const Ray& ray, uint32_t primitive) const;
  double stop_opacity(const Ray& ray, uint32_t primitive, const Nudge& nudge = {}) const;
  bool stops(const Ray& ray, uint32_t primitive, double opacity) const;
  Role role(uint32_t primitive) const { return role_[material_of(scene_, primitive)]; }
  const Material& material(uint32_t primitive) const { return scene_.materials[material_of(scene_, primitive)]; }

 private:
  struct Point;  // where the ray meets the plane of the triangle
  Point point_on_sphere(const Ray& ray, uint32_t primitive) const;
  Point point_on_plane(const Ray& ray, uint32_t primitive) const;
  Point point_at(const Ray& ray, uint32_t primitive, const Nudge& nudge) const;
  glm::dvec3 interpolated_normal(const Point& point, uint32_t primitive) const;
  glm::dvec3 lift(const Point& point, uint32_t primitive, double clearance) const;
  glm::dvec3 bumped(const Point& point, const Material& material, glm::dvec3 normal) const;
  void apply_maps(const Point& point, const Material& material, Surface& s) const;
  const TextureUse* use(int32_t map) const;

  const SceneData& scene_;
  const Settings settings_;
  const Textures textures_;
  std::vector<Role> role_;  // by material
};

}  // namespace spanray::reference
