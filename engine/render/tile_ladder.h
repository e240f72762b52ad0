// What a tile writes on the hash ladder.
#pragma once
#include "frame/ladder.h"
#include "render/tile.h"

namespace spanray {

void mix_surfaces(Ladder& ladder, const SurfaceBatch& surfaces);
void mix_shadow_bits(Ladder& ladder, const SurfaceBatch& surfaces, const uint32_t* lit, int light);
// Ids, radiance and bytes of finished level-0 slots.
void mix_chunk(Ladder& ladder, const FrameJob& job, const Level& level);

}  // namespace spanray
