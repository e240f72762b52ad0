// Batches of surfaces filled by hand, for tests of light that must not depend on resolve_surfaces.
#pragma once
#include <cstring>
#include <vector>

#include "shade/light.h"
#include "support/random.h"
#include "support/shading_oracle.h"
#include "support/test_frame.h"

namespace spanray {

inline void put3(float* const out[3], int i, const glm::dvec3& v) {
  for (int k = 0; k < 3; ++k) out[k][i] = static_cast<float>(v[k]);
}
inline glm::dvec3 get3(float* const in[3], int i) { return {in[0][i], in[1][i], in[2][i]}; }

inline glm::dvec3 random_unit(TestRandom& random) {
  for (;;) {
    const glm::dvec3 v{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};  // in braces: in this order
    const double d = dot3(v, v);
    if (d > 0.01 && d <= 1) return v / std::sqrt(d);
  }
}
// Of a length in [low, high).
inline glm::dvec3 random_vector(TestRandom& random, double low, double high) {
  const double length = random.uniform(low, high);
  return length * random_unit(random);
}
inline glm::dvec3 random_color(TestRandom& random, double high = 1) {
  return {random.uniform(0, high), random.uniform(0, high), random.uniform(0, high)};
}

// All arrays of a batch, as words.
inline std::vector<uint32_t*> all_fields(const SurfaceBatch& s) {
  std::vector<uint32_t*> fields;
  float* const* const vectors[] = {s.position, s.geometric_normal, s.normal, s.view, s.weight, s.dpdx, s.dpdy,
                                   s.ambient, s.diffuse, s.specular, s.emission, s.mirror, s.lift, s.smooth_normal};
  for (float* const* v : vectors)
    for (int k = 0; k < 3; ++k) fields.push_back(reinterpret_cast<uint32_t*>(v[k]));
  for (float* f : {s.position_error, s.t, s.shininess, s.opacity}) fields.push_back(reinterpret_cast<uint32_t*>(f));
  for (uint32_t* w : {s.pixel, s.ray, s.primitive, s.material, s.valid}) fields.push_back(w);
  return fields;
}
inline void clear_surfaces(SurfaceBatch& s, int count) {
  s.resize(count);
  for (uint32_t* f : all_fields(s)) std::memset(f, 0, sizeof(uint32_t) * static_cast<size_t>(count));
}
inline void copy_surfaces(const SurfaceBatch& from, int first, int count, SurfaceBatch& to) {
  clear_surfaces(to, count);
  const auto source = all_fields(from), target = all_fields(to);
  for (size_t f = 0; f < source.size(); ++f) std::memcpy(target[f], source[f] + first, sizeof(uint32_t) * static_cast<size_t>(count));
}

// Three channels of radiance, exactly as long as they must be.
struct TestRadiance {
  std::vector<float> channel[3];
  explicit TestRadiance(int n) { for (auto& c : channel) c.assign(static_cast<size_t>(n), 0.0f); }
  bool operator==(const TestRadiance& o) const {
    for (int c = 0; c < 3; ++c)
      if (std::memcmp(channel[c].data(), o.channel[c].data(), channel[c].size() * 4) != 0) return false;
    return true;
  }
  struct Pointers { float* p[3]; };
  Pointers at(int i = 0) { return {{channel[0].data() + i, channel[1].data() + i, channel[2].data() + i}}; }
  double max_encoded_difference(int i, const glm::dvec3& other) const {
    double d = 0;
    for (int c = 0; c < 3; ++c) d = std::max(d, std::fabs(oracle_srgb(channel[c][static_cast<size_t>(i)]) - oracle_srgb(other[c])));
    return d;
  }
};

// A cloud of triangles with bent normals, five materials, point and directional lights; hits spread over it, each seen by the eye or
// by its own ray.
struct TestSurfaces {
  std::unique_ptr<TestFrame> test;
  RayBatch rays;
  HitBatch hits;
  SurfaceBatch surfaces;
  Frame& frame() { return test->frame; }
  SceneData& scene() { return test->scene; }
  OracleSurface oracle(int i) const {
    const SurfaceBatch& s = surfaces;
    return {get3(s.position, i), get3(s.geometric_normal, i), get3(s.normal, i), get3(s.view, i), get3(s.ambient, i),
            get3(s.diffuse, i), get3(s.specular, i), get3(s.emission, i), s.shininess[i]};
  }
  int reflectance(int i) const { return test->scene.materials[surfaces.material[i]].reflectance; }
  const Triangle& triangle(int i) const { return test->scene.triangles[surfaces.primitive[i]]; }
  glm::dvec3 corner(int i, int j) const { return oracle_vec(test->scene.vertices[triangle(i).vertex[j]].position); }
  glm::dvec3 corner_normal(int i, int j) const { return oracle_vec(test->scene.vertices[triangle(i).vertex[j]].normal); }
  glm::dvec3 viewer(int i) const {
    if (hits.rays == nullptr) return test->frame.primary.eye;
    return {rays.origin[0][static_cast<size_t>(i)], rays.origin[1][static_cast<size_t>(i)], rays.origin[2][static_cast<size_t>(i)]};
  }
};

inline SceneData make_lit_scene(TestRandom& random, int triangles) {
  std::vector<Material> materials(5);
  const float shininess[5] = {0, 1, 12.5f, 200, 1e4f};
  for (size_t m = 0; m < 5; ++m) {
    materials[m].shininess = shininess[m];
    materials[m].reflectance = m == 1 ? 1 : 0;
  }
  std::vector<SoupTriangle> soup;
  for (int i = 0; i < triangles; ++i) {
    const glm::dvec3 a = random_vector(random, 0, 2), b = a + random_vector(random, 0.3, 1);
    const glm::dvec3 c = a + random_vector(random, 0.3, 1);
    SoupTriangle t = soup_triangle(a, b, c, static_cast<uint32_t>(random.below(5)));
    const glm::dvec3 face = normalize3(cross3(b - a, c - a), glm::dvec3(0, 1, 0));
    for (Vertex& v : t.corner) {
      const glm::dvec3 n = normalize3(face + 0.7 * random_unit(random), face);
      for (int k = 0; k < 3; ++k) v.normal[k] = static_cast<float>(n[k]);
    }
    soup.push_back(t);
  }
  SceneData scene = make_test_scene(soup, materials);
  for (int i = 0; i < 6; ++i) {
    Light light;
    light.kind = i % 3 == 2;
    const glm::dvec3 p = random_vector(random, 2, 4), d = random_unit(random);
    const glm::dvec3 intensity = random_color(random, light.kind ? 2 : 20);
    for (int k = 0; k < 3; ++k) {
      light.position[k] = static_cast<float>(p[k]), light.direction[k] = static_cast<float>(d[k]);
      light.intensity[k] = static_cast<float>(intensity[k]);
    }
    if (i == 1) light.attenuation[0] = 0.5f, light.attenuation[1] = 0.25f;
    scene.lights.push_back(light);
  }
  return scene;
}

// Fills entry i as a hit of the triangle's point with these weights, seen from `viewer`. Shading normal: interpolated and turned
// to the side of the geometric normal, or that itself (flat).
inline void put_surface(TestSurfaces& t, int i, uint32_t primitive, const glm::dvec3& weight, const glm::dvec3& viewer) {
  SurfaceBatch& s = t.surfaces;
  s.primitive[i] = primitive;
  s.valid[i] = 1;
  s.ray[i] = static_cast<uint32_t>(i);
  s.pixel[i] = pack_pixel(static_cast<uint32_t>(i % 64), static_cast<uint32_t>(i / 64));
  s.material[i] = material_of(t.triangle(i));
  s.shininess[i] = t.scene().materials[s.material[i]].shininess;
  glm::dvec3 position(0), normal(0);
  for (int j = 0; j < 3; ++j) position += weight[j] * t.corner(i, j), normal += weight[j] * t.corner_normal(i, j);
  glm::dvec3 g = normalize3(cross3(t.corner(i, 1) - t.corner(i, 0), t.corner(i, 2) - t.corner(i, 0)), glm::dvec3(0, 1, 0));
  if (dot3(g, viewer - position) < 0) g = -g;
  normal = t.frame().settings.shading == Shading::kFlat ? g : normalize3(normal, g);
  if (dot3(normal, g) < 0) normal = -normal;
  put3(s.position, i, position);
  put3(s.geometric_normal, i, g);
  put3(s.normal, i, normal);
  put3(s.view, i, normalize3(viewer - position, g));
  put3(s.weight, i, weight);
  s.t[i] = static_cast<float>(length3(viewer - position));
  s.position_error[i] = static_cast<float>(std::max({std::fabs(position.x), std::fabs(position.y), std::fabs(position.z)}) * 0x1p-22);
}

inline std::unique_ptr<TestSurfaces> make_test_surfaces(uint32_t seed, int count, Shading shading, bool bounce) {
  TestRandom random(seed);
  auto t = std::make_unique<TestSurfaces>();
  Settings settings = test_settings(64, 64);
  settings.shading = shading;
  Camera camera;
  camera.eye[0] = 0.3, camera.eye[1] = 0.7, camera.eye[2] = 5.1;
  t->test = make_test_frame(make_lit_scene(random, 60), camera, settings);
  t->frame().plan.specular = t->frame().plan.ambient = t->frame().plan.emission = true;
  clear_surfaces(t->surfaces, count);
  t->rays.resize(count, false);
  t->hits.resize(count, bounce);
  if (bounce) t->hits.rays = &t->rays;
  for (int i = 0; i < count; ++i) {
    glm::dvec3 viewer = t->frame().primary.eye;
    if (bounce) viewer = random_vector(random, 0.5, 6);
    for (int k = 0; k < 3; ++k) {
      t->rays.origin[k][static_cast<size_t>(i)] = static_cast<float>(viewer[k]);
      viewer[k] = bounce ? static_cast<double>(static_cast<float>(viewer[k])) : viewer[k];
    }
    glm::dvec3 weight = random_color(random);
    weight /= weight.x + weight.y + weight.z;
    put_surface(*t, i, static_cast<uint32_t>(random.below(60)), weight, viewer);
    SurfaceBatch& s = t->surfaces;
    for (float* const* color : {s.ambient, s.diffuse, s.mirror}) put3(color, i, random_color(random));
    put3(s.specular, i, random.below(4) == 0 ? glm::dvec3(0) : random_color(random));
    put3(s.emission, i, random.below(8) == 0 ? random_color(random, 0.3) : glm::dvec3(0));
    if (random.below(16) == 0)
      for (uint32_t* f : all_fields(s)) f[i] = 0;  // a miss
    t->hits.primitive[static_cast<size_t>(i)] = s.valid[i] ? s.primitive[i] : kNoPrimitive;
    if (bounce) t->hits.ray[static_cast<size_t>(i)] = static_cast<uint32_t>(i);
  }
  return t;
}

// One surface at the origin, facing +z, Kd = 0, Ks = 1, one light.
inline std::unique_ptr<TestSurfaces> one_surface(const Light& light, int count = 1) {
  auto t = make_test_surfaces(1, count, Shading::kPhong, false);
  t->scene().lights = {light};
  t->scene().materials.assign(5, Material());
  clear_surfaces(t->surfaces, count);
  for (int i = 0; i < count; ++i) {
    SurfaceBatch& s = t->surfaces;
    s.valid[i] = 1;
    put3(s.geometric_normal, i, {0, 0, 1}), put3(s.normal, i, {0, 0, 1}), put3(s.view, i, {0, 0, 1});
    put3(s.specular, i, glm::dvec3(1));
    s.position_error[i] = 1e-7f;
  }
  return t;
}
inline Light directional_light(const glm::dvec3& toward) {
  Light light;
  light.kind = static_cast<int32_t>(LightKind::kDirectional);
  for (int k = 0; k < 3; ++k) light.direction[k] = static_cast<float>(-toward[k]);
  return light;
}

// Ambient and all lights over the whole batch.
inline TestRadiance shade_all(TestSurfaces& t, Isa isa, const std::vector<uint32_t>* lit = nullptr) {
  t.frame().isa = isa;
  TestRadiance radiance(t.surfaces.count);
  shade_ambient(t.frame(), t.surfaces, radiance.at().p);
  for (int light = 0; light < static_cast<int>(t.scene().lights.size()); ++light)
    shade_light(t.frame(), t.surfaces, t.hits, light, lit ? lit[light].data() : nullptr, radiance.at().p);
  return radiance;
}

}  // namespace spanray
