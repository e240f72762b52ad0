// Everything that scene/scene_data.h promises of a loaded scene, whatever the file was.
#pragma once
#include <cmath>
#include <string>

#include "scene/scene_data.h"

namespace spanray {

inline std::string broken_counts(const SceneData& s) {
  if (s.materials.empty() || s.materials.size() != s.material_names.size()) return "materials";
  if (s.cameras.empty() || s.cameras.size() != s.camera_names.size()) return "cameras";
  if (s.textures.size() != s.texture_names.size()) return "texture names";
  if (s.lights.size() > static_cast<size_t>(kMaxLights)) return "too many lights";
  return {};
}

inline std::string broken_geometry(const SceneData& s) {
  for (const Vertex& v : s.vertices) {
    double length = 0;
    for (int k = 0; k < 3; ++k) {
      if (!std::isfinite(v.position[k]) || !std::isfinite(v.normal[k])) return "a vertex that is not finite";
      if (!(s.bounds_min[k] <= v.position[k] && v.position[k] <= s.bounds_max[k])) return "a vertex out of bounds";
      length += static_cast<double>(v.normal[k]) * static_cast<double>(v.normal[k]);
    }
    if (!(std::fabs(length - 1) < 1e-6)) return "a normal that has not length 1";
    if (!std::isfinite(v.uv[0]) || !std::isfinite(v.uv[1])) return "texture coordinates that are not finite";
  }
  for (const Triangle& t : s.triangles) {
    if (material_of(t) >= s.materials.size()) return "a material index";
    for (const uint32_t i : t.vertex)
      if (i >= s.vertices.size()) return "a vertex index";
  }
  return {};
}

inline std::string broken_material(const SceneData& s) {
  for (const Material& m : s.materials) {
    for (const float* c : {m.ambient, m.diffuse, m.specular, m.emission, m.mirror})
      for (int k = 0; k < 3; ++k)
        if (!(c[k] >= 0 && std::isfinite(c[k]))) return "a color";
    if (!(m.opacity >= 0 && m.opacity <= 1 && m.shininess >= 0 && m.shininess <= 1e4f)) return "opacity or shininess";
    for (const int32_t use : {m.map_ambient, m.map_diffuse, m.map_specular, m.map_shininess, m.map_emission, m.map_opacity,
                              m.map_bump, m.map_normal})
      if (use < -1 || use >= static_cast<int32_t>(s.texture_uses.size())) return "the index of a texture use";
  }
  for (const TextureUse& u : s.texture_uses)
    if (u.texture < 0 || static_cast<size_t>(u.texture) >= s.textures.size()) return "the index of a texture";
  for (const Texture& t : s.textures)
    if (t.width < 1 || t.height < 1 || t.levels < 1 || t.offset[0] < 0 ||
        static_cast<size_t>(t.offset[t.levels - 1]) >= s.texels.size())
      return "a texture's levels";
  return {};
}

// The first promise that does not hold; empty if all do.
inline std::string broken_promise(const SceneData& s) {
  std::string broken = broken_counts(s);
  if (broken.empty()) broken = broken_geometry(s);
  if (broken.empty()) broken = broken_material(s);
  for (const Camera& c : s.cameras)
    for (int k = 0; k < 3 && broken.empty(); ++k)
      if (!std::isfinite(c.eye[k]) || !std::isfinite(c.target[k]) || !(c.near_plane > 0)) broken = "a camera";
  for (const Light& l : s.lights)
    for (int k = 0; k < 3 && broken.empty(); ++k)
      if (!std::isfinite(l.position[k]) || !std::isfinite(l.direction[k]) || !(l.intensity[k] >= 0)) broken = "a light";
  return broken;
}

}  // namespace spanray
