// Lighting of one batch of surfaces inside a tile.
#pragma once
#include "render/tile.h"

namespace spanray {

// worker.radiance = ambient + emission + every light in index order, each with its shadow bits.
void light_surfaces(const FrameJob& job, TileWorker& worker, SurfaceBatch& surfaces, const HitBatch& hits);

}  // namespace spanray
