// Height maps in the form that shading reads fastest.
#pragma once
#include "scene/scene_data.h"

namespace spanray {

// SceneData::height_rows and heights for what materials use as map_bump: uses that name one channel (the loader lets gray ones do so)
// and repeat their texture. Other uses, and whatever would go beyond 2^30 heights, are read from the texels. About 2.7 bytes a texel.
// To be called when all materials, uses and textures are there, and again after any change of them.
void make_height_rows(SceneData& scene);

}  // namespace spanray
