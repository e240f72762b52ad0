// The textures of the shipped scenes. Colors are sRGB; height maps 0 (deep) to 1; all of them tile unless said.
#pragma once
#include "picture.h"

namespace spanray::assets {

// Masonry. `_height` fits the color map of the same name texel by texel.
Picture limestone_color(int size);
Picture limestone_height(int size);
Picture brick_color(int size);       // 4 bricks x 12 courses
Picture brick_height(int size);
Picture slab_color(int size);        // 2 x 2 floor slabs with joints
Picture slab_height(int size);
Picture marble_color(int size, glm::dvec3 ground, glm::dvec3 vein, uint32_t seed);
Picture chessboard_color(int size);  // 2 x 2 squares of marble
Picture terrazzo_color(int size);

// Things cut, woven and painted.
Picture plank_color(int width, int height);  // 4 boards along u
Picture plank_height(int width, int height);
Picture ironwork_mask(int size);     // gray: 1 where there is iron; one panel, edges included
Picture leaf_color(int size);        // one leaf, stem at the bottom center; does not tile
Picture leaf_mask(int size);
Picture foliage_color(int size);     // a clipped hedge
Picture foliage_height(int size);
Picture ripple_height(int size);     // still water
Picture gauze_color(int size);       // woven stripes, along v
Picture ceramic_color(int width, int height);  // bands and lozenges of a painted vase, bottom to top
Picture globe_color(int width, int height);    // land and sea of a world that never was; tiles along u

}  // namespace spanray::assets
