#include "render/query_hit.h"

#include <algorithm>

#include "ray/triangle_test.h"

namespace spanray {

ExactRay exact_ray(const Ray& r) {
  ExactRay ray;
  for (int k = 0; k < 3; ++k) ray.origin[k] = r.origin[k], ray.direction[k] = r.direction[k];
  ray.t_max = r.t_max;
  return ray;
}

TriangleName name_of(const SceneData& scene, uint32_t primitive) {
  TriangleName name;
  name.triangle = primitive;
  name.material_index = material_of(scene, primitive);
  name.material = scene.material_names[name.material_index];
  name.sphere = scene.is_sphere(primitive), name.plane = scene.is_plane(primitive);
  if (!scene.is_triangle(primitive)) return name;
  const auto next = std::upper_bound(scene.parts.begin(), scene.parts.end(), primitive,
                                     [](uint32_t p, const ScenePart& part) { return p < part.first; });
  name.object = scene.part_names[(next - 1)->object], name.group = scene.part_names[(next - 1)->group];
  return name;
}

RayHit hit_of(const SceneData& scene, const ExactRay& ray, uint32_t primitive) {
  const ExactHitAt at = first_hit(ray, scene, primitive);
  RayHit hit;
  hit.name = name_of(scene, primitive), hit.t = at.t, hit.front = at.front, hit.distance = at.t * length3(ray.direction);
  glm::dvec3 position = ray.origin + ray.direction * at.t, normal;
  if (hit.name.plane) {
    normal = normalize3(normal_of(scene.plane(primitive)), glm::dvec3(0, 1, 0));
  } else {
    const glm::dvec3 center = center_of(scene.sphere(primitive));
    normal = normalize3(ray.origin - center + ray.direction * at.t, glm::dvec3(0, 1, 0));
    position = center + normal * static_cast<double>(scene.sphere(primitive).radius);
  }
  store(position, hit.position), store(normal, hit.normal);
  return hit;
}

RayHit hit_of(const SceneData& scene, const Ray& ray, uint32_t primitive) {
  if (!scene.is_triangle(primitive)) return hit_of(scene, exact_ray(ray), primitive);
  const Triangle& triangle = scene.triangles[primitive];
  float corners[9];
  glm::dvec3 v[3];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) v[i][k] = corners[3 * i + k] = scene.vertices[triangle.vertex[i]].position[k];
  RayHit hit;
  hit.name = name_of(scene, primitive);
  if (!meet_triangle(ray.origin, ray.direction, ray.t_max, corners, hit.t)) return hit;
  const glm::dvec3 origin(ray.origin[0], ray.origin[1], ray.origin[2]), direction(ray.direction[0], ray.direction[1], ray.direction[2]);
  hit.distance = hit.t * length3(direction);
  store(origin + direction * hit.t, hit.position);
  glm::dvec3 normal = normalize3(cross3(v[1] - v[0], v[2] - v[0]), glm::dvec3(0));
  if ((triangle.bits & kTriangleFlipped) != 0) normal = -normal;
  store(normal, hit.normal);
  hit.front = facing(scene, triangle, origin) >= 0;
  return hit;
}

}  // namespace spanray
