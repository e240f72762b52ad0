// How one pixel comes about: the loop of render/tile.cpp repeated for a single pixel, by the same stage functions on batches of
// one, keeping what each step gave. For `spanray why`.
#pragma once
#include <memory>
#include <vector>

#include "frame/rays.h"
#include "spanray/render.h"

namespace spanray {

struct LightTrace {
  int light = 0;
  bool in_front = false;                   // the light may reach the surface: only then is a shadow ray made
  bool has_ray = false;                    // shadow rays are part of the plan, and this surface got one
  float origin[3] = {}, direction[3] = {}, t_max = 0;
  bool lifted = false;                     // that ray starts at position + lift
  bool lit = true;
  uint32_t blocker = 0xffffffffu;          // nearest primitive on the way to the light, if a closest-hit ray finds one
  float to_light[3] = {}, irradiance[3] = {};  // at the position: unit direction, W/m^2 on a surface that faces the light
  float alone[3] = {};                     // radiance of this light, as if nothing blocked it
  float sum[3] = {};                       // radiance after this light
};

struct SurfaceTrace {
  uint32_t primitive = 0xffffffffu, material = 0;
  bool valid = false;
  float t = 0, weight[3] = {}, position[3] = {}, position_error = 0;
  float geometric_normal[3] = {}, normal[3] = {}, view[3] = {}, lift[3] = {};
  float uv[2] = {};                        // vertex coordinates weighted here, for orientation; shading has its own
  float dpdx[3] = {}, dpdy[3] = {};
  float ambient[3] = {}, diffuse[3] = {}, specular[3] = {}, emission[3] = {}, mirror[3] = {}, shininess = 0, opacity = 1;
  float ambient_radiance[3] = {};          // ambient + emission, before any light
  std::vector<LightTrace> lights;
  float radiance[3] = {};
};

// One ray of the chain: the primary ray, or a mirror ray.
struct LevelTrace {
  float origin[3] = {}, direction[3] = {};  // of a mirror ray
  float weight[3] = {1, 1, 1};              // what its radiance is multiplied by one level up
  SurfaceTrace surface;                     // not valid: the ray left the scene
  std::vector<SurfaceTrace> layers;         // translucent, farthest first
  float layers_over[3] = {}, transmittance = 1;  // radiance after the layers; what they let through
  float radiance[3] = {};                   // with everything that came back from the levels below
};

// What the pixel sees: one of these, or with several samples a pixel one for each slot of render/tile_samples.h.
struct SlotTrace {
  float weight = 1;                         // of the pixel's samples
  bool quad = false;                        // shaded once for 2 x 2 pixels (Settings::shading_rate)
  glm::dvec2 position{0};                   // in the picture, where it is shaded
  glm::dvec3 direction{0};                  // the exact primary ray through it
  // What each engine sees there; of a quad, in the pixel itself.
  uint32_t raster_primitive = 0xffffffffu, ray_primitive = 0xffffffffu;
  uint32_t primitive = 0xffffffffu;         // the one that is shaded
  float raster_depth = 0;                   // of the rasterizer's tile
  std::vector<LevelTrace> levels;
};

struct PixelTrace {
  glm::dvec3 eye{0};
  bool by_ray = false;                      // settings.visibility
  int samples = 1;
  uint32_t primitive = 0xffffffffu;         // that the pixel, or its sample 0, sees
  std::vector<SlotTrace> slots;             // first what sample 0 sees
  float radiance[3] = {};
  uint8_t rgba[4] = {};
};

// Errors: as Renderer::render; a pixel outside the picture.
Result<PixelTrace> trace_pixel(const Scene& scene, const Camera& camera, const Settings& settings, int x, int y);

}  // namespace spanray
