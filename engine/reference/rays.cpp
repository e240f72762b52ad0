#include "reference/rays.h"

#include <cmath>

#include "frame/samples.h"
#include "reference/light.h"

namespace spanray::reference {
namespace {

// Derivative of a unit direction d = D / length by that of D.
glm::dvec3 of_unit(const glm::dvec3& d, double length, const glm::dvec3& derivative) {
  return (derivative - d * dot3(d, derivative)) * (1 / length);
}

}  // namespace

// A grid: one sample in each of grid x grid squares, and in each of grid^2 columns and rows, so that upright and level edges
// are measured as finely as slanted ones. Source: Chiu, Shirley, Wang 1994, "Multi-Jittered Sampling", the canonical
// arrangement, not jittered.
Places make_places(const Settings& settings, int grid) {
  Places places;
  if (grid > 0) {
    for (int j = 0; j < grid; ++j)
      for (int i = 0; i < grid; ++i) places.at.emplace_back((i + (j + 0.5) / grid) / grid, (j + (i + 0.5) / grid) / grid);
  } else {
    const SamplePlaces pattern = make_sample_places(settings.samples);
    for (int i = pattern.first(); i < pattern.end(); ++i) places.at.emplace_back(pattern.x[i], pattern.y[i]);
  }
  places.side = 1 / std::sqrt(static_cast<double>(places.at.size()));
  return places;
}

Ray primary_ray(const View& view, const Places& places, size_t i, int x, int y) {
  Ray ray;
  ray.line = {view.eye, view.direction(x + places.at[i].x, y + places.at[i].y)};
  ray.direction_dx = view.right * places.side, ray.direction_dy = view.down * places.side;
  ray.t_min = view.near;
  ray.x = x, ray.y = y;
  ray.rank_shift = static_cast<int>(i * 64 / places.at.size());
  return ray;
}

Ray mirrored_ray(const Ray& ray, const Surface& s) {
  const double length = length3(ray.line.direction);
  const glm::dvec3 d = -s.view, &n = s.normal;
  const auto turned = [&](const glm::dvec3& derivative) {
    const glm::dvec3 dd = of_unit(d, length, derivative);
    return dd - n * (2 * dot3(dd, n));  // the normal's own change left out, as the model says
  };
  Ray next;
  next.line = {start_above(s), mirror_direction(s)}, next.x = ray.x, next.y = ray.y;
  next.origin_dx = s.position_dx, next.origin_dy = s.position_dy;
  next.direction_dx = turned(ray.direction_dx), next.direction_dy = turned(ray.direction_dy);
  return next;
}

}  // namespace spanray::reference
