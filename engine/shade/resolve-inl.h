// From a hit {ray, primitive} to weights, position and footprint: the one function behind both engines, surfaces and
// accept(hit) alike. Include inside a *_kernel.cpp (simd/dispatch.h), after the project headers.
#if defined(SPANRAY_RESOLVE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_RESOLVE_INL_H_
#undef SPANRAY_RESOLVE_INL_H_
#else
#define SPANRAY_RESOLVE_INL_H_
#endif

#include "shade/lane_vec-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace surface_lanes {

// kLanes hits. Lanes that are not valid name a primitive that may be read.
struct HitLanes {
  const RayBatch* rays;  // nullptr: primary rays
  I32 pixel, ray, primitive;
  Mask valid;
  bool uniform;             // one primitive in all lanes: loads become broadcasts, the arithmetic stays the same
  uint32_t first_primitive;  // of lane 0
  int place = 0;             // of all, in their pixels (frame/samples.h); primary rays only
};

struct RayLanes { V3d origin, direction; };
struct DifferentialLanes { V3d origin_dx, origin_dy, direction_dx, direction_dy; };

// Field k of each lane's record in an array of records of 32-bit words.
struct RecordLanes {
  I32 offset;         // words
  uint32_t first;     // offset of lane 0
  bool uniform;
  HWY_INLINE F32 real(const float* base, int k) const {
    return uniform ? f32(base[first + static_cast<uint32_t>(k)]) : gather(base, offset + i32(k));
  }
  HWY_INLINE I32 word(const uint32_t* base, int k) const {
    return uniform ? i32(base[first + static_cast<uint32_t>(k)]) : gather(base, offset + i32(k));
  }
};

struct TriangleLanes {
  RecordLanes vertex[3];
  I32 bits;            // Triangle::bits
  V3d v0, v1, v2;
};

struct SurfaceLanes {
  F64 b0, b1, b2;      // weights, in [0, 1]
  V3d position;        // in double; to_f32 of it is what shading sees
  V3d normal;          // cross(v1 - v0, v2 - v0): neither unit length nor turned
  V3d edge1, edge2;    // v1 - v0, v2 - v0
  V3d from_origin;     // v0 - origin
};

// Where a ray batch of primary rays must be read from the camera instead.
HWY_INLINE const RayBatch* secondary(const RayBatch* rays) { return rays != nullptr && !rays->primary ? rays : nullptr; }

HWY_INLINE RecordLanes record_lanes(I32 index, int stride, bool uniform) {
  const I32 offset = index * i32(stride);
  return {offset, static_cast<uint32_t>(first_lane(offset)), uniform};
}

HWY_INLINE V3d gather3(const AlignedBuffer<float> (&a)[3], I32 index) {
  return to_f64(V3f{gather(a[0].data(), index), gather(a[1].data(), index), gather(a[2].data(), index)});
}

HWY_INLINE RayLanes load_rays(const Frame& frame, const HitLanes& hits) {
  if (const RayBatch* rays = secondary(hits.rays)) return {gather3(rays->origin, hits.ray), gather3(rays->direction, hits.ray)};
  const PrimaryRays& p = frame.primary;
  const F64 x = to_f64(hits.pixel & i32(0xffff)) + f64(frame.places.x[hits.place]);
  const F64 y = to_f64(shift_right_logical<16>(hits.pixel)) + f64(frame.places.y[hits.place]);
  return {broadcast(p.eye), broadcast(p.corner) + broadcast(p.step_x) * x + broadcast(p.step_y) * y};
}

// Zero for rays that carry none: their footprint is a point, textures are read at level 0.
HWY_INLINE DifferentialLanes load_differentials(const Frame& frame, const HitLanes& hits) {
  const V3d zero{f64(0.0), f64(0.0), f64(0.0)};
  const RayBatch* rays = secondary(hits.rays);
  if (rays == nullptr) {  // accept(hit) is asked at every sample
    const F64 spacing = f64(frame.places.spacing);
    return {zero, zero, broadcast(frame.primary.step_x) * spacing, broadcast(frame.primary.step_y) * spacing};
  }
  if (rays->direction_dx[0].empty()) return {zero, zero, zero, zero};
  return {gather3(rays->origin_dx, hits.ray), gather3(rays->origin_dy, hits.ray), gather3(rays->direction_dx, hits.ray),
          gather3(rays->direction_dy, hits.ray)};
}

HWY_INLINE TriangleLanes load_triangles(const SceneData& scene, const HitLanes& hits) {
  const uint32_t* words = reinterpret_cast<const uint32_t*>(scene.triangles.data());
  const float* vertices = reinterpret_cast<const float*>(scene.vertices.data());
  const RecordLanes record{hits.primitive * i32(kTriangleStride), hits.first_primitive * kTriangleStride, hits.uniform};
  TriangleLanes t;
  V3d* const corner[3] = {&t.v0, &t.v1, &t.v2};
  for (int i = 0; i < 3; ++i) {
    t.vertex[i] = record_lanes(record.word(words, i), kVertexStride, hits.uniform);
    *corner[i] = to_f64(V3f{t.vertex[i].real(vertices, 0), t.vertex[i].real(vertices, 1), t.vertex[i].real(vertices, 2)});
  }
  t.bits = record.word(words, 3);
  return t;
}

