// An OBJ file with its materials and textures -> the geometry and tables of a scene.
#pragma once
#include <string>

#include "scene/instance_list.h"
#include "scene/moving_parts.h"
#include "scene/scene_data.h"
#include "scene/text_input.h"
#include "spanray/scene.h"

namespace spanray {

// Fills materials, textures, geometry, motions and instances of `scene` (which must be empty). Missing libraries, materials and textures are
// warnings. Errors name file, line and cause.
Result<void> load_obj(const std::string& path, const LoadOptions& options, const MovingParts& moving, const InstanceList& instances, SceneData& scene,
                      Messages& messages);

}  // namespace spanray
