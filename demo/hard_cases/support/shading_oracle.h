// Light on one surface, in double, written from the model's definition alone (no code of engine/catalog or engine/shade):
//   radiance = ambient * scene ambient + emission + sum over lit lights of E * (Kd max(0, n.l) + Ks [n.l > 0] max(0, n.h)^Ns) / pi
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "scene/scene_data.h"
#include "math/vec.h"

namespace spanray {

struct OracleSurface {
  glm::dvec3 position{0}, geometric_normal{0}, normal{0}, view{0};
  glm::dvec3 ambient{0}, diffuse{0}, specular{0}, emission{0};
  double shininess = 1;
};

inline glm::dvec3 oracle_vec(const float* v) { return glm::dvec3(v[0], v[1], v[2]); }

struct OracleIncidence { glm::dvec3 to_light{0}; double irradiance = 0; };  // unit or zero; for intensity 1
inline OracleIncidence oracle_incidence(const glm::dvec3& position, const Light& light) {
  if (light.kind == static_cast<int32_t>(LightKind::kDirectional)) return {-oracle_vec(light.direction), 1.0};
  const glm::dvec3 path = oracle_vec(light.position) - position;
  const double d = std::sqrt(path.x * path.x + path.y * path.y + path.z * path.z);
  if (d == 0) return {};
  const double falloff = light.attenuation[0] + light.attenuation[1] * d + light.attenuation[2] * d * d;
  return {path / d, 1.0 / std::max(falloff, double(kMinAttenuation))};
}

// Diffuse and specular reflectance times cosine. specular 0 for lambert (catalog index 1).
struct OracleReflected { double diffuse = 0, specular = 0; };
inline OracleReflected oracle_reflected(const glm::dvec3& n, const glm::dvec3& l, const glm::dvec3& v, double shininess,
                                        int reflectance = 0) {
  const double pi = 3.14159265358979323846;
  const double n_l = n.x * l.x + n.y * l.y + n.z * l.z;
  if (n_l <= 0) return {};
  OracleReflected r{n_l / pi, 0};
  const glm::dvec3 sum = l + v;
  const double length = std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z);
  if (reflectance != 0 || length <= 1e-5) return r;
  const double n_h = (n.x * sum.x + n.y * sum.y + n.z * sum.z) / length;
  if (n_h > 0) r.specular = std::pow(std::min(n_h, 1.0), shininess) / pi;
  return r;
}

inline glm::dvec3 oracle_light(const OracleSurface& s, const Light& light, int reflectance = 0) {
  const OracleIncidence in = oracle_incidence(s.position, light);
  const glm::dvec3& g = s.geometric_normal;
  if (g.x * in.to_light.x + g.y * in.to_light.y + g.z * in.to_light.z <= 0) return glm::dvec3(0);
  const OracleReflected r = oracle_reflected(s.normal, in.to_light, s.view, s.shininess, reflectance);
  return in.irradiance * oracle_vec(light.intensity) * (s.diffuse * r.diffuse + s.specular * r.specular);
}

// Bit i of lit: light i reaches the surface.
inline glm::dvec3 oracle_radiance(const OracleSurface& s, const SceneData& scene, uint64_t lit, int reflectance = 0) {
  glm::dvec3 sum = s.ambient * oracle_vec(scene.ambient_radiance) + s.emission;
  for (size_t i = 0; i < scene.lights.size(); ++i)
    if (lit >> i & 1) sum += oracle_light(s, scene.lights[i], reflectance);
  return sum;
}

// Linear radiance -> sRGB in [0, 1], not rounded.
inline double oracle_srgb(double linear) {
  const double x = std::min(std::max(linear, 0.0), 1.0);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

}  // namespace spanray
