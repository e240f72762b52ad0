#include "render/lifted_light.h"

namespace spanray {
namespace {

// Traces the rays; a bit in `free` for each surface whose ray meets nothing.
uint64_t trace_free(const Frame& frame, const Bvh& opaque, LiftedLight& w, uint32_t* free) {
  const int rays = w.rays.count;
  if (rays == 0) return 0;
  w.occluded.assign((static_cast<size_t>(rays) + 31) / 32, 0);
  trace_any(frame, opaque, w.rays, w.occluded.data());
  for (int i = 0; i < rays; ++i) {
    const uint32_t seen = ~(w.occluded[static_cast<size_t>(i) / 32] >> (i % 32)) & 1u, surface = w.surface_of_ray[i];
    free[surface / 32] |= seen << (surface % 32);
  }
  return static_cast<uint64_t>(rays);
}

}  // namespace

// The way to the light first: in the shade of something else it ends the matter, while the way up is free nearly everywhere.
uint64_t find_lifted_light(const Frame& frame, const Bvh& opaque, const SurfaceBatch& surfaces, int light, LiftedLight& w,
                           uint32_t* lit) {
  make_lifted_rays(frame, surfaces, light, lit, w.rays, w.surface_of_ray);
  w.seen.assign((static_cast<size_t>(surfaces.count) + 31) / 32 + 1, 0);
  uint64_t rays = trace_free(frame, opaque, w, w.seen.data());
  if (rays == 0) return 0;
  make_lift_rays(frame, surfaces, w.seen.data(), w.rays, w.surface_of_ray);
  rays += trace_free(frame, opaque, w, lit);
  return rays;
}

}  // namespace spanray
