// What a map of a material needs of its texture: uv and footprint -> coordinates and level of detail. Include inside a *_kernel.cpp.
#if defined(SPANRAY_TEXTURE_USE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_TEXTURE_USE_INL_H_
#undef SPANRAY_TEXTURE_USE_INL_H_
#else
#define SPANRAY_TEXTURE_USE_INL_H_
#endif

#include "shade/point-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace surface_lanes {

// Fields of TextureUse and Texture, in words.
inline constexpr int kUseOffset = offsetof(TextureUse, offset) / 4, kUseScale = offsetof(TextureUse, scale) / 4;
inline constexpr int kUseBase = offsetof(TextureUse, base) / 4, kUseGain = offsetof(TextureUse, gain) / 4;
inline constexpr int kUseMultiplier = offsetof(TextureUse, bump_multiplier) / 4, kUseClamp = offsetof(TextureUse, clamp) / 4;
inline constexpr int kUseChannel = offsetof(TextureUse, channel) / 4, kTextureOffset = offsetof(Texture, offset) / 4;

// One use of a texture in each lane.
struct MapLanes {
  Mask active;          // lanes that have one; the others read texture 0 and are ignored
  RecordLanes record;   // the TextureUse

  HWY_INLINE F32 real(const SceneData& scene, int field) const {
    return record.real(reinterpret_cast<const float*>(scene.texture_uses.data()), field);
  }
  HWY_INLINE I32 word(const SceneData& scene, int field) const {
    return record.word(reinterpret_cast<const uint32_t*>(scene.texture_uses.data()), field);
  }
};

struct UseLanes : MapLanes {
  RecordLanes texture;  // the Texture
  RecordLanes rows;     // the HeightRows, if the scene has any
  I32 width, height;    // of level 0
  Mask clamp;
  bool any_clamp;
  F32 s, t;             // in [0, 1], t down from the top row
  I32 level_256;        // level of detail times 256, in [0, 256 * (levels - 1)]

  HWY_INLINE I32 texture_word(const SceneData& scene, int field) const {
    return texture.word(reinterpret_cast<const uint32_t*>(scene.textures.data()), field);
  }
};

// Input: the derivatives of position by a pixel step. db1/dp = cross(e2, n) / |n|^2, db2/dp = cross(n, e1) / |n|^2.
// tangents: whether those are wanted, else 0.
HWY_INLINE UvLanes resolve_uv(const SceneData& scene, const TriangleLanes& t, const SurfaceLanes& s, const V3d& dpdx, const V3d& dpdy,
                              bool tangents) {
  const CornerUv c = corner_uv(scene, t);
  UvLanes uv;
  const SplitLanes u = split(c.u0 + s.b1 * c.du1 + s.b2 * c.du2), v = split(c.v0 + s.b1 * c.dv1 + s.b2 * c.dv2);
  uv.u = u.rest, uv.v = v.rest, uv.whole_u = u.whole, uv.whole_v = v.whole;
  const F64 square = dot(s.normal, s.normal), zero = f64(0.0);
  const F64 scale = select_eq(square, zero, zero, f64(1.0) / select_eq(square, zero, f64(1.0), square));
  UvGradients g = uv_gradients(c, s.edge1, s.edge2, s.normal);
  g.u = g.u * scale, g.v = g.v * scale;
  uv.du_dx = to_f32(dot(g.u, dpdx)), uv.dv_dx = to_f32(dot(g.v, dpdx));
  uv.du_dy = to_f32(dot(g.u, dpdy)), uv.dv_dy = to_f32(dot(g.v, dpdy));
  const V3f none{F32::zero(), F32::zero(), F32::zero()};
  const UvTangents along = tangents ? uv_tangents(c, s.edge1, s.edge2, s.normal) : UvTangents{none, none};
  uv.tangent_u = along.u, uv.tangent_v = along.v;
  return uv;
}

// fraction() of a float (point-inl.h).
HWY_INLINE F32 fraction(F32 a) {
  return select(abs_(a) < f32(8388608.0f), F32{hn::Sub(a.v, hn::Floor(a.v))}, F32::zero());
}

