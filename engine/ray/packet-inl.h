// Coherent rays down the tree together: lanes are rays, one box at a time. Leaves, and subtrees that few rays reach, take the
// rays one by one (ray/traverse-inl.h), so incoherent packets cost little more than single rays. Included once a target.
// Source:   Wald, Slusallek, Benthin, Wagner 2001, "Interactive Rendering with Coherent Ray Tracing"; Benthin, Wald, Woop, Ernst,
//           Mark 2012, "Combining Single and Packet-Ray Tracing for Arbitrary Ray Distributions on the Intel MIC Architecture".
// Contract: finds what single rays find, for every packet size: boxes cull by the same arithmetic, hit_triangle() decides.
#if defined(SPANRAY_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_PACKET_INL_H_
#undef SPANRAY_PACKET_INL_H_
#else
#define SPANRAY_PACKET_INL_H_
#endif

#include <bit>
#include <cstdint>
#include <limits>

#include "ray/traverse-inl.h"
#include "simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

inline constexpr int kPacketRays = kLanes;
inline constexpr int kFewRays = 2;  // that many left in a packet go on by themselves

struct PacketEntry {
  alignas(64) float near[kPacketRays];
  uint32_t child;
};

template <class Visitor>
struct Packet {
  LaneRay ray[kPacketRays];
  Visitor visitor[kPacketRays];
  alignas(64) float limit[kPacketRays];  // of the visitors
  F32 origin[3], inv_near[3], inv_far[3];
  const int* near_row;  // of all rays
  const int* far_row;
};

HWY_INLINE F32 packet_cull_min(F32 a, F32 b) { return {hn::Min(a.v, b.v)}; }  // see cull_min()
HWY_INLINE F32 packet_cull_max(F32 a, F32 b) { return {hn::Max(a.v, b.v)}; }
HWY_INLINE uint32_t packet_bits(Mask m) {
  uint8_t bytes[8] = {};
  hn::StoreMaskBits(DF(), m.m, bytes);
  return (bytes[0] | static_cast<uint32_t>(bytes[1]) << 8) & ((1u << kPacketRays) - 1);
}

// Arrays of the rays; false if they do not all point into one octant.
template <class Visitor>
HWY_INLINE bool gather_packet(Packet<Visitor>& p) {
  alignas(64) float rows[9][kPacketRays];
  for (int i = 0; i < kPacketRays; ++i) {
    const TraceRay& r = p.ray[i].exact;
    for (int k = 0; k < 3; ++k) {
      if (r.negative[k] != p.ray[0].exact.negative[k]) return false;
      rows[k][i] = r.origin[k], rows[3 + k][i] = r.inv_near[k], rows[6 + k][i] = r.inv_far[k];
    }
    p.limit[i] = p.visitor[i].limit;
  }
  for (int k = 0; k < 3; ++k) p.origin[k] = F32::load(rows[k]), p.inv_near[k] = F32::load(rows[3 + k]), p.inv_far[k] = F32::load(rows[6 + k]);
  p.near_row = p.ray[0].near_row, p.far_row = p.ray[0].far_row;
  return true;
}

// Pushes the children that any ray meets, so that the nearest of the first such ray is popped first.
template <class Visitor>
HWY_INLINE int push_children(const BvhNode& node, const Packet<Visitor>& p, PacketEntry* stack, int top) {
  float key[kBvhWidth];
  const F32 limit = F32::load(p.limit);
  const int bottom = top;
  for (int c = 0; c < kBvhWidth && node.bounds[0][c] <= node.bounds[3][c]; ++c) {
    F32 near = F32::zero(), far = limit;
    for (int k = 0; k < 3; ++k) {  // the arithmetic of slab()
      near = packet_cull_max((f32(node.bounds[p.near_row[k]][c]) - p.origin[k]) * p.inv_near[k], near);
      far = packet_cull_min((f32(node.bounds[p.far_row[k]][c]) - p.origin[k]) * p.inv_far[k], far);
    }
    const Mask meets = near <= far;
    const uint32_t bits = packet_bits(meets);
    if (bits == 0) continue;
    alignas(64) float entry[kPacketRays];
    select(meets, near, f32(std::numeric_limits<float>::infinity())).store(entry);
    const float first = entry[std::countr_zero(bits)];
    int at = top++;
    for (; at > bottom && key[at - 1 - bottom] < first; --at) stack[at] = stack[at - 1], key[at - bottom] = key[at - 1 - bottom];
    F32::load(entry).store(stack[at].near);
    stack[at].child = node.child[c];
    key[at - bottom] = first;
  }
  return top;
}

// All rays of a packet down the tree together; the few that a subtree concerns go down it alone.
template <class Visitor>
HWY_INLINE void traverse_packet(const Bvh::Data& data, Packet<Visitor>& p) {
  PacketEntry stack[kBvhStackSize];
  for (float& n : stack[0].near) n = 0;
  stack[0].child = 0;
  int top = 1;
  while (top > 0) {
    const PacketEntry& entry = stack[--top];
    const uint32_t child = entry.child;
    uint32_t active = packet_bits(F32::load(entry.near) <= F32::load(p.limit));
    if (active == 0) continue;
    const bool leaf = (child & kLeafBit) != 0;
    if (!leaf && std::popcount(active) > kFewRays) {
      top = push_children(data.nodes[child], p, stack, top);
      continue;
    }
    for (; active != 0; active &= active - 1) {
      const int i = std::countr_zero(active);
      if (leaf) visit_leaf(data, child, p.ray[i], p.visitor[i]);
      else traverse(data, {entry.near[i], child}, p.ray[i], p.visitor[i]);
      p.limit[i] = p.visitor[i].limit;
    }
  }
}

// Visitor{batch, i, ray} for each ray i of the batch that is one, then finish(i, visitor).
template <class Visitor, class Batch, class Finish>
HWY_INLINE void trace_batch(const Bvh::Data& data, const Batch& batch, const Finish& finish) {
  const RayBatch& rays = batch.rays;
  Packet<Visitor> p;
  for (int first = 0; first < rays.count; first += kPacketRays) {
    const int n = rays.count - first < kPacketRays ? rays.count - first : kPacketRays;
    bool valid[kPacketRays];
    int alive = 0;
    for (int i = 0; i < n; ++i) {
      valid[i] = !data.nodes.empty() && prepare_lane_ray(data, rays, first + i, p.ray[i]);
      if (valid[i]) p.visitor[i].begin(batch, first + i, p.ray[i].exact);
      alive += valid[i];
    }
    if (kPacketRays > kFewRays && alive == kPacketRays && gather_packet(p)) {
      traverse_packet(data, p);
    } else {
      for (int i = 0; i < n; ++i)
        if (valid[i]) traverse(data, {0.0f, 0}, p.ray[i], p.visitor[i]);
    }
    for (int i = 0; i < n; ++i)
      if (valid[i]) finish(first + i, p.visitor[i]);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_PACKET_INL_H_
