// Triangles against a packet: lanes are rays, one triangle at a time. Included once a target.
// Contract: as candidates(): lanes only sort out, hit_triangle() decides, one lane at a time or in lanes of double with its bits.
#if defined(SPANRAY_PACKET_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_PACKET_LEAF_INL_H_
#undef SPANRAY_PACKET_LEAF_INL_H_
#else
#define SPANRAY_PACKET_LEAF_INL_H_
#endif

#include "ray/ray_packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

HWY_INLINE F32 cull_mul_add(F32 a, F32 b, F32 c) { return {hn::MulAdd(a.v, b.v, c.v)}; }          // one or two roundings
HWY_INLINE F32 cull_neg_mul_add(F32 a, F32 b, F32 c) { return {hn::NegMulAdd(a.v, b.v, c.v)}; }

// Coordinates of one vertex along the axes of each lane.
struct AlongAxes { F32 x, y, z; };
HWY_INLINE AlongAxes vertex_along(const RayPacket& p, const TriangleBlock& block, int vertex, int triangle) {
  const float(&v)[3][kBvhWidth] = block.vertex[vertex];
  if (p.kz >= 0) {
    const int kx = p.kz == 2 ? 0 : p.kz + 1, ky = kx == 2 ? 0 : kx + 1;
    return {f32(v[kx][triangle]), f32(v[ky][triangle]), f32(v[p.kz][triangle])};
  }
  const F32 a = f32(v[0][triangle]), b = f32(v[1][triangle]), c = f32(v[2][triangle]);
  return {by_axis(p, b, c, a), by_axis(p, c, a, b), by_axis(p, a, b, c)};
}

// Rays that might hit a triangle at no more than their limit, and those of them that surely do: hit_triangle() would accept
// them. For any hit also at less than the limit; for the closest, low <= t <= high for its t.
struct LaneHits { uint32_t maybe, sure; };
enum class SureHits { kOfAny, kOfClosest };

// Sure: inside by more than the error of the edge functions, and every vertex in front of the origin. Any hit: and nearer than the limit, also
// after rounding: t lies between those of the vertices, whose numbers here are at most 10 roundings too small.
// Closest: see bounds_on_t().
template <SureHits kSure>
HWY_INLINE LaneHits triangle_lanes(const RayPacket& p, const TriangleBlock& block, int triangle, BoundsOnT<F32>* distances = nullptr) {
  F32 x[3], y[3], t[3];
  for (int v = 0; v < 3; ++v) {
    const AlongAxes a = vertex_along(p, block, v, triangle);
    const F32 z = a.z - p.origin_z;
    x[v] = cull_neg_mul_add(p.shear_x32, z, a.x - p.origin_x);
    y[v] = cull_neg_mul_add(p.shear_y32, z, a.y - p.origin_y);
    t[v] = z * p.inv_z;
  }
  const F32 edge_u = cull_neg_mul_add(x[1], y[2], x[2] * y[1]);
  const F32 edge_v = cull_neg_mul_add(x[2], y[0], x[0] * y[2]);
  const F32 edge_w = cull_neg_mul_add(x[0], y[1], x[1] * y[0]);
  const F32 sum = abs_(x[0]) + abs_(y[0]) + (abs_(x[1]) + abs_(y[1])) + (abs_(x[2]) + abs_(y[2]));
  const F32 error = cull_mul_add(p.edge_slope, sum, p.edge_offset);
  const F32 least = cull_min(cull_min(edge_u, edge_v), edge_w), greatest = cull_max(cull_max(edge_u, edge_v), edge_w);
  const F32 first = cull_min(cull_min(t[0], t[1]), t[2]), last = cull_max(cull_max(t[0], t[1]), t[2]);
  const Mask miss = ((least < -error) & (greatest > error)) | (first > p.limit) | (last < F32::zero());
  LaneHits hits{~to_bits(miss) & ((1u << kLanes) - 1), 0};
  if (hits.maybe == 0) return hits;
  const Mask inside = ((least > error) | (greatest < -error)) & (first > F32::zero());
  if constexpr (kSure == SureHits::kOfAny) {
    hits.sure = hits.maybe & to_bits(inside & (last * f32(1 + 0x1p-20f) < p.limit));
  } else {
    *distances = bounds_on_t<F32, f32>(edge_u, edge_v, edge_w, t, error, first, last, last);
    hits.sure = hits.maybe & to_bits(inside & (distances->size > f32(kLeastSureSize)));
  }
  return hits;
}

