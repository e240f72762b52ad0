// Scenes of coarse smooth meshes under lights that are all there is, for tests of Settings::shadow_terminator.
#pragma once
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "support/bvh_oracle.h"
#include "support/surface_oracle.h"
#include "support/test_surfaces.h"

namespace spanray {

inline constexpr int kSide = 96;

inline Settings small(ShadowTerminator terminator) {
  Settings s = test_settings(kSide, kSide);
  s.shadow_terminator = terminator;
  return s;
}

// A sphere of 20 * 4^levels triangles whose normals are those of the true sphere.
inline std::vector<SoupTriangle> sphere(int levels, double radius, const glm::dvec3& at = glm::dvec3(0), uint32_t material = 0) {
  const IndexedMesh mesh = make_sphere(levels);
  std::vector<SoupTriangle> soup;
  add_mesh(soup, mesh, radius, at, material);
  for (SoupTriangle& t : soup)
    for (Vertex& v : t.corner)
      for (int k = 0; k < 3; ++k) v.normal[k] = static_cast<float>((v.position[k] - at[k]) / radius);
  return soup;
}

inline Material matte() {
  Material m;
  for (int k = 0; k < 3; ++k) m.diffuse[k] = 1, m.ambient[k] = 0;
  return m;
}

inline Light lamp(const glm::dvec3& at) {
  Light light;
  for (int k = 0; k < 3; ++k) light.position[k] = static_cast<float>(at[k]), light.intensity[k] = 40;
  return light;
}

// Lights and nothing else: what is not lit is exactly black.
inline Scene scene_of(const std::vector<SoupTriangle>& soup, const std::vector<Light>& lights, std::vector<Material> materials = {matte()}) {
  auto data = std::make_shared<SceneData>(make_test_scene(soup, std::move(materials)));
  data->lights = lights;
  std::fill_n(data->background, 3, 0.0f);
  hash_scene(*data);
  return Scene(data);
}

}  // namespace spanray
