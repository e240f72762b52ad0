#include "ray/exact_set.h"

#include <algorithm>
#include <cmath>

#include "frame/exact_hit.h"
#include "ray/triangle_test.h"

namespace spanray {
namespace {

bool finite3(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool usable(const ExactRay& ray) {
  return finite3(ray.origin) && finite3(ray.direction) && ray.direction != glm::dvec3(0) && !std::isnan(ray.t_max);
}

ExactRay ray_of(const RayBatch& rays, int i) {
  ExactRay ray;
  for (int k = 0; k < 3; ++k) ray.origin[k] = rays.origin[k][i], ray.direction[k] = rays.direction[k][i];
  ray.t_max = rays.t_max[i];
  if (!rays.from.empty()) ray.from = rays.from[i];
  return ray;
}

// t of a triangle that the ray is known to meet, in units of its direction.
double triangle_t(const SceneData& scene, const RayBatch& rays, int i, uint32_t primitive) {
  float origin[3], direction[3], corner[9];
  for (int k = 0; k < 3; ++k) origin[k] = rays.origin[k][i], direction[k] = rays.direction[k][i];
  for (int v = 0; v < 3; ++v) std::copy_n(scene.vertices[scene.triangles[primitive].vertex[v]].position, 3, corner + 3 * v);
  TraceRay ray;
  double t = 0;
  if (!prepare_ray(origin, direction, rays.t_max[i], ray) || !hit_triangle(ray, TriangleView{corner, 3, 1}, t)) return 0;
  return t * (ray.direction_z / static_cast<double>(direction[ray.kz]));  // a power of two
}

}  // namespace

ExactSet::ExactSet(const SceneData& scene, const uint32_t* material_flags, uint32_t mask, uint32_t value)
    : spheres_(scene, material_flags, mask, value) {
  for (size_t i = 0; i < scene.planes.size(); ++i)
    if ((material_flags[scene.planes[i].material] & mask) == value)
      planes_.push_back({scene.planes[i], static_cast<uint32_t>(scene.triangles.size() + scene.spheres.size() + i)});
}

ExactMeeting ExactSet::closest(const ExactRay& ray) const {
  if (!usable(ray)) return {};
  ExactMeeting best;
  for (const PlaneItem& item : planes_)
    if (const double t = first_hit(ray, item.plane, item.primitive).t; t <= ray.t_max) best.improve(item.primitive, t);
  if (spheres_.empty()) return best;
  ExactRay rest = ray;
  rest.t_max = std::min(ray.t_max, best.t);
  const ExactMeeting sphere = spheres_.closest(rest);
  best.improve(sphere.primitive, sphere.t);
  return best;
}

bool ExactSet::any(const ExactRay& ray) const {
  if (!usable(ray)) return false;
  for (const PlaneItem& item : planes_)
    if (const double t = first_hit(ray, item.plane, item.primitive).t; t <= ray.t_max && std::isfinite(t)) return true;
  return spheres_.any(ray);
}

void closest_exact(const Frame& frame, const ExactSet& set, const RayBatch& rays, uint32_t* out) {
  for (int i = 0; i < rays.count; ++i) {
    ExactRay ray = ray_of(rays, i);
    ray.front_only = frame.settings.culling == Culling::kBack;
    const ExactMeeting met = set.closest(ray);
    if (met.primitive == kNoPrimitive) continue;
    if (out[i] == kNoPrimitive ||
        !shows_triangle(*frame.scene, out[i], triangle_t(*frame.scene, rays, i, out[i]), met.primitive, met.t))
      out[i] = met.primitive;
  }
}

void any_exact(const ExactSet& set, const RayBatch& rays, uint32_t* out) {
  for (int i = 0; i < rays.count; ++i)
    if ((out[i / 32] >> (i % 32) & 1u) == 0 && set.any(ray_of(rays, i))) out[i / 32] |= 1u << (i % 32);
}

}  // namespace spanray
