// Tables of the kernels of this half of shade/, by instruction set.
#pragma once
#include "shade/surface.h"
#include "simd/dispatch.h"

namespace spanray {

using ResolveFn = void (*)(const Frame&, const HitBatch&, SurfaceBatch&);
extern const ResolveFn kResolve[kIsaCount];

// Flat and Gouraud: whether light can be a matter of triangles, for primary rays.
bool triangles_carry_light(const Frame& frame);

extern const AcceptRowFn kAcceptRow[kIsaCount];
extern const AcceptRaysFn kAcceptRays[kIsaCount];

}  // namespace spanray
