// A resolved hit up to its material, and the parts of it that the triangle alone decides: shared by primary rays (once a triangle,
// primary-inl.h) and all others (once a hit, resolve_kernel.cpp). Include inside a *_kernel.cpp.
#if defined(SPANRAY_POINT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_POINT_INL_H_
#undef SPANRAY_POINT_INL_H_
#else
#define SPANRAY_POINT_INL_H_
#endif

#include "shade/resolve-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace surface_lanes {

// uv of the mesh at the hit, before scale and offset of a use, and how it moves with a pixel step. Its whole part, or most of it, stands
// apart, so that repeated textures keep their digits: u is whole_u + u.
struct UvLanes {
  F32 u, v, whole_u, whole_v;
  F32 du_dx, dv_dx, du_dy, dv_dy;
  V3f tangent_u, tangent_v;  // unit, along growing u and v; zero where the triangle has no area in space or uv. Only with plan.bump.
};

struct PointLanes {
  V3f position, weight, view, geometric, normal;  // as SurfaceBatch
  F32 position_error, t;
  V3f dpdx, dpdy;  // only with plan.bounces
  bool mapped;     // some lane reads textures
  UvLanes uv;      // only if mapped
  I32 material;
};

HWY_INLINE bool reads_textures(const Frame& frame) { return frame.plan.textures || frame.plan.bump || frame.plan.translucents; }

// MaterialFlags of all lanes together.
HWY_INLINE I32 flags_of_materials(const Frame& frame, I32 material) { return gather(frame.material_flags, material); }
HWY_INLINE bool any_flag(I32 flags, MaterialFlags flag) { return any((flags & i32(static_cast<int32_t>(flag))) != I32::zero()); }

// a - floor(a), in [0, 1]; 0 for NaN and where doubles have no fraction left.
HWY_INLINE F64 fraction(F64 a) {
  F64 f;
  for (int h = 0; h < kHalves; ++h) f.v[h] = hn::Sub(a.v[h], hn::Floor(a.v[h]));
  return select_lt(abs_(a), f64(2251799813685248.0), f, f64(0.0));
}

// floor(a), rounded to float, and fraction(a).
struct SplitLanes { F32 whole, rest; };
HWY_INLINE SplitLanes split(F64 a) {
  const F64 rest = fraction(a);
  return {to_f32(a - rest), to_f32(rest)};
}

// Texture coordinates of vertex 0, and what the weights 1 and 2 add: equal corners give exactly their value.
struct CornerUv { F64 u0, v0, du1, du2, dv1, dv2; };
HWY_INLINE CornerUv corner_uv(const SceneData& scene, const TriangleLanes& t) {
  const float* vertices = reinterpret_cast<const float*>(scene.vertices.data());
  const auto real = [&](int corner, int k) HWY_ATTR { return to_f64(t.vertex[corner].real(vertices, k)); };
  CornerUv c;
  c.u0 = real(0, 6), c.v0 = real(0, 7);
  c.du1 = real(1, 6) - c.u0, c.du2 = real(2, 6) - c.u0;
  c.dv1 = real(1, 7) - c.v0, c.dv2 = real(2, 7) - c.v0;
  return c;
}

// Gradients of u and v over position, times the square of |n|: sum of du_i cross(e2, n), cross(n, e1).
struct UvGradients { V3d u, v; };
HWY_INLINE UvGradients uv_gradients(const CornerUv& c, const V3d& side1, const V3d& side2, const V3d& normal) {
  const V3d g1 = cross(side2, normal), g2 = cross(normal, side1);
  return {g1 * c.du1 + g2 * c.du2, g1 * c.dv1 + g2 * c.dv2};
}

struct UvTangents { V3f u, v; };
HWY_INLINE UvTangents uv_tangents(const CornerUv& c, const V3d& side1, const V3d& side2, const V3d& normal) {
  const V3f none{F32::zero(), F32::zero(), F32::zero()};
  const UvGradients g = uv_gradients(c, side1, side2, normal);
  const Mask flat = c.du1 * c.dv2 - c.du2 * c.dv1 == f64(0.0);
  return {select(flat, none, unit_or(g.u, none)), select(flat, none, unit_or(g.v, none))};
}

// The unit normal on the side that the ray's origin sees; zero for a triangle without area.
// Source: facing() of frame/frame.h. Edge-on counts as the front.
HWY_INLINE V3f geometric_normal(const TriangleLanes& t, const V3d& normal, const V3d& from_origin) {
  const F64 zero = f64(0.0);
  const V3f unit = unit_or(normal, {F32::zero(), F32::zero(), F32::zero()});
  const F64 side = -dot(normal, from_origin);
  const Mask flipped = t.bits < i32(0);
  const Mask back = (flipped & (zero < side)) | and_not(flipped, side < zero);
  const Mask turned = and_not(flipped, back) | and_not(back, flipped);
  return select(turned, -unit, unit);
}

// Normals of vertex 0, and what the weights 1 and 2 add. The three corners turn as one, by the sign of their sum against the
// geometric normal, whatever the winding says: files disagree about it (as Gouraud).
struct CornerNormals { V3f n0, d1, d2; };
HWY_INLINE CornerNormals corner_normals(const SceneData& scene, const TriangleLanes& t, const V3f& geometric) {
  const float* vertices = reinterpret_cast<const float*>(scene.vertices.data());
  const auto corner = [&](int j) HWY_ATTR {
    return V3f{t.vertex[j].real(vertices, 3), t.vertex[j].real(vertices, 4), t.vertex[j].real(vertices, 5)};
  };
  const V3f n0 = corner(0), n1 = corner(1), n2 = corner(2);
  const Mask away = dot(n0 + n1 + n2, geometric) < F32::zero();
  const CornerNormals n = {n0, n1 - n0, n2 - n0};
  return {select(away, -n.n0, n.n0), select(away, -n.d1, n.d1), select(away, -n.d2, n.d2)};
}

// Of a blend of corner normals: unit, or as it is (plan.raw_normals); the geometric normal where opposed corners leave nothing.
inline constexpr float kLeastNormalSquare = 1e-6f;
HWY_INLINE V3f normal_of_blend(const Frame& frame, const V3f& blend, const V3f& geometric) {
  if (!frame.plan.raw_normals) return unit_or(blend, kLeastNormalSquare, geometric);
  return select(dot(blend, blend) > f32(kLeastNormalSquare), blend, geometric);
}

HWY_INLINE V3f interpolated_normal(const Frame& frame, const CornerNormals& n, F32 b1, F32 b2, const V3f& geometric) {
  const auto blend = [&](F32 n0, F32 d1, F32 d2) HWY_ATTR { return mul_add(b2, d2, mul_add(b1, d1, n0)); };
  const V3f whole = {blend(n.n0.x, n.d1.x, n.d2.x), blend(n.n0.y, n.d1.y, n.d2.y), blend(n.n0.z, n.d1.z, n.d2.z)};
  return normal_of_blend(frame, whole, geometric);
}

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_POINT_INL_H_
