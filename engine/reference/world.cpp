#include "reference/world.h"

#include <cmath>

#include "scene/default_view.h"

namespace spanray::reference {
namespace {

std::vector<uint32_t> primitives(const SceneData& scene, const Surfaces& surfaces, bool blended) {
  std::vector<uint32_t> list;
  for (uint32_t i = 0; i < scene.triangles.size() + scene.spheres.size() + scene.planes.size(); ++i)
    if ((surfaces.role(i) == Role::kBlended) == blended) list.push_back(i);
  return list;
}

}  // namespace

World::World(const SceneData& s, const Camera& camera, const Settings& settings)
    : scene(s),
      surfaces(s, settings),
      opaque(s, primitives(s, surfaces, false)),
      blended(s, primitives(s, surfaces, true)),
      lights(s.lights) {
  if (s.light_follows_eye) lights.assign(1, default_light(s, camera));
}

Result<void> check_model(const SceneData& scene, const Settings& settings) {
  if (settings.width < 1 || settings.height < 1 || settings.width > kMaxImageSide || settings.height > kMaxImageSide)
    return Error{"reference: a picture has 1 to 16384 pixels a side"};
  if (!(std::fabs(settings.time) <= kMostSeconds)) return Error{"reference: the time is at most 1e6 seconds either way"};
  for (size_t i = 0; i < scene.materials.size(); ++i)
    if (const int model = scene.materials[i].reflectance; model != kBlinnPhong && model != kLambert)
      return Error{"reference: material " + scene.material_names[i] + " has a reflectance that the reference does not model"};
  for (const Light& light : scene.lights)
    if (light.kind != static_cast<int32_t>(LightKind::kPoint) && light.kind != static_cast<int32_t>(LightKind::kDirectional))
      return Error{"reference: the scene has a kind of light that the reference does not model"};
  return {};
}

}  // namespace spanray::reference
