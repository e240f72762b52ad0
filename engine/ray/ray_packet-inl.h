// kLanes rays side by side, prepared together: lanes are rays. Included once a target.
// Source:   as prepare_ray(), whose bits every lane has.
#if defined(SPANRAY_RAY_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_RAY_PACKET_INL_H_
#undef SPANRAY_RAY_PACKET_INL_H_
#else
#define SPANRAY_RAY_PACKET_INL_H_
#endif

#include <bit>
#include <cstdint>
#include <limits>

#include "ray/traverse-inl.h"
#include "simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// The machine's own, for culling only: see cull_min().
HWY_INLINE F32 cull_min(F32 a, F32 b) { return {hn::Min(a.v, b.v)}; }
HWY_INLINE F32 cull_max(F32 a, F32 b) { return {hn::Max(a.v, b.v)}; }
HWY_INLINE float least_lane(F32 a) { return hn::GetLane(hn::MinOfLanes(DF(), a.v)); }
HWY_INLINE float greatest_lane(F32 a) { return hn::GetLane(hn::MaxOfLanes(DF(), a.v)); }

struct RayPacket {
  F32 origin[3], inv_near[3], inv_far[3];  // TraceRay
  F32 limit;                               // round_up() of t_max, then of the best hit
  F64 direction_z, t_max;
  Mask negative[3];
  I32 from;                                // the triangles that they leave, or kNoPrimitive
  uint32_t all_from;                       // the one that all leave; kNoPrimitive if there is none
  uint32_t valid;                          // the other lanes repeat a valid one
  int mixed_axes;                          // along which directions have both signs
  int near_row[3], far_row[3];             // of BvhNode::bounds, along the other axes
  // Axes of each lane (TraceRay::kx, ky, kz), and the same of all lanes or -1.
  Mask z_is[3];
  int kz;
  F32 origin_x, origin_y, origin_z, inv_z;   // along them
  F32 along_x, along_y, along_z;             // directions, not scaled
  F32 shear_x32, shear_y32, edge_slope, edge_offset;  // LaneRay
};

// 2^e and 2^-e for numbers m * 2^e, m in [1, 2); normal and positive.
struct ScaleLanes { F64 size, to_one; };
HWY_INLINE ScaleLanes scale_of(F64 a) {
  ScaleLanes r;
  for (int h = 0; h < kHalves; ++h) {
    const DDI d;
    const auto exponent = hn::ShiftRight<52>(hn::BitCast(d, a.v[h]));
    r.size.v[h] = hn::BitCast(DD(), hn::ShiftLeft<52>(exponent));
    r.to_one.v[h] = hn::BitCast(DD(), hn::ShiftLeft<52>(hn::Sub(hn::Set(d, 2046), exponent)));
  }
  return r;
}

HWY_INLINE F32 round_up_lanes(F64 t) {
  const F32 f = to_f32(t);
  const F32 up = select(to_f64(f) < t, float_from_bits(bits_of(f) + i32(1)), f);
  return select(t < f64(static_cast<double>(kLargestT)), up, f32(kLargestT));
}

// No more than t.
HWY_INLINE F32 round_down_lanes(F64 t) {
  return to_f32(t) * f32(1 - 0x1p-23f);
}

// One of three by the axis along which the direction is largest.
HWY_INLINE F32 by_axis(const RayPacket& p, F32 if0, F32 if1, F32 if2) { return select(p.z_is[2], if2, select(p.z_is[1], if1, if0)); }

struct RawRays { F32 origin[3], direction[3], t_max, largest; };  // largest: magnitude of a component of the direction

// n rays of the batch, n in [1, kLanes]; further lanes are no rays.
HWY_INLINE RawRays load_raw(const RayBatch& rays, int first, int n) {
  RawRays r;
  const auto load = [&](const AlignedBuffer<float>& from) HWY_ATTR {
    if (n == kLanes) return F32::load(from.data() + first);
    alignas(64) float lanes[kLanes] = {};
    for (int i = 0; i < n; ++i) lanes[i] = from[static_cast<size_t>(first + i)];
    return F32::load(lanes);
  };
  for (int k = 0; k < 3; ++k) r.origin[k] = load(rays.origin[k]), r.direction[k] = load(rays.direction[k]);
  r.t_max = load(rays.t_max);
  return r;
}

