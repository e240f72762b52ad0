// Rays that leave a closed mesh through its vertices and edges, by the size of the mesh and by its distance from the origin.
#include "ray_cases.h"
#include "rivals.h"
#include "sweep.h"

namespace spanray::hard {
namespace {

std::vector<std::array<glm::vec3, 3>> triangles_of(const SceneData& scene) {
  std::vector<std::array<glm::vec3, 3>> list(scene.triangles.size());
  for (uint32_t p = 0; p < list.size(); ++p)
    for (int i = 0; i < 3; ++i) list[p][static_cast<size_t>(i)] = glm::vec3(scene_vertex(scene, p, i));
  return list;
}

// Share of rays, in percent, that hit no triangle at all.
double leaks_of_moller_trumbore(const SceneData& scene, const RayBatch& rays, float epsilon) {
  const auto triangles = triangles_of(scene);
  int missed = 0;
  for (int i = 0; i < rays.count; ++i) {
    const glm::vec3 o(ray_origin(rays, i)), d(ray_direction(rays, i));
    bool hit = false;
    for (size_t p = 0; p < triangles.size() && !hit; ++p) {
      float t;
      hit = moller_trumbore(o, d, triangles[p], epsilon, &t);
    }
    missed += !hit;
  }
  return 100.0 * missed / rays.count;
}

// One point of the sweep: a sphere of 320 triangles.
void add_leaks(const Effort& effort, double scale, const glm::dvec3& center, Sweep& sweep) {
  const auto t = mesh_frame(make_sphere(2), scale, center);
  const Bvh bvh = build_all(*t);
  Tally ours;
  double rivals[2] = {};
  for (const Aim aim : {Aim::kVertex, Aim::kEdge}) {
    const RayBatch rays = rays_inside(*t, aim, effort.count(5000, 500), 71, scale, center);
    check_hits(*t, bvh, rays, supported_isas().back(), ours);
    rivals[0] += leaks_of_moller_trumbore(t->scene, rays, 0) / 2, rivals[1] += leaks_of_moller_trumbore(t->scene, rays, 1e-6f) / 2;
  }
  sweep.curves[0].y.push_back(100.0 * static_cast<double>(ours.wrong()) / static_cast<double>(ours.checked()));
  for (size_t k = 0; k < 2; ++k) sweep.curves[1 + k].y.push_back(rivals[k]);
}

std::vector<Curve> contenders() {
  return {{"spanray: watertight test (Woop, Benthin, Wald 2013), set up in double", true, {}},
          {"Möller-Trumbore in float", false, {}},
          {"Möller-Trumbore in float, |determinant| > 1e-6 as published", false, {}}};
}

}  // namespace

Sweep sweep_leaks_by_scale(const Effort& effort) {
  Sweep s;
  s.title = "Rays through a closed mesh, by its size";
  s.what =
      "Rays from inside a sphere of 320 triangles at its vertices and edges; each must hit something. A test that rounds each "
      "triangle by itself "
      "leaves gaps between neighbours, and a fixed epsilon makes whole meshes vanish when they are small. Edge functions that "
      "are exact "
      "opposites for both triangles of an edge leave none, at any size.";
  s.x_name = "radius of the sphere", s.y_name = "rays that get out, %";
  s.x = decades(-6, 6), s.curves = contenders();
  for (const double scale : s.x) add_leaks(effort, scale, glm::dvec3(0), s);
  return s;
}

Sweep sweep_leaks_by_distance(const Effort& effort) {
  Sweep s;
  s.title = "Rays through a closed mesh, by its distance from the origin";
  s.what =
      "The same with a sphere of radius 1 whose center moves away from the origin of the world: subtracting large coordinates "
      "costs digits.";
  s.x_name = "distance of the sphere from the origin, radius 1", s.y_name = "rays that get out, %";
  s.x = decades(0, 6, 0.5), s.curves = contenders();
  for (const double distance : s.x) add_leaks(effort, 1, glm::dvec3(glm::vec3(glm::dvec3(0.76, -0.53, 0.38) * distance)), s);
  return s;
}

}  // namespace spanray::hard
