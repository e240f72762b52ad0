#include "shade/exact_surface.h"

#include <algorithm>
#include <cmath>

#include "frame/exact_hit.h"
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
  ExactRay line;
  glm::dvec3 origin_d[2]{}, direction_d[2]{};
};

HitRay ray_of(const Frame& frame, const HitBatch& hits, size_t i) {
  HitRay ray;
  if (hits.rays == nullptr || hits.rays->primary) {
    const size_t place = hits.place.empty() ? 0 : hits.place[i];
    const uint32_t pixel = hits.pixel[i];
    ray.line = primary_exact_ray(frame, (pixel & 0xffff) + frame.places.x[place], (pixel >> 16) + frame.places.y[place]);
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

// Where a ray meets a primitive that it is said to hit. error: bound on each coordinate of the position, as it is rounded to
// float, against the surface: half an ulp, and what double loses.
struct ExactPoint {
  double t = 0;
  glm::dvec3 position{0}, normal{0};  // normal: unit, toward the ray's origin
  double error = 0;
};

double error_at(const glm::dvec3& position, double lost) { return max_abs(position) * 0x1.01p-24 + lost + 0x1p-148; }

// A ray that passes the sphere by (a pixel's center, where only samples saw it) takes the point that it comes nearest to.
// Rays start beyond the tangent plane by the error at least, which is more than the sphere sags under it as long as it is a few
// ulp wide: those that start inside stay inside.
ExactPoint point_of(const ExactRay& ray, const Sphere& sphere, uint32_t primitive) {
  const glm::dvec3 center = center_of(sphere), from_center = ray.origin - center;
  const ExactHitAt hit = first_hit(ray, sphere, primitive);
  ExactPoint p;
  p.t = hit.t;
  if (!std::isfinite(p.t)) p.t = std::max(-dot3(from_center, ray.direction) / dot3(ray.direction, ray.direction), ray.t_min);
  const double radius = static_cast<double>(sphere.radius);
  const glm::dvec3 outward = normalize3(from_center + ray.direction * p.t, glm::dvec3(0, 0, 1));
  p.position = center + outward * radius;
  p.normal = hit.front ? outward : -outward;
  p.error = error_at(p.position, (max_abs(center) + max_abs(from_center) + radius) * 0x1p-44);
  return p;
}

// A plane from a place: its unit normal, and height_over() of the place. Neighbouring hits mostly ask for the same.
class PlaneFrom {
 public:
  void set(const SceneData& scene, uint32_t plane, const glm::dvec3& place) {
    if (plane == plane_ && place == place_) return;
    const glm::dvec3 along = normal_of(scene.plane(plane));
    if (plane != plane_) normal = normalize3(along, glm::dvec3(0, 0, 1));
    height = height_over(along, point_of(scene.plane(plane)), place);
    plane_ = plane, place_ = place;
  }
  glm::dvec3 normal{0};
  double height = 0;

 private:
  uint32_t plane_ = kNoPrimitive;
  glm::dvec3 place_{0};
};

// A ray that misses the plane takes the farthest point that planes have. (No ray of a frame does: where samples see a plane, so
// does the middle between them.) from: the plane from the ray's origin.
ExactPoint point_of(const ExactRay& ray, const Plane& plane, const PlaneFrom& from) {
  const ExactHitAt hit = first_hit(ray, plane, from.height);
  const double reach = max_abs(ray.direction);
  ExactPoint p;
  p.t = std::isfinite(hit.t) ? hit.t : kFarthestHit / reach;
  p.position = ray.origin + ray.direction * p.t;
  p.normal = hit.front ? from.normal : -from.normal;
  p.error = error_at(p.position, (max_abs(ray.origin) + reach * p.t) * 0x1p-48);
  return p;
}

ExactPoint point_of(const ExactRay& ray, const SceneData& scene, uint32_t primitive, PlaneFrom& from) {
  if (scene.is_sphere(primitive)) return point_of(ray, scene.sphere(primitive), primitive);
  from.set(scene, primitive, ray.origin);
  return point_of(ray, scene.plane(primitive), from);
}

// Toward the ray's origin; where the surface is there, against the ray.
glm::dvec3 view_of(const ExactRay& ray, const ExactPoint& p) {
  const glm::dvec3 view = normalize3(ray.origin - p.position, glm::dvec3(0));
  return view != glm::dvec3(0) ? view : normalize3(-ray.direction, p.normal);
}

// How the position moves with a pixel, as on a plane through it. Source: Igehy 1999, equations 10 to 12 (transfer() of
// shade/resolve-inl.h).
glm::dvec3 transfer(const glm::dvec3& origin_d, const glm::dvec3& direction_d, const ExactRay& ray, const ExactPoint& p) {
  const glm::dvec3 moved = origin_d + direction_d * p.t;
  const double slope = dot3(ray.direction, p.normal), ratio = slope == 0 ? 0 : dot3(moved, p.normal) / slope;
  glm::dvec3 d = moved - ray.direction * std::clamp(ratio, -0x1p100, 0x1p100);
  for (int k = 0; k < 3; ++k) d[k] = std::clamp(d[k], -0x1p62, 0x1p62);  // its length is finite in float
  return d;
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
void resolve_exact(const Frame& frame, const HitBatch& hits, int i, PlaneFrom& from, SurfaceBatch& out) {
  const size_t at = static_cast<size_t>(i);
  const uint32_t primitive = hits.primitive[at], material = material_of(*frame.scene, primitive);
  const HitRay ray = ray_of(frame, hits, at);
  const ExactPoint p = point_of(ray.line, *frame.scene, primitive, from);
  put3(out.position, i, p.position), put3(out.geometric_normal, i, p.normal);
  if (out.fields & kSurfaceNormal) put3(out.normal, i, p.normal);
  if (out.fields & kSurfaceView) put3(out.view, i, view_of(ray.line, p));
  out.position_error[i] = static_cast<float>(p.error);
  if (out.fields & kSurfaceDepth) out.t[i] = static_cast<float>(p.t);
  if (out.fields & kSurfaceFootprint) {
    put3(out.dpdx, i, transfer(ray.origin_d[0], ray.direction_d[0], ray.line, p));
    put3(out.dpdy, i, transfer(ray.origin_d[1], ray.direction_d[1], ray.line, p));
  }
  put_material(frame.plan, frame.scene->materials[material], out, i);
  out.pixel[i] = hits.pixel[at], out.primitive[i] = primitive, out.material[i] = material, out.valid[i] = 1;
  out.ray[i] = hits.rays != nullptr && !hits.rays->primary ? hits.ray[at] : 0;
}

}  // namespace

void resolve_with_exact(const Frame& frame, const HitBatch& hits, SurfaceBatch& out) {
  kResolve[isa_index(frame.isa)](frame, hits, out);  // triangles; all else is cleared
  const SceneData& scene = *frame.scene;
  PlaneFrom from;
  for (int i = 0; i < hits.count; ++i) {
    const uint32_t primitive = hits.primitive[static_cast<size_t>(i)];
    if (primitive == kNoPrimitive || scene.is_triangle(primitive)) continue;
    resolve_exact(frame, hits, i, from, out);
    out.exact.push_back(i);
  }
}

}  // namespace spanray