// The rays that prepare_ray() accepts; the other lanes then repeat the first of them.
HWY_INLINE uint32_t mend_raw(RawRays& r) {
  const F32 largest_float = f32(kLargestT);
  Mask good = r.t_max >= F32::zero();
  r.largest = F32::zero();
  for (int k = 0; k < 3; ++k) {
    good = good & (abs_(r.direction[k]) <= largest_float) & (abs_(r.origin[k]) <= largest_float);
    r.largest = cull_max(r.largest, abs_(r.direction[k]));
  }
  good = good & (r.largest > F32::zero());
  const uint32_t bits = to_bits(good);
  if (bits == (1u << kLanes) - 1 || bits == 0) return bits;
  const auto mend = [&](F32& v) HWY_ATTR {
    alignas(64) float lanes[kLanes];
    v.store(lanes);
    v = select(good, v, f32(lanes[std::countr_zero(bits)]));
  };
  for (int k = 0; k < 3; ++k) mend(r.origin[k]), mend(r.direction[k]);
  mend(r.t_max), mend(r.largest);
  return bits;
}

// The triangles that n rays leave; the other lanes repeat the first.
HWY_INLINE I32 from_lanes(const RayBatch& rays, int first, int n) {
  if (rays.from.empty()) return i32(kNoPrimitive);
  const uint32_t* const from = rays.from.data() + first;
  if (n == kLanes) return I32::load(from);
  alignas(64) uint32_t lanes[kLanes];
  for (int i = 0; i < kLanes; ++i) lanes[i] = from[i < n ? i : 0];
  return I32::load(lanes);
}

HWY_INLINE void load_from(const RayBatch& rays, int first, int n, RayPacket& p) {
  p.from = from_lanes(rays, first, n);
  const uint32_t all_from = static_cast<uint32_t>(first_lane(p.from));
  p.all_from = all(p.from == i32(all_from)) ? all_from : kNoPrimitive;
}

// What prepare_ray() finds out about one axis: d is the scaled direction.
HWY_INLINE void prepare_axis(RayPacket& p, int k, F32 direction, F64 d) {
  const F32 inverse = f32(1.0f) / to_f32(d);
  const Mask zero = direction == F32::zero(), tiny = abs_(d) < f64(0x1p-126);
  const F32 infinite = copysign_(f32(std::numeric_limits<float>::infinity()), direction);
  const F32 nan = f32(std::numeric_limits<float>::quiet_NaN());
  p.inv_near[k] = select(zero, infinite, select(tiny, nan, inverse * f32(1.0f - kSlabWidening)));
  p.inv_far[k] = select(zero, infinite, select(tiny, nan, inverse * f32(1.0f + kSlabWidening)));
  p.negative[k] = bits_of(direction) < I32::zero();
  const uint32_t signs = to_bits(p.negative[k]);
  p.near_row[k] = signs != 0 ? k + 3 : k, p.far_row[k] = signs != 0 ? k : k + 3;
  p.mixed_axes += signs != 0 && signs != (1u << kLanes) - 1;
}

// Along the axes of each lane.
HWY_INLINE void prepare_shear(RayPacket& p, const RawRays& r, F64 scale) {
  const F32 size[3] = {abs_(r.direction[0]), abs_(r.direction[1]), abs_(r.direction[2])};
  p.z_is[2] = (size[2] > size[0]) & (size[2] > size[1]);
  p.z_is[1] = and_not(p.z_is[2], size[1] > size[0]);
  p.z_is[0] = !(p.z_is[2] | p.z_is[1]);
  p.kz = all(p.z_is[0]) ? 0 : all(p.z_is[1]) ? 1 : all(p.z_is[2]) ? 2 : -1;
  p.along_x = by_axis(p, r.direction[1], r.direction[2], r.direction[0]);
  p.along_y = by_axis(p, r.direction[2], r.direction[0], r.direction[1]);
  p.along_z = by_axis(p, r.direction[0], r.direction[1], r.direction[2]);
  p.direction_z = to_f64(p.along_z) * scale;
  p.shear_x32 = p.along_x / p.along_z, p.shear_y32 = p.along_y / p.along_z;
  p.origin_x = by_axis(p, r.origin[1], r.origin[2], r.origin[0]);
  p.origin_y = by_axis(p, r.origin[2], r.origin[0], r.origin[1]);
  p.origin_z = by_axis(p, r.origin[0], r.origin[1], r.origin[2]);
  p.inv_z = by_axis(p, p.inv_near[0], p.inv_near[1], p.inv_near[2]);
}

// TraceRay::shear_x and shear_y, which most packets never need.
struct ShearLanes { F64 x, y; };
HWY_INLINE ShearLanes exact_shear(const RayPacket& p) {
  const F64 z = to_f64(p.along_z);
  return {to_f64(p.along_x) / z, to_f64(p.along_y) / z};
}

