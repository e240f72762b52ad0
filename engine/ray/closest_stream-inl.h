// Closest hits of incoherent rays, as streams of rays that point into one octant: all enter and leave boxes by the same sides, and what is near
// to one is mostly near to the others. Included once a target.
// Source:   as ray/stream-inl.h; rays by octant: Boulos et al. 2007, "Packet-based Whitted and Distribution Ray Tracing".
// Contract: finds what single rays find, for every set of rays: boxes cull by the same arithmetic, hit_triangle() decides.
#if defined(SPANRAY_CLOSEST_STREAM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_CLOSEST_STREAM_INL_H_
#undef SPANRAY_CLOSEST_STREAM_INL_H_
#else
#define SPANRAY_CLOSEST_STREAM_INL_H_
#endif

#include <bit>
#include <cstdint>
#include <limits>

#include "ray/stream-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// Rays of one octant. Usage: add() until it is full, then trace().
class ClosestStream {
 public:
  HWY_INLINE bool full() const { return rays_.full(); }

  // Lane i of a packet.
  HWY_INLINE void add(PacketTask& packet, int i) {
    const int r = rays_.add(packet, i);
    const double t_max = rays_.ray[r].exact.t_max;
    best_[r] = {t_max, kNoPrimitive, 0, round_down(t_max), true};
  }

  // out: by ray of the batch. The stream is empty then.
  HWY_INLINE void trace(const Bvh::Data& data, const Batch& batch, uint32_t* out) {
    if (rays_.count == 0) return;
    Entry stack[kBvhStackSize];
    stack[0] = {rays_.all(), 0, 0.0f};
    for (int top = 1; top > 0;) {
      Entry entry = stack[--top];
      entry.rays &= reaching(entry.near);
      if (entry.rays == 0) continue;
      if (top > 0) fetch_child(data, stack[top - 1].child);
      if (kLanes8 == 1 || std::popcount(entry.rays) <= kFewRays) alone(data, batch, entry);
      else if ((entry.child & kLeafBit) != 0) leaf(data, batch, entry);
      else top = push(data.nodes[entry.child], entry.rays, stack, top);
    }
    for (int r = 0; r < rays_.count; ++r) out[rays_.index[r]] = best_[r].primitive;
    rays_.count = 0;
  }

 private:
  struct Entry {
    uint64_t rays;
    uint32_t child;
    float near;  // no ray enters the child before
  };
  struct Best {  // of ClosestVisitor, but for its limit: that stands with the ray
    double t;
    uint32_t primitive, place;
    float low;
    bool known;
  };

  // The rays that may hit something at `near` or beyond.
  HWY_INLINE uint64_t reaching(float near) const {
    uint64_t set = 0;
    for (int i = 0; i < kStreamRays; i += kLanes) set |= static_cast<uint64_t>(to_bits(f32(near) <= F32::load(rays_.limit + i))) << i;
    return set;
  }

  // Lets f have ray r as a visitor.
  template <class F> HWY_INLINE void with_visitor(const Bvh::Data& data, const Batch& batch, int r, const F& f) {
    Best& b = best_[r];
    ClosestVisitor v{batch, data, rays_.ray[r].exact, rays_.index[r], b.t, b.primitive, b.place, b.low, rays_.limit[r], b.known};
    f(v);
    b = {v.best_t, v.best, v.place, v.low, v.known};
    rays_.limit[r] = v.limit;
  }

  HWY_INLINE void alone(const Bvh::Data& data, const Batch& batch, const Entry& entry) {
    for_each_ray(entry.rays, [&](int r) HWY_ATTR {
      with_visitor(data, batch, r, [&](ClosestVisitor& v) HWY_ATTR { traverse(data, entry.child, entry.near, rays_.ray[r], v); });
    });
  }

  HWY_INLINE void leaf(const Bvh::Data& data, const Batch& batch, const Entry& entry) {
    visit_leaf_together<ClosestVisitor>(data, entry.child, entry.rays, rays_.ray, rays_.limit, [&](int r, const AtLeaf& at) HWY_ATTR {
      with_visitor(data, batch, r, [&](ClosestVisitor& v) HWY_ATTR { at.visit(rays_.ray[r], v); });
    });
  }

  // The children that rays meet: that which one of them enters first is popped first. The sides of their boxes stay in registers.
  HWY_INLINE int push(const BvhNode& node, uint64_t rays, Entry* stack, int top) const {
    alignas(64) uint8_t meets[kStreamRays] = {};  // of each ray, bits of children
    float first[kBvhWidth];
    for (int s = 0; s < kBvhWidth; s += kLanes8) {
      const LaneRay& any = rays_.ray[0];
      F8 near_side[3], far_side[3], least = f8(std::numeric_limits<float>::infinity());
      for (int k = 0; k < 3; ++k)
        near_side[k] = F8::load(node.bounds[any.near_row[k]] + s), far_side[k] = F8::load(node.bounds[any.far_row[k]] + s);
      for_each_ray(rays, [&](int r) HWY_ATTR {
        const ChildLanes box = box_between(near_side, far_side, rays_.ray[r], rays_.limit[r]);
        meets[r] = static_cast<uint8_t>(meets[r] | to_bits(box.meets) << s);
        least = select(box.meets, cull_min(least, box.near), least);
      });
      least.store(first + s);
    }
    const int bottom = top;
    for (int c = 0; c < kBvhWidth; ++c) {
      const uint64_t set = set_of_bit(meets, c);
      if (set == 0) continue;
      int at = top++;
      for (; at > bottom && stack[at - 1].near < first[c]; --at) stack[at] = stack[at - 1];
      stack[at] = {set, node.child[c], first[c]};
    }
    return top;
  }

  StreamRays rays_;
  Best best_[kStreamRays];
};

// The rays of a batch that no packet takes, by octant. Usage: add() packets, then finish().
class ClosestStreams {
 public:
  ClosestStreams(const Bvh::Data& tree, const Batch& rays, uint32_t* out) : data_(tree), batch_(rays), out_(out) {}

  HWY_INLINE void add(PacketTask& packet) {
    const uint32_t(&negative)[3] = packet.lanes().negative;
    for_each_ray(packet.p.valid, [&](int i) HWY_ATTR {
      ClosestStream& stream = octant_[(negative[0] >> i & 1u) | (negative[1] >> i & 1u) << 1 | (negative[2] >> i & 1u) << 2];
      stream.add(packet, i);
      if (stream.full()) stream.trace(data_, batch_, out_);
    });
  }
  HWY_INLINE void finish() {
    for (ClosestStream& stream : octant_) stream.trace(data_, batch_, out_);
  }

 private:
  const Bvh::Data& data_;
  const Batch& batch_;
  uint32_t* out_;
  ClosestStream octant_[8];
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_CLOSEST_STREAM_INL_H_
