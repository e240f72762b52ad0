// Batches of rays against exact primitives: all rays in packets, lanes are rays, coherent or not. Planes first, one by one (of any
// hit, the sphere that stopped rays before them); then down the tree of spheres, one sphere at a time.
// Input:    any rays; those that prepare_ray() refuses miss.
// Contract: what is found is what first_hit() over all primitives finds, whatever the tree, the order of the batch and the
//           instruction set.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <type_traits>

#include "frame/exact_hit.h"
#include "frame/frame.h"
#include "ray/exact_kernel.h"
#include "simd/dispatch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ray/exact_kernel.cpp"
#include "hwy/foreach_target.h"
#include "ray/exact_lanes-inl.h"
#include "ray/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// kAny: any hit of each ray; else the closest.
template <bool kAny> class ExactPacket {
 public:
  ExactPacket(const ExactSet& set, double t_min, bool front_only) : set_(set) {
    ray_.t_min = f64(t_min), ray_.front_only = front_only;
  }

  // Those of rays first to first + kLanes - 1 that are in `wanted`. Returns which of them hit something.
  HWY_INLINE uint32_t trace(const RayBatch& rays, int first, uint32_t wanted) {
    RawRays raw;
    prepare_rays(rays, first, std::min(rays.count - first, kLanes), p_, raw, scales_);
    p_.valid &= wanted;
    found_ = 0;
    if (p_.valid == 0) return 0;
    for (int k = 0; k < 3; ++k) ray_.origin[k] = to_f64(raw.origin[k]), ray_.direction[k] = to_f64(raw.direction[k]);
    ray_.length_square = dot3(ray_.direction, ray_.direction), ray_.t_max = to_f64(raw.t_max);
    best_ = i32(kNoPrimitive);
    if (stopper_ != nullptr) test(*stopper_, p_.valid);
    for (const PlaneItem& item : set_.planes)
      take(first_hit_lanes(ray_, item.plane, leaving(item.primitive), p_.valid), item.primitive);
    if (p_.valid == 0 || set_.spheres.nodes.empty()) return found_;
    const Beam beam = make_beam(p_);
    if (p_.mixed_axes == 0) descend<false>(beam);
    else descend<true>(beam);
    return found_;
  }

  // The closest hits, by lane.
  HWY_INLINE void store(uint32_t* primitive, double* t) const { best_.store(primitive), ray_.t_max.store(t); }

 private:
  HWY_INLINE uint32_t leaving(uint32_t primitive) const { return to_bits(p_.from == i32(primitive)); }

  HWY_INLINE void test(const TreeSphere& sphere, uint32_t rays) {
    const ExactLaneHits hits = first_hit_lanes<kAny>(ray_, sphere, leaving(sphere.primitive), rays);
    take(hits, sphere.primitive);
    if (kAny && (hits.hit | hits.sure) != 0) stopper_ = &sphere;
  }

  HWY_INLINE void take(const ExactLaneHits& hits, uint32_t primitive) {
    uint32_t hit = hits.hit | hits.sure;
    if constexpr (kAny) {
      p_.valid &= ~hit;
    } else {
      hit &= bits_less(hits.t, ray_.t_max) | to_bits(less_unsigned(i32(primitive), best_));
      if (hit == 0) return;
      const Mask m = mask_from_bits(hit);
      ray_.t_max = select(m, hits.t, ray_.t_max), best_ = select(m, i32(primitive), best_);
      p_.limit = select(m, round_up_lanes(hits.t * scales_.size), p_.limit);
    }
    found_ |= hit;
  }

  template <bool kMixed> HWY_INLINE void descend(const Beam& beam) {
    const SphereTree& tree = set_.spheres;
    std::conditional_t<kAny, AnyEntry, PacketEntry> stack[kBvhStackSize];
    const auto push = [&](uint32_t node, uint32_t rays, int top) HWY_ATTR {
      if constexpr (kAny) return push_any<kMixed>(p_, tree.nodes[node], rays, beam, stack, top);
      else return push_nearest<kMixed>(p_, tree.nodes[node], beam, stack, top);
    };
    for (int top = push(0, p_.valid, 0); top > 0;) {
      const auto& entry = stack[--top];
      const uint32_t child = entry.child, rays = p_.valid & rays_of(entry);
      if (rays == 0) continue;
      if ((child & kLeafBit) != 0) test(tree.spheres[sphere_of(child)], rays);
      else top = push(child, rays, top);
    }
  }
  HWY_INLINE uint32_t rays_of(const AnyEntry& entry) const { return entry.rays; }
  HWY_INLINE uint32_t rays_of(const PacketEntry& entry) const { return to_bits(F32::load(entry.near) <= p_.limit); }

  const ExactSet& set_;
  RayPacket p_;  // valid: rays that still ask
  ScaleLanes scales_;
  ExactRays ray_;
  I32 best_;  // of the closest hits
  uint32_t found_ = 0;
  // Of any hit: the sphere that last stopped a ray. Where one packet is dark, the next often is by the same.
  const TreeSphere* stopper_ = nullptr;
};

void closest_exact_kernel(const Frame& frame, const ExactSet& set, const RayBatch& rays, double t_min, uint32_t* out) {
  ExactPacket<false> packet(set, t_min, frame.settings.culling == Culling::kBack);
  for (int first = 0; first < rays.count; first += kLanes) {
    const uint32_t found = packet.trace(rays, first, ~0u);
    if (found == 0) continue;
    alignas(64) uint32_t primitive[kLanes];
    alignas(64) double t[kLanes];
    packet.store(primitive, t);
    for (uint32_t rest = found; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      uint32_t& best = out[first + i];
      if (best == kNoPrimitive ||
          !shows_triangle(*frame.scene, best, triangle_t(*frame.scene, rays, first + i, best), primitive[i], t[i]))
        best = primitive[i];
    }
  }
}

void any_exact_kernel(const ExactSet& set, const RayBatch& rays, uint32_t* out) {
  ExactPacket<true> packet(set, 0, false);
  for (int first = 0; first < rays.count; first += kLanes)
    out[first / 32] |= packet.trace(rays, first, ~(out[first / 32] >> (first % 32))) << (first % 32);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {
const ClosestExactFn kClosestExact[kIsaCount] = SPANRAY_KERNEL_TABLE(closest_exact_kernel);
const AnyExactFn kAnyExact[kIsaCount] = SPANRAY_KERNEL_TABLE(any_exact_kernel);
}  // namespace spanray
#endif