// Weights and position of the hit of each ray with the plane of its triangle, clamped to the triangle.
// Source:   Olano and Greer 1997, "Triangle Scan Conversion Using 2D Homogeneous Coordinates": b_i = e_i / sum(e), e_i = d .
//           cross(v_j - o, v_k - o). Here cross(v_j - o, v_k - v_j), the same in exact arithmetic: its rounding error grows with
//           distance times size of the triangle instead of distance squared.
// Output:   weights in [0, 1]; edge-on (sum(e) = 0, or nothing left to divide by) vertex 0. Never NaN for finite input.
// Contract: double throughout; error of a weight <= 2^-48 |p| |edge| |d| / |d . n|.
HWY_INLINE SurfaceLanes resolve_lanes(const RayLanes& ray, const TriangleLanes& t) {
  SurfaceLanes s;
  const V3d& d = ray.direction;
  s.from_origin = t.v0 - ray.origin;
  s.edge1 = t.v1 - t.v0;
  s.edge2 = t.v2 - t.v0;
  s.normal = cross(s.edge1, s.edge2);
  const F64 e0 = dot(d, cross(t.v1 - ray.origin, t.v2 - t.v1));
  const F64 e1 = dot(d, cross(t.v2 - ray.origin, -s.edge2));
  const F64 e2 = dot(d, cross(s.from_origin, s.edge1));
  const F64 sum = e0 + e1 + e2;
  const F64 zero = f64(0.0), one = f64(1.0);
  const F64 safe_sum = select_eq(sum, zero, one, sum);
  const F64 b0 = e0 / safe_sum, b1 = e1 / safe_sum, b2 = e2 / safe_sum;
  // Of a sum of 1, clamping takes away only negative terms: what is left is 1 or more.
  const F64 c0 = min_(max_(b0, zero), one), c1 = min_(max_(b1, zero), one), c2 = min_(max_(b2, zero), one);
  const F64 outside = select_eq(b0, c0, select_eq(b1, c1, select_eq(b2, c2, zero, one), one), one);
  const F64 total = select_eq(outside, zero, one, c0 + c1 + c2);
  const F64 usable = select_eq(sum, zero, zero, select_lt(zero, total, one, zero));
  s.b0 = c0, s.b1 = c1, s.b2 = c2;
  if (any(outside == one)) {  // else all is divided by 1
    const F64 divisor = select_eq(usable, zero, one, total);
    s.b0 = c0 / divisor, s.b1 = c1 / divisor, s.b2 = c2 / divisor;
  }
  s.b0 = select_eq(usable, zero, one, s.b0), s.b1 = select_eq(usable, zero, zero, s.b1), s.b2 = select_eq(usable, zero, zero, s.b2);
  s.position = t.v0 + s.edge1 * s.b1 + s.edge2 * s.b2;
  return s;
}

// Bound on each coordinate of to_f32(position) - p, p the nearest point of the triangle: half an ulp for the rounding to float,
// and the double error, which scales with vertices and distance. It is also the bound on the distance to the exact hit as long as
// |d . n| >= |d| |n| / 16; for flatter views the hit slides along the triangle, not off it.
inline constexpr float kRoundingError = 0x1.01p-24f;
HWY_INLINE F32 size_error(const TriangleLanes& t, const V3d& from_origin, const V3d& edge1, const V3d& edge2) {
  const F32 around = max_(max_abs(to_f32(t.v0)), max_(max_abs(to_f32(t.v1)), max_abs(to_f32(t.v2)))) +
                     max_abs(to_f32(from_origin)) + max_abs(to_f32(edge1)) + max_abs(to_f32(edge2));
  return around * f32(0x1p-44f) + f32(0x1p-148f);
}
HWY_INLINE F32 position_error(const SurfaceLanes& s, const TriangleLanes& t) {
  return max_abs(to_f32(s.position)) * f32(kRoundingError) + size_error(t, s.from_origin, s.edge1, s.edge2);
}

// How position moves with a step of one pixel.
// Source:   Igehy 1999, "Tracing Ray Differentials", equations 10 to 12 (transfer to a plane).
// Contract: finite; a view along the plane, where the derivative is infinite, gives one of at most 2^100 |d|, and the
//           unprojected one where d . n is exactly 0.
HWY_INLINE V3d transfer(const V3d& origin_d, const V3d& direction_d, F64 t, const RayLanes& ray, const V3d& normal) {
  const V3d moved = origin_d + direction_d * t;
  const F64 slope = dot(ray.direction, normal), zero = f64(0.0), limit = f64(0x1p100);
  const F64 ratio = select_eq(slope, zero, zero, dot(moved, normal) / select_eq(slope, zero, f64(1.0), slope));
  return moved - ray.direction * min_(max_(ratio, -limit), limit);
}

// Distance along the ray, in units of its direction: of the clamped position, so it stays within the triangle's range.
HWY_INLINE F64 hit_t(const SurfaceLanes& s, const RayLanes& ray) {
  const F64 square = dot(ray.direction, ray.direction), zero = f64(0.0);
  return select_eq(square, zero, zero, dot(s.position - ray.origin, ray.direction) / select_eq(square, zero, f64(1.0), square));
}

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_RESOLVE_INL_H_
