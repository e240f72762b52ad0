// What a tile writes on the hash ladder.
#pragma once
#include "frame/ladder.h"
#include "render/tile.h"

namespace spanray {

// Several surfaces of one pixel come in no order that its own samples decide, so they are added up instead of chained.
void mix_surfaces(const FrameJob& job, const SurfaceBatch& surfaces, const HitBatch& hits);
void mix_shadow_bits(const FrameJob& job, const SurfaceBatch& surfaces, const HitBatch& hits, const uint32_t* lit, int light);
// Ids (of every sample), radiance and bytes of the finished pixels of a chunk.
void mix_chunk(const FrameJob& job, const TileWorker& worker, const Chunk& chunk, const ChunkPixels& pixels);

}  // namespace spanray
