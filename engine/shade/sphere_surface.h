// Surfaces of spheres: one hit at a time, in plain doubles, beside the kernels of triangles.
#pragma once
#include "shade/surface.h"

namespace spanray {

// resolve_surfaces() (shade/surface.h) of a scene with spheres; out has its size.
// Contract: as resolve(): an entry is a function of its own ray, primitive and the frame alone. Weights and lift of spheres are
//           0; their shading normal is the sphere's own, whatever Settings::shading says.
void resolve_with_spheres(const Frame& frame, const HitBatch& hits, SurfaceBatch& out);

}  // namespace spanray
