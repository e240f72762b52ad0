// Rays against exact primitives by instruction set; called by ray/exact_set.cpp only.
#pragma once
#include "ray/exact_set.h"

namespace spanray {

using ClosestExactFn = void (*)(const Frame&, const ExactSet&, const RayBatch&, double t_min, uint32_t*);
using AnyExactFn = void (*)(const ExactSet&, const RayBatch&, uint32_t*);
extern const ClosestExactFn kClosestExact[kIsaCount];
extern const AnyExactFn kAnyExact[kIsaCount];

// t of a triangle that the ray is known to meet, in units of its direction.
double triangle_t(const SceneData& scene, const RayBatch& rays, int i, uint32_t primitive);

}  // namespace spanray
