#include "ray/exact_set.h"

#include <algorithm>

#include "ray/exact_kernel.h"
#include "ray/triangle_test.h"

namespace spanray {

ExactSet::ExactSet(const SceneData& scene, const uint32_t* material_flags, uint32_t mask, uint32_t value)
    : spheres(build_sphere_tree(scene, material_flags, mask, value)) {
  for (size_t i = 0; i < scene.planes.size(); ++i)
    if ((material_flags[scene.planes[i].material] & mask) == value)
      planes.push_back({scene.planes[i], static_cast<uint32_t>(scene.triangles.size() + scene.spheres.size() + i)});
}

void closest_exact(const Frame& frame, const ExactSet& set, const RayBatch& rays, double t_min, uint32_t* out) {
  kClosestExact[isa_index(frame.isa)](frame, set, rays, t_min, out);
}

void any_exact(const Frame& frame, const ExactSet& set, const RayBatch& rays, uint32_t* out) {
  kAnyExact[isa_index(frame.isa)](set, rays, out);
}

double triangle_t(const SceneData& scene, const RayBatch& rays, int i, uint32_t primitive) {
  float origin[3], direction[3], corners[9];
  for (int k = 0; k < 3; ++k) origin[k] = rays.origin[k][i], direction[k] = rays.direction[k][i];
  for (int v = 0; v < 3; ++v) std::copy_n(scene.vertices[scene.triangles[primitive].vertex[v]].position, 3, corners + 3 * v);
  double t = 0;
  return meet_triangle(origin, direction, rays.t_max[i], corners, t) ? t : 0;
}

}  // namespace spanray
