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

// The gallery hall.
Picture hall_floor_color(int size);      // one bay of inlaid marble: border, roundel, corner squares
Picture ashlar_color(int size);          // six courses of cut stone, three blocks each
Picture ashlar_height(int size);
Picture hall_brick_color(int size);      // 8 bricks x 24 courses
Picture hall_brick_height(int size);
Picture relief_sun_color(int size);      // a rosette in a ring of beads; one panel, edges included
Picture relief_sun_height(int size);
Picture relief_vine_color(int size);     // a plant of scrolls, mirrored about its stem
Picture relief_vine_height(int size);
Picture cut_stone_color(int size);       // fine, pale, without joints
Picture coffer_color(int size);          // deep blue, worn
Picture lattice_mask(int size);          // gray: iron bars of a window, 4 x 4 panes

}  // namespace spanray::assets
