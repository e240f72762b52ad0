#pragma once
#include <cstddef>

#include "frame/frame.h"
#include "simd/isa.h"

namespace spanray {

// Transforms scene vertices [begin, end); begin is a multiple of 16. May write up to 15 entries past end.
using TransformFn = void (*)(const Frame& frame, size_t begin, size_t end, ScreenVertices& out);
extern const TransformFn kTransformRange[kIsaCount];

}  // namespace spanray
