// Exact primitives over what a tile sees of triangles (raster/exact.h), in the layouts of either visibility engine.
#pragma once
#include "render/tile.h"

namespace spanray {

// After rasterize_tile, through `place` (frame/samples.h). Returns how many samples passed.
uint64_t rasterize_exact(const Frame& frame, const ExactBins& bins, int tile, int place, TileHits& visible);
inline uint64_t rasterize_exact(const FrameJob& job, int tile, int place, TileHits& visible) {
  return rasterize_exact(job.frame, *job.exact, tile, place, visible);
}

// After trace_closest of a chunk's primary rays. primitive: row by row; or level.primitive, by slot of worker.pixel_order.
void add_exact(const FrameJob& job, const Chunk& chunk, int place, TileWorker& worker, uint32_t* primitive);
void add_exact(const FrameJob& job, const Chunk& chunk, TileWorker& worker, Level& level);

}  // namespace spanray
