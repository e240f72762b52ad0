// The kernels behind shade/light.h, one entry an instruction set (simd/dispatch.h).
#pragma once
#include "shade/light.h"
#include "simd/dispatch.h"

namespace spanray {

using ShadeAmbientFn = void (*)(const Frame& frame, const SurfaceBatch& surfaces, float* const radiance[3]);
extern const ShadeAmbientFn kShadeAmbient[kIsaCount];

// Flat and Phong.
using ShadeLightFn = void (*)(const Frame& frame, const SurfaceBatch& surfaces, const HitBatch& hits, int light,
                              const uint32_t* lit, float* const radiance[3]);
extern const ShadeLightFn kShadeLight[kIsaCount];

// Gouraud. corner_light: light at the vertices as LightVerticesFn wrote it, of this light; nullptr: evaluated here.
using ShadeLightGouraudFn = void (*)(const Frame& frame, const SurfaceBatch& surfaces, const HitBatch& hits, int light,
                                     const uint32_t* lit, const float* corner_light, float* const radiance[3]);
extern const ShadeLightGouraudFn kShadeLightGouraud[kIsaCount];

// Lights vertices, each with a material, seen from the eye. Both arrays are readable one vector past count. Writes, for each
// light, values[light * light_stride + 2 * vertex] = diffuse and [.. + 1] = specular factor: attenuation * reflectance * cosine,
// with the sign of n.l; times intensity and Kd or Ks it is radiance.
using LightVerticesFn = void (*)(const Frame& frame, const uint32_t* vertex, const uint32_t* material, int count,
                                 float* values, size_t light_stride);
extern const LightVerticesFn kLightVertices[kIsaCount];

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