HWY_INLINE F64 fmin_(F64 a, F64 b) { return select_lt(b, a, b, a); }  // std::min, std::max: a unless b is less, greater
HWY_INLINE F64 fmax_(F64 a, F64 b) { return select_lt(a, b, b, a); }

// hit_triangle() of all lanes with one triangle: its operations in its order. Lanes that see it edge-on are left to hit_triangle() itself:
// their t is not set.
struct ExactLanes { F64 t; uint32_t hit, edge_on; };
HWY_INLINE ExactLanes exact_lanes(const RayPacket& p, const TriangleBlock& block, int triangle) {
  F64 x[3], y[3], z[3];
  const F64 zero = f64(0.0);
  const ShearLanes shear = exact_shear(p);
  for (int v = 0; v < 3; ++v) {
    const AlongAxes a = vertex_along(p, block, v, triangle);
    z[v] = to_f64(a.z) - to_f64(p.origin_z);
    x[v] = (to_f64(a.x) - to_f64(p.origin_x)) - shear.x * z[v];
    y[v] = (to_f64(a.y) - to_f64(p.origin_y)) - shear.y * z[v];
  }
  const F64 u = x[2] * y[1] - y[2] * x[1];
  const F64 v = x[0] * y[2] - y[0] * x[2];
  const F64 w = x[1] * y[0] - y[1] * x[0];
  const F64 det = u + v + w;
  const F64 least = fmin_(fmin_(u, v), w), greatest = fmax_(fmax_(u, v), w);  // finite: coordinates are floats
  ExactLanes out;
  out.edge_on = 0;
  out.hit = ~(bits_less(least, zero) & bits_less(zero, greatest)) & (bits_less(det, zero) | bits_less(zero, det));
  if (out.hit == 0) return out;
  F64 s = zero;
  for (int i = 0; i < 3; ++i) s = fmax_(s, fmax_(abs_(x[i]), abs_(y[i])));
  out.edge_on = out.hit & ~bits_less(f64(kEdgeOn) * s * s, abs_(det));

  const F64 z_min = fmin_(fmin_(z[0], z[1]), z[2]), z_max = fmax_(fmax_(z[0], z[1]), z[2]);
  const F64 z_raw = (u * z[0] + v * z[1] + w * z[2]) / det;
  const F64 z_hit = select_lt(z_raw, z_min, z_min, select_lt(z_max, z_raw, z_max, z_raw));
  const uint32_t forward = bits_less(zero, p.direction_z);
  const uint32_t front = (forward & bits_less(zero, z_min)) | (~forward & bits_less(z_max, zero));
  if ((out.hit & ~front) != 0) {
    constexpr double e = 0x1p-53;
    const F64 reach = fmax_(abs_(z_min), abs_(z_max)), m = s + reach;
    const F64 edge_error = f64(40 * e) * m * (s + f64(8 * e) * m);
    const F64 size = abs_(det), error = f64(3) * edge_error * reach + f64(8 * e) * size * reach;
    out.hit &= front | (bits_less(error, select_lt(zero, p.direction_z, z_hit, -z_hit) * size));
    if (out.hit == 0) return out;
  }
  F32 near = F32::zero(), far = f32(kLargestT);
  for (int k = 0; k < 3; ++k) {
    const float a = block.vertex[0][k][triangle], b = block.vertex[1][k][triangle], c = block.vertex[2][k][triangle];
    const F32 low = f32(std::min(std::min(a, b), c)), high = f32(std::max(std::max(a, b), c));
    const F32 n = (select(p.negative[k], high, low) - p.origin[k]) * p.inv_near[k];
    const F32 f = (select(p.negative[k], low, high) - p.origin[k]) * p.inv_far[k];
    near = select(n > near, n, near);
    far = select(f < far, f, far);
  }
  const F64 t = z_hit / p.direction_z, near64 = to_f64(near), largest = f64(static_cast<double>(kLargestT));
  out.t = select_lt(t, near64, near64, select_lt(largest, t, largest, t));
  out.hit &= to_bits(near <= far);
  return out;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_PACKET_LEAF_INL_H_
