#pragma once
#include "frame/frame.h"
#include "simd/isa.h"

namespace spanray {

// Appends what is drawn of primitives [begin, end), and adds to counts. fate: ClusterFate of each cluster of the scene, or
// nullptr: all are kept. begin is the first primitive of a cluster.
using ClipRangeFn = void (*)(const Frame& frame, const ScreenVertices& vertices, uint32_t begin, uint32_t end,
                             const uint8_t* fate, BinChunk& chunk, FrameCounts& counts);
extern const ClipRangeFn kClipRange[kIsaCount];

// The same for a single primitive, which may need clipping (clip.cpp).
void clip_triangle(const Frame& frame, const ScreenVertices& vertices, uint32_t primitive, BinChunk& chunk, FrameCounts& counts);

}  // namespace spanray
