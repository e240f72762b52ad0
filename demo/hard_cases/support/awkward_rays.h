// Meshes and rays that are awkward to answer, and who may judge the answers (HARD-CASES Y4, Y5, Y8, Y9, Y10).
#pragma once
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "support/bvh_oracle.h"

namespace spanray {

inline std::unique_ptr<TestFrame> frame_of(const std::vector<SoupTriangle>& soup, std::vector<Material> materials = {}) {
  return make_test_frame(make_test_scene(soup, std::move(materials)), Camera(), test_settings(16, 16));
}

// From anywhere around the unit cube, half of them toward it, a third of them ending soon.
inline RayBatch random_rays(TestRandom& random, int n) {
  RayBatch rays = make_rays(n);
  for (int i = 0; i < n; ++i) {
    const float t_max = i % 3 == 0 ? static_cast<float>(random.uniform(0, 3)) : kInfinity;
    const glm::dvec3 origin = random_point(random, 1.5);
    set_ray(rays, i, origin, random_point(random, 1) - (i % 2 != 0 ? origin : glm::dvec3(0)), t_max);
  }
  return rays;
}

// Unit cubes on an integer grid, and rays on the grid and along its axes: all ties and all zeros that there are.
inline std::vector<SoupTriangle> cubes_on_grid(TestRandom& random) {
  std::vector<SoupTriangle> soup;
  for (int i = 0; i < 40; ++i) {
    glm::dvec3 p;
    for (int k = 0; k < 3; ++k) p[k] = random.between(-3, 2);
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        glm::dvec3 a(0), b(0), n(0);
        a[(axis + 1) % 3] = 1, b[(axis + 2) % 3] = 1, n[axis] = side;
        soup.push_back(soup_triangle(p + n, p + n + a, p + n + a + b));
        soup.push_back(soup_triangle(p + n, p + n + a + b, p + n + b));
      }
  }
  return soup;
}
inline RayBatch rays_on_grid(TestRandom& random, int n) {
  constexpr double kSteps[] = {0.0, -0.0, 1, -1, 2, -2, 0.0, -0.0, 0.5, 1e-40, -1e-40, 1e-30};
  RayBatch rays = make_rays(n);
  for (int i = 0; i < n; ++i) {
    glm::dvec3 o, d;
    for (int k = 0; k < 3; ++k) o[k] = random.between(-8, 8) * 0.5, d[k] = kSteps[random.below(12)];
    set_ray(rays, i, o, d, i % 2 != 0 ? kInfinity : static_cast<float>(random.between(0, 4)));
  }
  return rays;
}

// The same 60 triangles thirteen times (more than a leaf holds), corners rotated and mirrored, among others that change the tree.
struct CoincidentSoup {
  static constexpr uint32_t kBase = 60, kCopies = 12;
  std::vector<SoupTriangle> triangles;  // the base, then kCopies blocks of others and a copy of the base
  uint32_t block;                       // triangles of one of them

  bool is_copy(uint32_t primitive) const {
    return primitive != kNoPrimitive && primitive >= kBase && (primitive - kBase) % block >= block - kBase;
  }
};
inline CoincidentSoup coincident_soup(const std::vector<SoupTriangle>& base, int others, TestRandom& random) {
  CoincidentSoup soup{base, static_cast<uint32_t>(others) + CoincidentSoup::kBase};
  for (uint32_t copy = 1; copy <= CoincidentSoup::kCopies; ++copy) {
    add_random_triangles(soup.triangles, random, others, 0.02);
    for (SoupTriangle triangle : base) {
      std::rotate(triangle.corner, triangle.corner + copy % 3, triangle.corner + 3);
      if (copy % 2 == 0) std::swap(triangle.corner[0], triangle.corner[1]);
      soup.triangles.push_back(triangle);
    }
  }
  return soup;
}

