// Batches of rays against the tree: coherent neighbours as packets (ray/packet-inl.h), others as streams (ray/stream-inl.h,
// ray/closest_stream-inl.h), and one by one where few are left or all hits are asked for (ray/traverse-inl.h).
// Input:    any rays; those that prepare_ray() refuses miss.
// Contract: what is found is what hit_triangle() over all triangles finds, with ties in t to the lowest primitive, whatever the tree,
//           the order of the batch and the instruction set.
#include <algorithm>
#include <bit>
#include <cstdint>

#include "frame/frame.h"
#include "frame/tiles.h"
#include "ray/bvh_data.h"
#include "ray/trace_kernel.h"
#include "ray/triangle_test.h"
#include "simd/dispatch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ray/trace_kernel.cpp"
#include "hwy/foreach_target.h"
#include "ray/packet-inl.h"
#include "ray/entrance-inl.h"
#include "ray/closest_stream-inl.h"
#include "ray/instance-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// A packet goes down the tree together if its rays point into one octant or two neighbouring ones.
constexpr int kMixedAxes = 1;

// A beam costs as much as so many triangles.
constexpr int kLeastForBeam = 3;

HWY_INLINE bool coherent(const RayPacket& p) {
  return kLanes > kFewRays && p.mixed_axes <= kMixedAxes && std::popcount(p.valid) > kFewRays;
}

// How many rays from `first` on, in whole packets but for the last of the batch, belong to one cell of the picture: they have
// much in common.
HWY_INLINE int same_cell(const RayBatch& rays, int first) {
  const auto cell = [&](int i) { return rays.pixel[static_cast<size_t>(i)] & kCellMask; };
  int n = kLanes;
  while (n < kShaftRays && first + n < rays.count && cell(first + n) == cell(first)) n += kLanes;
  return std::min(n, rays.count - first);
}

void closest_kernel(const Frame& frame, const Bvh::Data& data, const RayBatch& rays, uint32_t* out) {
  std::fill_n(out, rays.count, kNoPrimitive);
  if (data.nodes.empty()) return;
  const Batch batch{frame, rays, frame.settings.culling == Culling::kBack};
  ClosestPacket packet(data, batch);
  ClosestStreams streams(data, batch, out);
  for (int first = 0; first < rays.count; first += kLanes) {
    packet.start(first);
    if (packet.p.valid == 0) continue;
    if (coherent(packet.p)) {
      go_together(packet, make_beam(packet.p));
    } else if (data.instances) {  // which want to know how far each ray came
      packet.alone(0, nullptr, packet.p.valid);
    } else {
      streams.add(packet);
      continue;
    }
    if (data.instances) closest_of_instances(packet, *data.instances);
    for (int i = 0; i < kLanes && first + i < rays.count; ++i) out[first + i] = packet.best[i];
  }
  streams.finish();
}

// Whether any triangle stops the rays of a packet, from where their cell enters the tree; nullptr: from the root.
HWY_INLINE void trace_together(AnyPacket& packet, const Entrance* from) {
  packet.test_stopper();
  if (packet.alive == 0) return;
  const int triangles = from != nullptr ? from->triangles : 0, nodes = from != nullptr ? from->nodes() : 1;
  const uint32_t few = (1u << triangles) - 1;
  if (nodes == 0 && triangles < kLeastForBeam) return packet.test(from->few, few, packet.alive);
  const Beam beam = make_beam(packet.p);
  if (triangles != 0) packet.test(from->few, packet.triangles_ahead(from->few, few, beam), packet.alive);
  if (nodes != 0 && packet.alive != 0) go_together(packet, beam, from != nullptr ? from->node : packet.data.nodes.data(), nodes);
}

void any_kernel(const Frame& frame, const Bvh::Data& data, const RayBatch& rays, uint32_t* out) {
  std::fill_n(out, (rays.count + 31) / 32, 0u);
  if (data.nodes.empty()) return;
  const Batch batch{frame, rays, false};
  AnyPacket packet(data, batch);
  AnyStream stream(data, batch);
  Shaft shaft;
  Entrance entrance;
  for (int first = 0; first < rays.count;) {
    const int n = same_cell(rays, first);
    const bool narrow = kLanes > kFewRays && n > kLanes && make_shaft(data, rays, first, n, shaft);
    if (narrow) find_entrance(data, shaft, entrance);
    packet.stopper = nullptr;  // it may stand in the entrance before
    for (const int end = first + n; first < end; first += kLanes) {
      if (narrow && entrance.empty()) continue;
      packet.start(first);
      if (packet.p.valid == 0) continue;
      if (!coherent(packet.p)) {
        if (!stream.has_room()) stream.trace(out);
        stream.add(packet);
        continue;
      }
      trace_together(packet, narrow ? &entrance : nullptr);
      out[first / 32] |= (packet.p.valid & ~packet.alive) << (first % 32);
    }
  }
  stream.trace(out);
  if (data.instances) any_of_instances(packet, *data.instances, out);
}

// Of the hits from `first` on, all of one ray: those of a triangle that stands in several leaves, but one.
HWY_NOINLINE void drop_repeated(size_t first, FragmentList& out) {
  uint32_t* const begin = out.primitive.begin() + first;
  std::sort(begin, out.primitive.end());
  const size_t n = static_cast<size_t>(std::unique(begin, out.primitive.end()) - out.primitive.begin());
  out.primitive.resize(n), out.pixel.resize(n), out.ray.resize(n);  // all pixels are the same, and all rays
}

// Hits of one ray stay together, in no order: rays go alone.
void all_kernel(const Frame& frame, const Bvh::Data& data, const RayBatch& rays, HitsOnEdges edges, FragmentList& out) {
  if (data.nodes.empty()) return;
  const Batch batch{frame, rays, frame.settings.culling == Culling::kBack};
  PacketTask packet(data, batch);
  for (int first = 0; first < rays.count; first += kLanes) {
    packet.start(first);
    for (uint32_t rest = packet.p.valid; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      LaneRay ray;
      take_lane(packet.lanes(), i, ray);
      AllVisitor visitor{batch, ray.exact, first + i, packet.lanes().limit[i], edges == HitsOnEdges::kOfOne, out};
      const size_t before = out.primitive.size();
      traverse(data, 0, 0.0f, ray, visitor);
      if (data.instances) traverse_instances(*frame.scene, *data.instances, ray, visitor);
      if (data.references > data.primitives) drop_repeated(before, out);
    }
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
