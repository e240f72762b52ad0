// Surfaces of exact primitives: one hit at a time, in plain doubles, beside the kernels of triangles.
#pragma once
#include "shade/surface.h"

namespace spanray {

// resolve_surfaces() (shade/surface.h) of a scene with exact primitives; out has its size.
// Contract: as resolve(): an entry is a function of its own ray, primitive and the frame alone. Their weights and lift are
//           0; their shading normal is their own, whatever Settings::shading says.
void resolve_with_exact(const Frame& frame, const HitBatch& hits, SurfaceBatch& out);

}  // namespace spanray
