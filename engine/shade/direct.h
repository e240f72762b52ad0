// Hits of primary rays -> radiance in one go, where nothing stands between light and eye: surfaces stay in registers, none is stored.
#pragma once
#include "shade/surface.h"

namespace spanray {

// Whether shade_direct() gives what resolve_surfaces(), shade_ambient() and shade_light() give, and nobody asks for more: no shadow or
// bounce rays start at the surfaces.
bool can_shade_direct(const Frame& frame);

struct DirectCounts {
  LaneCounts plane_lanes, surface_lanes;  // used: planes; hits of triangles
};

// radiance[c][i] of each entry of hits (primary rays), the background's where it hit nothing; the same bits as the way through surfaces.
// t: likewise with plan.depths, infinity for misses; else not written. Writes whole vectors: up to 15 floats past count. planes: scratch.
DirectCounts shade_direct(const Frame& frame, const HitBatch& hits, AlignedBuffer<float>& planes, float* const radiance[3], float* t);

using ShadeDirectFn = DirectCounts (*)(const Frame& frame, const HitBatch& hits, AlignedBuffer<float>& planes, float* const radiance[3],
                                       float* t);
extern const ShadeDirectFn kShadeDirect[kIsaCount];

}  // namespace spanray
