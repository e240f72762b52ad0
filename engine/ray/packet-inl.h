// Coherent rays down the tree together: lanes are rays. At each node the beam of all rays sorts out children, then one box at a time;
// at each leaf one triangle at a time. Where few rays are left they go on alone (ray/traverse-inl.h). Included once a target.
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

#include "ray/beam-inl.h"
#include "ray/packet_leaf-inl.h"
#include "ray/visitors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

inline constexpr int kFewRays = 2;  // that many left in a packet go on by themselves

// The rays that meet child c, and where they enter it. The arithmetic of slab().
struct LaneBox { Mask meets; F32 near; };
template <bool kMixed> HWY_INLINE LaneBox box_lanes(const RayPacket& p, const BvhNode& node, int c) {
  F32 near = F32::zero(), far = p.limit;
  for (int k = 0; k < 3; ++k) {
    const int near_row = kMixed ? k : p.near_row[k], far_row = kMixed ? k + 3 : p.far_row[k];
    F32 to_near = f32(node.bounds[near_row][c]), to_far = f32(node.bounds[far_row][c]);
    if constexpr (kMixed) {
      const F32 low = to_near, high = to_far;
      to_near = select(p.negative[k], high, low), to_far = select(p.negative[k], low, high);
    }
    near = cull_max((to_near - p.origin[k]) * p.inv_near[k], near);
    far = cull_min((to_far - p.origin[k]) * p.inv_far[k], far);
  }
  return {near <= far, near};
}

// A packet of a batch on its way through the tree.
struct PacketTask {
  const Bvh::Data& data;
  const Batch& batch;
  RayPacket p;
  int first = 0;  // ray of lane 0

  PacketTask(const Bvh::Data& tree, const Batch& rays) : data(tree), batch(rays) {}

  // Rays from `at` on.
  HWY_INLINE void start(int at) {
    first = at;
    prepare_packet(data, batch.rays, at, batch.rays.count - at < kLanes ? batch.rays.count - at : kLanes, p);
    lanes_stored_ = false;
  }

  // The rays one by one. Most packets never ask.
  HWY_INLINE const PacketLanes& lanes() {
    if (!lanes_stored_) store_lanes(p, lanes_);
    lanes_stored_ = true;
    return lanes_;
  }

  // The rays that leave a triangle.
  HWY_INLINE uint32_t leaving(uint32_t primitive) const { return to_bits(p.from == i32(primitive)); }

  // Of some triangles of a block those that some ray may hit, by their boxes and by where the rays come from.
  HWY_INLINE uint32_t triangles_ahead(const TriangleBlock& block, uint32_t triangles, const Beam& beam) const {
    return triangles & beam_triangles(block, beam) & ~words_equal(block.primitive, p.all_from);
  }

  // hit_triangle() of some rays with triangle j of a block.
  HWY_INLINE ExactLanes exact(const TriangleBlock& block, int j, uint32_t rays) {
    ExactLanes lanes = exact_lanes(p, block, j);
    lanes.hit &= rays;
    if ((lanes.hit & lanes.edge_on) != 0) exact_edge_on(block, j, lanes);
    return lanes;
  }

  // Of some rays, those whose hit the surface takes.
  HWY_INLINE uint32_t ask(uint32_t rays, uint32_t primitive) const { return batch.accepts_of(first, rays, primitive); }

 private:
  HWY_NOINLINE void exact_edge_on(const TriangleBlock& block, int j, ExactLanes& out) {
    alignas(64) double t[kLanes];
    out.t.store(t);
    for (uint32_t rest = out.hit & out.edge_on; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      LaneRay ray;
      take_lane(lanes(), i, ray);
      if (!hit_triangle(ray.exact, triangle_of(block, j), t[i])) out.hit &= ~(1u << i);
    }
    out.t = F64::load(t);
  }

  PacketLanes lanes_{};
  bool lanes_stored_ = false;
};

// All rays of a packet down the tree; Packet is one of the two below. from: what its descend() takes besides.
template <class Packet, class... From> HWY_INLINE void go_together(Packet& packet, const Beam& beam, From... from) {
  if (packet.p.mixed_axes == 0) packet.template descend<false>(beam, from...);
  else packet.template descend<true>(beam, from...);
}

// ---- any hit ---------------------------------------------------------------------------------------------------------

struct AnyEntry { uint32_t child, rays; };

// Pushes the children that some rays meet, in no order. Returns the new top.
template <bool kMixed>
HWY_INLINE int push_any(const RayPacket& p, const BvhNode& node, uint32_t rays, const Beam& beam, AnyEntry* stack, int top) {
  for (uint32_t rest = beam_children(node, beam); rest != 0; rest &= rest - 1) {
    const int c = std::countr_zero(rest);
    const uint32_t meet = to_bits(box_lanes<kMixed>(p, node, c).meets) & rays;
    if (meet != 0) stack[top++] = {node.child[c], meet};
  }
  return top;
}

