// Tables of the kernels of this half of shade/, by instruction set.
#pragma once
#include "shade/surface.h"
#include "simd/dispatch.h"

namespace spanray {

using ResolveFn = void (*)(const Frame&, const HitBatch&, SurfaceBatch&);
extern const ResolveFn kResolve[kIsaCount];

// Flat and Gouraud: whether light can be a matter of triangles, for primary rays.
bool triangles_carry_light(const Frame& frame);

// Bit i: ray i accepts `primitive`. rays == nullptr: ray i is that of pixel (x0 + i, y) at `place`; else all are ray x0 of *rays.
using AcceptFn = uint32_t (*)(const Frame&, const RayBatch* rays, uint32_t primitive, int x0, int y, uint32_t candidates, int place);
extern const AcceptFn kAccept[kIsaCount];

}  // namespace spanray
