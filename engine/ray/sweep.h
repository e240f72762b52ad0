// Spheres against the tree, of one level or two: moved along a segment, or at rest.
#pragma once
#include <vector>

#include "ray/bvh.h"
#include "ray/sphere_triangle.h"

namespace spanray {

struct SphereHit {
  uint32_t primitive = kNoPrimitive;
  SphereContact contact;    // point seen from the first center
  double distance = 0;      // of a sphere at rest: from its center to the point
};

// The first triangle, or sphere of the scene, that a sphere touches on its way from `start` to `end` (first_contact(): all
// its promises hold), ties to the lowest primitive; kNoPrimitive if none. Depends on these only, not on the tree, but
// for grazes of triangles that a tree of TreeQuality::kHigh holds in pieces: there by 2^-45 of the triangle's reach (SceneQuery has none).
// scene: what the tree was built of. start != end, radius > 0, all at most 1e30.
SphereHit sweep_sphere(const SceneData& scene, const Bvh& bvh, const glm::dvec3& start, const glm::dvec3& end, double radius);

// Every triangle and sphere at most `radius` away from `center`, nearest first, ties by primitive. contact.time is 0.
std::vector<SphereHit> touch_sphere(const SceneData& scene, const Bvh& bvh, const glm::dvec3& center, double radius);

}  // namespace spanray
