// Batches of rays against exact primitives: all rays in packets, lanes are rays, coherent or not. Planes first, one by one; then down the
// tree of spheres, one sphere at a time.
// Input:    any rays; those that prepare_ray() refuses miss.
// Contract: what is found is what first_hit() over all primitives finds, whatever the tree, the order of the batch and the instruction set.
#include <algorithm>
#include <bit>
#include <cstdint>

#include "frame/exact_hit.h"
#include "frame/frame.h"
#include "ray/exact_kernel.h"
#include "ray/triangle_test.h"
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

  // Those of rays first to first + n - 1 that are in `wanted`. Afterwards: which of them were hit.
  HWY_INLINE uint32_t trace(const RayBatch& rays, int first, int n, uint32_t wanted) {
    RawRays raw;
    prepare_rays(rays, first, n, p_, raw, scales_);
    p_.valid &= wanted;
    found_ = 0;
    if (p_.valid == 0) return 0;
    for (int k = 0; k < 3; ++k) ray_.origin[k] = to_f64(raw.origin[k]), ray_.direction[k] = to_f64(raw.direction[k]);
    ray_.length_square = dot3(ray_.direction, ray_.direction);
    best_t_ = to_f64(raw.t_max), best_ = i32(kNoPrimitive);
    for (const PlaneItem& item : set_.planes) test(item);
    if (!set_.spheres.nodes.empty() && p_.valid != 0) {
      const Beam beam = make_beam(p_);
      if (p_.mixed_axes == 0) descend<false>(beam);
      else descend<true>(beam);
    }
    return found_;
  }

  // Of the closest hits, by lane.
  HWY_INLINE void store(uint32_t* primitive, double* t) const { best_.store(primitive), best_t_.store(t); }

 private:
  HWY_INLINE uint32_t leaving(uint32_t primitive) const { return to_bits(p_.from == i32(primitive)); }

  HWY_INLINE void test(const PlaneItem& item) {
    take(first_hit_lanes(ray_, item.plane, leaving(item.primitive), p_.valid), item.primitive);
  }
  HWY_INLINE void test(const TreeSphere& sphere, uint32_t rays) {
    take(first_hit_lanes(ray_, sphere, leaving(sphere.primitive), rays), sphere.primitive);
  }

  HWY_INLINE void take(const ExactLaneHits& hits, uint32_t primitive) {
    if (hits.hit == 0) return;
    if constexpr (kAny) {
      const uint32_t hit = hits.hit & ~bits_less(best_t_, hits.t);
      found_ |= hit, p_.valid &= ~hit;
    } else {
      const uint32_t nearer = bits_less(hits.t, best_t_), same = ~(nearer | bits_less(best_t_, hits.t));
      const uint32_t hit = hits.hit & (nearer | (same & to_bits(less_unsigned(i32(primitive), best_))));
      if (hit == 0) return;
      const Mask m = mask_from_bits(hit);
      found_ |= hit;
      best_t_ = select(m, hits.t, best_t_), best_ = select(m, i32(primitive), best_);
      p_.limit = select(m, round_up_lanes(hits.t * scales_.size), p_.limit);
    }
  }

  template <bool kMixed> HWY_INLINE void descend(const Beam& beam) {
    if constexpr (kAny) descend_any<kMixed>(beam);
    else descend_near<kMixed>(beam);
  }

  template <bool kMixed> HWY_INLINE void descend_any(const Beam& beam) {
    AnyEntry stack[kBvhStackSize + kBvhWidth];
    int top = push_any<kMixed>(p_, set_.spheres.nodes[0], p_.valid, beam, stack, 0);
    while (top > 0) {
      const AnyEntry entry = stack[--top];
      const uint32_t rays = entry.rays & p_.valid;
      if (rays == 0) continue;
      if ((entry.child & kLeafBit) != 0) test(set_.spheres.spheres[sphere_of(entry.child)], rays);
      else top = push_any<kMixed>(p_, set_.spheres.nodes[entry.child], rays, beam, stack, top);
    }
  }

  template <bool kMixed> HWY_INLINE void descend_near(const Beam& beam) {
    PacketEntry stack[kBvhStackSize + kBvhWidth];
    int top = push_nearest<kMixed>(p_, set_.spheres.nodes[0], beam, stack, 0);
    while (top > 0) {
      const PacketEntry& entry = stack[--top];
      const uint32_t child = entry.child, rays = to_bits(F32::load(entry.near) <= p_.limit) & p_.valid;
      if (rays == 0) continue;
      if ((child & kLeafBit) != 0) test(set_.spheres.spheres[sphere_of(child)], rays);
      else top = push_nearest<kMixed>(p_, set_.spheres.nodes[child], beam, stack, top);
    }
  }

  const ExactSet& set_;
  RayPacket p_;  // valid: rays that are still traced
  ScaleLanes scales_;
  ExactRays ray_;
  F64 best_t_;  // t_max until something is hit
  I32 best_;
  uint32_t found_ = 0;
};

HWY_INLINE int rays_from(const RayBatch& rays, int first) { return std::min(rays.count - first, kLanes); }

// t of a triangle that the ray is known to meet, in units of its direction.
HWY_NOINLINE double triangle_t(const SceneData& scene, const RayBatch& rays, int i, uint32_t primitive) {
  float origin[3], direction[3], corner[9];
  for (int k = 0; k < 3; ++k) origin[k] = rays.origin[k][i], direction[k] = rays.direction[k][i];
  for (int v = 0; v < 3; ++v) std::copy_n(scene.vertices[scene.triangles[primitive].vertex[v]].position, 3, corner + 3 * v);
  TraceRay ray;
  double t = 0;
  if (!prepare_ray(origin, direction, rays.t_max[i], ray) || !hit_triangle(ray, TriangleView{corner, 3, 1}, t)) return 0;
  return t * (ray.direction_z / static_cast<double>(direction[ray.kz]));  // a power of two
}

void closest_exact_kernel(const Frame& frame, const ExactSet& set, const RayBatch& rays, double t_min, uint32_t* out) {
  ExactPacket<false> packet(set, t_min, frame.settings.culling == Culling::kBack);
  for (int first = 0; first < rays.count; first += kLanes) {
    const uint32_t found = packet.trace(rays, first, rays_from(rays, first), (1u << kLanes) - 1);
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
    out[first / 32] |= packet.trace(rays, first, rays_from(rays, first), ~(out[first / 32] >> (first % 32))) << (first % 32);
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
