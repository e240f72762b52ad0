// Three-component vectors of lanes. Products and sums are unfused and in the written order, as math/vec.h.
#if defined(SPANRAY_LANE_VEC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_LANE_VEC_INL_H_
#undef SPANRAY_LANE_VEC_INL_H_
#else
#define SPANRAY_LANE_VEC_INL_H_
#endif

#include "simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace surface_lanes {

template <class T> struct V3 { T x, y, z; };
using V3f = V3<F32>;
using V3d = V3<F64>;

template <class T> HWY_INLINE V3<T> operator+(const V3<T>& a, const V3<T>& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
template <class T> HWY_INLINE V3<T> operator-(const V3<T>& a, const V3<T>& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <class T> HWY_INLINE V3<T> operator-(const V3<T>& a) { return {-a.x, -a.y, -a.z}; }
template <class T> HWY_INLINE V3<T> operator*(const V3<T>& a, T s) { return {a.x * s, a.y * s, a.z * s}; }
template <class T> HWY_INLINE T dot(const V3<T>& a, const V3<T>& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class T> HWY_INLINE V3<T> cross(const V3<T>& a, const V3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

HWY_INLINE V3f select(Mask m, const V3f& a, const V3f& b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}
HWY_INLINE V3d to_f64(const V3f& a) { return {to_f64(a.x), to_f64(a.y), to_f64(a.z)}; }
HWY_INLINE V3f to_f32(const V3d& a) { return {to_f32(a.x), to_f32(a.y), to_f32(a.z)}; }
HWY_INLINE V3d broadcast(const glm::dvec3& a) { return {f64(a.x), f64(a.y), f64(a.z)}; }
HWY_INLINE F32 max_abs(const V3f& a) { return max_(abs_(a.x), max_(abs_(a.y), abs_(a.z))); }

// Unit vector along a, or `fallback` where |a|^2 is not above least_square (NaN included).
HWY_INLINE V3f unit_or(const V3f& a, float least_square, const V3f& fallback) {
  const F32 square = dot(a, a);
  const Mask good = square > f32(least_square);
  const F32 inverse = f32(1.0f) / sqrt_(select(good, square, f32(1.0f)));
  return select(good, V3f{a.x * inverse, a.y * inverse, a.z * inverse}, fallback);
}
// Unit vector along a, rounded; `fallback` where a is zero.
HWY_INLINE V3f unit_or(const V3d& a, const V3f& fallback) {
  const F64 square = dot(a, a);
  const Mask good = f64(0.0) < square;
  const F64 length = sqrt_(select_lt(f64(0.0), square, square, f64(1.0)));
  return select(good, V3f{to_f32(a.x / length), to_f32(a.y / length), to_f32(a.z / length)}, fallback);
}

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_LANE_VEC_INL_H_
