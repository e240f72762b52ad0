#include "ray/bvh.h"
#include "ray/light_grid.h"
#include "ray/light_grid_kernel.h"
#include "ray/trace_kernel.h"

namespace spanray {

void trace_closest(const Frame& frame, const Bvh& bvh, const RayBatch& rays, uint32_t* out) {
  kTraceClosest[isa_index(frame.isa)](frame, bvh.data(), rays, out);
  if (!bvh.data().exact.empty() && !rays.primary) closest_exact(frame, bvh.data().exact, rays, 0, out);
}

void trace_any(const Frame& frame, const Bvh& bvh, const RayBatch& rays, uint32_t* out) {
  kTraceAny[isa_index(frame.isa)](frame, bvh.data(), rays, out);
  if (!bvh.data().exact.empty()) any_exact(frame, bvh.data().exact, rays, out);
}

void trace_to_light(const Frame& frame, const Bvh& bvh, const LightGrid& grid, const RayBatch& rays, uint32_t* out) {
  kTraceToLight[isa_index(frame.isa)](frame, bvh.data(), grid, rays, out);
  if (!bvh.data().exact.empty()) any_exact(frame, bvh.data().exact, rays, out);
}

void trace_all(const Frame& frame, const Bvh& bvh, const RayBatch& rays, HitsOnEdges edges, FragmentList& out) {
  kTraceAll[isa_index(frame.isa)](frame, bvh.data(), rays, edges, out);
}

}  // namespace spanray
