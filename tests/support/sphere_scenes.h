// Scenes with exact spheres, and frames of them.
#pragma once
#include <gtest/gtest.h>

#include <utility>

#include "math/vec.h"
#include "reference/reference.h"
#include "scene/scene_builder.h"
#include "spanray/render.h"
#include "support/random.h"
#include "support/test_frame.h"

namespace spanray {

inline Sphere ball(const glm::dvec3& c, double r, uint32_t material = 0) {
  Sphere s{};
  for (int k = 0; k < 3; ++k) s.center[k] = static_cast<float>(c[k]);
  s.radius = static_cast<float>(r), s.material = material;
  return s;
}

inline void add_sun(SceneData& scene, const glm::dvec3& along) {
  Light sun;
  sun.kind = static_cast<int32_t>(LightKind::kDirectional);
  const glm::dvec3 d = normalize3(along, glm::dvec3(0, -1, 0));
  for (int k = 0; k < 3; ++k) sun.direction[k] = static_cast<float>(d[k]), sun.intensity[k] = 2;
  scene.lights.push_back(sun);
}
inline void add_lamp(SceneData& scene, const glm::dvec3& at, float watts) {
  Light lamp;
  for (int k = 0; k < 3; ++k) lamp.position[k] = static_cast<float>(at[k]), lamp.intensity[k] = watts;
  scene.lights.push_back(lamp);
}

inline Scene finish(SceneData&& scene) {
  hash_scene(scene);
  return Scene(std::make_shared<SceneData>(std::move(scene)));
}

// A floor with balls on it, in it and through each other, a mirroring one, a pane of glass before some.
enum { kMatte, kShiny, kMirror, kGlass };
inline Scene crowd() {
  std::vector<Material> m(4);
  m[kShiny].diffuse[1] = m[kShiny].diffuse[2] = 0.1f;
  for (int k = 0; k < 3; ++k) m[kShiny].specular[k] = 0.5f, m[kMirror].mirror[k] = 0.7f, m[kMirror].diffuse[k] = 0.1f;
  m[kShiny].shininess = 60;
  m[kGlass].opacity = 0.4f, m[kGlass].transparency = static_cast<int32_t>(MaterialTransparency::kAlpha);
  std::vector<SoupTriangle> soup = {soup_triangle({-4, 0, -4}, {-4, 0, 4}, {4, 0, 4}),
                                    soup_triangle({-4, 0, -4}, {4, 0, 4}, {4, 0, -4}),
                                    soup_triangle({-1.5, 0.1, 1.8}, {0, 0.1, 1.8}, {0, 1.2, 1.8}, kGlass)};
  SceneData scene = make_test_scene(soup, m);
  add_sphere(ball({0, 0.7, 0}, 0.7, kMirror), scene);
  add_sphere(ball({-1.2, 0.5, 0.6}, 0.5, kShiny), scene);
  add_sphere(ball({1.2, 0.4, 0.8}, 0.4), scene);
  add_sphere(ball({1.0, 0.6, 0.9}, 0.25, kShiny), scene);
  add_sphere(ball({0.2, -0.05, 1.6}, 0.2, kShiny), scene);
  TestRandom random(3);
  for (int i = 0; i < 40; ++i) {
    const uint32_t material = static_cast<uint32_t>(random.below(2));  // first: compilers order arguments as they like
    add_sphere(ball({random.uniform(-3, 3), 0.05, random.uniform(-3, 3)}, 0.05, material), scene);
  }
  add_lamp(scene, {3, 5, 3}, 60), add_sun(scene, {1, -2, -1});
  return finish(std::move(scene));
}

inline Camera from_to(const glm::dvec3& eye, const glm::dvec3& target, double near_plane = 0.01) {
  Camera c;
  for (int k = 0; k < 3; ++k) c.eye[k] = eye[k], c.target[k] = target[k];
  c.near_plane = near_plane;
  return c;
}
inline const Camera kCrowdView = from_to({0.5, 2.0, 5.5}, {0, 0.6, 0});

inline Framebuffer render(const Scene& scene, const Camera& camera, const Settings& settings) {
  FrameRequest request;
  request.radiance = request.depth = request.primitive = request.normal = request.uv = true;
  Framebuffer out;
  Renderer renderer;
  const Result<FrameStats> done = renderer.render(scene, camera, settings, out, request);
  EXPECT_TRUE(done) << done.error().to_string();
  return out;
}

inline uint64_t sphere_pixels(const Scene& scene, const Framebuffer& f) {
  uint64_t n = 0;
  for (const uint32_t p : f.primitive) n += p != kNoPrimitive && scene.data().is_sphere(p);
  return n;
}

// The frame shows what the reference shows, but for a few pixels at edges.
inline void expect_reference(const Scene& scene, const Camera& camera, const Settings& settings) {
  Framebuffer truth;
  ASSERT_TRUE(render_reference(scene, camera, settings, {}, truth));
  const Framebuffer fast = render(scene, camera, settings);
  int over = 0, ids = 0;
  for (size_t i = 0; i < fast.primitive.size(); ++i) {
    ids += fast.primitive[i] != truth.primitive[i];
    int most = 0;
    for (size_t k = 4 * i; k < 4 * i + 4; ++k) most = std::max(most, std::abs(truth.color.rgba[k] - fast.color.rgba[k]));
    over += most > 1;
  }
  const std::string where = "shading " + std::to_string(static_cast<int>(settings.shading)) + ", culling " + std::to_string(static_cast<int>(settings.culling)) +
                            ", eye at z " + std::to_string(camera.eye[2]);
  EXPECT_LE(ids, 10) << where;
  EXPECT_LE(over, 30) << where;
}

}  // namespace spanray
