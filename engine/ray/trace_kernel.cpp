// Batches of rays against the tree: coherent neighbours as packets (ray/packet-inl.h), others one by one (ray/traverse-inl.h).
// Input:    any rays; those that prepare_ray() refuses miss.
// Contract: what is found is what hit_triangle() over all triangles finds, with ties in t to the lowest primitive, whatever the tree,
//           the order of the batch and the instruction set.
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "frame/frame.h"
#include "ray/bvh_data.h"
#include "ray/trace_kernel.h"
#include "ray/triangle_test.h"
#include "simd/dispatch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ray/trace_kernel.cpp"
#include "hwy/foreach_target.h"
#include "ray/packet-inl.h"
#include "ray/traverse-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// Does the surface itself take the hit? Asked only for hits that count.
HWY_INLINE bool accepts(const Frame& frame, const RayBatch& rays, int ray, const float* origin, uint32_t primitive, bool cull_back) {
  if (cull_back && !(facing(*frame.scene, frame.scene->triangles[primitive], {origin[0], origin[1], origin[2]}) > 0)) return false;
  if (frame.accept_ray == nullptr || !(flags_of(frame, primitive) & kMaterialMasked)) return true;
  return frame.accept_ray(frame, rays, ray, primitive);
}

struct Batch {
  const Frame& frame;
  const RayBatch& rays;
  bool cull_back;
};

struct ClosestVisitor {
  const Batch* batch;
  const float* origin;
  int index;
  float limit;  // >= best_t
  double best_t;
  uint32_t best;
  HWY_INLINE void begin(const Batch& b, int i, const TraceRay& ray) {
    batch = &b, origin = ray.origin, index = i, limit = round_up(ray.t_max), best_t = ray.t_max, best = kNoPrimitive;
  }
  HWY_INLINE bool hit(double t, uint32_t primitive) {
    if (t > best_t || (t == best_t && primitive > best)) return false;
    if (!accepts(batch->frame, batch->rays, index, origin, primitive, batch->cull_back)) return false;
    best_t = t, best = primitive, limit = round_up(t);
    return false;
  }
};

struct AnyVisitor {
  const Batch* batch;
  const float* origin;
  int index;
  float limit;
  double t_max;
  bool found;
  HWY_INLINE void begin(const Batch& b, int i, const TraceRay& ray) {
    batch = &b, origin = ray.origin, index = i, limit = round_up(ray.t_max), t_max = ray.t_max, found = false;
  }
  HWY_INLINE bool hit(double t, uint32_t primitive) {
    if (!(t <= t_max) || !accepts(batch->frame, batch->rays, index, origin, primitive, false)) return false;
    limit = -1;  // no box and no triangle is near enough any more
    return found = true;
  }
};

struct AllVisitor {
  const Batch& batch;
  const TraceRay& ray;
  int index;
  float limit;
  FragmentList& out;
  HWY_INLINE bool hit(double t, uint32_t primitive) {
    if (t <= ray.t_max && accepts(batch.frame, batch.rays, index, ray.origin, primitive, batch.cull_back)) {
      out.pixel.push_back(batch.rays.pixel[index]);
      out.ray.push_back(static_cast<uint32_t>(index));
      out.primitive.push_back(primitive);
    }
    return false;
  }
};

struct StoreClosest {
  uint32_t* out;
  HWY_INLINE void operator()(int i, const ClosestVisitor& v) const { out[i] = v.best; }
};
struct StoreAny {
  uint32_t* out;
  HWY_INLINE void operator()(int i, const AnyVisitor& v) const { out[i / 32] |= static_cast<uint32_t>(v.found) << (i % 32); }
};

void closest_kernel(const Frame& frame, const Bvh::Data& data, const RayBatch& rays, uint32_t* out) {
  for (int i = 0; i < rays.count; ++i) out[i] = kNoPrimitive;
  trace_batch<ClosestVisitor>(data, Batch{frame, rays, frame.settings.culling == Culling::kBack}, StoreClosest{out});
}

void any_kernel(const Frame& frame, const Bvh::Data& data, const RayBatch& rays, uint32_t* out) {
  for (int i = 0; i < (rays.count + 31) / 32; ++i) out[i] = 0;
  trace_batch<AnyVisitor>(data, Batch{frame, rays, false}, StoreAny{out});
}

// Hits of one ray stay together, in no order: no packets, which would mix them.
void all_kernel(const Frame& frame, const Bvh::Data& data, const RayBatch& rays, FragmentList& out) {
  const Batch batch{frame, rays, frame.settings.culling == Culling::kBack};
  for (int i = 0; i < rays.count && !data.nodes.empty(); ++i) {
    LaneRay ray;
    if (!prepare_lane_ray(data, rays, i, ray)) continue;
    AllVisitor visitor{batch, ray.exact, i, round_up(ray.exact.t_max), out};
    traverse(data, {0.0f, 0}, ray, visitor);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {
const TraceClosestFn kTraceClosest[kIsaCount] = SPANRAY_KERNEL_TABLE(closest_kernel);
const TraceAnyFn kTraceAny[kIsaCount] = SPANRAY_KERNEL_TABLE(any_kernel);
const TraceAllFn kTraceAll[kIsaCount] = SPANRAY_KERNEL_TABLE(all_kernel);
}  // namespace spanray
#endif
