// The kernels behind shade/light.h, one entry an instruction set (simd/dispatch.h).
#pragma once
#include "shade/light.h"
#include "simd/dispatch.h"

namespace spanray {

using ShadeAmbientFn = void (*)(const Frame& frame, const SurfaceBatch& surfaces, float* const radiance[3]);
extern const ShadeAmbientFn kShadeAmbient[kIsaCount];

// Phong, and flat surfaces that carry no light; Gouraud, and surfaces that carry some.
using ShadeLightFn = void (*)(const Frame& frame, const SurfaceBatch& surfaces, const HitBatch& hits, int light,
                              const uint32_t* lit, float* const radiance[3]);
extern const ShadeLightFn kShadeLight[kIsaCount], kShadeTriangleLight[kIsaCount];

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
