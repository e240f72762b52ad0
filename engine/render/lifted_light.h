// Light that shadow rays from above coarse triangles find (Settings::shadow_terminator).
#pragma once
#include "ray/bvh.h"
#include "shade/light.h"

namespace spanray {

// Scratch, and what the last light left there.
struct LiftedLight {
  RayBatch rays;
  AlignedBuffer<uint32_t> surface_of_ray, occluded, seen;  // seen: a bit a surface, for lifted rays that met nothing
  size_t memory_bytes() const { return rays.memory_bytes() + surface_of_ray.bytes() + occluded.bytes() + seen.bytes(); }
};

// Sets the bits in `lit` (one a surface, readable one word past the last) of surfaces that have none and that the light reaches by a
// lifted ray: nothing between the surface and where that ray starts, nothing between there and the light. Returns how many rays were
// traced.
uint64_t find_lifted_light(const Frame& frame, const Bvh& opaque, const SurfaceBatch& surfaces, int light, LiftedLight& scratch,
                           uint32_t* lit);

}  // namespace spanray
