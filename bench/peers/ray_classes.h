// The rays of one of our frames, kind by kind, so that two tracers can answer the very same ones.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "ray/bvh.h"
#include "spanray/scene.h"

namespace spanray::peers {

// Rays stand in the order of 4 x 4 pixel blocks, in parts of 64 x 16 pixels: what a tile of a frame asks for at once.
struct RayClass {
  std::string name;
  bool any_hit = false;
  std::vector<RayBatch> parts;
  size_t count() const;
};

// What our tracer wants to know besides the rays. All triangles are opaque: Embree is asked without filter functions.
struct TracedScene {
  Scene scene;
  std::vector<uint32_t> flags;  // by material: 0
  Frame frame;
  Bvh bvh;
  double build_ms = 0;  // median
  TracedScene(const Scene& traced, const Camera& camera, const Settings& settings, Parallel& parallel, int builds);
  TracedScene(const TracedScene&) = delete;
  TracedScene& operator=(const TracedScene&) = delete;
};

// primary: through every pixel. shadow: from what they hit to each light, as our frame starts them (any hit). mirror: about the
// shading normal. diffuse: one cosine-distributed direction about it. ao: the same, 0.15 of the scene's diagonal long (any hit).
std::vector<RayClass> make_ray_classes(const TracedScene& traced);

}  // namespace spanray::peers
