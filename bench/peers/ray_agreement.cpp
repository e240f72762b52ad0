#include "ray_agreement.h"

#include <algorithm>
#include <cmath>

#include "ray/bvh_data.h"
#include "ray/triangle_test.h"

namespace spanray::peers {
namespace {

// t of a ray and the triangle that it hits, as our test finds it; in units of the ray's direction.
double exact_t(const SceneData& scene, const RayBatch& rays, size_t i, uint32_t primitive) {
  float origin[3], direction[3], corners[9];
  for (size_t k = 0; k < 3; ++k) origin[k] = rays.origin[k][i], direction[k] = rays.direction[k][i];
  for (size_t v = 0; v < 3; ++v)
    for (size_t k = 0; k < 3; ++k) corners[3 * v + k] = scene.vertices[scene.triangles[primitive].vertex[v]].position[k];
  TraceRay ray;
  double t = 0;
  if (!prepare_ray(origin, direction, rays.t_max[i], ray) || !hit_triangle(ray, TriangleView{corners, 3, 1}, t)) return -1;
  const double largest = std::max(std::fabs(direction[0]), std::max(std::fabs(direction[1]), std::fabs(direction[2])));
  return std::ldexp(t, -std::ilogb(largest));  // counted in the direction scaled to [1, 2)
}

}  // namespace

uint64_t different_hits(const SceneData& scene, const RayBatch& rays, const uint32_t* ours, const uint32_t* theirs, const float* their_t) {
  uint64_t different = 0;
  for (size_t i = 0; i < static_cast<size_t>(rays.count); ++i) {
    if (ours[i] == theirs[i]) continue;
    if (ours[i] == kNoPrimitive || theirs[i] == kNoPrimitive) { ++different; continue; }
    const double t = exact_t(scene, rays, i, ours[i]);
    if (!(std::fabs(t - static_cast<double>(their_t[i])) <= kSameDistance * t)) ++different;
  }
  return different;
}

uint64_t different_bits(int count, const uint32_t* ours, const uint32_t* theirs) {
  uint64_t different = 0;
  for (size_t i = 0; i < static_cast<size_t>(count); ++i) different += ((ours[i / 32] ^ theirs[i / 32]) >> (i % 32)) & 1u;
  return different;
}

}  // namespace spanray::peers
