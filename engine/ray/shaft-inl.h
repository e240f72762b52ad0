// The space that a group of rays sweeps from their origins to their ends: what lies outside, none of them meets. Included once a target.
// Source:   Haines and Wallace 1991, "Shaft Culling for Efficient Ray-Cast Radiosity": the hull of two boxes.
// Contract: a triangle that hit_triangle() accepts for a ray of the group, at t <= t_max, is never outside.
#if defined(SPANRAY_SHAFT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_SHAFT_INL_H_
#undef SPANRAY_SHAFT_INL_H_
#else
#define SPANRAY_SHAFT_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ray/ray_packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

inline constexpr int kShaftRays = 256;  // at most: a cell of the picture

inline constexpr int kMostSides = 6;

struct ShaftBox { float low[3], high[3]; };

// A plane along one axis that touches both boxes: normal_a x_a + normal_b x_b <= limit in the shaft.
struct ShaftSide {
  int row_a, row_b;  // of BvhNode::bounds: the corner of a box that is least along the normal
  float normal_a, normal_b, limit;
};

struct Shaft {
  alignas(64) float start[3][kShaftRays], end[3][kShaftRays];  // whole vectors; lanes past the last ray repeat one of them
  int vectors = 0;
  ShaftBox starts, ends, hull;
  ShaftSide side[kMostSides];
  int sides = 0;
  float reach = 0;  // no coordinate of scene or segments is larger
};

// Along how many axes some rays point forward and others backward.
HWY_INLINE int mixed_axes(const Mask* any_forward, const Mask* any_backward) {
  int n = 0;
  for (int k = 0; k < 3; ++k) n += any(any_forward[k]) && any(any_backward[k]);
  return n;
}

// Rays [first, first + n): where they start and end, and the boxes of both. An end beyond all triangles stands for a farther one.
// Output: false, and nothing else, if the rays point into more than two octants, one of them is none, or numbers are too large or small.
HWY_NOINLINE bool find_segments(const Bvh::Data& data, const RayBatch& rays, int first, int n, Shaft& shaft) {
  float around = 0;
  for (int k = 0; k < 3; ++k) around = std::max(around, std::max(std::fabs(data.bounds_min[k]), std::fabs(data.bounds_max[k])));
  if (!(around > 1e-9f && around < 1e9f)) return false;
  const F32 far = f32(1e9f);
  F32 low[3] = {far, far, far}, high[3] = {-far, -far, -far}, end_low[3] = {far, far, far}, end_high[3] = {-far, -far, -far};
  Mask good = first_lanes(kLanes), any_forward[3], any_backward[3];
  for (int k = 0; k < 3; ++k) any_forward[k] = any_backward[k] = !good;
  shaft.vectors = 0;
  for (int i = 0; i < n; i += kLanes, ++shaft.vectors) {
    RawRays r = load_raw(rays, first + i, n - i < kLanes ? n - i : kLanes);
    const Mask used = first_lanes(n - i);
    F32 size = F32::zero(), away = f32(around);
    for (int k = 0; k < 3; ++k) {
      r.origin[k] = select(used, r.origin[k], f32(rays.origin[k][static_cast<size_t>(first + i)]));
      r.direction[k] = select(used, r.direction[k], f32(rays.direction[k][static_cast<size_t>(first + i)]));
      size = cull_max(abs_(r.direction[k]), size), away = cull_max(abs_(r.origin[k]), away);
      good = good & (abs_(r.origin[k]) < far) & (abs_(r.direction[k]) < far);
      any_forward[k] = any_forward[k] | (r.direction[k] > F32::zero()), any_backward[k] = any_backward[k] | (r.direction[k] < F32::zero());
    }
    if (i == 0 && mixed_axes(any_forward, any_backward) > 1) return false;
    const F32 t_max = select(used, r.t_max, f32(rays.t_max[static_cast<size_t>(first + i)]));
    good = good & (size > f32(1e-9f)) & (t_max >= F32::zero());
    const F32 t = cull_min(f32(2.0f) * away / size, t_max);
    for (int k = 0; k < 3; ++k) {
      const F32 end = r.origin[k] + t * r.direction[k];
      low[k] = cull_min(r.origin[k], low[k]), high[k] = cull_max(r.origin[k], high[k]);
      end_low[k] = cull_min(end, end_low[k]), end_high[k] = cull_max(end, end_high[k]);
      r.origin[k].store(shaft.start[k] + i), end.store(shaft.end[k] + i);
    }
  }
  if (!all(good) || mixed_axes(any_forward, any_backward) > 1) return false;
  shaft.reach = around;
  for (int k = 0; k < 3; ++k) {
    ShaftBox &a = shaft.starts, &b = shaft.ends;
    a.low[k] = least_lane(low[k]), a.high[k] = greatest_lane(high[k]), b.low[k] = least_lane(end_low[k]), b.high[k] = greatest_lane(end_high[k]);
    shaft.reach = std::max({shaft.reach, -a.low[k], a.high[k], -b.low[k], b.high[k]});
    // On the side of the origins exactly, for rays start just off their surfaces: there (bound - origin) * reciprocal of slab() is less than
    // 0 for every box beyond. Ends are rounded.
    const bool forward = !any(any_backward[k]), backward = !any(any_forward[k]);
    shaft.hull.low[k] = forward ? a.low[k] - 1e-36f : std::min(a.low[k], b.low[k]);
    shaft.hull.high[k] = backward ? a.high[k] + 1e-36f : std::max(a.high[k], b.high[k]);
    if (!forward) shaft.hull.low[k] -= shaft.reach * 0x1p-18f;
    if (!backward) shaft.hull.high[k] += shaft.reach * 0x1p-18f;
  }
  return true;
}

