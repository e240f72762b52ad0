// From a shaded chunk to the caller's arrays.
#pragma once
#include "render/tile.h"

namespace spanray {

// Writes the pixels of a chunk: bytes, and what else the request asks for, the ladder included. level: level 0, shaded.
void write_chunk(const FrameJob& job, TileWorker& worker, const Level& level, const Chunk& chunk);

}  // namespace spanray
