// Surfaces of primary rays: everything that depends on the triangle alone once a triangle and cell of the picture, in double; the rest,
// linear in the pixel, in float. Include inside a *_kernel.cpp (simd/dispatch.h), after the project headers.
#if defined(SPANRAY_PRIMARY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_PRIMARY_INL_H_
#undef SPANRAY_PRIMARY_INL_H_
#else
#define SPANRAY_PRIMARY_INL_H_
#endif

#include "shade/plane-inl.h"
#include "shade/place-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace surface_lanes {

// The planes of kLanes hits: a few, by broadcast into the lanes of each, or gathered.
template <int kCount, bool kAllInside = false> struct FewPlanes {
  static constexpr bool kInside = kAllInside;  // in each the whole cell (kPlaneInside)
  const float* single[kCount];
  const double* real[kCount];
  Mask lanes[kCount];  // not of the first

  template <int kFirst, bool kFirstInside = false> HWY_INLINE FewPlanes<kFirst, kFirstInside> first() const {
    FewPlanes<kFirst, kFirstInside> r;
    for (int i = 0; i < kFirst; ++i) r.single[i] = single[i], r.real[i] = real[i], r.lanes[i] = lanes[i];
    return r;
  }
  HWY_INLINE F32 f(int field) const {
    F32 r = f32(single[0][field * kPlaneLine]);
    for (int i = 1; i < kCount; ++i) r = select(lanes[i], f32(single[i][field * kPlaneLine]), r);
    return r;
  }
  HWY_INLINE F64 d(int field) const {
    F64 r = f64(real[0][field * kPlaneLine]);
    for (int i = 1; i < kCount; ++i) r = select(lanes[i], f64(real[i][field * kPlaneLine]), r);
    return r;
  }
  HWY_INLINE bool mapped() const {
    bool r = false;
    for (int i = 0; i < kCount; ++i) r |= single[i][kPlaneMapped * kPlaneLine] != 0.0f;
    return r;
  }
};
struct ManyPlanes {
  static constexpr bool kInside = false;
  const float* single;  // bases of the block
  const double* real;
  I32 single_offset, real_offset;
  HWY_INLINE F32 f(int field) const { return gather(single + field * kPlaneLine, single_offset); }
  HWY_INLINE bool mapped() const { return true; }  // asking costs as much as it saves
  HWY_INLINE F64 d(int field) const { return gather(real + field * kPlaneLine, real_offset); }
};
// Of planes that stand within four lines: permutations of these instead of gathers.
struct NearPlanes {
  static constexpr bool kInside = false;
  const float* single;  // first line
  int stride;           // from line to line
  I32 plane;            // in these lines
  Mask high;            // in the third or fourth
  const double* real;
  I32 real_offset;
  HWY_INLINE F32 f(int field) const {
    const float* const line = single + field * kPlaneLine;
    const F32 a = lookup32(F32::load(line), F32::load(line + stride), plane);
    return select(high, lookup32(F32::load(line + 2 * stride), F32::load(line + 3 * stride), plane), a);
  }
  HWY_INLINE bool mapped() const { return true; }  // asking costs as much as it saves
  HWY_INLINE F64 d(int field) const { return gather(real + field * kPlaneLine, real_offset); }
};
template <class Planes> HWY_INLINE V3f plane3(const Planes& p, int field) { return {p.f(field), p.f(field + 1), p.f(field + 2)}; }

// Where hits lie from the anchor of their planes, in pixels, and the inverse of the relative 1 / depth there.
struct PlanePoint {
  F32 dx, dy, inverse;
  HWY_INLINE F32 moved(F32 per_x, F32 per_y) const { return mul_add(per_y, dy, per_x * dx) * inverse; }
  // The derivative of what has moved by `moved`, by a step of one pixel: (per - moved * step) / s, step of s.
  HWY_INLINE F32 slope(F32 per, F32 moved, F32 step) const { return neg_mul_add(moved, step, per) * inverse; }
};

template <class Planes> HWY_INLINE V3f moved3(const Planes& p, const PlanePoint& at, int field) {
  return {at.moved(p.f(field + 3), p.f(field + 6)), at.moved(p.f(field + 4), p.f(field + 7)), at.moved(p.f(field + 5), p.f(field + 8))};
}

