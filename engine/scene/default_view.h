// A camera and a light for scenes that name none.
#pragma once
#include "scene/scene_data.h"

namespace spanray {

// Of eye and target, either way: squares of larger numbers overflow nothing yet, but leave no digits for a picture.
inline constexpr double kMaxCameraCoordinate = 1e18;

// Distance of the near plane for a scene: 1e-3 of the diagonal of its bounds.
double fitted_near_plane(const SceneData& scene);

// Looks at the middle of the bounds from +z, slightly above, 45 degrees: the bounding sphere just fits the height of the
// picture (and its width, for pictures at least as wide as high).
Camera fitted_camera(const SceneData& scene);

// A point light near the eye (up and to the left of it, so that shadows show), without falloff: a white surface that faces it
// has the radiance kDefaultLightRadiance.
Light default_light(const SceneData& scene, const Camera& camera);
inline constexpr double kDefaultLightRadiance = 0.9;

}  // namespace spanray
