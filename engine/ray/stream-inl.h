// Incoherent rays down the tree together: each node is fetched once for all the rays that meet its box, and they are put to its eight
// children, or the eight triangles of a leaf, one after the other; so no ray waits for memory or a branch of the one before it.
// Included once a target.
// Source:   Barringer and Akenine-Moeller 2014, "Dynamic Ray Stream Traversal" (the rays of a node as a set).
// Contract: finds what single rays find: the same boxes, the same triangles.
#if defined(SPANRAY_STREAM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_STREAM_INL_H_
#undef SPANRAY_STREAM_INL_H_
#else
#define SPANRAY_STREAM_INL_H_
#endif

#include <bit>
#include <cstdint>

#include "ray/packet-inl.h"
#include "simd/bit_sets-inl.h"
#include "simd/pairs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

inline constexpr int kStreamRays = 64;  // bits of a set

// Up to kStreamRays rays of a batch.
struct StreamRays {
  LaneRay ray[kStreamRays];
  alignas(64) float limit[kStreamRays] = {};
  int index[kStreamRays];  // in the batch
  int count = 0;

  HWY_INLINE bool full() const { return count == kStreamRays; }
  HWY_INLINE uint64_t all() const { return ~uint64_t{0} >> (kStreamRays - count); }  // count > 0
  // Lane i of a packet. Returns its place.
  HWY_INLINE int add(PacketTask& packet, int i) {
    const PacketLanes& lanes = packet.lanes();
    take_lane(lanes, i, ray[count]);
    limit[count] = lanes.limit[i], index[count] = packet.first + i;
    return count++;
  }
};

// Calls f(r) for each member.
template <class F> HWY_INLINE void for_each_ray(uint64_t set, const F& f) {
  for (uint64_t rest = set; rest != 0; rest &= rest - 1) f(std::countr_zero(rest));
}

// While another child is visited, this one comes into the cache.
HWY_INLINE void fetch_child(const Bvh::Data& data, uint32_t child) {
  const bool leaf = (child & kLeafBit) != 0;
  const void* const what = leaf ? static_cast<const void*>(&data.blocks[leaf_block(child)]) : &data.nodes[child];
  const char* const from = static_cast<const char*>(what);
  for (size_t i = 0; i < (leaf ? sizeof(TriangleBlock) : sizeof(BvhNode)); i += 64) __builtin_prefetch(from + i);
}

// What the lanes found for one ray at a leaf.
struct AtLeaf {
  const TriangleBlock& block;
  uint32_t place;  // of its first triangle
  Candidates found;
  const CandidateDistances& distances;
  template <class Visitor> HWY_INLINE bool visit(const LaneRay& ray, Visitor& visitor) const {
    return visit_candidates(block, place, found, distances, ray, visitor);
  }
};

// Some rays at a leaf: the lanes put all of them to it first, without a branch that depends on what they find; then visit(r, AtLeaf) for those
// that may hit something.
template <class Visitor, class Visit>
HWY_INLINE void visit_leaf_together(const Bvh::Data& data, uint32_t child, uint64_t set, const LaneRay* rays, const float* limits, const Visit& visit) {
  const TriangleBlock& block = data.blocks[leaf_block(child)];
  const uint32_t used = leaf_lanes(child);
  uint32_t found[kStreamRays];  // Candidates in one word: a pair that is written by halves and read whole would stall
  CandidateDistances distances[Visitor::kClosest ? kStreamRays : 1];
  int ray[kStreamRays], n = 0;
  for_each_ray(set, [&](int r) HWY_ATTR {
    ray[n] = r;
    const Candidates c = candidates<Visitor, false>(block, rays[r], limits[r], distances[Visitor::kClosest ? n : 0]);
    found[n] = (c.maybe | c.sure << kBvhWidth) & (used | used << kBvhWidth);
    n += (c.maybe & used) != 0;
  });
  const uint32_t place = leaf_block(child) * kBvhWidth;
  constexpr uint32_t kAll = (1u << kBvhWidth) - 1;
  for (int i = 0; i < n; ++i)
    visit(ray[i], AtLeaf{block, place, {found[i] & kAll, found[i] >> kBvhWidth}, distances[Visitor::kClosest ? i : 0]});
}

// What boxes are put to, ray by ray. Of a ray that runs along an axis, or nearly so, that axis never culls: its reciprocal is NaN.
struct BoxRays {
  alignas(64) float origin[3][kStreamRays], inverse[3][kStreamRays], limit[kStreamRays];
  HWY_INLINE void set(int at, const RayPacket& p) {
    for (int k = 0; k < 3; ++k) {
      p.origin[k].store(origin[k] + at);
      (p.inv_far[k] + (p.inv_far[k] - p.inv_far[k])).store(inverse[k] + at);  // infinite: NaN
    }
    p.limit.store(limit + at);
  }
};

