#pragma once
#include "support/surface_scenes.h"

namespace spanray {

inline Material material_of_kind(MaterialTransparency kind, float opacity) {
  Material m;
  m.transparency = static_cast<int32_t>(kind);
  m.opacity = opacity;
  return m;
}

// A quad that fills the picture of the default camera, uv over [0, 4]^2, cut in two triangles of one material.
inline std::unique_ptr<TestFrame> quad_frame(const Material& material, const std::function<void(SceneData&, Material&)>& setup = {}) {
  const SoupTriangle a = with_uv(soup_triangle({-4, -4, 0}, {4, -4, -1}, {4, 4, 0}), {0, 0}, {4, 0}, {4, 4});
  const SoupTriangle b = with_uv(soup_triangle({-4, -4, 0}, {4, 4, 0}, {-4, 4, 1}), {0, 0}, {4, 4}, {0, 4});
  SceneData scene = make_test_scene({a, b}, {material});
  if (setup) setup(scene, scene.materials[0]);
  auto t = make_test_frame(std::move(scene), Camera{}, test_settings(128, 128));
  plan_all(t->frame);
  return t;
}

}  // namespace spanray