// 256 * log2(sqrt(square)), rounded. Error <= 0.55; monotone; about -2^14 for 0.
// Source: log2(1 + x) = x + x (1 - x) q(x), q quadratic through Chebyshev nodes: exact at both ends, so octaves join.
HWY_INLINE I32 half_log2_256(F32 square) {
  const I32 bits = bits_of(square);
  const F32 exponent = to_f32(shift_right<23>(bits) - i32(127));
  const F32 x = float_from_bits((bits & i32(0x7fffff)) | i32(0x3f800000)) - f32(1.0f);
  const F32 q = mul_add(mul_add(f32(0.0816157f), x, f32(-0.2426695f)), x, f32(0.4407808f));
  const F32 log2 = mul_add(x * (f32(1.0f) - x), q, x) + exponent;
  return nearest_i32_small(log2 * f32(128.0f));
}

// Level of detail of a footprint: log2 of the longer side of a pixel, in texels of level 0.
// Source:   Williams 1983, "Pyramidal Parametrics"; the measure of OpenGL 4.6, 8.14.1: rho = max of the two lengths.
// Contract: clamped to the levels there are and monotone in the footprint; infinite or NaN derivatives give the last level.
HWY_INLINE I32 level_of_detail(const UvLanes& uv, F32 texels_u, F32 texels_v, I32 levels) {
  const auto length_square = [&](F32 du, F32 dv) HWY_ATTR {
    const F32 a = du * texels_u, b = dv * texels_v;
    return min_(a * a + b * b, f32(0x1p100f));  // beyond every level; also for NaN
  };
  const F32 square = max_(length_square(uv.du_dx, uv.dv_dx), length_square(uv.du_dy, uv.dv_dy));
  return min_(max_(half_log2_256(square), i32(0)), shift_left<8>(levels - i32(1)));
}

// Opens use `index` (into SceneData::texture_uses, -1: none) of each lane in `lanes`; uniform: it is the same in all lanes. Only call
// with any(result of has_use).
HWY_INLINE UseLanes open_use(const SceneData& scene, I32 index, bool uniform, Mask lanes, const UvLanes& uv) {
  UseLanes use;
  use.record = record_lanes(max_(index, i32(0)), kTextureUseStride, uniform);
  const I32 texture = use.word(scene, 0);
  use.active = lanes & (index > i32(-1)) & (texture > i32(-1));
  use.texture = record_lanes(max_(texture, i32(0)), kTextureStride, uniform);
  use.rows = record_lanes(max_(index, i32(0)), kHeightRowsStride, uniform);
  use.width = use.texture_word(scene, 0);
  use.height = use.texture_word(scene, 1);
  use.clamp = use.word(scene, kUseClamp) != i32(0);
  use.any_clamp = any(use.clamp);
  const F32 scale_u = use.real(scene, kUseScale), scale_v = use.real(scene, kUseScale + 1);
  const F32 offset_u = use.real(scene, kUseOffset), offset_v = use.real(scene, kUseOffset + 1), one = f32(1.0f), zero = F32::zero();
  use.s = fraction(uv.u), use.t = one - fraction(uv.v);
  // Lane by lane: what a neighbour does with its coordinates changes none of this lane's bits.
  const Mask plain = and_not(use.clamp, (scale_u == one) & (scale_v == one) & (offset_u == zero) & (offset_v == zero));
  if (!all(plain)) {
    const F64 u = (to_f64(uv.whole_u) + to_f64(uv.u)) * to_f64(scale_u) + to_f64(offset_u);
    const F64 v = (to_f64(uv.whole_v) + to_f64(uv.v)) * to_f64(scale_v) + to_f64(offset_v);
    const F64 first = f64(0.0), last = f64(1.0);
    const F32 repeated_s = select(plain, use.s, to_f32(fraction(u))), repeated_t = select(plain, use.t, to_f32(last - fraction(v)));
    use.s = select(use.clamp, to_f32(min_(max_(u, first), last)), repeated_s);
    use.t = select(use.clamp, to_f32(last - min_(max_(v, first), last)), repeated_t);
  }
  use.level_256 = level_of_detail(uv, scale_u * to_f32(use.width), scale_v * to_f32(use.height), use.texture_word(scene, 2));
  return use;
}

// True where some lane uses a texture in this slot: else the whole stage is skipped.
HWY_INLINE bool has_use(const SceneData& scene, I32 index, Mask lanes) {
  return any(lanes & (index > i32(-1))) && !scene.textures.empty();
}

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_TEXTURE_USE_INL_H_
