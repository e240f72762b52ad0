// The rays of the model: through the places of a pixel, and from mirrors.
#pragma once
#include <vector>

#include "reference/surface.h"
#include "reference/view.h"

namespace spanray::reference {

// Places in a pixel where it is sampled, from its upper left corner, in pixels, and the side of the square that each stands
// for.
struct Places {
  std::vector<glm::dvec2> at;
  double side = 1;
};
// grid > 0: grid x grid places; 0: those of settings.samples (frame/samples.h).
Places make_places(const Settings& settings, int grid);

// The ray through place i of pixel (x, y), of view depth 1.
Ray primary_ray(const View& view, const Places& places, size_t i, int x, int y);
// What a mirror sends a ray to, footprint and all.
Ray mirrored_ray(const Ray& ray, const Surface& s);

}  // namespace spanray::reference