template <class Planes> HWY_INLINE UvLanes primary_uv(const Frame& frame, const Planes& p, const PlanePoint& at, F32 step_x, F32 step_y) {
  const F32 side = f32(static_cast<float>(frame.footprint));
  UvLanes uv;
  const F32 ux = p.f(kPlaneUv + 2), vx = p.f(kPlaneUv + 3), uy = p.f(kPlaneUv + 4), vy = p.f(kPlaneUv + 5);
  const F32 u = at.moved(ux, uy), v = at.moved(vx, vy);
  uv.u = p.f(kPlaneUv) + u, uv.v = p.f(kPlaneUv + 1) + v;
  uv.whole_u = p.f(kPlaneUv + 6), uv.whole_v = p.f(kPlaneUv + 7);
  uv.du_dx = at.slope(ux, u, step_x) * side, uv.dv_dx = at.slope(vx, v, step_x) * side;
  uv.du_dy = at.slope(uy, u, step_y) * side, uv.dv_dy = at.slope(vy, v, step_y) * side;
  if (frame.plan.bump) uv.tangent_u = plane3(p, kPlaneTangentU), uv.tangent_v = plane3(p, kPlaneTangentV);
  return uv;
}

// The surfaces of kLanes hits of primary rays, up to their materials. Returns the lanes where that is so: the others look past an edge of
// their triangle, or so near to one that rounding could carry their position over it, behind a wall that meets it there. These are
// resolved as hits of other rays are, and moved into the triangle (resolve_kernel.cpp).
// Contract: positions on the triangle, but for position_error off its plane; weights in [0, 1]. Errors are those of moving the pixel by
//           2^-19 and of rounding to float. t is of double precision, rounded.
template <class Planes>
HWY_INLINE Mask primary_point(const Frame& frame, const Planes& p, I32 pixel, const OffsetLanes& offset, PointLanes& point) {
  const F32 zero = F32::zero(), one = f32(1.0f);
  PlanePoint at;
  at.dx = to_f32((pixel & i32(0xffff)) - bits_of(p.f(kPlaneAnchor))) + offset.x;
  at.dy = to_f32(shift_right_logical<16>(pixel) - bits_of(p.f(kPlaneAnchor + 1))) + offset.y;
  const F64 step_x = p.d(kPlaneStepX), step_y = p.d(kPlaneStepY), s = f64(1.0) + (step_x * to_f64(at.dx) + step_y * to_f64(at.dy));
  const F32 single_s = to_f32(s);
  at.inverse = one / single_s;
  if (frame.plan.depths) {
    const F64 r = to_f64(at.inverse);
    const F64 two = f64(2.0), better = r * (two - s * r);  // Newton's method: 46 bits, then all
    point.t = to_f32(p.d(kPlaneDepth) * (better * (two - s * better)));
  }

  if (!Planes::kInside || frame.plan.weights || frame.settings.shading == Shading::kGouraud) {
    const F32 b1 = p.f(kPlaneWeight) + at.moved(p.f(kPlaneWeight + 2), p.f(kPlaneWeight + 4));
    const F32 b2 = p.f(kPlaneWeight + 1) + at.moved(p.f(kPlaneWeight + 3), p.f(kPlaneWeight + 5));
    point.weight = {one - b1 - b2, b1, b2};
  }

  const V3f moved = moved3(p, at, kPlanePosition);
  point.position = plane3(p, kPlanePosition) + moved;
  const F32 reach = mul_add(p.f(kPlaneError + 2), abs_(at.dy), p.f(kPlaneError + 1) * abs_(at.dx)) * at.inverse;
  point.position_error = mul_add(max_abs(point.position), f32(kPositionRounding), reach) + p.f(kPlaneError);
  Mask good = first_lanes(kLanes);
  point.geometric = plane3(p, kPlaneGeometric);
  if (!Planes::kInside) {
    const F32 margin = mul_add(point.position_error, p.f(kPlaneSlimness), f32(0x1p-20f));
    good = (single_s > zero) & (point.weight.x >= margin) & (point.weight.y >= margin) & (point.weight.z >= margin) &
           (point.position_error < f32(0x1p100f)) & (dot(point.geometric, point.geometric) > zero);
  }

  const PrimaryRays& rays = frame.primary;
  const V3f none{zero, zero, zero};
  const auto single = [](const float (&v)[3]) HWY_ATTR { return V3f{f32(v[0]), f32(v[1]), f32(v[2])}; };
  point.view = none;
  if (frame.plan.views)
    point.view = unit_or(plane3(p, kPlaneView) - single(rays.single_step_x) * at.dx - single(rays.single_step_y) * at.dy, 0.0f, none);
  point.normal = point.geometric;
  if (frame.plan.normals && frame.settings.shading != Shading::kFlat)
    point.normal = normal_of_blend(frame, plane3(p, kPlaneNormal) + moved3(p, at, kPlaneNormal), point.geometric);
  point.mapped = reads_textures(frame) && p.mapped();
  if (!frame.plan.bounces && !point.mapped) {
    point.material = bits_of(p.f(kPlaneMaterial));
    return good;
  }
  const F32 single_x = to_f32(step_x), single_y = to_f32(step_y);
  if (frame.plan.bounces) {
    const F32 side = f32(static_cast<float>(frame.footprint));
    const auto by_pixel = [&](F32 step, int field) HWY_ATTR {
      const V3f per = plane3(p, field);
      return V3f{at.slope(per.x, moved.x, step), at.slope(per.y, moved.y, step), at.slope(per.z, moved.z, step)} * side;
    };
    point.dpdx = by_pixel(single_x, kPlanePosition + 3), point.dpdy = by_pixel(single_y, kPlanePosition + 6);
  }
  if (point.mapped) point.uv = primary_uv(frame, p, at, single_x, single_y);
  point.material = bits_of(p.f(kPlaneMaterial));
  return good;
}

