#include "ray/exact_set.h"

#include "ray/exact_kernel.h"

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

}  // namespace spanray