struct AnyPacket : PacketTask {
  uint32_t alive = 0;  // rays without a hit
  // The triangle that last stopped some ray, of this packet or one before: where one packet is dark, the next often is by the same.
  const TriangleBlock* stopper = nullptr;  // the block that it stands in; none yet
  int stopper_lane = 0;

  using PacketTask::PacketTask;
  HWY_INLINE void start(int at) {
    PacketTask::start(at);
    alive = p.valid;
  }

  HWY_INLINE void alone(AnyEntry entry) {
    for (uint32_t rest = entry.rays; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      LaneRay ray;
      take_lane(lanes(), i, ray);
      AnyVisitor visitor{batch, ray.exact, first + i, lanes().limit[i]};
      traverse(data, entry.child, 0.0f, ray, visitor);
      if (visitor.found) alive &= ~(1u << i);
    }
  }

  HWY_INLINE void leaf(AnyEntry entry, const Beam& beam) {
    const TriangleBlock& block = data.blocks[leaf_block(entry.child)];
    test(block, triangles_ahead(block, leaf_lanes(entry.child), beam), entry.rays);
  }

  // Some triangles of a block against some rays.
  HWY_INLINE void test(const TriangleBlock& block, uint32_t triangles, uint32_t rays) {
    for (uint32_t rest = triangles; rest != 0 && (rays & alive) != 0; rest &= rest - 1) {
      const int j = std::countr_zero(rest);
      const LaneHits hits = triangle_lanes<SureHits::kOfAny>(p, block, j);
      uint32_t maybe = hits.maybe & rays & alive;
      if (maybe == 0) continue;
      const uint32_t primitive = block.primitive[j];
      maybe &= ~leaving(primitive);
      uint32_t found = hits.sure & maybe;
      if (const uint32_t unsure = maybe & ~found; unsure != 0) {
        const ExactLanes exact = this->exact(block, j, unsure);
        if (exact.hit != 0) found |= exact.hit & ~bits_less(p.t_max, exact.t);
      }
      if (found != 0) stop(ask(found, primitive), block, j);
    }
  }

  HWY_INLINE void stop(uint32_t rays, const TriangleBlock& block, int triangle) {
    if (rays == 0) return;
    alive &= ~rays;
    stopper = &block, stopper_lane = triangle;
  }

  HWY_INLINE void test_stopper() {
    if (stopper != nullptr) test(*stopper, 1u << stopper_lane, alive);
  }

  // From the children of some nodes.
  template <bool kMixed> HWY_INLINE void descend(const Beam& beam, const BvhNode* nodes, int n) {
    AnyEntry stack[kBvhStackSize + kBvhWidth];
    int top = 0;
    for (int i = 0; i < n; ++i) top = push_any<kMixed>(p, nodes[i], alive, beam, stack, top);
    while (top > 0) {
      AnyEntry entry = stack[--top];
      entry.rays &= alive;
      if (entry.rays == 0) continue;
      if (std::popcount(entry.rays) <= kFewRays) alone(entry);
      else if ((entry.child & kLeafBit) != 0) leaf(entry, beam);
      else top = push_any<kMixed>(p, data.nodes[entry.child], entry.rays, beam, stack, top);
    }
  }
};

// ---- closest hit -----------------------------------------------------------------------------------------------------

struct PacketEntry {
  alignas(64) float near[kLanes];
  uint32_t child;
};

// Pushes the children that rays meet, so that the nearest of the first such ray is popped first. Returns the new top.
template <bool kMixed> HWY_INLINE int push_nearest(const RayPacket& p, const BvhNode& node, const Beam& beam, PacketEntry* stack, int top) {
  float key[kBvhWidth];
  const int bottom = top;
  for (uint32_t rest = beam_children(node, beam); rest != 0; rest &= rest - 1) {
    const int c = std::countr_zero(rest);
    const LaneBox box = box_lanes<kMixed>(p, node, c);
    const uint32_t bits = to_bits(box.meets) & p.valid;
    if (bits == 0) continue;
    const F32 entry = select(box.meets, box.near, f32(std::numeric_limits<float>::infinity()));
    alignas(64) float lanes_near[kLanes];
    entry.store(lanes_near);
    const float nearest = lanes_near[std::countr_zero(bits)];
    int at = top++;
    for (; at > bottom && key[at - 1 - bottom] < nearest; --at) stack[at] = stack[at - 1], key[at - bottom] = key[at - 1 - bottom];
    entry.store(stack[at].near);
    stack[at].child = node.child[c];
    key[at - bottom] = nearest;
  }
  return top;
}

// Of each ray the closest hit so far: most are known only by bounds on their t, which is enough to order nearly all of them.
struct ClosestPacket : PacketTask {
  alignas(64) double best_t[kLanes];   // t_max until something is hit; no less than t where it is not known
  alignas(64) uint32_t best[kLanes];
  alignas(64) uint32_t place[kLanes];  // of `best` among the triangles of all blocks
  F32 low;                             // no more than t; p.limit is no less
  uint32_t known = 0;                  // rays whose best_t is t