// Rays first to first + n - 1 of the batch, without what only triangles need: shears, axes of lanes, errors of edges. p.valid is
// 0 if none is a ray.
HWY_INLINE void prepare_rays(const RayBatch& rays, int first, int n, RayPacket& p, RawRays& r, ScaleLanes& scales) {
  r = load_raw(rays, first, n);
  p.valid = mend_raw(r);
  if (p.valid == 0) return;
  load_from(rays, first, n, p);
  scales = scale_of(to_f64(r.largest));
  p.t_max = to_f64(r.t_max) * scales.size;  // a power of two: exact, as the division
  p.limit = round_up_lanes(p.t_max);
  p.mixed_axes = 0;
  for (int k = 0; k < 3; ++k) {
    p.origin[k] = r.origin[k];
    prepare_axis(p, k, r.direction[k], to_f64(r.direction[k]) * scales.to_one);
  }
}

// The whole of it.
// Contract: with u = 2^-24 and M the largest distance along an axis from the origin to a vertex, x and y in lanes are off by at most
//           7 u M from those in double, so x1 * y2 - y1 * x2 is off by at most 40 u M (|x1| + |y1| + |x2| + |y2| + 4 u M).
HWY_INLINE void prepare_packet(const Bvh::Data& data, const RayBatch& rays, int first, int n, RayPacket& p) {
  RawRays r;
  ScaleLanes scales;
  prepare_rays(rays, first, n, p, r, scales);
  if (p.valid == 0) return;
  F32 m = F32::zero();
  for (int k = 0; k < 3; ++k)
    m = cull_max(m, cull_max(abs_(f32(data.bounds_min[k]) - r.origin[k]), abs_(f32(data.bounds_max[k]) - r.origin[k])));
  prepare_shear(p, r, scales.to_one);
  // Where products may overflow or lose bits to underflow, every lane goes to the exact test.
  const Mask in_range = (m > f32(1e-15f)) & (m < f32(1e18f));
  p.edge_slope = select(in_range, f32(2.4e-6f) * m, F32::zero());
  p.edge_offset = select(in_range, f32(6e-13f) * m * m, f32(std::numeric_limits<float>::infinity()));
}

// Lanes of a packet as numbers.
struct PacketLanes {
  alignas(64) float origin[3][kLanes], inv_near[3][kLanes], inv_far[3][kLanes];
  alignas(64) float shear_x32[kLanes], shear_y32[kLanes], edge_slope[kLanes], edge_offset[kLanes];
  alignas(64) float limit[kLanes];  // of t_max
  alignas(64) uint32_t from[kLanes];
  alignas(64) double shear_x[kLanes], shear_y[kLanes], direction_z[kLanes], t_max[kLanes];
  uint32_t negative[3], z_is[3];
};

HWY_INLINE void store_lanes(const RayPacket& p, PacketLanes& out) {
  for (int k = 0; k < 3; ++k) {
    p.origin[k].store(out.origin[k]), p.inv_near[k].store(out.inv_near[k]), p.inv_far[k].store(out.inv_far[k]);
    out.negative[k] = to_bits(p.negative[k]), out.z_is[k] = to_bits(p.z_is[k]);
  }
  p.shear_x32.store(out.shear_x32), p.shear_y32.store(out.shear_y32);
  p.limit.store(out.limit);
  p.from.store(out.from);
  p.edge_slope.store(out.edge_slope), p.edge_offset.store(out.edge_offset);
  const ShearLanes shear = exact_shear(p);
  shear.x.store(out.shear_x), shear.y.store(out.shear_y), p.direction_z.store(out.direction_z), p.t_max.store(out.t_max);
}

// Lane i by itself.
HWY_INLINE void take_lane(const PacketLanes& p, int i, LaneRay& ray) {
  TraceRay& e = ray.exact;
  e.kz = (p.z_is[1] >> i & 1u) != 0 ? 1 : (p.z_is[2] >> i & 1u) != 0 ? 2 : 0;
  e.kx = e.kz == 2 ? 0 : e.kz + 1;
  e.ky = e.kx == 2 ? 0 : e.kx + 1;
  for (int k = 0; k < 3; ++k) {
    e.origin[k] = p.origin[k][i], e.inv_near[k] = p.inv_near[k][i], e.inv_far[k] = p.inv_far[k][i];
    e.negative[k] = (p.negative[k] >> i & 1u) != 0;
    ray.near_row[k] = e.negative[k] ? k + 3 : k;
    ray.far_row[k] = e.negative[k] ? k : k + 3;
  }
  e.shear_x = p.shear_x[i], e.shear_y = p.shear_y[i], e.direction_z = p.direction_z[i], e.t_max = p.t_max[i];
  ray.shear_x = p.shear_x32[i], ray.shear_y = p.shear_y32[i];
  ray.from = p.from[i];
  ray.edge_slope = p.edge_slope[i], ray.edge_offset = p.edge_offset[i];
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_RAY_PACKET_INL_H_
