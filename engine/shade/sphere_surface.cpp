#include "shade/sphere_surface.h"

#include <algorithm>
#include <cmath>

#include "frame/sphere_hit.h"
#include "shade/surface_kernels.h"

namespace spanray {
namespace {

double max_abs(const glm::dvec3& v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

void put3(float* const field[3], int i, const glm::dvec3& v) {
  for (int k = 0; k < 3; ++k) field[k][i] = static_cast<float>(v[k]);
}
void put3(float* const field[3], int i, const float (&v)[3]) {
  for (int k = 0; k < 3; ++k) field[k][i] = v[k];
}

// The ray of a hit, with how origin and direction move by a pixel in x and in y.
struct HitRay {
  SphereRay line;
  glm::dvec3 origin_d[2]{}, direction_d[2]{};
};

HitRay ray_of(const Frame& frame, const HitBatch& hits, size_t i) {
  HitRay ray;
  if (hits.rays == nullptr || hits.rays->primary) {
    const size_t place = hits.place.empty() ? 0 : hits.place[i];
    const uint32_t pixel = hits.pixel[i];
    ray.line = primary_sphere_ray(frame, (pixel & 0xffff) + frame.places.x[place], (pixel >> 16) + frame.places.y[place]);
    ray.direction_d[0] = frame.primary.step_x * frame.footprint, ray.direction_d[1] = frame.primary.step_y * frame.footprint;
    return ray;
  }
  const RayBatch& rays = *hits.rays;
  const size_t at = hits.ray[i];
  const auto get = [at](const AlignedBuffer<float>(&from)[3]) { return glm::dvec3(from[0][at], from[1][at], from[2][at]); };
  ray.line.origin = get(rays.origin), ray.line.direction = get(rays.direction);
  ray.line.front_only = frame.settings.culling == Culling::kBack;
  if (rays.direction_dx[0].empty()) return ray;
  ray.origin_d[0] = get(rays.origin_dx), ray.origin_d[1] = get(rays.origin_dy);
  ray.direction_d[0] = get(rays.direction_dx), ray.direction_d[1] = get(rays.direction_dy);
  return ray;
}

// Where a ray meets a sphere that it is said to hit. One that passes it by (a pixel's center, where only samples saw the
// sphere) takes the point that it comes nearest to.
struct SpherePoint {
  double t = 0;
  glm::dvec3 position{0}, normal{0};  // normal: unit, toward the ray's origin
};
SpherePoint point_of(const SphereRay& ray, const Sphere& sphere, uint32_t primitive) {
  const glm::dvec3 center = center_of(sphere), from_center = ray.origin - center;
  const SphereHitAt hit = first_hit(ray, sphere, primitive);
  SpherePoint p;
  p.t = hit.t;
  if (!std::isfinite(p.t)) p.t = std::max(-dot3(from_center, ray.direction) / dot3(ray.direction, ray.direction), ray.t_min);
  const glm::dvec3 outward = normalize3(from_center + ray.direction * p.t, glm::dvec3(0, 0, 1));
  p.position = center + outward * static_cast<double>(sphere.radius);
  p.normal = hit.entering ? outward : -outward;
  return p;
}

// How the position moves with a pixel, as on a plane through it. Source: Igehy 1999, equations 10 to 12 (transfer() of
// shade/resolve-inl.h).
glm::dvec3 transfer(const glm::dvec3& origin_d, const glm::dvec3& direction_d, const SphereRay& ray, const SpherePoint& p) {
  const glm::dvec3 moved = origin_d + direction_d * p.t;
  const double slope = dot3(ray.direction, p.normal), ratio = slope == 0 ? 0 : dot3(moved, p.normal) / slope;
  glm::dvec3 d = moved - ray.direction * std::clamp(ratio, -0x1p100, 0x1p100);
  for (int k = 0; k < 3; ++k) d[k] = std::clamp(d[k], -0x1p62, 0x1p62);  // its length is finite in float
  return d;
}

// Bound on each coordinate of the position in float against the sphere: half an ulp, and what double loses. Rays start beyond the
// tangent plane by that much at least, which is more than the sphere sags under it as long as it is a few ulp wide: those that
// start inside stay inside.
double position_error(const SphereRay& ray, const Sphere& sphere, const SpherePoint& p) {
  const glm::dvec3 center = center_of(sphere);
  const double around = max_abs(center) + max_abs(ray.origin - center) + static_cast<double>(sphere.radius);
  return max_abs(p.position) * 0x1.01p-24 + around * 0x1p-44 + 0x1p-148;
}

void put_material(const PlanFlags& plan, const Material& m, SurfaceBatch& out, int i) {
  const float none[3] = {0, 0, 0};
  put3(out.diffuse, i, m.diffuse);
  put3(out.specular, i, plan.specular ? m.specular : none);
  out.shininess[i] = plan.specular ? m.shininess : 0, out.opacity[i] = m.opacity;
  if (out.fields & kSurfaceAmbient) put3(out.ambient, i, m.ambient);
  if (out.fields & kSurfaceMirror) put3(out.mirror, i, m.mirror);
  if (out.fields & kSurfaceEmission) put3(out.emission, i, m.emission);
}

// Entry i, all of whose fields are 0.
void resolve_sphere(const Frame& frame, const HitBatch& hits, int i, SurfaceBatch& out) {
  const size_t at = static_cast<size_t>(i);
  const uint32_t primitive = hits.primitive[at];
  const Sphere& sphere = frame.scene->sphere(primitive);
  const HitRay ray = ray_of(frame, hits, at);
  const SpherePoint p = point_of(ray.line, sphere, primitive);
  put3(out.position, i, p.position), put3(out.geometric_normal, i, p.normal);
  if (out.fields & kSurfaceNormal) put3(out.normal, i, p.normal);
  if (out.fields & kSurfaceView) put3(out.view, i, normalize3(ray.line.origin - p.position, normalize3(-ray.line.direction, p.normal)));
  out.position_error[i] = static_cast<float>(position_error(ray.line, sphere, p));
  if (out.fields & kSurfaceDepth) out.t[i] = static_cast<float>(p.t);
  if (out.fields & kSurfaceFootprint) {
    put3(out.dpdx, i, transfer(ray.origin_d[0], ray.direction_d[0], ray.line, p));
    put3(out.dpdy, i, transfer(ray.origin_d[1], ray.direction_d[1], ray.line, p));
  }
  put_material(frame.plan, frame.scene->materials[sphere.material], out, i);
  out.pixel[i] = hits.pixel[at], out.primitive[i] = primitive, out.material[i] = sphere.material, out.valid[i] = 1;
  out.ray[i] = hits.rays != nullptr && !hits.rays->primary ? hits.ray[at] : 0;
}

bool is_sphere(const SceneData& scene, uint32_t primitive) { return primitive != kNoPrimitive && scene.is_sphere(primitive); }

}  // namespace

void resolve_with_spheres(const Frame& frame, const HitBatch& hits, SurfaceBatch& out) {
  kResolve[isa_index(frame.isa)](frame, hits, out);  // triangles; all else is cleared
  for (int i = 0; i < hits.count; ++i)
    if (is_sphere(*frame.scene, hits.primitive[static_cast<size_t>(i)])) resolve_sphere(frame, hits, i, out), out.spheres.push_back(i);
}

}  // namespace spanray
