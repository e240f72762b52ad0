// From the slots of a level to a batch of hits, and back.
#pragma once
#include "render/tile.h"

namespace spanray {

// The slots that hit something, as a batch: shading works on these only. Slots, those of mirror rays too, are neighbours in the picture.
void compact_hits(const Frame& frame, Level& level, bool primary);

// What a batch of hits says, to their slots; what misses say, to all others.
// worker.radiance, surfaces.t -> level.radiance, level.opaque_t.
void scatter_hits(const Frame& frame, TileWorker& worker, Level& level);

}  // namespace spanray
