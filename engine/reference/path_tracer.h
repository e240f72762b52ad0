// The rendering equation, one path of light at a time.
#pragma once
#include "reference/emitters.h"
#include "reference/paths.h"
#include "reference/random.h"
#include "reference/scatter.h"
#include "reference/view.h"

namespace spanray::reference {

// What paths make of a scene's settings: interpolated normals, all layers blended, one sample.
Settings for_paths(Settings settings);

// Source:   Kajiya 1986, "The Rendering Equation"; next-event estimation joined with the reflected path by the power heuristic:
//           Veach, Guibas 1995, "Optimally Combining Sampling Techniques for Monte Carlo Rendering".
class PathTracer {
 public:
  // scene must live as long.
  PathTracer(const SceneData& scene, const Camera& camera, const Settings& settings, const PathOptions& options);
  // Radiance along one random line of sight through a pixel, W/(m^2 sr). The expected value is the pixel's mean radiance; equal
  // arguments give equal bits.
  glm::dvec3 radiance(int x, int y, uint32_t path) const;

 private:
  // The first surface that stops a ray; layers stop it as often as they are opaque.
  Surface meet(const Ray& ray, double t_min, const PathKey& key, uint32_t bounce) const;
  // Share of the light that comes through between the origin and t_max; `lamp` itself is not in the way.
  double passes(const Ray& ray, double t_max, uint32_t lamp) const;
  glm::dvec3 by_lights(const Surface& s, const Scatter& scatter) const;
  glm::dvec3 by_emitters(const Surface& s, const Scatter& scatter, const PathKey& key, uint32_t bounce) const;
  // What one path that goes on from a surface adds to its emission.
  glm::dvec3 reflected(Surface s, const PathKey& key) const;
  // How densely by_emitters() looks at a surface that a ray of unit length met, 1/sr.
  double emitter_density(const Surface& hit) const;

  const PathOptions options_;
  const View view_;
  const World world_;
  const Emitters emitters_;
  const glm::dvec3 background_;
};

}  // namespace spanray::reference
