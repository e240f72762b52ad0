// Scenes with exact planes.
#pragma once
#include "support/sphere_scenes.h"

namespace spanray {

inline Plane plane_at(const glm::dvec3& point, const glm::dvec3& normal, uint32_t material = 0) {
  Plane p{};
  for (int k = 0; k < 3; ++k) p.point[k] = static_cast<float>(point[k]);
  EXPECT_TRUE(set_normal(normal, p));
  p.material = material;
  return p;
}

inline void no_ambient(SceneData& scene) {
  for (float& a : scene.ambient_radiance) a = 0;
}

// A floor to the horizon with balls and a pyramid on it, a tilted mirroring plane far behind, a quad painted onto the floor.
inline Scene landscape() {
  std::vector<Material> m(3);
  m[kShiny].diffuse[1] = m[kShiny].diffuse[2] = 0.1f;
  for (int k = 0; k < 3; ++k) m[kShiny].specular[k] = 0.5f, m[kMirror].mirror[k] = 0.7f, m[kMirror].diffuse[k] = 0.1f;
  m[kShiny].shininess = 60;
  const glm::dvec3 top(-1.5, 1.2, -0.5), a(-2.1, -0.2, 0), b(-0.9, -0.2, 0), c(-1.5, -0.2, -1.1);
  SceneData scene = make_test_scene({soup_triangle(a, b, top), soup_triangle(b, c, top), soup_triangle(c, a, top),
                                     soup_triangle({-0.4, 0, 2.2}, {0.9, 0, 2.1}, {0.3, 0, 1.3}, kShiny)},
                                    m);
  add_sphere(ball({0, 0.7, 0}, 0.7, kMirror), scene);
  add_sphere(ball({1.3, 0.4, 0.8}, 0.4, kShiny), scene);
  add_sphere(ball({0.7, -0.05, 1.6}, 0.2, kShiny), scene);
  add_plane(plane_at({0, 0, 0}, {0, 1, 0}), scene);
  add_plane(plane_at({0, 0, -7}, {0.2, -0.1, 1}, kMirror), scene);
  add_lamp(scene, {3, 5, 3}, 60), add_sun(scene, {1, -2, -1});
  return finish(std::move(scene));
}
inline const Camera kLandscapeView = from_to({0.5, 1.6, 5.5}, {0, 0.6, 0});

inline uint64_t plane_pixels(const Scene& scene, const Framebuffer& f) {
  uint64_t n = 0;
  for (const uint32_t p : f.primitive) n += scene.data().is_plane(p);
  return n;
}

}  // namespace spanray
