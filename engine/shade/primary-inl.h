// Surfaces of primary rays: everything that depends on the triangle alone once a triangle, everything linear in the pixel by two
// multiplications. Include inside a *_kernel.cpp (simd/dispatch.h), after the project headers.
#if defined(SPANRAY_PRIMARY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_PRIMARY_INL_H_
#undef SPANRAY_PRIMARY_INL_H_
#else
#define SPANRAY_PRIMARY_INL_H_
#endif

#include "shade/place-inl.h"
#include "shade/point-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace surface_lanes {

// Fields of a triangle's setup in double; X, Y, Z of a vector follow each other.
enum SetupReal : int {
  kSetupSum = 0,                   // sum of the edge functions: at pixel (0, 0), per pixel in x, per pixel in y
  kSetupEdge1 = 3, kSetupEdge2 = 6,
  kSetupV0 = 9, kSetupSide1 = 12, kSetupSide2 = 15,  // vertex 0, v1 - v0, v2 - v0
  kSetupDepth = 18,                // view depth of vertex 0, and what the weights 1 and 2 add
  kSetupU = 21, kSetupV = 24,      // the same of the texture coordinates
  kSetupRealCount = 27
};
// Fields in float.
enum SetupFloat : int {
  kSetupGeometric = 0,                 // unit, toward the eye; zero for a triangle without area
  kSetupNormal = 3,                    // at vertex 0, then what the weights 1 and 2 add: three vectors, turned toward the eye
  kSetupError = 12,                    // what the size of the triangle adds to position_error
  kSetupTangentU = 13, kSetupTangentV = 16,
  kSetupMaterial = 19,                 // bits of the index
  kSetupFloatCount = 20
};

inline constexpr int kSetupLine = 16;  // triangles side by side, whatever the instruction set
inline constexpr int kBlockHits = 256;

// Setups of the triangles that a block of hits sees: field by field in lines of kSetupLine triangles.
struct SetupBlock {
  alignas(64) double real[kBlockHits * kSetupRealCount];
  alignas(64) float single[kBlockHits * kSetupFloatCount];
  alignas(64) uint32_t primitive[kBlockHits + kSetupLine];
  alignas(64) uint32_t triangle_of_hit[kBlockHits + kSetupLine];
  int triangles = 0;

  double* reals(int triangle) {
    return real + triangle / kSetupLine * (kSetupLine * kSetupRealCount) + triangle % kSetupLine;
  }
  float* singles(int triangle) {
    return single + triangle / kSetupLine * (kSetupLine * kSetupFloatCount) + triangle % kSetupLine;
  }
};

HWY_INLINE void store_setup(double* out, int field, F64 value) { value.store(out + field * kSetupLine); }
HWY_INLINE void store_setup(float* out, int field, F32 value) { value.store(out + field * kSetupLine); }
template <class T, class V> HWY_INLINE void store_setup(T* out, int field, const V3<V>& v) {
  store_setup(out, field, v.x), store_setup(out, field + 1, v.y), store_setup(out, field + 2, v.z);
}

// An edge function along the primary rays: at pixel (0, 0), and its steps.
HWY_INLINE V3d along_rays(const PrimaryRays& p, const V3d& c) {
  return {dot(broadcast(p.corner), c), dot(broadcast(p.step_x), c), dot(broadcast(p.step_y), c)};
}

// kLanes setups from entry `at` on.
// Source:   Olano and Greer 1997 (resolve-inl.h): the edge functions of a primary ray are linear in the pixel.
void setup_triangles(const Frame& frame, SetupBlock& block, int at) {
  const SceneData& scene = *frame.scene;
  const HitLanes hits{nullptr, i32(0), i32(0), I32::load(block.primitive + at), first_lanes(kLanes), false, block.primitive[at]};
  const TriangleLanes t = load_triangles(scene, hits);
  const V3d eye = broadcast(frame.primary.eye), forward = broadcast(frame.primary.forward);
  const V3d from_eye = t.v0 - eye, side1 = t.v1 - t.v0, side2 = t.v2 - t.v0, normal = cross(side1, side2);
  double* const real = block.reals(at);
  float* const single = block.singles(at);
  store_setup(real, kSetupSum, along_rays(frame.primary, normal));
  store_setup(real, kSetupEdge1, along_rays(frame.primary, cross(t.v2 - eye, -side2)));
  store_setup(real, kSetupEdge2, along_rays(frame.primary, cross(from_eye, side1)));
  store_setup(real, kSetupV0, t.v0);
  store_setup(real, kSetupSide1, side1);
  store_setup(real, kSetupSide2, side2);
  store_setup(real, kSetupDepth, V3d{dot(from_eye, forward), dot(side1, forward), dot(side2, forward)});
  if (reads_textures(frame)) {
    const CornerUv c = corner_uv(scene, t);
    store_setup(real, kSetupU, V3d{c.u0, c.du1, c.du2});
    store_setup(real, kSetupV, V3d{c.v0, c.dv1, c.dv2});
    if (frame.plan.bump) {
      const UvTangents g = uv_tangents(c, side1, side2, normal);
      store_setup(single, kSetupTangentU, g.u);
      store_setup(single, kSetupTangentV, g.v);
    }
  }
  const V3f geometric = geometric_normal(t, normal, from_eye);
  store_setup(single, kSetupGeometric, geometric);
  if (frame.settings.shading != Shading::kFlat) {
    const CornerNormals n = corner_normals(scene, t, geometric);
    store_setup(single, kSetupNormal, n.n0);
    store_setup(single, kSetupNormal + 3, n.d1);
    store_setup(single, kSetupNormal + 6, n.d2);
  }
  store_setup(single, kSetupError, size_error(t, from_eye, side1, side2));
  store_setup(single, kSetupMaterial, float_from_bits(t.bits & i32(kTriangleMaterialMask)));
}

