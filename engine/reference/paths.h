// The ground truth, second mode: the rendering equation (Kajiya 1986) by path tracing in double. Light by way of other
// surfaces, glowing surfaces as lamps, soft shadows: what the renderer's model leaves out.
//
// What is modelled, and what is done where the renderer's model is no physics:
// * Lights: point lights (radiant intensity, W/sr) and directional ones (irradiance, W/m^2), with the scene's attenuation even
//   where that is not the inverse square; glowing surfaces (Ke: radiance, W/(m^2 sr), to both sides); the background (radiance,
//   W/(m^2 sr)) from all around. Ambient light is left out: it stands for what is computed here.
// * Reflectance: that of the catalog, for light from everywhere. Materials that would reflect more than they receive are made
//   darker as a whole (scatter.h). The MTL highlight is not reciprocal (its product with the cosine is symmetric instead of
//   itself) and is taken as it is.
// * Mirrors: exact. What a point light sends by way of one onto another surface is not found, since no path from the eye meets
//   a point, but for the highlight that the material has beside its mirror.
// * Layers (d below 1): stop light by chance, as often as they are opaque, and dim shadows, which the renderer's do not. They
//   refract nothing, and light on their far side is not seen. Screen-door layers are the same; map_d cuts out.
// * Normals: interpolated and bumped as the renderer has them; nothing is reflected to or from behind the geometric surface.
// Settings that count: size, time, transparency none, culling, textures, bump, filter (textures at their finest level).
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "spanray/image.h"
#include "spanray/scene.h"

namespace spanray {

inline constexpr int kMostDepth = 1024, kMostBranching = 1024;
inline constexpr uint32_t kMostPaths = 1u << 30;

struct PathOptions {
  int depth = 64;                // most surfaces that reflect along a path, 0 (only what glows is seen) to kMostDepth
  int branching = 1;             // paths that go on from what a viewing ray meets, 1 to kMostBranching
  bool russian_roulette = true;  // ends paths by chance, the darker the sooner, and makes up for it
  bool next_event = true;        // looks for glowing surfaces on purpose, too; point and directional lights always are
  uint64_t seed = 0;
  int threads = 0;  // 0: one per processor; changes no value
};

// What paths have gathered so far. With equal scene, camera, settings, options (but threads) and number of paths the same bits,
// in however many steps they were made.
struct PathSums {
  int width = 0, height = 0;     // pixels
  uint32_t paths = 0;            // viewing rays a pixel
  std::vector<double> radiance;  // sum of the paths' radiance, W/(m^2 sr), linear RGB, row-major, top row first
  std::vector<double> square;    // a pixel: sum of the squares of the paths' luminance (Rec. 709)

  double luminance(size_t pixel) const;  // mean, W/(m^2 sr)
  // Of the mean luminance of a pixel; infinite below 2 paths.
  double standard_error(size_t pixel) const;
  // Root mean square of all pixels' standard errors over the picture's mean luminance; infinite below 2 paths, 0 for black.
  double noise() const;
};

struct PathControl {
  // Called now and then, by one thread at a time; may be empty. Of the paths that are asked for.
  std::function<void(double fraction)> progress = {};
  // Called after each pass of one viewing ray a pixel; false: enough. May be empty.
  std::function<bool(const PathSums&)> go_on = {};
};

// Adds viewing rays to every pixel until there are `paths`. sums: empty ({}), or what an earlier call made with the same scene,
// camera, settings and options. Errors: those of render_reference(); options out of range; sums of another size.
Result<void> trace_paths(const Scene& scene, const Camera& camera, const Settings& settings, const PathOptions& options,
                         uint32_t paths, PathSums& sums, const PathControl& control = {});

// The means: radiance in float and its sRGB bytes. Without primitives.
void path_picture(const PathSums& sums, Framebuffer& out);

// Where this scene asks for what is no physics, or is not found, and what is done about it (see above): some words each.
std::vector<std::string> path_remarks(const Scene& scene, const Settings& settings);

}  // namespace spanray
