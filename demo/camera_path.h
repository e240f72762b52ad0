// A camera path in time.
#pragma once
#include <vector>

#include "scene/scene_data.h"

namespace spanray::demo {

// The camera at a time, linear between the two keys around it and held before the first and after the last. keys: not empty,
// in order of time.
Camera camera_at(const std::vector<CameraKey>& keys, double time);

// The time of frame `index` of `count` spread evenly over the whole path, the first and the last key included.
double time_of_frame(const std::vector<CameraKey>& keys, int index, int count);

}  // namespace spanray::demo
