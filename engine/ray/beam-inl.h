// The rays of a packet as one interval, which culls the eight children of a node at once. Included once a target.
// Source:   Boulos, Wald, Shirley 2006, "Geometric and Arithmetic Culling Methods for Entire Ray Packets" (interval arithmetic).
// Contract: never culls a child that a ray of the packet meets, by slab()'s arithmetic: subtraction and multiplication by a number of
//           one sign keep order also after rounding, so the least and greatest results are at the ends of the intervals.
#if defined(SPANRAY_BEAM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_BEAM_INL_H_
#undef SPANRAY_BEAM_INL_H_
#else
#define SPANRAY_BEAM_INL_H_
#endif

#include "ray/ray_packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// One axis along which all rays point to one side and have finite reciprocals.
struct BeamAxis {
  int near_row, far_row;          // of BvhNode::bounds
  float near_origin, far_origin;  // the ends that give the least entry, the greatest exit
  float inv_least, inv_greatest;
};

struct Beam {
  BeamAxis axis[3];
  int axes = 0;
  float limit;  // the greatest of the rays
};

HWY_INLINE Beam make_beam(const RayPacket& p) {
  Beam b;
  b.limit = greatest_lane(p.limit);
  for (int k = 0; k < 3; ++k) {
    const uint32_t signs = to_bits(p.negative[k]);
    const bool forward = signs == 0;
    if ((!forward && signs != (1u << kLanes) - 1) || !all(abs_(p.inv_far[k]) <= f32(kLargestT))) continue;
    const float least = least_lane(p.origin[k]), greatest = greatest_lane(p.origin[k]);
    BeamAxis& a = b.axis[b.axes++];
    a.near_row = forward ? k : k + 3, a.far_row = forward ? k + 3 : k;
    a.near_origin = forward ? greatest : least, a.far_origin = forward ? least : greatest;
    // |inv_near| <= |inv_far|
    a.inv_least = least_lane(forward ? p.inv_near[k] : p.inv_far[k]);
    a.inv_greatest = greatest_lane(forward ? p.inv_far[k] : p.inv_near[k]);
  }
  return b;
}

// Of kLanes8 boxes, those that some ray may meet in [0, limit]. bound(row): rows as of BvhNode::bounds.
template <class Bound> HWY_INLINE uint32_t beam_boxes(const Beam& beam, const Bound& bound) {
  F8 near = f8(0.0f), far = f8(beam.limit);
  for (int i = 0; i < beam.axes; ++i) {
    const BeamAxis& a = beam.axis[i];
    const F8 to_near = bound(a.near_row) - f8(a.near_origin), to_far = bound(a.far_row) - f8(a.far_origin);
    near = cull_max(cull_min(to_near * f8(a.inv_least), to_near * f8(a.inv_greatest)), near);
    far = cull_min(cull_max(to_far * f8(a.inv_least), to_far * f8(a.inv_greatest)), far);
  }
  return to_bits(near <= far);
}

HWY_INLINE uint32_t beam_children(const BvhNode& node, const Beam& beam) {
  uint32_t bits = 0;
  for (int s = 0; s < kBvhWidth; s += kLanes8) bits |= beam_boxes(beam, [&](int row) HWY_ATTR { return F8::load(node.bounds[row] + s); }) << s;
  return bits;
}

// The triangles of a leaf, by their boxes.
HWY_INLINE uint32_t beam_triangles(const TriangleBlock& block, const Beam& beam) {
  uint32_t bits = 0;
  for (int s = 0; s < kBvhWidth; s += kLanes8)
    bits |= beam_boxes(beam, [&](int row) HWY_ATTR {
              const int k = row % 3;
              const F8 v0 = F8::load(block.vertex[0][k] + s), v1 = F8::load(block.vertex[1][k] + s), v2 = F8::load(block.vertex[2][k] + s);
              return row < 3 ? cull_min(cull_min(v0, v1), v2) : cull_max(cull_max(v0, v1), v2);
            }) << s;
  return bits;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_BEAM_INL_H_
