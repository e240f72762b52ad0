// A scene as both modes of the reference ask for it: its trees, its surfaces, its lights.
#pragma once
#include "reference/surface.h"
#include "spanray/result.h"

namespace spanray::reference {

struct World {
  // scene must live as long; camera: where the default light stands.
  World(const SceneData& scene, const Camera& camera, const Settings& settings);
  // What a ray's walk through a tree asks of each hit.
  auto stop(const Ray& ray) const {
    return [this, &ray](uint32_t primitive, double) { return surfaces.stops(ray, primitive); };
  }
  // The same of a shadow ray: both faces of a surface cast shadows, whatever is culled (ray/bvh.h).
  auto blocks(const Ray& ray) const {
    return [this, &ray](uint32_t primitive, double) {
      return surfaces.stops(ray, primitive, surfaces.stop_opacity(ray, primitive));
    };
  }

  const SceneData& scene;
  const Surfaces surfaces;
  const Tree opaque, blended;  // blended: the layers of translucent surfaces
  std::vector<Light> lights;
};

// Whether the reference knows the scene's reflectances and lights, and settings are in range.
Result<void> check_model(const SceneData& scene, const Settings& settings);

}  // namespace spanray::reference
