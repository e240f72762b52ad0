// make_depth_plane in lanes: the same operations in the same order, so the same bits. Included once per target.
#if defined(SPANRAY_DEPTH_PLANE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_DEPTH_PLANE_INL_H_
#undef SPANRAY_DEPTH_PLANE_INL_H_
#else
#define SPANRAY_DEPTH_PLANE_INL_H_
#endif

#include <limits>

#include "frame/frame.h"
#include "simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

struct Dvec3Lanes { F64 x, y, z; };
HWY_INLINE Dvec3Lanes operator-(const Dvec3Lanes& a, const Dvec3Lanes& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
HWY_INLINE Dvec3Lanes splat(const glm::dvec3& v) { return {f64(v.x), f64(v.y), f64(v.z)}; }
HWY_INLINE F64 dot3(const Dvec3Lanes& a, const Dvec3Lanes& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
HWY_INLINE Dvec3Lanes cross3(const Dvec3Lanes& a, const Dvec3Lanes& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
HWY_INLINE Dvec3Lanes position_of(const SceneData& scene, I32 vertex) {
  const float* const p = scene.vertices.data()->position;
  const I32 word = vertex * i32(kVertexStride);
  return {to_f64(gather(p, word)), to_f64(gather(p + 1, word)), to_f64(gather(p + 2, word))};
}

// facing() of frame/frame.h, not yet turned over for flipped triangles.
HWY_INLINE F64 unturned_facing(const Dvec3Lanes v[3], const glm::dvec3& from) {
  return dot3(cross3(v[1] - v[0], v[2] - v[0]), splat(from) - v[0]);
}

struct DepthPlaneLanes {
  F64 depth0, dx, dy;
  F32 min, max;
};
HWY_INLINE DepthPlaneLanes depth_planes(const PrimaryRays& primary, const Dvec3Lanes v[3], const F64 view_depth[3]) {
  const F64 near_plane = f64(primary.near_plane);
  DepthPlaneLanes plane;
  plane.min = f32(1.0f), plane.max = F32::zero();
  for (int i = 0; i < 3; ++i) {
    const F32 depth = to_f32(select_lt(near_plane, view_depth[i], near_plane / view_depth[i], f64(1.0)));
    plane.min = min_(plane.min, depth), plane.max = max_(plane.max, depth);
  }
  plane.min = max_(plane.min, f32(std::numeric_limits<float>::denorm_min()));
  plane.max = max_(plane.max, plane.min);
  const Dvec3Lanes normal = cross3(v[1] - v[0], v[2] - v[0]);
  const F64 scale = near_plane / dot3(v[0] - splat(primary.eye), normal), zero = f64(0.0);
  const F64 depth0 = dot3(splat(primary.corner), normal) * scale;
  const F64 dx = dot3(splat(primary.step_x), normal) * scale, dy = dot3(splat(primary.step_y), normal) * scale;
  const F64 nan_if_not_finite = depth0 * zero + dx * zero + dy * zero;
  plane.depth0 = select_eq(nan_if_not_finite, zero, depth0, to_f64(plane.min));
  plane.dx = select_eq(nan_if_not_finite, zero, dx, zero);
  plane.dy = select_eq(nan_if_not_finite, zero, dy, zero);
  return plane;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_DEPTH_PLANE_INL_H_
