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

namespace {

// onto: onto what stands in radiance.
void add_lights(const Frame& frame, const SurfaceBatch& surfaces, const HitBatch& hits, const LightRange& lights, bool onto,
                float* const radiance[3]) {
  const int isa = isa_index(frame.isa);
  const bool by_triangle = surfaces.lights > 0 || frame.settings.shading == Shading::kGouraud;
  const ShadeLightsFn shade = (by_triangle ? kShadeTriangleLights : kShadeLights)[isa];
  if (frame.settings.shading == Shading::kPhong || surfaces.exact.empty()) return shade(frame, surfaces, hits, lights, onto, radiance);
  // Triangles as the settings say, exact primitives by the normal at each pixel: the batch holds these, then those.
  if (!onto) shade_ambient(frame, surfaces, radiance);
  const std::vector<uint32_t> valid(surfaces.valid, surfaces.valid + surfaces.count);
  for (const int i : surfaces.exact) surfaces.valid[i] = 0;
  shade(frame, surfaces, hits, lights, true, radiance);
  std::fill_n(surfaces.valid, surfaces.count, 0u);
  for (const int i : surfaces.exact) surfaces.valid[i] = valid[static_cast<size_t>(i)];
  Frame phong = frame;
  phong.settings.shading = Shading::kPhong;
  kShadeLights[isa](phong, surfaces, hits, lights, true, radiance);
  std::copy(valid.begin(), valid.end(), surfaces.valid);
}

}  // namespace

void shade_lights(const Frame& frame, const SurfaceBatch& surfaces, const HitBatch& hits, const LightRange& lights, float* const radiance[3]) {
  add_lights(frame, surfaces, hits, lights, false, radiance);
}

void shade_ambient(const Frame& frame, const SurfaceBatch& surfaces, float* const radiance[3]) {
  kShadeTriangleLights[isa_index(frame.isa)](frame, surfaces, {}, {}, false, radiance);  // without lights: of all surfaces alike
}

void shade_light(const Frame& frame, const SurfaceBatch& surfaces, const HitBatch& hits, int light, const uint32_t* lit,
                 float* const radiance[3]) {
  add_lights(frame, surfaces, hits, {light, 1, lit, 0}, true, radiance);
}

void make_bounce_rays(const Frame& frame, const SurfaceBatch& surfaces, const HitBatch& hits, RayBatch& rays,
                      AlignedBuffer<uint32_t>& surface_of_ray) {
  kMakeBounceRays[isa_index(frame.isa)](frame, surfaces, hits, rays, surface_of_ray);
}

}  // namespace spanray
