// A sphere against exact primitives, moved along a segment or at rest: what ray/sweep.h asks after the triangles.
#pragma once
#include <vector>

#include "ray/exact_set.h"
#include "ray/sweep.h"

namespace spanray {

// Improves `best`, the first contact so far. Like triangles, spheres are surfaces without an inside: they stop what comes from
// within, too; planes stop it from both sides. Asks each of them: some ten nanoseconds a sphere.
void sweep_exact(const ExactSet& set, const glm::dvec3& start, const glm::dvec3& motion, double radius,
                   SphereHit& best);

// Appends the exact primitives whose surface is at most `radius` away from `center`, in no order.
void touch_exact(const ExactSet& set, const glm::dvec3& center, double radius, std::vector<SphereHit>& hits);

}  // namespace spanray
