// Shadow rays that start above coarse triangles (Settings::shadow_terminator): which surfaces may have them.
#pragma once
#include "ray/bvh.h"
#include "shade/light.h"

namespace spanray {

// Takes the lift from surfaces where something stands between them and the start of their lifted rays: their shadow rays then start on
// the triangle, so that no light passes through it. Once a batch, before its lights. `blocked`, rays and surface_of_ray are scratch.
// Returns how many rays were traced.
uint64_t keep_free_lifts(const Frame& frame, const Bvh& opaque, SurfaceBatch& surfaces, RayBatch& rays,
                         AlignedBuffer<uint32_t>& surface_of_ray, AlignedBuffer<uint32_t>& blocked);

}  // namespace spanray
