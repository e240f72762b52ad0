// What both pictures of the model, and its ambiguity mask, begin with: is the request possible, and pixel by pixel.
#pragma once
#include <functional>

#include "reference/reference.h"
#include "scene/scene_data.h"

namespace spanray::reference {

// Errors as of render_reference.
Result<void> check_request(const SceneData& scene, const Settings& settings, int grid);
// Calls body(x, y) for every pixel, on options.threads threads, in blocks, and tells options.progress.
void for_each_pixel(const Settings& settings, const ReferenceOptions& options, const std::function<void(int x, int y)>& body);

}  // namespace spanray::reference