// The setups of kLanes hits: one for all, or gathered.
struct SetupLanes {
  const double* real;
  const float* single;  // of lane 0; bases of the block where the lanes differ
  I32 real_offset, single_offset;
  bool uniform;

  HWY_INLINE F64 d(int field) const {
    return uniform ? f64(real[field * kSetupLine]) : gather(real + field * kSetupLine, real_offset);
  }
  HWY_INLINE F32 f(int field) const {
    return uniform ? f32(single[field * kSetupLine]) : gather(single + field * kSetupLine, single_offset);
  }
  HWY_INLINE V3d d3(int field) const { return {d(field), d(field + 1), d(field + 2)}; }
  HWY_INLINE V3f f3(int field) const { return {f(field), f(field + 1), f(field + 2)}; }
};

HWY_INLINE SetupLanes load_setup(SetupBlock& block, int hit) {
  const uint32_t first = block.triangle_of_hit[hit];
  const I32 triangle = I32::load(block.triangle_of_hit + hit);
  if (all(triangle == i32(first)))
    return {block.reals(static_cast<int>(first)), block.singles(static_cast<int>(first)), i32(0), i32(0), true};
  const I32 line = shift_right<4>(triangle), lane = triangle & i32(kSetupLine - 1);
  return {block.real, block.single, line * i32(kSetupLine * kSetupRealCount) + lane,
          line * i32(kSetupLine * kSetupFloatCount) + lane, false};
}

struct WeightLanes {
  F64 b1, b2, inverse_sum;
  V3f b;          // all three, rounded
  Mask outside;   // clamped
};

// Contract: as resolve_lanes: in [0, 1], vertex 0 where the sum is 0, never NaN. b0 is 1 - b1 - b2.
HWY_INLINE WeightLanes primary_weights(const SetupLanes& s, F64 x, F64 y) {
  const F64 zero = f64(0.0), one = f64(1.0);
  const auto at_pixel = [&](int field) HWY_ATTR { return s.d(field) + s.d(field + 1) * x + s.d(field + 2) * y; };
  const F64 sum = at_pixel(kSetupSum);
  WeightLanes w;
  w.inverse_sum = one / select_eq(sum, zero, one, sum);
  w.b1 = at_pixel(kSetupEdge1) * w.inverse_sum, w.b2 = at_pixel(kSetupEdge2) * w.inverse_sum;
  F64 b0 = one - w.b1 - w.b2;
  // A NaN in b1 or b2 is one in b0, and min_ gives its second operand if the first is not less.
  const F64 least = min_(min_(w.b1, w.b2), b0);
  const F64 good = select_eq(sum, zero, zero, select_lt(least, zero, zero, select_eq(least, least, one, zero)));
  w.outside = to_f32(good) == F32::zero();
  if (any(w.outside)) {
    const F64 c0 = min_(max_(b0, zero), one), c1 = min_(max_(w.b1, zero), one), c2 = min_(max_(w.b2, zero), one);
    const F64 total = c0 + c1 + c2;
    const F64 usable = select_eq(sum, zero, zero, select_lt(zero, total, one, zero));
    const F64 divisor = select_eq(usable, zero, one, total);
    b0 = select_eq(good, zero, select_eq(usable, zero, one, c0 / divisor), b0);
    w.b1 = select_eq(good, zero, select_eq(usable, zero, zero, c1 / divisor), w.b1);
    w.b2 = select_eq(good, zero, select_eq(usable, zero, zero, c2 / divisor), w.b2);
  }
  w.b = {to_f32(b0), to_f32(w.b1), to_f32(w.b2)};
  return w;
}

// How a value that the weights interpolate moves with a pixel step: value = v0 + moved, moved = (e1 d1 + e2 d2) / sum.
struct PixelStep {
  F64 edge1, edge2, sum, inverse_sum;
  HWY_INLINE F64 of(F64 d1, F64 d2, F64 moved) const { return (edge1 * d1 + edge2 * d2 - moved * sum) * inverse_sum; }
};

// axis: 1 for x, 2 for y. The step is as long as what is shaded at once.
HWY_INLINE PixelStep pixel_step(const Frame& frame, const SetupLanes& s, const WeightLanes& w, int axis) {
  return {s.d(kSetupEdge1 + axis), s.d(kSetupEdge2 + axis), s.d(kSetupSum + axis), w.inverse_sum * f64(frame.footprint)};
}

