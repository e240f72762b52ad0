// Rays that leave a surface: origins moved off it by an epsilon, and by the bound on the error of the position.
#include <cmath>

#include "ray_cases.h"
#include "shade/light.h"
#include "support/surface_scenes.h"
#include "sweep.h"

namespace spanray::hard {
namespace {

constexpr double kEpsilons[] = {1e-3, 1e-5};

std::vector<Curve> contenders() {
  return {{"spanray: by the error bound of the position", true, {}},
          {"epsilon 1e-3 along the normal", false, {}},
          {"epsilon 1e-5 along the normal", false, {}}};
}

// The same rays with their origins at position + epsilon * normal, rounded to float.
RayBatch moved_by(const RayBatch& rays, const AlignedBuffer<uint32_t>& of, const SurfaceBatch& s, double epsilon) {
  RayBatch moved = make_rays(rays.count);
  for (int i = 0; i < rays.count; ++i) {
    const uint32_t surface = of[static_cast<size_t>(i)];
    const glm::vec3 position(s.position[0][surface], s.position[1][surface], s.position[2][surface]);
    set_ray(moved, i, glm::dvec3(position + static_cast<float>(epsilon) * glm::vec3(normal_at(s, surface))), ray_direction(rays, i));
  }
  return moved;
}

// Counts of shadow rays by contender.
struct Counts { uint64_t wrong[3] = {}, checked = 0; };

template <class IsWrong>
void count_shadow_rays(TestFrame& t, const Bvh& bvh, const SurfaceBatch& surfaces, const IsWrong& is_wrong, Counts& counts) {
  RayBatch rays;
  AlignedBuffer<uint32_t> of;
  make_shadow_rays(t.frame, surfaces, 0, rays, of);
  rays.from.clear();  // where they start must do by itself
  counts.checked += static_cast<uint64_t>(rays.count);
  for (size_t k = 0; k < 3; ++k) {
    const RayBatch moved = k == 0 ? RayBatch{} : moved_by(rays, of, surfaces, kEpsilons[k - 1]);
    std::vector<uint32_t> closest(static_cast<size_t>(rays.count));
    trace_closest(t.frame, bvh, k == 0 ? rays : moved, closest.data());
    for (size_t i = 0; i < closest.size(); ++i) counts.wrong[k] += is_wrong(closest[i], surfaces.primitive[of[i]]);
  }
}

void add_shares(const Counts& counts, Sweep& sweep) {
  for (size_t k = 0; k < 3; ++k)
    sweep.curves[k].y.push_back(
        counts.checked == 0 ? NAN : 100.0 * static_cast<double>(counts.wrong[k]) / static_cast<double>(counts.checked));
}

// Shadow rays from a sphere of 1280 triangles; cosine: of the angle between the rays and the normal of the triangle that they
// leave, 0 for lights in all directions. Wrong: the ray hits the triangle that it left.
void add_self_hits(const Effort& effort, double scale, const glm::dvec3& center, double cosine, Sweep& sweep) {
  std::vector<SoupTriangle> soup;
  add_mesh(soup, make_sphere(3), scale, center);
  Camera camera;
  const glm::dvec3 eye = center + glm::dvec3(1.1, 0.7, 3) * scale;
  for (int k = 0; k < 3; ++k) camera.eye[k] = eye[k], camera.target[k] = center[k];
  camera.near_plane = 1e-3 * scale;
  auto t = full_frame(make_test_scene(soup), camera, 512, 512);
  const Bvh bvh = build_all(*t);
  TestRandom random(81);
  Counts counts;
  for (int n = 0; n < effort.count(40, 10); ++n) {
    HitBatch hits;
    uint32_t p = 0, pixel = 0;
    do p = static_cast<uint32_t>(random.below(static_cast<int>(soup.size())));
    while (facing(t->scene, t->scene.triangles[p], eye) <= 0);
    for (int i = 0; i < 100; ++i) {
      if (cosine == 0) p = static_cast<uint32_t>(random.below(static_cast<int>(soup.size())));
      if (facing(t->scene, t->scene.triangles[p], eye) > 0 && pixel_of(t->frame, point_on(t->scene, p, random), &pixel))
        add_hit(hits, pixel, 0, p);
    }
    if (hits.count == 0) continue;
    SurfaceBatch surfaces;
    resolve_surfaces(t->frame, hits, surfaces);
    const glm::dvec3 normal = normal_at(surfaces, 0), side = normalize3(cross3(normal, random_point(random)), glm::dvec3(1, 0, 0));
    light_from(t->scene, cosine == 0 ? random_point(random) : side * std::sqrt(1 - cosine * cosine) + normal * cosine);
    count_shadow_rays(*t, bvh, surfaces, [](uint32_t hit, uint32_t own) { return hit == own; }, counts);
  }
  add_shares(counts, sweep);
}

}  // namespace

Sweep sweep_self_hits_by_scale(const Effort& effort) {
  Sweep s;
  s.title = "Shadow rays that hit the triangle which they leave, by the size of the scene";
  s.what =
      "Positions of a hit are rounded to float, so half of them lie behind their surface. An epsilon that is right for one "
      "scene is smaller than "
      "that rounding in a larger one: black speckles. The error bound grows with the coordinates.";
  s.x_name = "radius of a sphere of 1,280 triangles", s.y_name = "self-hits, % of shadow rays";
  s.x = decades(-6, 6), s.curves = contenders();
  for (const double scale : s.x) add_self_hits(effort, scale, glm::dvec3(0), 0, s);
  return s;
}

Sweep sweep_self_hits_by_distance(const Effort& effort) {
  Sweep s;
  s.title = "Shadow rays that hit the triangle which they leave, by the distance from the origin";
  s.what = "A sphere of radius 1 whose center moves away from the origin of the world; at 1e6 coordinates have 1/16 of a unit left.";
  s.x_name = "distance of the sphere from the origin, radius 1", s.y_name = "self-hits, % of shadow rays";
  s.x = decades(0, 6, 0.5), s.curves = contenders();
  for (const double distance : s.x) add_self_hits(effort, 1, glm::dvec3(glm::vec3(glm::dvec3(0.76, -0.53, 0.38) * distance)), 0, s);
  return s;
}

Sweep sweep_self_hits_by_angle(const Effort& effort) {
  Sweep s;
  s.title = "Shadow rays that hit the triangle which they leave, by angle";
  s.what = "A sphere of radius 20,000, lights that graze the triangle: the cosine between light and normal falls to 1e-6.";
  s.x_name = "cosine between light and normal", s.y_name = "self-hits, % of shadow rays";
  s.x = decades(-6, -0.5, 0.5), s.curves = contenders();
  for (const double cosine : s.x) add_self_hits(effort, 2e4, glm::dvec3(0), cosine, s);
  return s;
}

// A floor, and a ceiling 1e-4 of the scale above it; the points on the floor are hits of rays that start between the two.
Sweep sweep_blockers_by_scale(const Effort& effort) {
  Sweep s;
  s.title = "Shadow rays that start beyond a blocker close by, by the size of the scene";
  s.what =
      "A ceiling 1e-4 of the scene's size above a floor shadows all of it. An epsilon larger than that gap starts its rays "
      "above the ceiling: light "
      "leaks. No one epsilon is right here and in the plot of self-hits at all sizes.";
  s.x_name = "size of the scene", s.y_name = "missed blockers, % of shadow rays";
  s.x = decades(-6, 6), s.curves = contenders();
  for (const double size : s.x) {
    const double h = 1e-4 * size, wide = 100 * size;
    auto t = full_frame(make_test_scene({soup_triangle({-size, 0, -size}, {-size, 0, 3 * size}, {3 * size, 0, -size}),
                                         soup_triangle({-wide, h, -wide}, {3 * wide, h, -wide}, {-wide, h, 3 * wide})}),
                        Camera(), 16, 16);
    const Bvh bvh = build_all(*t);
    TestRandom random(82);
    Counts counts;
    for (int n = 0; n < effort.count(40, 10); ++n) {
      RayBatch down;
      HitBatch hits;
      hits.rays = &down;
      for (int i = 0; i < 100; ++i) {
        const glm::dvec3 p = random_point(random, 0.5 * size);
        add_hit(hits, 0, static_cast<uint32_t>(add_ray(down, {p.x, h / 2, p.z}, {0, -1, 0})), 0);
      }
      SurfaceBatch surfaces;
      resolve_surfaces(t->frame, hits, surfaces);
      light_from(t->scene, random_point(random, 10) * glm::dvec3(1, 0, 1) + glm::dvec3(0, 1, 0));
      count_shadow_rays(*t, bvh, surfaces, [](uint32_t hit, uint32_t) { return hit != 1; }, counts);
    }
    add_shares(counts, s);
  }
  return s;
}

}  // namespace spanray::hard
