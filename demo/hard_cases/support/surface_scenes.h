// Random scenes and hits that use every part of surfaces.
#pragma once
#include <algorithm>

#include "support/surface_oracle.h"

namespace spanray {

inline Texel noise_texel(TestRandom& random) {
  const auto c = [&] { return static_cast<uint16_t>(random.bits() >> 16); };
  return {c(), c(), c(), c()};
}

// Triangles around the origin, sizes 0.01 to 2, two-sided views, six materials: bare, every map, bump, normal map, clamp, -mm.
inline SceneData random_surface_scene(uint32_t seed, int triangles) {
  TestRandom random(seed);
  std::vector<Material> materials(6);
  for (Material& m : materials) {
    for (float* color : {m.ambient, m.diffuse, m.specular, m.emission, m.mirror})
      for (int k = 0; k < 3; ++k) color[k] = static_cast<float>(random.uniform());
    m.shininess = static_cast<float>(random.uniform(1, 100));
    m.opacity = static_cast<float>(random.uniform());
  }
  std::vector<SoupTriangle> soup;
  for (int i = 0; i < triangles; ++i) {
    const double size = std::pow(10.0, random.uniform(-2, 0.3));
    const glm::dvec3 a = random_point(random);
    // One draw a statement: compilers differ in the order in which they evaluate arguments.
    const glm::dvec3 b = a + random_point(random, size);
    const glm::dvec3 c = a + random_point(random, size);
    SoupTriangle t = soup_triangle(a, b, c, static_cast<uint32_t>(i % 6));
    const glm::dvec3 normal = random_point(random);
    for (Vertex& v : t.corner) {
      for (float& uv : v.uv) uv = static_cast<float>(random.uniform(-2, 2));
      const glm::dvec3 n = normal + random_point(random, 0.3);
      for (int k = 0; k < 3; ++k) v.normal[k] = i % 3 ? static_cast<float>(n[k]) : 0.0f;
    }
    soup.push_back(t);
  }
  SceneData scene = make_test_scene(soup, materials);
  const auto noise = [&](int, int) { return noise_texel(random); };
  const int32_t square = add_texture(scene, 64, 64, noise), wide = add_texture(scene, 128, 4, noise), dot = add_texture(scene, 1, 1, noise);
  scene.texture_uses[static_cast<size_t>(wide)].clamp = 1;
  scene.texture_uses[static_cast<size_t>(square)].scale[0] = -3;
  scene.texture_uses[static_cast<size_t>(dot)].base = 0.25f, scene.texture_uses[static_cast<size_t>(dot)].gain = 0.5f;
  Material* m = scene.materials.data();
  m[1].map_diffuse = square, m[1].map_ambient = wide, m[1].map_specular = dot, m[1].map_shininess = square, m[1].map_emission = wide;
  m[1].map_opacity = square, m[2].map_bump = square, m[3].map_normal = wide, m[4].map_diffuse = wide, m[5].map_diffuse = dot;
  return scene;
}

inline Camera random_camera(TestRandom& random, double distance) {
  Camera c;
  const glm::dvec3 eye = normalize3(random_point(random), glm::dvec3(0, 0, 1)) * distance;
  for (int k = 0; k < 3; ++k) c.eye[k] = eye[k], c.target[k] = 0.1 * k;
  c.fov_y_degrees = 60;
  return c;
}

// The pixel that sees p; false if none does.
inline bool pixel_of(const Frame& frame, const glm::dvec3& p, uint32_t* pixel) {
  const PrimaryRays& r = frame.primary;
  const glm::dvec3 v = p - r.eye;
  const double w = dot3(r.forward, v), x = dot3(r.pixel_row_x, v) / w, y = dot3(r.pixel_row_y, v) / w;
  if (!(w > 0) || !(x >= 0) || !(y >= 0) || x >= r.width || y >= r.height) return false;
  *pixel = pack_pixel(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
  return true;
}

// n primary hits of random triangles near random points of them: also of pixels just outside.
inline void random_primary_hits(const Frame& frame, TestRandom& random, int n, HitBatch& hits) {
  while (hits.count < n) {
    const uint32_t primitive = random.bits() % static_cast<uint32_t>(frame.scene->triangles.size());
    uint32_t pixel = 0;
    if (pixel_of(frame, point_on(*frame.scene, primitive, random), &pixel)) add_hit(hits, pixel, 0, primitive);
  }
  hits.pad();  // as those of tiles
}

// The same triangles, all bumped by noise.
inline SceneData bumpy_scene(TestRandom& random) {
  SceneData scene = random_surface_scene(3, 60);
  const int32_t noise = add_texture(scene, 32, 32, [&](int, int) { return noise_texel(random); });
  for (Material& m : scene.materials) m.map_bump = noise, m.map_normal = -1;
  return scene;
}

// A frame whose plan has every part of a surface.
inline std::unique_ptr<TestFrame> full_frame(SceneData scene, const Camera& camera, int width, int height, Isa isa = Isa::kAuto) {
  auto t = make_test_frame(std::move(scene), camera, test_settings(width, height, isa));
  plan_all(t->frame);
  return t;
}

}  // namespace spanray
