// From a shaded chunk to the caller's arrays.
#pragma once
#include "render/tile.h"

namespace spanray {

// Writes the pixels of a chunk: bytes, and what else the request asks for, the ladder included. level: level 0, shaded.
void write_chunk(const FrameJob& job, TileWorker& worker, const Level& level, const Chunk& chunk);

// Asks for the memory that write_chunk will write, so that it comes while the chunk is shaded.
void fetch_output(const FrameJob& job, const Chunk& chunk);

// The same where nothing is seen, and nothing but bytes is asked for.
void write_background(const FrameJob& job, TileWorker& worker, const Chunk& chunk);

}  // namespace spanray
