// From what a ray met to the answer of spanray/query.h: its name, place and normal.
#pragma once
#include "frame/exact_hit.h"
#include "spanray/query.h"

namespace spanray {

inline void store(const glm::dvec3& v, double (&out)[3]) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }

// Without t_min, as the tracer sees it.
ExactRay exact_ray(const Ray& ray);

TriangleName name_of(const SceneData& scene, uint32_t primitive);

// The hit of a ray with a primitive that it is known to meet; with an ExactRay, an exact one.
RayHit hit_of(const SceneData& scene, const Ray& ray, uint32_t primitive);
RayHit hit_of(const SceneData& scene, const ExactRay& ray, uint32_t primitive);

}  // namespace spanray
