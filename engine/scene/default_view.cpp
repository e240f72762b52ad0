#include "scene/default_view.h"

#include <algorithm>

#include "math/elementary.h"
#include "math/vec.h"

namespace spanray {
namespace {

struct Ball {
  glm::dvec3 center;
  double radius;
};

Ball bounding_sphere(const SceneData& scene) {
  glm::dvec3 low, high;
  for (int k = 0; k < 3; ++k) low[k] = scene.bounds_min[k], high[k] = scene.bounds_max[k];
  const double radius = length3(high - low) * 0.5;
  return {(low + high) * 0.5, radius > 0 ? radius : 1.0};
}

}  // namespace

double fitted_near_plane(const SceneData& scene) { return 2e-3 * bounding_sphere(scene).radius; }

Camera fitted_camera(const SceneData& scene) {
  const Ball sphere = bounding_sphere(scene);
  Camera camera;
  double sine = 0, cosine = 0;
  sin_cos(camera.fov_y_degrees * 0.5 * (kPi / 180), &sine, &cosine);
  const double distance = sphere.radius / sine;
  const glm::dvec3 eye = sphere.center + normalize3(glm::dvec3(0, 0.3, 1), glm::dvec3(0, 0, 1)) * distance;
  for (int k = 0; k < 3; ++k) camera.eye[k] = eye[k], camera.target[k] = sphere.center[k];
  camera.near_plane = fitted_near_plane(scene);
  return camera;
}

Light default_light(const SceneData& scene, const Camera& camera) {
  glm::dvec3 eye, target, up;
  for (int k = 0; k < 3; ++k) eye[k] = camera.eye[k], target[k] = camera.target[k], up[k] = camera.up[k];
  const glm::dvec3 forward = normalize3(target - eye, glm::dvec3(0, 0, -1));
  const glm::dvec3 right = normalize3(cross3(forward, up), glm::dvec3(1, 0, 0));
  // A camera inside the scene keeps its light near: a wall may stand close to it.
  const double step = 0.05 * std::min(length3(target - eye), bounding_sphere(scene).radius);
  const glm::dvec3 position = eye + (cross3(right, forward) - right) * step;
  Light light;
  light.kind = static_cast<int32_t>(LightKind::kPoint);
  for (int k = 0; k < 3; ++k) {
    light.position[k] = static_cast<float>(position[k]) + 0.0f;
    light.intensity[k] = static_cast<float>(kPi * kDefaultLightRadiance);
    light.attenuation[k] = k == 0 ? 1.0f : 0.0f;
  }
  return light;
}

}  // namespace spanray
