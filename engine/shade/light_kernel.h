// The kernels behind shade/light.h, one entry an instruction set (simd/dispatch.h).
#pragma once
#include "shade/light.h"
#include "simd/dispatch.h"

namespace spanray {

// Phong, and flat surfaces that carry no light; Gouraud, and surfaces that carry some. onto: onto what stands in radiance, else from ambient
// and emission on.
using ShadeLightsFn = void (*)(const Frame& frame, const SurfaceBatch& surfaces, const HitBatch& hits, const LightRange& lights, bool onto,
                               float* const radiance[3]);
extern const ShadeLightsFn kShadeLights[kIsaCount], kShadeTriangleLights[kIsaCount];

using MakeShadowRaysFn = void (*)(const Frame& frame, const SurfaceBatch& surfaces, int light, RayBatch& rays,
                                  AlignedBuffer<uint32_t>& surface_of_ray);
extern const MakeShadowRaysFn kMakeShadowRays[kIsaCount];

using MakeLiftRaysFn = void (*)(const Frame& frame, const SurfaceBatch& surfaces, RayBatch& rays,
                                AlignedBuffer<uint32_t>& surface_of_ray);
extern const MakeLiftRaysFn kMakeLiftRays[kIsaCount];

using MakeBounceRaysFn = void (*)(const Frame& frame, const SurfaceBatch& surfaces, const HitBatch& hits, RayBatch& rays,
                                  AlignedBuffer<uint32_t>& surface_of_ray);
extern const MakeBounceRaysFn kMakeBounceRays[kIsaCount];

}  // namespace spanray
