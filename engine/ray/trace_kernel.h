// The traversal kernels by instruction set; called by ray/trace.cpp only.
#pragma once
#include "ray/bvh_data.h"

namespace spanray {

using TraceClosestFn = void (*)(const Frame&, const Bvh::Data&, const RayBatch&, uint32_t*);
using TraceAnyFn = void (*)(const Frame&, const Bvh::Data&, const RayBatch&, uint32_t*);
using TraceAllFn = void (*)(const Frame&, const Bvh::Data&, const RayBatch&, HitsOnEdges, FragmentList&);
extern const TraceClosestFn kTraceClosest[kIsaCount];
extern const TraceAnyFn kTraceAny[kIsaCount];
extern const TraceAllFn kTraceAll[kIsaCount];

}  // namespace spanray