// What the triangles carry of that many lights: to(light, factor) says where kLanes floats of SurfaceBatch::triangle_light go.
template <class Planes, class To>
HWY_INLINE void put_triangle_light(const Frame& frame, int lights, const To& to, const Planes& p, const V3f& weight) {
  const bool corners = frame.settings.shading == Shading::kGouraud;
  int field = kPlaneLight;
  for (int i = 0; i < lights; ++i)
    for (int factor = 0; factor < 2; ++factor, field += corners ? 3 : 1) {
      if (factor == 1 && !frame.plan.specular) continue;
      F32 light = p.f(field);
      if (corners) light = formula::shading::gouraud::interpolate(as_vec3(weight), light, p.f(field + 1), p.f(field + 2));
      light.store(to(i, factor));
    }
}

// visit(planes) with the planes of hits [hit, hit + kLanes) of the block.
template <class Visit> HWY_INLINE void with_planes(PlaneBlock& block, int hit, const Visit& visit) {
  constexpr int kMost = 4;  // beyond, gathers are as fast
  const I32 plane = I32::load(block.plane_of_hit + hit);
  FewPlanes<kMost> few;
  int count = 0;
  for (uint32_t left = (1u << kLanes) - 1; left != 0; ++count) {
    if (count == kMost) {
      const I32 line = shift_right<4>(plane), lane = plane & i32(kPlaneLine - 1);
      const I32 real_offset = line * i32(kPlaneLine * kPlaneRealCount) + lane;
      if constexpr (kHasLookup32) {
        constexpr int kLines = 4, kMostLine = kPlaneHits / kPlaneLine - kLines;
        const int lowest = static_cast<int>(min_of_lanes(line)), first = lowest < kMostLine ? lowest : kMostLine;
        if (all(line < i32(first + kLines)))
          return visit(NearPlanes{block.single + first * kPlaneLine * block.fields, kPlaneLine * block.fields, plane - i32(first * kPlaneLine),
                                  line > i32(first + 1), block.real, real_offset});
      }
      return visit(ManyPlanes{block.single, block.real, line * i32(kPlaneLine * block.fields) + lane, real_offset});
    }
    const uint32_t first = block.plane_of_hit[hit + __builtin_ctz(left)];
    few.single[count] = block.singles(static_cast<int>(first)), few.real[count] = block.reals(static_cast<int>(first));
    few.lanes[count] = plane == i32(first);
    left &= ~to_bits(few.lanes[count]);
  }
  if (count == 1) return few.single[0][kPlaneInside * kPlaneLine] != 0.0f ? visit(few.first<1, true>()) : visit(few.first<1>());
  if (count == 2) return visit(few.first<2>());
  for (; count < kMost; ++count) few.single[count] = few.single[0], few.real[count] = few.real[0], few.lanes[count] = few.lanes[0];
  visit(few);
}

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_PRIMARY_INL_H_
