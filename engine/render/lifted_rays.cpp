#include "render/lifted_rays.h"

namespace spanray {

uint64_t keep_free_lifts(const Frame& frame, const Bvh& opaque, SurfaceBatch& surfaces, RayBatch& rays,
                         AlignedBuffer<uint32_t>& surface_of_ray, AlignedBuffer<uint32_t>& blocked) {
  make_lift_rays(frame, surfaces, rays, surface_of_ray);
  if (rays.count == 0) return 0;
  blocked.assign((static_cast<size_t>(rays.count) + 31) / 32, 0);
  trace_any(frame, opaque, rays, blocked.data());
  for (int i = 0; i < rays.count; ++i) {
    if ((blocked[static_cast<size_t>(i) / 32] >> (i % 32) & 1u) == 0) continue;
    for (float* component : surfaces.lift) component[surface_of_ray[static_cast<size_t>(i)]] = 0;
  }
  return static_cast<uint64_t>(rays.count);
}

}  // namespace spanray
