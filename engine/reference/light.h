// Light on a surface, in double, from the definitions of the model (docs/decisions/0004-units-and-mtl.md).
#pragma once
#include "reference/surface.h"

namespace spanray::reference {

// Light that arrives at a point: the unit vector toward it (zero: none), and W/m^2 on a surface that faces it, for intensity 1.
struct Incidence {
  glm::dvec3 direction{0};
  double irradiance = 0;
};
Incidence incidence(const Light& light, const glm::dvec3& position);

// Reflectance times cosine, 1/sr: to be multiplied by Kd and by Ks.
struct Reflectance {
  double diffuse = 0, specular = 0;
};
// Lambert 1760; Blinn 1977, with the whole divided by pi. Unit vectors: n the shading normal, l to the light, v to the viewer;
// dot(n, l) must be positive.
Reflectance reflectance(int32_t model, const glm::dvec3& n, const glm::dvec3& l, const glm::dvec3& v, double shininess);

// Where the view is mirrored to; lifted above the surface where the shading normal points it inside. About of unit length.
glm::dvec3 mirror_direction(const Surface& s);
// Where rays from a surface start.
glm::dvec3 start_above(const Surface& s);

// The segment that must be free for the light to reach a point: origin + t * direction, 0 < t <= t_max.
struct Way {
  Line line;
  double t_max = 0;
};
Way way_to(const Light& light, const glm::dvec3& origin);

// Ambient light and emission.
glm::dvec3 ambient_radiance(const SceneData& scene, const Surface& s);
// May the light reach the surface at all, shadows aside?
bool faces(const Surface& s, const Light& light);
// ... and may it by a lifted shadow ray? That starts at position + lift, where the segment up to there is free, on to kLiftReach of
// its length; else the shadow ray starts on the surface.
bool faces_lifted(const Surface& s, const Light& light);
inline constexpr double kLiftReach = 1 + 0x1p-10;
// Radiance toward `viewer` by one light that reaches the surface, W/(m^2 sr).
glm::dvec3 reflected(const SceneData& scene, Shading shading, const Surface& s, const Light& light, const glm::dvec3& viewer);

}  // namespace spanray::reference