// Lines in the plane of two axes that have both boxes on one side: through corners of one kind, with a normal that points away from the
// boxes there.
HWY_INLINE void add_sides(int axis_a, int axis_b, Shaft& shaft) {
  const float margin = shaft.reach * 0x1p-18f;  // for rounded ends, and the roundings here and in shaft_boxes()
  for (int corner = 0; corner < 4; ++corner) {
    const bool up_a = (corner & 1) != 0, up_b = (corner & 2) != 0;
    const auto at = [&](const ShaftBox& box, int k, bool up) { return up ? box.high[k] : box.low[k]; };
    const float a0 = at(shaft.starts, axis_a, up_a), b0 = at(shaft.starts, axis_b, up_b), a1 = at(shaft.ends, axis_a, up_a), b1 = at(shaft.ends, axis_b, up_b);
    float normal_a = b1 - b0, normal_b = a0 - a1;
    if (up_a ? normal_a < 0 : normal_a > 0) normal_a = -normal_a, normal_b = -normal_b;
    if (!(up_b ? normal_b > 0 : normal_b < 0) || !(std::fabs(normal_a) > 1e-20f) || shaft.sides == kMostSides) continue;
    const float limit = std::max(normal_a * a0 + normal_b * b0, normal_a * a1 + normal_b * b1) + (std::fabs(normal_a) + std::fabs(normal_b)) * margin;
    shaft.side[shaft.sides++] = {up_a ? axis_a : axis_a + 3, up_b ? axis_b : axis_b + 3, normal_a, normal_b, limit};
  }
}

HWY_NOINLINE bool make_shaft(const Bvh::Data& data, const RayBatch& rays, int first, int n, Shaft& shaft) {
  if (!find_segments(data, rays, first, n, shaft)) return false;
  shaft.sides = 0;
  add_sides(0, 1, shaft), add_sides(1, 2, shaft), add_sides(2, 0, shaft);
  return true;
}

// Of kLanes8 boxes, those that are not outside. row(r): bounds as of BvhNode.
template <class Row> HWY_INLINE uint32_t shaft_boxes(const Shaft& shaft, const Row& row) {
  Mask8 inside = f8(shaft.hull.low[0]) <= row(3);
  for (int k = 0; k < 3; ++k) {
    if (k > 0) inside = inside & (f8(shaft.hull.low[k]) <= row(k + 3));
    inside = inside & (row(k) <= f8(shaft.hull.high[k]));
  }
  for (int i = 0; i < shaft.sides; ++i) {
    const ShaftSide& s = shaft.side[i];
    inside = inside & (row(s.row_a) * f8(s.normal_a) + row(s.row_b) * f8(s.normal_b) <= f8(s.limit));
  }
  return to_bits(inside);
}

HWY_INLINE uint32_t shaft_children(const Shaft& shaft, const BvhNode& node) {
  uint32_t bits = 0;
  for (int s = 0; s < kBvhWidth; s += kLanes8) bits |= shaft_boxes(shaft, [&](int r) HWY_ATTR { return F8::load(node.bounds[r] + s); }) << s;
  return bits;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_SHAFT_INL_H_