// Where a line is between the two planes of each axis, whatever way it goes; met if the intervals have something in common. F: lanes of rays or
// of boxes. Both sides are scaled by inv_far of slab(): that is no less than 1 - 15u of its near side and no more than 1 + 3u of its far one (u =
// 2^-24), so what slab() takes is taken. Not for the empty box, which is met.
template <class F, class Same>
HWY_INLINE auto meets_box(const F (&low)[3], const F (&high)[3], const F (&origin)[3], const F (&inverse)[3], F limit, const Same& same) {
  F near = same(0.0f), far = limit;
  for (int k = 0; k < 3; ++k) {
    const F a = (low[k] - origin[k]) * inverse[k], b = (high[k] - origin[k]) * inverse[k];
    near = cull_max(cull_min(a, b), near), far = cull_min(cull_max(a, b), far);
  }
  return near <= cull_mul_add(far, same(1 + 0x1p-19f), same(0x1p-120f));
}

// Any hit, of rays in all directions. Usage: add() packets while there is room, then trace().
class AnyStream {
 public:
  AnyStream(const Bvh::Data& tree, const Batch& rays) : data_(tree), batch_(rays) {}

  HWY_INLINE bool has_room() const { return packets_ < kPackets; }

  // The rays of a packet.
  HWY_INLINE void add(PacketTask& packet) {
    const int at = packets_ * kLanes;
    boxes_.set(at, packet.p);
    const PacketLanes& lanes = packet.lanes();
    for (uint32_t rest = packet.p.valid; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      take_lane(lanes, i, ray_[at + i]);
    }
    first_[packets_] = packet.first;
    all_ |= static_cast<uint64_t>(packet.p.valid) << at;
    ++packets_;
  }

  // Sets the bits of the rays that hit something. The stream is empty then.
  HWY_INLINE void trace(uint32_t* out) {
    if (all_ == 0) return;
    alive_ = all_;
    Entry stack[kBvhStackSize + 1];  // put() writes one past the last
    stack[0] = {alive_, 0};
    for (int top = 1; top > 0;) {
      Entry entry = stack[--top];
      entry.rays &= alive_;
      if (entry.rays == 0) continue;
      if (top > 0) fetch_child(data_, stack[top - 1].child);
      const int n = std::popcount(entry.rays);
      if (kLanes8 == 1 || n <= kFewRays) alone(entry);
      else if ((entry.child & kLeafBit) != 0) leaf(entry);
      else if (n >= kManyRays) top = push_many(entry, stack, top);
      else if constexpr (kHasPairs) top = push_pairs(entry, stack, top);
      else top = push(entry, stack, top);
    }
    const uint64_t found = all_ & ~alive_;
    for (int p = 0; p < packets_; ++p) {
      const auto bits = static_cast<uint32_t>(found >> (p * kLanes)) & ((1u << kLanes) - 1);
      out[first_[p] / 32] |= bits << (first_[p] % 32);
    }
    packets_ = 0, all_ = 0;
  }

 private:
  struct Entry { uint64_t rays; uint32_t child; };
  static constexpr int kPackets = kStreamRays / kLanes;
  static constexpr int kManyRays = kHasPairs ? 32 : 20;  // from so many on, lanes are rays, though some of them are not asked for

  HWY_INLINE AnyVisitor visitor(int r) const { return {batch_, ray_[r].exact, first_[r / kLanes] + r % kLanes, boxes_.limit[r]}; }
  HWY_INLINE void end(int r) { alive_ &= ~(uint64_t{1} << r); }

  HWY_INLINE void alone(const Entry& entry) {
    for_each_ray(entry.rays, [&](int r) HWY_ATTR {
      AnyVisitor v = visitor(r);
      traverse(data_, entry.child, 0.0f, ray_[r], v);
      if (v.found) end(r);
    });
  }

  HWY_INLINE void leaf(const Entry& entry) {
    visit_leaf_together<AnyVisitor>(data_, entry.child, entry.rays, ray_, boxes_.limit, [&](int r, const AtLeaf& at) HWY_ATTR {
      AnyVisitor v = visitor(r);
      if (at.visit(ray_[r], v)) end(r);
    });
  }

  // Without a branch: whether any ray meets a child is hard to foretell.
  HWY_INLINE static int put(Entry* stack, int top, uint64_t rays, uint32_t child) {
    stack[top] = {rays, child};
    return top + (rays != 0);
  }

