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

// Any hit of up to kStreamRays rays of a batch. Usage: add() packets while there is room, then trace().
class AnyStream {
 public:
  AnyStream(const Bvh::Data& tree, const Batch& rays) : data_(tree), batch_(rays) {}

  HWY_INLINE bool has_room() const { return count_ + kLanes <= kStreamRays; }

  // The rays of a packet.
  HWY_INLINE void add(PacketTask& packet) {
    for (uint32_t rest = packet.p.valid; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      take_lane(packet.lanes(), i, ray_[count_]);
      limit_[count_] = packet.lanes().limit[i];
      index_[count_++] = packet.first + i;
    }
  }

  // Sets the bits of the rays that hit something. The stream is empty then.
  HWY_INLINE void trace(uint32_t* out) {
    if (count_ == 0) return;
    const uint64_t all = ~uint64_t{0} >> (kStreamRays - count_);
    alive_ = all;
    Entry stack[kBvhStackSize];
    stack[0] = {all, 0};
    for (int top = 1; top > 0;) {
      Entry entry = stack[--top];
      entry.rays &= alive_;
      if (entry.rays == 0) continue;
      if (kLanes8 == 1 || std::popcount(entry.rays) <= kFewRays) alone(entry);
      else if ((entry.child & kLeafBit) != 0) leaf(entry);
      else top = push(entry, stack, top);
    }
    for (uint64_t rest = all & ~alive_; rest != 0; rest &= rest - 1) {
      const int i = index_[std::countr_zero(rest)];
      out[i / 32] |= 1u << (i % 32);
    }
    count_ = 0;
  }

 private:
  struct Entry {
    uint64_t rays;
    uint32_t child;
  };

  HWY_INLINE AnyVisitor visitor(int r) const { return {batch_, ray_[r].exact, index_[r], limit_[r]}; }

  HWY_INLINE void alone(const Entry& entry) {
    for (uint64_t rest = entry.rays; rest != 0; rest &= rest - 1) {
      const int r = std::countr_zero(rest);
      AnyVisitor v = visitor(r);
      traverse(data_, entry.child, 0.0f, ray_[r], v);
      if (v.found) alive_ &= ~(uint64_t{1} << r);
    }
  }

  HWY_INLINE void leaf(const Entry& entry) {
    for (uint64_t rest = entry.rays; rest != 0; rest &= rest - 1) {
      const int r = std::countr_zero(rest);
      AnyVisitor v = visitor(r);
      if (visit_leaf(data_, entry.child, ray_[r], v)) alive_ &= ~(uint64_t{1} << r);
    }
  }

  HWY_INLINE int push(const Entry& entry, Entry* stack, int top) const {
    const BvhNode& node = data_.nodes[entry.child];
    alignas(64) uint8_t meets[kStreamRays] = {};  // of each ray, bits of children
    for (uint64_t rest = entry.rays; rest != 0; rest &= rest - 1) {
      const int r = std::countr_zero(rest);
      uint32_t bits = 0;
      for (int s = 0; s < kBvhWidth; s += kLanes8) bits |= to_bits(box_children(node, s, ray_[r], limit_[r]).meets) << s;
      meets[r] = static_cast<uint8_t>(bits);
    }
    for (int c = 0; c < kBvhWidth; ++c)
      if (const uint64_t rays = set_of_bit(meets, c); rays != 0) stack[top++] = {rays, node.child[c]};
    return top;
  }

  const Bvh::Data& data_;
  const Batch& batch_;
  LaneRay ray_[kStreamRays];
  float limit_[kStreamRays];
  int index_[kStreamRays];  // in the batch
  int count_ = 0;
  uint64_t alive_ = 0;  // rays without a hit
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_STREAM_INL_H_
