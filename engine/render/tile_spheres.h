// Spheres over what a tile sees of triangles (raster/spheres.h), in the layouts of either visibility engine.
#pragma once
#include "render/tile.h"

namespace spanray {

// After rasterize_tile, through `place` (frame/samples.h). Returns how many samples passed.
uint64_t rasterize_spheres(const Frame& frame, const SphereBins& bins, int tile, int place, TileHits& visible);
inline uint64_t rasterize_spheres(const FrameJob& job, int tile, int place, TileHits& visible) {
  return rasterize_spheres(job.frame, *job.spheres, tile, place, visible);
}

// After trace_closest of a chunk's primary rays. primitive: row by row; or level.primitive, by slot of worker.pixel_order.
void add_spheres(const FrameJob& job, const Chunk& chunk, int place, TileWorker& worker, uint32_t* primitive);
void add_spheres(const FrameJob& job, const Chunk& chunk, TileWorker& worker, Level& level);

}  // namespace spanray