// Rays beside one triangle in the plane z = 2 that covers the unit square, and whether they hit it.
struct RayCase { glm::dvec3 origin, direction; float t_max; bool hit; };
inline SoupTriangle bad_ray_target() { return soup_triangle({-1, -1, 2}, {3, -1, 2}, {-1, 3, 2}); }
inline std::vector<RayCase> bad_rays() {
  const double nan = std::nan(""), inf = kInfinity;
  const glm::dvec3 z(0, 0, 1);
  return {
      // A hit at exactly t_max counts.
      {{0, 0, 0}, z, kInfinity, true},
      {{0, 0, 0}, z, 2.0f, true},
      {{0, 0, 0}, z, std::nextafter(2.0f, 0.0f), false},
      {{0, 0, 0}, z * 8.0, 0.25f, true},
      {{0, 0, 0}, z * 8.0, std::nextafter(0.25f, 0.0f), false},
      {{0.2, 0.1, 0}, z * 3.0, 2.0f / 3 * 1.0000001f, true},
      // Directions and origins that are no numbers, zero, infinite.
      {{0, 0, 0}, {0, 0, 0}, kInfinity, false},
      {{0, 0, 0}, {-0.0, 0, -0.0}, kInfinity, false},
      {{0, 0, 0}, {nan, 0, 1}, kInfinity, false},
      {{0, 0, 0}, {0, nan, nan}, kInfinity, false},
      {{0, 0, 0}, {0, 0, inf}, kInfinity, false},
      {{0, 0, 0}, {-inf, 0, 1}, kInfinity, false},
      {{nan, 0, 0}, z, kInfinity, false},
      {{0, inf, 0}, z, kInfinity, false},
      {{0, 0, -inf}, z, kInfinity, false},
      {{0, 0, 0}, z, static_cast<float>(nan), false},
      {{0, 0, 0}, z, -1.0f, false},
      {{0, 0, 0}, z, 0.0f, false},
      // t = 0 is not in front.
      {{0, 0, 0}, -z, kInfinity, false},
      {{0, 0, 2}, z, kInfinity, false},
      {{0, 0, 2}, -z, kInfinity, false},
      // Denormal and huge directions are directions.
      {{0, 0, 0}, {0, 0, 1e-45}, kInfinity, true},
      {{0, 0, 0}, {0, 0, 3e38}, kInfinity, true},
      {{0, 0, -3e38}, {0, 0, 3e38}, kInfinity, true},
      {{0, 0, 0}, {1e-45, 1e-45, 1e-45}, kInfinity, false},
      {{0.2, 0.2, 0}, {1e-45, 1e-45, 3e-39}, kInfinity, true},
  };
}
inline RayBatch batch_of(const std::vector<RayCase>& cases) {
  RayBatch rays = make_rays(static_cast<int>(cases.size()));
  for (size_t i = 0; i < cases.size(); ++i) set_ray(rays, static_cast<int>(i), cases[i].origin, cases[i].direction, cases[i].t_max);
  return rays;
}

// Toward a unit sphere at the origin, from 1e5 away.
inline RayBatch rays_from_far(TestRandom& random, int n) {
  RayBatch rays = make_rays(n);
  for (int i = 0; i < n; ++i) {
    const glm::dvec3 origin = normalize3(random_point(random, 1), glm::dvec3(1, 0, 0)) * 1e5;
    set_ray(rays, i, origin, normalize3(random_point(random, 0.6) - origin, glm::dvec3(1, 0, 0)));
  }
  return rays;
}

// What an independent test in extended precision says of ray i; ties in t to the last primitive.
struct Judged {
  uint32_t primitive = kNoPrimitive;
  long double t;           // of the hit, else t_max
  long double margin = 1;  // the least of all triangles: below rounding, inside and outside cannot be told apart
};
inline Judged judge(const SceneData& scene, const RayBatch& rays, int i) {
  Judged nearest{kNoPrimitive, rays.t_max[static_cast<size_t>(i)]};
  for (uint32_t p = 0; p < scene.triangles.size(); ++p) {
    const RayOracleHit h = oracle_hit(scene, p, ray_origin(rays, i), ray_direction(rays, i));
    nearest.margin = std::min(nearest.margin, h.margin);
    if (h.hit && h.t <= nearest.t) nearest.t = h.t, nearest.primitive = p;
  }
  return nearest;
}

}  // namespace spanray
