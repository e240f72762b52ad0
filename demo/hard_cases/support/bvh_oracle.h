// Meshes, rays and plain answers for the tests of visibility engine 2.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "frame/rays.h"
#include "math/vec.h"
#include "ray/triangle_test.h"
#include "support/random.h"
#include "support/test_frame.h"

namespace spanray {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct IndexedMesh {
  std::vector<glm::dvec3> vertices;
  std::vector<glm::ivec3> triangles;
};

// A closed sphere of 20 * 4^levels triangles, outward faces counter-clockwise.
inline IndexedMesh make_sphere(int levels) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  IndexedMesh m;
  m.vertices = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0}, {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g}, {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  m.triangles = {{0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                 {3, 9, 4}, {3, 4, 2}, {3, 2, 6}, {3, 6, 8}, {3, 8, 9}, {4, 9, 5}, {2, 4, 11}, {6, 2, 10}, {8, 6, 7}, {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<int, int>, int> middle;
    const auto middle_of = [&](int a, int b) {
      const auto [it, is_new] = middle.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<int>(m.vertices.size()));
      if (is_new) m.vertices.push_back((m.vertices[static_cast<size_t>(a)] + m.vertices[static_cast<size_t>(b)]) * 0.5);
      return it->second;
    };
    std::vector<glm::ivec3> finer;
    for (const glm::ivec3& t : m.triangles) {
      const int a = middle_of(t.x, t.y), b = middle_of(t.y, t.z), c = middle_of(t.z, t.x);
      finer.insert(finer.end(), {{t.x, a, c}, {t.y, b, a}, {t.z, c, b}, {a, b, c}});
    }
    m.triangles = finer;
  }
  for (glm::dvec3& v : m.vertices) v = normalize3(v, glm::dvec3(0));
  return m;
}

// Corners are scaled, moved, and then rounded to float by soup_triangle: equal vertices stay equal.
inline void add_mesh(std::vector<SoupTriangle>& soup, const IndexedMesh& m, double scale, const glm::dvec3& move, uint32_t material = 0) {
  const auto at = [&](int v) { return m.vertices[static_cast<size_t>(v)] * scale + move; };
  for (const glm::ivec3& t : m.triangles) soup.push_back(soup_triangle(at(t.x), at(t.y), at(t.z), material));
}

inline void add_random_triangles(std::vector<SoupTriangle>& soup, TestRandom& random, int n, double size, uint32_t material = 0) {
  for (int i = 0; i < n; ++i) {
    const glm::dvec3 p = random_point(random, 1), a = random_point(random, size), b = random_point(random, size);
    soup.push_back(soup_triangle(p, p + a, p + b, material));
  }
}

inline RayBatch make_rays(int n) {
  RayBatch rays;
  rays.resize(n, false);
  for (int i = 0; i < n; ++i) rays.pixel[static_cast<size_t>(i)] = static_cast<uint32_t>(i), rays.t_max[static_cast<size_t>(i)] = kInfinity;
  return rays;
}

inline void set_ray(RayBatch& rays, int i, const glm::dvec3& origin, const glm::dvec3& direction, float t_max = kInfinity) {
  for (int k = 0; k < 3; ++k) {
    rays.origin[k][static_cast<size_t>(i)] = static_cast<float>(origin[k]);
    rays.direction[k][static_cast<size_t>(i)] = static_cast<float>(direction[k]);
  }
  rays.t_max[static_cast<size_t>(i)] = t_max;
}

inline glm::dvec3 ray_origin(const RayBatch& rays, int i) {
  const size_t r = static_cast<size_t>(i);
  return {rays.origin[0][r], rays.origin[1][r], rays.origin[2][r]};
}
inline glm::dvec3 ray_direction(const RayBatch& rays, int i) {
  const size_t r = static_cast<size_t>(i);
  return {rays.direction[0][r], rays.direction[1][r], rays.direction[2][r]};
}
inline glm::dvec3 scene_vertex(const SceneData& scene, uint32_t primitive, int v) {
  const float* p = scene.vertices[scene.triangles[primitive].vertex[v]].position;
  return {p[0], p[1], p[2]};
}

// The engine's own triangle test over all triangles: what every tree must find, in order of primitives.
// accept(primitive) stands for masks and culling.
template <class Accept>
std::vector<uint32_t> brute_force_all(const SceneData& scene, const RayBatch& rays, int i, const Accept& accept, uint32_t* closest) {
  std::vector<uint32_t> hits;
  *closest = kNoPrimitive;
  const size_t r = static_cast<size_t>(i);
  const float origin[3] = {rays.origin[0][r], rays.origin[1][r], rays.origin[2][r]};
  const float direction[3] = {rays.direction[0][r], rays.direction[1][r], rays.direction[2][r]};
  TraceRay ray;
  if (!prepare_ray(origin, direction, rays.t_max[r], ray)) return hits;
  double best = ray.t_max;
  for (uint32_t p = 0; p < scene.triangles.size(); ++p) {
    float v[9];
    for (int c = 0; c < 3; ++c) std::copy_n(scene.vertices[scene.triangles[p].vertex[c]].position, 3, v + 3 * c);
    double t;
    if (!hit_triangle(ray, TriangleView{v, 3, 1}, t) || t > ray.t_max || !accept(p)) continue;
    hits.push_back(p);
    if (t < best || *closest == kNoPrimitive) best = t, *closest = p;
  }
  return hits;
}
inline uint32_t brute_force_closest(const SceneData& scene, const RayBatch& rays, int i) {
  uint32_t closest;
  (void)brute_force_all(scene, rays, i, [](uint32_t) { return true; }, &closest);
  return closest;
}

// An independent answer in extended precision: e_k = d . cross(v_i - o, v_j - o), t from the plane.
// `margin` is the least |e| relative to the sizes that it was made of: below some 1e-14 inside and outside cannot be told apart.
struct RayOracleHit {
  bool hit = false;
  long double t = 0, margin = 0;
};
inline RayOracleHit oracle_hit(const SceneData& scene, uint32_t primitive, const glm::dvec3& origin, const glm::dvec3& direction) {
  using V = glm::vec<3, long double>;
  V v[3];
  for (int i = 0; i < 3; ++i) v[i] = V(scene_vertex(scene, primitive, i)) - V(origin);
  const V d(direction);
  RayOracleHit r;
  r.margin = 1;
  bool positive = false, negative = false;
  for (int i = 0; i < 3; ++i) {
    const V a = v[(i + 1) % 3], b = v[(i + 2) % 3];
    const long double e = dot3(d, cross3(a, b));
    positive |= e > 0, negative |= e < 0;
    r.margin = std::min(r.margin, std::fabs(e) / (length3(d) * length3(a) * length3(b)));
  }
  const V n = cross3(v[1] - v[0], v[2] - v[0]);
  const long double along = dot3(n, d);
  r.t = along == 0 ? -1 : dot3(n, v[0]) / along;
  r.hit = !(positive && negative) && r.t > 0;
  return r;
}

}  // namespace spanray