  // Lanes are the children of the node, for two rays at a time. What each ray meets stays in registers.
  HWY_INLINE int push_pairs(const Entry& entry, Entry* stack, int top) const {
    const BvhNode& node = data_.nodes[entry.child];
    F32 low[3], high[3];
    for (int k = 0; k < 3; ++k) low[k] = twice(node.bounds[k]), high[k] = twice(node.bounds[k + 3]);
    const uint32_t used = to_bits(low[0] <= high[0]);
    static_assert(!kHasPairs || kManyRays % 8 == 0);
    uint64_t meets[kManyRays / 8] = {};
    uint64_t rest = entry.rays;
    for (int w = 0; w < kManyRays / 8 && rest != 0; ++w) {
      int at = 0;
      do {
        const int a = std::countr_zero(rest);
        rest &= rest - 1;
        const int b = rest != 0 ? std::countr_zero(rest) : a;
        rest &= rest - 1;
        F32 origin[3], inverse[3];
        for (int k = 0; k < 3; ++k)
          origin[k] = halves(boxes_.origin[k][a], boxes_.origin[k][b]), inverse[k] = halves(boxes_.inverse[k][a], boxes_.inverse[k][b]);
        const F32 limit = halves(boxes_.limit[a], boxes_.limit[b]);
        const auto m = meets_box(low, high, origin, inverse, limit, [](float x) HWY_ATTR { return f32(x); });
        meets[w] |= static_cast<uint64_t>(to_bits(m) & used) << at;
        at += 2 * kBvhWidth;
      } while (at < 64 && rest != 0);
    }
    for (int c = 0; c < kBvhWidth; ++c) top = put(stack, top, members_with(meets, c, entry.rays), node.child[c]);
    return top;
  }

  // Lanes are the children of the node.
  HWY_INLINE int push(const Entry& entry, Entry* stack, int top) const {
    const BvhNode& node = data_.nodes[entry.child];
    alignas(64) uint8_t meets[kStreamRays] = {};  // of each ray, bits of children
    for (int s = 0; s < kBvhWidth; s += kLanes8) {
      F8 low[3], high[3];
      for (int k = 0; k < 3; ++k) low[k] = F8::load(node.bounds[k] + s), high[k] = F8::load(node.bounds[k + 3] + s);
      const uint32_t used = to_bits(low[0] <= high[0]);
      for_each_ray(entry.rays, [&](int r) HWY_ATTR {
        F8 origin[3], inverse[3];
        for (int k = 0; k < 3; ++k) origin[k] = f8(boxes_.origin[k][r]), inverse[k] = f8(boxes_.inverse[k][r]);
        const auto m = meets_box(low, high, origin, inverse, f8(boxes_.limit[r]), [](float x) HWY_ATTR { return f8(x); });
        meets[r] = static_cast<uint8_t>(meets[r] | (to_bits(m) & used) << s);
      });
    }
    for (int c = 0; c < kBvhWidth; ++c) top = put(stack, top, set_of_bit(meets, c), node.child[c]);
    return top;
  }

  // Lanes are rays.
  HWY_INLINE int push_many(const Entry& entry, Entry* stack, int top) const {
    const BvhNode& node = data_.nodes[entry.child];
    uint64_t set[kBvhWidth] = {};
    for (int p = 0; p < packets_; ++p) {
      const int at = p * kLanes;
      if ((entry.rays >> at & ((1u << kLanes) - 1)) == 0) continue;
      F32 origin[3], inverse[3];
      for (int k = 0; k < 3; ++k) origin[k] = F32::load(boxes_.origin[k] + at), inverse[k] = F32::load(boxes_.inverse[k] + at);
      const F32 limit = F32::load(boxes_.limit + at);
      for (int c = 0; c < kBvhWidth; ++c) {
        F32 low[3], high[3];
        for (int k = 0; k < 3; ++k) low[k] = f32(node.bounds[k][c]), high[k] = f32(node.bounds[k + 3][c]);
        const auto m = meets_box(low, high, origin, inverse, limit, [](float x) HWY_ATTR { return f32(x); });
        set[c] |= static_cast<uint64_t>(to_bits(m)) << at;
      }
    }
    for (int c = 0; c < kBvhWidth; ++c)
      top = put(stack, top, node.bounds[0][c] <= node.bounds[3][c] ? set[c] & entry.rays : 0, node.child[c]);
    return top;
  }

  const Bvh::Data& data_;
  const Batch& batch_;
  BoxRays boxes_;
  LaneRay ray_[kStreamRays];
  int first_[kPackets];  // ray of lane 0
  int packets_ = 0;
  uint64_t all_ = 0, alive_ = 0;  // the rays; those without a hit
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_STREAM_INL_H_
