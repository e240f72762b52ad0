// What becomes of the hits of one ray: the closest, any, all. Included once a target.
#if defined(SPANRAY_VISITORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_VISITORS_INL_H_
#undef SPANRAY_VISITORS_INL_H_
#else
#define SPANRAY_VISITORS_INL_H_
#endif

#include <bit>
#include <cstdint>

#include "frame/frame.h"
#include "ray/bvh_data.h"
#include "ray/triangle_test.h"
#include "simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

struct Batch {
  const Frame& frame;
  const RayBatch& rays;
  bool cull_back;

  // Does the surface itself take the hit? Asked only for hits that count.
  HWY_INLINE bool accepts(int ray, uint32_t primitive) const { return accepts_of(ray, 1u, primitive) != 0; }
  // The same for rays first + i of bits i.
  HWY_INLINE uint32_t accepts_of(int first, uint32_t bits, uint32_t primitive) const {
    const SceneData& scene = *frame.scene;
    for (uint32_t rest = cull_back ? bits : 0; rest != 0; rest &= rest - 1) {
      const size_t i = static_cast<size_t>(first + std::countr_zero(rest));
      const glm::dvec3 origin(rays.origin[0][i], rays.origin[1][i], rays.origin[2][i]);
      if (!(facing(scene, scene.triangles[primitive], origin) > 0)) bits ^= rest & -rest;
    }
    if (bits == 0 || frame.accept_rays == nullptr || (flags_of(frame, primitive) & kMaterialMasked) == 0) return bits;
    return frame.accept_rays(frame, rays, first, primitive, bits);
  }
};

// The closest hit so far is often known only by bounds on its t.
struct ClosestVisitor {
  static constexpr bool kAny = false, kClosest = true;
  const Batch& batch;
  const Bvh::Data& data;
  const TraceRay& ray;
  int index;
  double best_t;  // no less than t where it is not known
  uint32_t best;
  uint32_t place;    // of `best` among the triangles of all blocks
  float low, limit;  // no more than t, no less than t
  bool known;        // best_t is t

  // A hit that is surely accepted, with from <= t <= to.
  HWY_INLINE void sure(float from, float to, uint32_t primitive, uint32_t at) {
    if (batch.accepts(index, primitive))
      best_t = static_cast<double>(to), best = primitive, place = at, low = from, limit = to, known = false;
  }
  HWY_INLINE void hit(double t, uint32_t primitive, uint32_t at) {
    if (!known && t >= static_cast<double>(low) && t <= static_cast<double>(limit)) know();
    if (t > best_t || (t == best_t && primitive > best)) return;
    if (!batch.accepts(index, primitive)) return;
    best_t = t, best = primitive, place = at, limit = round_up(t), low = round_down(t), known = true;
  }
  HWY_NOINLINE void know() {
    hit_triangle(ray, triangle_at(data, place), best_t);
    known = true;
  }
};

struct AnyVisitor {
  static constexpr bool kAny = true, kClosest = false;
  const Batch& batch;
  const TraceRay& ray;
  int index;
  float limit;
  bool found = false;
  // A hit that hit_triangle() surely accepts, before the end of the ray.
  HWY_INLINE bool certain(uint32_t primitive) { return found = batch.accepts(index, primitive); }
  HWY_INLINE bool takes(const TriangleView&) const { return true; }
  HWY_INLINE bool hit(double t, uint32_t primitive) {
    if (!(t <= ray.t_max) || !batch.accepts(index, primitive)) return false;
    return found = true;
  }
};

struct AllVisitor {
  static constexpr bool kAny = false, kClosest = false;
  const Batch& batch;
  const TraceRay& ray;
  int index;
  float limit;
  bool owned_only;
  FragmentList& out;
  HWY_INLINE bool takes(const TriangleView& triangle) const { return !owned_only || owns_hit(ray, triangle); }
  HWY_INLINE bool hit(double t, uint32_t primitive) {
    if (t <= ray.t_max && batch.accepts(index, primitive)) {
      out.pixel.push_back(batch.rays.pixel[index]);
      out.ray.push_back(static_cast<uint32_t>(index));
      out.primitive.push_back(primitive);
    }
    return false;
  }
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_VISITORS_INL_H_
