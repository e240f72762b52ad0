// shade/light.h: the kernel of the frame's instruction set.
#include "shade/light.h"

#include <algorithm>
#include <vector>

#include "shade/light_kernel.h"

namespace spanray {

void make_shadow_rays(const Frame& frame, const SurfaceBatch& surfaces, int light, RayBatch& rays,
                      AlignedBuffer<uint32_t>& surface_of_ray) {
  kMakeShadowRays[isa_index(frame.isa)](frame, surfaces, light, rays, surface_of_ray);
}

void make_lift_rays(const Frame& frame, const SurfaceBatch& surfaces, RayBatch& rays, AlignedBuffer<uint32_t>& surface_of_ray) {
  kMakeLiftRays[isa_index(frame.isa)](frame, surfaces, rays, surface_of_ray);
}

void shade_ambient(const Frame& frame, const SurfaceBatch& surfaces, float* const radiance[3]) {
  kShadeAmbient[isa_index(frame.isa)](frame, surfaces, radiance);
}

void shade_light(const Frame& frame, const SurfaceBatch& surfaces, const HitBatch& hits, int light, const uint32_t* lit,
                 float* const radiance[3]) {
  const int isa = isa_index(frame.isa);
  const bool by_triangle = surfaces.lights > 0 || frame.settings.shading == Shading::kGouraud;
  const ShadeLightFn shade = (by_triangle ? kShadeTriangleLight : kShadeLight)[isa];
  if (frame.settings.shading == Shading::kPhong || surfaces.exact.empty()) return shade(frame, surfaces, hits, light, lit, radiance);
  // Triangles as the settings say, exact primitives by the normal at each pixel: the batch holds these, then those.
  const std::vector<uint32_t> valid(surfaces.valid, surfaces.valid + surfaces.count);
  for (const int i : surfaces.exact) surfaces.valid[i] = 0;
  shade(frame, surfaces, hits, light, lit, radiance);
  std::fill_n(surfaces.valid, surfaces.count, 0u);
  for (const int i : surfaces.exact) surfaces.valid[i] = valid[static_cast<size_t>(i)];
  Frame phong = frame;
  phong.settings.shading = Shading::kPhong;
  kShadeLight[isa](phong, surfaces, hits, light, lit, radiance);
  std::copy(valid.begin(), valid.end(), surfaces.valid);
}

void make_bounce_rays(const Frame& frame, const SurfaceBatch& surfaces, const HitBatch& hits, RayBatch& rays,
                      AlignedBuffer<uint32_t>& surface_of_ray) {
  kMakeBounceRays[isa_index(frame.isa)](frame, surfaces, hits, rays, surface_of_ray);
}

}  // namespace spanray
