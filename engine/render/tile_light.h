// Lighting of one batch of surfaces inside a tile.
#pragma once
#include <functional>

#include "render/tile.h"

namespace spanray {

// worker.radiance = ambient + emission + every light in index order, each with its shadow bits.
void light_surfaces(const FrameJob& job, TileWorker& worker, SurfaceBatch& surfaces, const HitBatch& hits);

// Sets the bits of the surfaces that a light reaches; lit: zeros, one bit a surface (32 a word), and one word more.
using FindLitFn = std::function<void(int light, uint32_t* lit)>;
// The same, whoever finds what is lit: for our rays, and for those of others (bench/peers).
void light_surfaces_by(const Frame& frame, TileWorker& worker, const SurfaceBatch& surfaces, const HitBatch& hits, const FindLitFn& find_lit);

// From the rays of make_shadow_rays to surfaces: sets bit surface_of_ray[i] of `lit` for each ray i whose bit of `occluded` is not set.
// surface_of_ray: strictly increasing. Reads one word past the last of `occluded` and may write 0 bits to the one after the last of `lit`.
void mark_lit(const uint32_t* surface_of_ray, const uint32_t* occluded, int rays, uint32_t* lit);

}  // namespace spanray
