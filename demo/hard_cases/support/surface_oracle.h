// What tests of shade/ share: an oracle in long double that solves for the hit by Cramer's rule, textures, batches of hits.
#pragma once
#include <cmath>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "shade/surface.h"
#include "support/random.h"
#include "support/test_frame.h"

namespace spanray {

using Real = long double;
struct Real3 {
  Real x = 0, y = 0, z = 0;
  Real operator[](int k) const { return k == 0 ? x : k == 1 ? y : z; }
};
inline Real3 operator-(Real3 a, Real3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Real3 operator+(Real3 a, Real3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Real3 operator*(Real3 a, Real s) { return {a.x * s, a.y * s, a.z * s}; }
inline Real dot_real(Real3 a, Real3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Real3 cross_real(Real3 a, Real3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline Real length_real(Real3 a) { return std::sqrt(dot_real(a, a)); }
inline Real3 real3(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
inline Real3 real3(const float* v) { return {v[0], v[1], v[2]}; }
inline Real3 real3(float* const v[3], int i) { return {v[0][i], v[1][i], v[2][i]}; }

struct OracleRay { Real3 origin, direction; };
struct OracleHit {
  Real t = 0, b[3] = {0, 0, 0};
  Real3 position, normal;  // normal of the stored order of vertices, unit
  Real cosine = 0;         // |d . n| / (|d| |n|)
  bool inside = false;
};

inline OracleRay oracle_primary(const Frame& frame, uint32_t pixel, Real dx = 0, Real dy = 0) {
  const PrimaryRays& p = frame.primary;
  const Real x = static_cast<Real>(pixel & 0xffff) + Real(0.5) + dx, y = static_cast<Real>(pixel >> 16) + Real(0.5) + dy;
  return {real3(p.eye), real3(p.corner) + real3(p.step_x) * x + real3(p.step_y) * y};
}

inline Real3 oracle_vertex(const SceneData& scene, uint32_t primitive, int corner) {
  return real3(scene.vertices[scene.triangles[primitive].vertex[corner]].position);
}

// o + t d = v0 + b1 e1 + b2 e2.
inline OracleHit oracle_hit(const SceneData& scene, uint32_t primitive, const OracleRay& ray) {
  const Real3 v0 = oracle_vertex(scene, primitive, 0);
  const Real3 e1 = oracle_vertex(scene, primitive, 1) - v0, e2 = oracle_vertex(scene, primitive, 2) - v0;
  const Real3 n = cross_real(e1, e2), m = cross_real(ray.direction, e2), s = ray.origin - v0;
  const Real det = dot_real(e1, m);
  OracleHit h;
  if (det == 0) return h;
  const Real3 q = cross_real(s, e1);
  h.b[1] = dot_real(s, m) / det;
  h.b[2] = dot_real(ray.direction, q) / det;
  h.b[0] = 1 - h.b[1] - h.b[2];
  h.t = dot_real(e2, q) / det;
  h.position = v0 + e1 * h.b[1] + e2 * h.b[2];
  h.normal = n * (1 / length_real(n));
  h.cosine = std::fabs(dot_real(ray.direction, h.normal)) / length_real(ray.direction);
  h.inside = h.b[0] >= 0 && h.b[1] >= 0 && h.b[2] >= 0 && h.t > 0;
  return h;
}

// uv at weights b, before scale and offset.
inline void oracle_uv(const SceneData& scene, uint32_t primitive, const Real b[3], Real uv[2]) {
  for (int k = 0; k < 2; ++k) {
    uv[k] = 0;
    for (int i = 0; i < 3; ++i) uv[k] += b[i] * scene.vertices[scene.triangles[primitive].vertex[i]].uv[k];
  }
}

// Every field of a batch, by name: 4-byte words.
struct BatchField {
  std::string name;
  const float* data;
};
inline std::vector<BatchField> batch_fields(const SurfaceBatch& s) {
  std::vector<BatchField> list;
  const auto vec = [&](const char* name, float* const v[3]) {
    for (int k = 0; k < 3; ++k) list.push_back({std::string(name) + "xyz"[k], v[k]});
  };
  vec("position.", s.position), vec("geometric_normal.", s.geometric_normal), vec("normal.", s.normal), vec("view.", s.view);
  vec("weight.", s.weight), vec("dpdx.", s.dpdx), vec("dpdy.", s.dpdy), vec("ambient.", s.ambient), vec("diffuse.", s.diffuse);
  vec("specular.", s.specular), vec("emission.", s.emission), vec("mirror.", s.mirror);
  vec("lift.", s.lift), vec("smooth_normal.", s.smooth_normal);
  list.push_back({"position_error", s.position_error}), list.push_back({"t", s.t});
  list.push_back({"shininess", s.shininess}), list.push_back({"opacity", s.opacity});
  const auto word = [&](const char* name, const uint32_t* w) { list.push_back({name, reinterpret_cast<const float*>(w)}); };
  word("pixel", s.pixel), word("ray", s.ray), word("primitive", s.primitive), word("material", s.material), word("valid", s.valid);
  return list;
}
inline uint32_t bits_of(float x) {
  uint32_t u;
  std::memcpy(&u, &x, 4);
  return u;
}
// The first field in which entry i of a and entry j of b differ in bits, with both values; empty if none does. skip: a field left out.
inline std::string surface_difference(const SurfaceBatch& a, int i, const SurfaceBatch& b, int j, const std::string& skip = "") {
  const auto fa = batch_fields(a), fb = batch_fields(b);
  for (size_t k = 0; k < fa.size(); ++k)
    if (fa[k].name != skip && std::memcmp(fa[k].data + i, fb[k].data + j, 4) != 0)
      return fa[k].name + ": " + std::to_string(fa[k].data[i]) + " != " + std::to_string(fb[k].data[j]);
  return "";
}

inline void add_hit(HitBatch& hits, uint32_t pixel, uint32_t ray, uint32_t primitive) {
  hits.pixel.push_back(pixel), hits.ray.push_back(ray), hits.primitive.push_back(primitive);
  ++hits.count;
}
inline int add_ray(RayBatch& rays, const glm::dvec3& origin, const glm::dvec3& direction, uint32_t pixel = 0) {
  for (int k = 0; k < 3; ++k) {
    rays.origin[k].push_back(static_cast<float>(origin[k]));
    rays.direction[k].push_back(static_cast<float>(direction[k]));
  }
  rays.t_max.push_back(INFINITY), rays.pixel.push_back(pixel);
  return rays.count++;
}
inline OracleRay oracle_ray(const RayBatch& rays, int i) {
  const auto at = [&](const AlignedBuffer<float>(&a)[3]) {
    return Real3{a[0][static_cast<size_t>(i)], a[1][static_cast<size_t>(i)], a[2][static_cast<size_t>(i)]};
  };
  return {at(rays.origin), at(rays.direction)};
}

// Adds a texture with levels by averaging; sizes are powers of two. Returns a use of it, with default options.
inline int32_t add_texture(SceneData& scene, int width, int height, const std::function<Texel(int x, int y)>& texel) {
  Texture t;
  t.width = width, t.height = height;
  std::vector<Texel> level(static_cast<size_t>(width) * static_cast<size_t>(height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) level[static_cast<size_t>(y * width + x)] = texel(x, y);
  for (int w = width, h = height;; w = std::max(1, w / 2), h = std::max(1, h / 2)) {
    t.offset[t.levels++] = static_cast<int32_t>(scene.texels.size());
    for (const Texel& x : level) scene.texels.push_back(x);
    if (w == 1 && h == 1) break;
    const int nw = std::max(1, w / 2), nh = std::max(1, h / 2), sx = w / nw, sy = h / nh;
    std::vector<Texel> next(static_cast<size_t>(nw * nh));
    for (int y = 0; y < nh; ++y)
      for (int x = 0; x < nw; ++x) {
        uint32_t sum[4] = {};
        for (int j = 0; j < sy; ++j)
          for (int i = 0; i < sx; ++i) {
            const Texel& p = level[static_cast<size_t>((y * sy + j) * w + x * sx + i)];
            sum[0] += p.r, sum[1] += p.g, sum[2] += p.b, sum[3] += p.a;
          }
        const uint32_t n = static_cast<uint32_t>(sx * sy);
        const auto mean = [&](int c) { return static_cast<uint16_t>((sum[c] + n / 2) / n); };
        next[static_cast<size_t>(y * nw + x)] = {mean(0), mean(1), mean(2), mean(3)};
      }
    level = next;
  }
  scene.textures.push_back(t);
  TextureUse use;
  use.texture = static_cast<int32_t>(scene.textures.size()) - 1;
  scene.texture_uses.push_back(use);
  return static_cast<int32_t>(scene.texture_uses.size()) - 1;
}

inline void plan_all(Frame& frame) {
  PlanFlags& p = frame.plan;
  p.textures = p.bump = p.emission = p.ambient = p.specular = p.bounces = p.masks = p.translucents = p.lifted_rays = true;
  p.maps = kAllMaps;
}

inline SoupTriangle with_uv(SoupTriangle t, const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const glm::dvec2* uv[3] = {&a, &b, &c};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 2; ++k) t.corner[i].uv[k] = static_cast<float>((*uv[i])[k]);
  return t;
}
inline SoupTriangle with_normals(SoupTriangle t, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3* n[3] = {&a, &b, &c};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) t.corner[i].normal[k] = static_cast<float>((*n[i])[k]);
  return t;
}

// A point on a random triangle of the scene as the target of a ray from `from`.
inline glm::dvec3 point_on(const SceneData& scene, uint32_t primitive, TestRandom& random) {
  double a = random.uniform(), b = random.uniform();
  if (a + b > 1) a = 1 - a, b = 1 - b;
  const Real3 v0 = oracle_vertex(scene, primitive, 0);
  const Real3 p = v0 + (oracle_vertex(scene, primitive, 1) - v0) * a + (oracle_vertex(scene, primitive, 2) - v0) * b;
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

}  // namespace spanray
