// Shading rate 2x2: squares of four pixels that see one surface are shaded once, all others pixel by pixel
// (docs/decisions/0012-shading-rate.md). Nothing here runs, and nothing is allocated, at rate 1x1.
#pragma once
#include <cstdint>

#include "frame/frame.h"

namespace spanray {

struct Chunk;
struct Level;
struct TileWorker;

// Four slots of level 0 whose pixels form an aligned square: the upper left one is shaded, in the middle of the square, and
// gives the others its radiance. Its footprint stays that of a pixel: twice as large erred more on every shipped scene.
struct Quad {
  uint32_t slot[4];       // upper left, upper right, lower left, lower right
  uint32_t primitive[4];  // what they see
};

// True where the middle of the square may stand for what its pixels see: one triangle, or (not in flat shading) triangles of
// one material that share a vertex, position, normal and texture coordinates alike, with the first. Never where one sees the
// background.
bool is_one_surface(const Frame& frame, const uint32_t (&primitive)[4]);

// Level 0 before it is shaded, its translucent fragments known: fills level.quads and level.shading_place. The slots that are
// not shaded count as misses until spread_quads.
// Contract: a function of what the pixels see, of nothing else: tiles and chunks begin at even pixels. Pixels whose samples see
//           different surfaces, or any translucent layer, are in no quad; nor are those of an odd last column or row.
void find_quads(const Frame& frame, const Chunk& chunk, const TileWorker& worker, Level& level);

// Radiance of each quad to all its slots, and their primitives back.
void spread_quads(Level& level);

}  // namespace spanray