  using PacketTask::PacketTask;
  HWY_INLINE void start(int at) {
    PacketTask::start(at);
    i32(kNoPrimitive).store(best), i32(0).store(place);
    if (p.valid == 0) return;
    p.t_max.store(best_t);
    low = round_down_lanes(p.t_max);
    known = (1u << kLanes) - 1;
  }

  // near: where the rays enter `child`, nullptr for 0.
  HWY_INLINE void alone(uint32_t child, const float* near, uint32_t rays) {
    alignas(64) float lows[kLanes], limits[kLanes];
    low.store(lows), p.limit.store(limits);
    for (uint32_t rest = rays; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      LaneRay ray;
      take_lane(lanes(), i, ray);
      ClosestVisitor visitor{batch, data, ray.exact, first + i, best_t[i], best[i], place[i], lows[i], limits[i], (known >> i & 1u) != 0};
      traverse(data, child, near != nullptr ? near[i] : 0.0f, ray, visitor);
      best_t[i] = visitor.best_t, best[i] = visitor.best, place[i] = visitor.place, lows[i] = visitor.low, limits[i] = visitor.limit;
      known = (known & ~(1u << i)) | static_cast<uint32_t>(visitor.known) << i;
    }
    low = F32::load(lows), p.limit = F32::load(limits);
  }

  // The closest hits of some lanes: triangle `at` of all blocks, at [from, to].
  HWY_INLINE void set(uint32_t rays, uint32_t primitive, uint32_t at, F64 t, F32 from, F32 to) {
    const Mask m = mask_from_bits(rays);
    select(m, t, F64::load(best_t)).store(best_t);
    select(m, i32(primitive), I32::load(best)).store(best);
    select(m, i32(at), I32::load(place)).store(place);
    low = select(m, from, low), p.limit = select(m, to, p.limit);
  }

  // Takes the hits of some lanes with one triangle.
  HWY_INLINE void take(uint32_t hit, F64 t, uint32_t primitive, uint32_t at) {
    hit &= ~bits_less(to_f64(p.limit), t);
    for (uint32_t rest = hit & ~known & ~bits_less(t, to_f64(low)); rest != 0; rest &= rest - 1) know(std::countr_zero(rest));
    const F64 before = F64::load(best_t);
    const uint32_t nearer = bits_less(t, before), same = ~(nearer | bits_less(before, t));
    uint32_t counts = hit & (nearer | (same & ~to_bits(less_unsigned(I32::load(best), i32(primitive)))));
    if (counts != 0) counts = ask(counts, primitive);
    if (counts == 0) return;
    set(counts, primitive, at, t, round_down_lanes(t), round_up_lanes(t));
    known |= counts;
  }

  // Finds out the t of a hit that bounds were enough for until now.
  HWY_NOINLINE void know(int i) {
    LaneRay ray;
    take_lane(lanes(), i, ray);
    hit_triangle(ray.exact, triangle_at(data, place[i]), best_t[i]);
    known |= 1u << i;
  }

  HWY_INLINE void leaf(uint32_t child, uint32_t rays, const Beam& beam) {
    const TriangleBlock& block = data.blocks[leaf_block(child)];
    for (uint32_t rest = triangles_ahead(block, leaf_lanes(child), beam); rest != 0; rest &= rest - 1) {
      const int j = std::countr_zero(rest);
      BoundsOnT<F32> t;
      const LaneHits hits = triangle_lanes<SureHits::kOfClosest>(p, block, j, &t);
      uint32_t maybe = hits.maybe & rays;
      if (maybe == 0) continue;
      const uint32_t primitive = block.primitive[j], at = leaf_block(child) * kBvhWidth + static_cast<uint32_t>(j);
      maybe &= ~leaving(primitive);
      const uint32_t nearer = hits.sure & maybe & to_bits(t.high < low);
      maybe &= ~(nearer | (hits.sure & to_bits(t.low > p.limit)));
      if (nearer != 0)
        if (const uint32_t counts = ask(nearer, primitive); counts != 0) {
          set(counts, primitive, at, to_f64(t.high), t.low, t.high);
          known &= ~counts;
        }
      if (maybe == 0) continue;
      const ExactLanes exact = this->exact(block, j, maybe);
      if (exact.hit != 0) take(exact.hit, exact.t, primitive, at);
    }
  }

  template <bool kMixed> HWY_INLINE void descend(const Beam& beam) {
    PacketEntry stack[kBvhStackSize];
    F32::zero().store(stack[0].near);
    stack[0].child = 0;
    int top = 1;
    while (top > 0) {
      const PacketEntry& entry = stack[--top];
      const uint32_t child = entry.child, active = to_bits(F32::load(entry.near) <= p.limit) & p.valid;
      if (active == 0) continue;
      if (std::popcount(active) <= kFewRays) alone(child, entry.near, active);
      else if ((child & kLeafBit) != 0) leaf(child, active, beam);
      else top = push_nearest<kMixed>(p, data.nodes[child], beam, stack, top);
    }
  }
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_PACKET_INL_H_
