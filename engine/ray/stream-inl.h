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
  const Candidates& found;
  const CandidateDistances& distances;
  template <class Visitor> HWY_INLINE bool visit(const LaneRay& ray, Visitor& visitor) const {
    return visit_candidates(block, place, found, distances, ray, visitor);
  }
};

// Some rays at a leaf: the lanes put all of them to it first, without a branch that depends on what they find; then visit(r, AtLeaf) for those
// that may hit something.
template <class Visitor, class Visit>
HWY_INLINE void visit_leaf_together(const Bvh::Data& data, uint32_t child, uint64_t set, const StreamRays& rays, const Visit& visit) {
  const TriangleBlock& block = data.blocks[leaf_block(child)];
  const uint32_t used = leaf_lanes(child);
  Candidates found[kStreamRays];
  CandidateDistances distances[Visitor::kClosest ? kStreamRays : 1];
  int ray[kStreamRays], n = 0;
  for_each_ray(set, [&](int r) HWY_ATTR {
    ray[n] = r;
    found[n] = candidates<Visitor, false>(block, rays.ray[r], rays.limit[r], distances[Visitor::kClosest ? n : 0]);
    found[n].maybe &= used, found[n].sure &= used;
    n += found[n].maybe != 0;
  });
  const uint32_t place = leaf_block(child) * kBvhWidth;
  for (int i = 0; i < n; ++i) visit(ray[i], AtLeaf{block, place, found[i], distances[Visitor::kClosest ? i : 0]});
}

// Any hit, of rays in all directions. Usage: add() packets while there is room, then trace().
class AnyStream {
 public:
  AnyStream(const Bvh::Data& tree, const Batch& rays) : data_(tree), batch_(rays) {}

  HWY_INLINE bool has_room() const { return rays_.count + kLanes <= kStreamRays; }

  // The rays of a packet.
  HWY_INLINE void add(PacketTask& packet) {
    for_each_ray(packet.p.valid, [&](int i) HWY_ATTR { rays_.add(packet, i); });
  }

  // Sets the bits of the rays that hit something. The stream is empty then.
  HWY_INLINE void trace(uint32_t* out) {
    if (rays_.count == 0) return;
    alive_ = rays_.all();
    Entry stack[kBvhStackSize];
    stack[0] = {alive_, 0};
    for (int top = 1; top > 0;) {
      Entry entry = stack[--top];
      entry.rays &= alive_;
      if (entry.rays == 0) continue;
      if (top > 0) fetch_child(data_, stack[top - 1].child);
      if (kLanes8 == 1 || std::popcount(entry.rays) <= kFewRays) alone(entry);
      else if ((entry.child & kLeafBit) != 0) leaf(entry);
      else top = push(entry, stack, top);
    }
    for_each_ray(rays_.all() & ~alive_, [&](int r) HWY_ATTR { out[rays_.index[r] / 32] |= 1u << (rays_.index[r] % 32); });
    rays_.count = 0;
  }

 private:
  struct Entry { uint64_t rays; uint32_t child; };

  HWY_INLINE AnyVisitor visitor(int r) const { return {batch_, rays_.ray[r].exact, rays_.index[r], rays_.limit[r]}; }
  HWY_INLINE void end(int r) { alive_ &= ~(uint64_t{1} << r); }

  HWY_INLINE void alone(const Entry& entry) {
    for_each_ray(entry.rays, [&](int r) HWY_ATTR {
      AnyVisitor v = visitor(r);
      traverse(data_, entry.child, 0.0f, rays_.ray[r], v);
      if (v.found) end(r);
    });
  }

  HWY_INLINE void leaf(const Entry& entry) {
    visit_leaf_together<AnyVisitor>(data_, entry.child, entry.rays, rays_, [&](int r, const AtLeaf& at) HWY_ATTR {
      AnyVisitor v = visitor(r);
      if (at.visit(rays_.ray[r], v)) end(r);
    });
  }

  HWY_INLINE int push(const Entry& entry, Entry* stack, int top) const {
    const BvhNode& node = data_.nodes[entry.child];
    alignas(64) uint8_t meets[kStreamRays] = {};  // of each ray, bits of children
    for_each_ray(entry.rays, [&](int r) HWY_ATTR {
      uint32_t bits = 0;
      for (int s = 0; s < kBvhWidth; s += kLanes8) bits |= to_bits(box_children(node, s, rays_.ray[r], rays_.limit[r]).meets) << s;
      meets[r] = static_cast<uint8_t>(bits);
    });
    for (int c = 0; c < kBvhWidth; ++c)
      if (const uint64_t set = set_of_bit(meets, c); set != 0) stack[top++] = {set, node.child[c]};
    return top;
  }

  const Bvh::Data& data_;
  const Batch& batch_;
  StreamRays rays_;
  uint64_t alive_ = 0;  // rays without a hit
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_STREAM_INL_H_
