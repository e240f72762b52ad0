// trace_to_light() by instruction set; called by ray/trace.cpp only.
#pragma once
#include "ray/bvh_data.h"
#include "ray/light_grid.h"

namespace spanray {

using TraceToLightFn = void (*)(const Frame&, const Bvh::Data&, const LightGrid&, const RayBatch&, uint32_t*);
extern const TraceToLightFn kTraceToLight[kIsaCount];

}  // namespace spanray
