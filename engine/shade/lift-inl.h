// Where shadow rays start above coarse triangles with interpolated normals. Include inside a *_kernel.cpp.
#if defined(SPANRAY_LIFT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_LIFT_INL_H_
#undef SPANRAY_LIFT_INL_H_
#else
#define SPANRAY_LIFT_INL_H_
#endif

#include "shade/surface_group-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace surface_lanes {

// Angles below this, in radians, between a triangle and the tangent plane at a corner lift nothing: rounded normals in files, and
// normals that are averages over a plane, are of that size.
inline constexpr float kLeastLiftAngle = 0x1p-16f;
// Least height above the triangle, in units of position_error: offset_origin() (light_rays_kernel.cpp) stays below it.
inline constexpr float kLeastLift = 8.0f;
// How far up to those planes: the share that Phong tessellation takes (Boubekeur and Alexa 2008). On a sphere, half would be the sphere
// itself; the rest is room for surfaces that are no spheres. Measured in docs/decisions/0015-shadow-terminator.md.
inline constexpr float kLiftShare = 0.75f;
inline constexpr float kMostLift = 0x1p100f;  // world units: starts of rays stay finite

// Lift and smooth normal of stored entries.
// Source:   Hanika 2021, "Hacking the Shadow Terminator", Ray Tracing Gems II, chapter 4: up to the point's projections onto the
//           tangent planes at the corners, where it lies below them, blended by its weights; kLiftShare of the way.
// Output:   lift zero where the corners' normals agree in all bits, where the surface is not convex, and where the result would not
//           lie clearly above the triangle.
// Contract: unfused, a function of the stored surface and its triangle alone.
[[maybe_unused]] static HWY_NOINLINE void store_lift(const Frame& frame, const SurfaceBatch& out, int at, const HitLanes& hits) {
  const TriangleLanes t = load_triangles(*frame.scene, hits);
  const float* vertices = reinterpret_cast<const float*>(frame.scene->vertices.data());
  const auto field = [&](int j, int k) HWY_ATTR {
    return V3f{t.vertex[j].real(vertices, k), t.vertex[j].real(vertices, k + 1), t.vertex[j].real(vertices, k + 2)};
  };
  const Group g{{frame, hits.valid, {}}, out, at};
  const V3f position = get(g, out.position), geometric = get(g, out.geometric_normal), weights = get(g, out.weight);
  const F32 weight[3] = {weights.x, weights.y, weights.z}, error = F32::load(out.position_error + at), zero = F32::zero();
  const V3f normal[3] = {field(0, 3), field(1, 3), field(2, 3)};
  const auto same = [](const V3f& a, const V3f& b) HWY_ATTR { return (a.x == b.x) & (a.y == b.y) & (a.z == b.z); };
  const Mask smooth = !(same(normal[0], normal[1]) & same(normal[0], normal[2]));
  const Mask away = dot(normal[0] + normal[1] + normal[2], geometric) < zero;  // turned as one, as corner_normals() does
  V3f lift{zero, zero, zero}, blend{zero, zero, zero};
  for (int j = 0; j < 3; ++j) {
    const V3f n = select(away, -normal[j], normal[j]), from = position - field(j, 0);
    const F32 below = -dot(from, n), reach = abs_(from.x) + abs_(from.y) + abs_(from.z);
    const Mask lifted = below > reach * f32(kLeastLiftAngle) + (error + error);
    lift = lift + n * (select(lifted, below, zero) * weight[j] * f32(kLiftShare));
    blend = blend + n * weight[j];
  }
  const Mask good = smooth & (dot(lift, geometric) > error * f32(kLeastLift)) & (max_abs(lift) < f32(kMostLift));
  put(g, out.lift, select(good, lift, V3f{zero, zero, zero}));
  put(g, out.smooth_normal, blend);
}

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_LIFT_INL_H_
