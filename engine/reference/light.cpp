#include "reference/light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spanray::reference {
namespace {

glm::dvec3 colored(const Surface& s, const Light& light, const Reflectance& r, double irradiance) {
  return to_dvec(light.intensity) * (s.diffuse * r.diffuse + s.specular * r.specular) * irradiance;
}

// Once for the whole face, at its middle (Bouknight 1970).
glm::dvec3 flat(const SceneData& scene, const Surface& s, int32_t model, const Light& light, const glm::dvec3& viewer) {
  glm::dvec3 middle(0);
  for (const uint32_t v : scene.triangles[s.primitive].vertex) middle += to_dvec(scene.vertices[v].position) * (1 / 3.0);
  const Incidence in = incidence(light, middle);
  if (!(dot3(s.geometric, in.direction) > 0)) return glm::dvec3(0);
  const Reflectance r = reflectance(model, s.geometric, in.direction, normalize3(viewer - middle, glm::dvec3(0)), s.shininess);
  return colored(s, light, r, in.irradiance);
}

// At the corners, interpolated (Gouraud 1971). A corner counts on the side of its normal that the light is on; the three
// normals together decide which side is seen. Textures stay per pixel; the exponent is the material's own.
glm::dvec3 gouraud(const SceneData& scene, const Surface& s, const Material& m, const Light& light, const glm::dvec3& viewer) {
  Reflectance sum;
  glm::dvec3 normals(0);
  for (const uint32_t v : scene.triangles[s.primitive].vertex) normals += to_dvec(scene.vertices[v].normal);
  const double side = dot3(normals, s.geometric) >= 0 ? 1 : -1;
  for (int k = 0; k < 3; ++k) {
    const Vertex& corner = scene.vertices[scene.triangles[s.primitive].vertex[k]];
    const glm::dvec3 position = to_dvec(corner.position), normal = to_dvec(corner.normal) * side;
    const Incidence in = incidence(light, position);
    if (!(dot3(normal, in.direction) > 0)) continue;
    const Reflectance r =
        reflectance(m.reflectance, normal, in.direction, normalize3(viewer - position, glm::dvec3(0)), m.shininess);
    sum.diffuse += s.weight[k] * r.diffuse * in.irradiance, sum.specular += s.weight[k] * r.specular * in.irradiance;
  }
  return colored(s, light, sum, 1);
}

}  // namespace

Incidence incidence(const Light& light, const glm::dvec3& position) {
  if (light.kind == static_cast<int32_t>(LightKind::kDirectional)) return {-to_dvec(light.direction), 1};
  const glm::dvec3 way = to_dvec(light.position) - position;
  const double d = length3(way);
  if (d < 0x1p-62) return {};
  const double falloff = light.attenuation[0] + light.attenuation[1] * d + light.attenuation[2] * d * d;
  return {way * (1 / d), 1 / std::max(falloff, double{kMinAttenuation})};
}

Reflectance reflectance(int32_t model, const glm::dvec3& n, const glm::dvec3& l, const glm::dvec3& v, double shininess) {
  Reflectance r{dot3(n, l) / std::numbers::pi, 0};
  const glm::dvec3 half = l + v;
  const double length = length3(half);
  if (model != kBlinnPhong || !(length > 1e-5)) return r;  // light from behind along the view has no half-way direction
  const double cosine = std::min(dot3(n, half) / length, 1.0);
  if (cosine > 0) r.specular = std::pow(cosine, shininess) / std::numbers::pi;
  return r;
}

glm::dvec3 mirror_direction(const Surface& s) {
  const glm::dvec3 d = -s.view, r = d - s.normal * (2 * dot3(d, s.normal));
  return r + s.geometric * std::max(kHorizon - dot3(s.geometric, r), 0.0);
}

glm::dvec3 start_above(const Surface& s) { return s.position + s.geometric * s.clearance; }

// Ends a little before a point light, so that a lamp modelled around it casts no shadow by touching it.
Way way_to(const Light& light, const glm::dvec3& origin) {
  if (light.kind == static_cast<int32_t>(LightKind::kDirectional))
    return {{origin, -to_dvec(light.direction)}, std::numeric_limits<double>::infinity()};
  return {{origin, to_dvec(light.position) - origin}, 1 - 0x1p-16};
}

glm::dvec3 ambient_radiance(const SceneData& scene, const Surface& s) {
  return s.ambient * to_dvec(scene.ambient_radiance) + s.emission;
}

bool faces(const Surface& s, const Light& light) { return dot3(s.geometric, incidence(light, s.position).direction) > 0; }

bool faces_lifted(const Surface& s, const Light& light) {
  return s.lift != glm::dvec3(0) && dot3(s.smooth, incidence(light, s.position).direction) > 0;
}

glm::dvec3 reflected(const SceneData& scene, Shading shading, const Surface& s, const Light& light, const glm::dvec3& viewer) {
  const Material& m = scene.materials[material_of(scene, s.primitive)];
  if (!scene.is_triangle(s.primitive)) shading = Shading::kPhong;  // always by its own normal
  if (shading == Shading::kFlat) return flat(scene, s, m.reflectance, light, viewer);
  if (shading == Shading::kGouraud) return gouraud(scene, s, m, light, viewer);
  const Incidence in = incidence(light, s.position);
  if (!(dot3(s.normal, in.direction) > 0)) return glm::dvec3(0);
  return colored(s, light, reflectance(m.reflectance, s.normal, in.direction, s.view, s.shininess), in.irradiance);
}

}  // namespace spanray::reference