HWY_INLINE UvLanes primary_uv(const Frame& frame, const SetupLanes& s, const WeightLanes& w) {
  const F64 du1 = s.d(kSetupU + 1), du2 = s.d(kSetupU + 2), dv1 = s.d(kSetupV + 1), dv2 = s.d(kSetupV + 2);
  const F64 u = w.b1 * du1 + w.b2 * du2, v = w.b1 * dv1 + w.b2 * dv2;
  const PixelStep x = pixel_step(frame, s, w, 1), y = pixel_step(frame, s, w, 2);
  UvLanes uv;
  uv.u = s.d(kSetupU) + u, uv.v = s.d(kSetupV) + v;
  uv.du_dx = to_f32(x.of(du1, du2, u)), uv.dv_dx = to_f32(x.of(dv1, dv2, v));
  uv.du_dy = to_f32(y.of(du1, du2, u)), uv.dv_dy = to_f32(y.of(dv1, dv2, v));
  if (frame.plan.bump) uv.tangent_u = s.f3(kSetupTangentU), uv.tangent_v = s.f3(kSetupTangentV);
  return uv;
}

// The surfaces of kLanes hits of primary rays, up to their materials.
HWY_INLINE PointLanes primary_point(const Frame& frame, const SetupLanes& s, const PlaceLanes& place) {
  const PrimaryRays& p = frame.primary;
  const F64 x = place.x, y = place.y;
  const WeightLanes w = primary_weights(s, x, y);
  const V3d side1 = s.d3(kSetupSide1), side2 = s.d3(kSetupSide2);
  const V3d moved = side1 * w.b1 + side2 * w.b2, position = s.d3(kSetupV0) + moved;
  PointLanes point;
  point.weight = w.b;
  point.position = to_f32(position);
  point.position_error = max_abs(point.position) * f32(kRoundingError) + s.f(kSetupError);
  point.t = to_f32(s.d(kSetupDepth) + w.b1 * s.d(kSetupDepth + 1) + w.b2 * s.d(kSetupDepth + 2));
  // Back along the ray; from the shaded point where the weights were clamped: the ray may pass below the triangle's horizon.
  const V3f none{F32::zero(), F32::zero(), F32::zero()};
  const V3d direction = broadcast(p.corner) + broadcast(p.step_x) * x + broadcast(p.step_y) * y;
  point.view = unit_or(to_f32(-direction), 0.0f, none);
  if (any(w.outside)) point.view = select(w.outside, unit_or(broadcast(p.eye) - position, point.view), point.view);
  point.geometric = s.f3(kSetupGeometric);
  const Mask no_area = dot(point.geometric, point.geometric) == F32::zero();
  if (any(no_area)) point.geometric = select(no_area, point.view, point.geometric);
  point.normal = point.geometric;
  if (frame.settings.shading != Shading::kFlat)
    point.normal = interpolated_normal({s.f3(kSetupNormal), s.f3(kSetupNormal + 3), s.f3(kSetupNormal + 6)}, w.b.y, w.b.z,
                                       point.geometric);
  if (frame.plan.bounces) {
    const PixelStep dx = pixel_step(frame, s, w, 1), dy = pixel_step(frame, s, w, 2);
    point.dpdx = {dx.of(side1.x, side2.x, moved.x), dx.of(side1.y, side2.y, moved.y), dx.of(side1.z, side2.z, moved.z)};
    point.dpdy = {dy.of(side1.x, side2.x, moved.x), dy.of(side1.y, side2.y, moved.y), dy.of(side1.z, side2.z, moved.z)};
  }
  if (reads_textures(frame)) point.uv = primary_uv(frame, s, w);
  point.material = bits_of(s.f(kSetupMaterial));
  return point;
}

// The triangles of hits [at, at + count) and their setups; misses stand for primitive 0.
void set_up_block(const Frame& frame, const HitBatch& hits, int at, int count, SetupBlock& block) {
  block.triangles = 0;
  for (int i = 0; i < count; ++i) {
    uint32_t primitive = hits.primitive[static_cast<size_t>(at + i)];
    if (primitive == kNoPrimitive) primitive = 0;
    if (block.triangles == 0 || primitive != block.primitive[block.triangles - 1]) block.primitive[block.triangles++] = primitive;
    block.triangle_of_hit[i] = static_cast<uint32_t>(block.triangles - 1);
  }
  // Lanes past the last hit follow it, lanes past the last triangle too.
  for (int i = 0; i < kSetupLine; ++i) block.triangle_of_hit[count + i] = block.triangle_of_hit[count - 1];
  for (int i = 0; i < kSetupLine; ++i) block.primitive[block.triangles + i] = block.primitive[block.triangles - 1];
  for (int i = 0; i < block.triangles; i += kLanes) setup_triangles(frame, block, i);
}

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_PRIMARY_INL_H_
