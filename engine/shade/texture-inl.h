// Texture sampling: uv and footprint -> level of detail -> filtered texels. Include inside a *_kernel.cpp.
// Raw samples count in 1 / 65535: a texel is 16 bits, weights are quantised to 1/256 (DESIGN 3.13), so the horizontal
// blend is exact, equal texels blend to exactly themselves, and a sample at a texel center is that texel.
#if defined(SPANRAY_TEXTURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_TEXTURE_INL_H_
#undef SPANRAY_TEXTURE_INL_H_
#else
#define SPANRAY_TEXTURE_INL_H_
#endif

#include "shade/point-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace surface_lanes {

inline constexpr float kRawToUnit = 1.0f / 65535.0f;  // 65535 * kRawToUnit rounds to exactly 1

// Fields of TextureUse and Texture, in words.
inline constexpr int kUseOffset = offsetof(TextureUse, offset) / 4, kUseScale = offsetof(TextureUse, scale) / 4;
inline constexpr int kUseBase = offsetof(TextureUse, base) / 4, kUseGain = offsetof(TextureUse, gain) / 4;
inline constexpr int kUseMultiplier = offsetof(TextureUse, bump_multiplier) / 4, kUseClamp = offsetof(TextureUse, clamp) / 4;
inline constexpr int kUseChannel = offsetof(TextureUse, channel) / 4, kTextureOffset = offsetof(Texture, offset) / 4;

// One use of a texture in each lane.
struct UseLanes {
  Mask active;          // lanes that have one; the others read texture 0 and are ignored
  RecordLanes record;   // the TextureUse
  RecordLanes texture;  // the Texture
  I32 width, height;    // of level 0
  Mask clamp;
  bool any_clamp;
  F32 s, t;             // in [0, 1], t down from the top row
  I32 level_256;        // level of detail times 256, in [0, 256 * (levels - 1)]

  HWY_INLINE F32 real(const SceneData& scene, int field) const {
    return record.real(reinterpret_cast<const float*>(scene.texture_uses.data()), field);
  }
  HWY_INLINE I32 word(const SceneData& scene, int field) const {
    return record.word(reinterpret_cast<const uint32_t*>(scene.texture_uses.data()), field);
  }
  HWY_INLINE I32 texture_word(const SceneData& scene, int field) const {
    return texture.word(reinterpret_cast<const uint32_t*>(scene.textures.data()), field);
  }
};

struct RawSample { F32 c[4]; };

// Input: the derivatives of position by a pixel step. db1/dp = cross(e2, n) / |n|^2, db2/dp = cross(n, e1) / |n|^2.
HWY_INLINE UvLanes resolve_uv(const Frame& frame, const TriangleLanes& t, const SurfaceLanes& s, const V3d& dpdx, const V3d& dpdy) {
  const CornerUv c = corner_uv(*frame.scene, t);
  UvLanes uv;
  uv.u = c.u0 + s.b1 * c.du1 + s.b2 * c.du2;
  uv.v = c.v0 + s.b1 * c.dv1 + s.b2 * c.dv2;
  const F64 square = dot(s.normal, s.normal), zero = f64(0.0);
  const F64 scale = select_eq(square, zero, zero, f64(1.0) / select_eq(square, zero, f64(1.0), square));
  UvGradients g = uv_gradients(c, s.edge1, s.edge2, s.normal);
  g.u = g.u * scale, g.v = g.v * scale;
  uv.du_dx = to_f32(dot(g.u, dpdx)), uv.dv_dx = to_f32(dot(g.v, dpdx));
  uv.du_dy = to_f32(dot(g.u, dpdy)), uv.dv_dy = to_f32(dot(g.v, dpdy));
  if (frame.plan.bump) {
    const UvTangents tangents = uv_tangents(c, s.edge1, s.edge2, s.normal);
    uv.tangent_u = tangents.u, uv.tangent_v = tangents.v;
  }
  return uv;
}

// a - floor(a), in [0, 1]; 0 for NaN and where doubles have no fraction left.
HWY_INLINE F64 fraction(F64 a) {
  F64 f;
  for (int h = 0; h < kHalves; ++h) f.v[h] = hn::Sub(a.v[h], hn::Floor(a.v[h]));
  return select_lt(abs_(a), f64(2251799813685248.0), f, f64(0.0));
}

// 256 * log2(sqrt(square)), rounded. Error <= 0.55; monotone; about -2^14 for 0.
// Source: log2(1 + x) = x + x (1 - x) q(x), q cubic through Chebyshev nodes: exact at both ends, so octaves join.
HWY_INLINE I32 half_log2_256(F32 square) {
  const I32 bits = bits_of(square);
  const F32 exponent = to_f32(shift_right<23>(bits) - i32(127));
  const F32 x = float_from_bits((bits & i32(0x7fffff)) | i32(0x3f800000)) - f32(1.0f);
  const F32 q = mul_add(mul_add(f32(0.0816157f), x, f32(-0.2426695f)), x, f32(0.4407808f));
  const F32 log2 = mul_add(x * (f32(1.0f) - x), q, x) + exponent;
  return floor_i32_small(log2 * f32(128.0f) + f32(0.5f));
}

// Level of detail of a footprint: log2 of the longer side of a pixel, in texels of level 0.
// Source:   Williams 1983, "Pyramidal Parametrics"; the measure of OpenGL 4.6, 8.14.1: rho = max of the two lengths.
// Contract: clamped to the levels there are and monotone in the footprint; infinite or NaN derivatives give the last level.
HWY_INLINE I32 level_of_detail(const UvLanes& uv, F32 texels_u, F32 texels_v, I32 levels) {
  const auto length_square = [&](F32 du, F32 dv) HWY_ATTR {
    const F32 limit = f32(0x1p50f);  // squares stay finite; clamp_ turns NaN into the far end
    const F32 a = clamp_(du * texels_u, -limit, limit), b = clamp_(dv * texels_v, -limit, limit);
    return a * a + b * b;
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
  use.width = use.texture_word(scene, 0);
  use.height = use.texture_word(scene, 1);
  use.clamp = use.word(scene, kUseClamp) != i32(0);
  use.any_clamp = any(use.clamp);
  const F32 scale_u = use.real(scene, kUseScale), scale_v = use.real(scene, kUseScale + 1);
  const F64 u = uv.u * to_f64(scale_u) + to_f64(use.real(scene, kUseOffset));
  const F64 v = uv.v * to_f64(scale_v) + to_f64(use.real(scene, kUseOffset + 1));
  const F64 zero = f64(0.0), one = f64(1.0);
  use.s = to_f32(fraction(u)), use.t = to_f32(one - fraction(v));
  if (use.any_clamp) {
    use.s = select(use.clamp, to_f32(min_(max_(u, zero), one)), use.s);
    use.t = select(use.clamp, to_f32(one - min_(max_(v, zero), one)), use.t);
  }
  use.level_256 = level_of_detail(uv, scale_u * to_f32(use.width), scale_v * to_f32(use.height), use.texture_word(scene, 2));
  return use;
}

// True where some lane uses a texture in this slot: else the whole stage is skipped.
HWY_INLINE bool has_use(const SceneData& scene, I32 index, Mask lanes) {
  return any(lanes & (index > i32(-1))) && !scene.textures.empty();
}

// Texel index from at most two texels outside to inside, by the rule of the use.
HWY_INLINE I32 wrap(I32 i, I32 size, const UseLanes& use) {
  const I32 zero = i32(0), last = size - i32(1);
  I32 r = i + select(i < zero, size, zero);
  r = r - select(r > last, size, zero);
  r = r - select(r > last, size, zero);  // twice: a level of one texel
  if (use.any_clamp) r = select(use.clamp, i, r);
  return min_(max_(r, zero), last);
}

// The first kChannels channels of texel `index`.
template <int kChannels> HWY_INLINE void read_texel(const uint32_t* words, I32 index, F32 out[4]) {
  const WordPair texel = gather_pair(words, index);
  const I32 low16 = i32(0xffff);
  out[0] = to_f32(texel.low & low16), out[1] = to_f32(shift_right_logical<16>(texel.low)), out[2] = to_f32(texel.high & low16);
  if constexpr (kChannels > 3) out[3] = to_f32(shift_right_logical<16>(texel.high));
}

// One level, nearest or bilinear, at the point of the use moved by (shift_x, shift_y) / 256 texels of that level. Channels from
// kChannels on are not set.
// Contract: in units of a texel's 1/65535. The blend along x is exact in float: a 16-bit difference times 8 bits of weight.
template <int kChannels>
[[maybe_unused]] static HWY_NOINLINE RawSample sample_level(const SceneData& scene, const UseLanes& use, I32 level, bool nearest,
                                                           int shift_x, int shift_y) {
  const uint32_t* words = reinterpret_cast<const uint32_t*>(scene.texels.data());
  const I32 w = max_(shift_right_by(use.width, level), i32(1)), h = max_(shift_right_by(use.height, level), i32(1));
  const int center = nearest ? 0 : -128;
  const F32 steps = f32(256.0f), half = f32(0.5f);  // of a position in [0, 2^22]
  const I32 x = to_i32_small(use.s * (to_f32(w) * steps) + half) + i32(shift_x + center);
  const I32 y = to_i32_small(use.t * (to_f32(h) * steps) + half) + i32(shift_y + center);
  const I32 x0 = shift_right<8>(x), y0 = shift_right<8>(y);
  const uint32_t* textures = reinterpret_cast<const uint32_t*>(scene.textures.data());
  const I32 base = gather(textures, use.texture.offset + i32(kTextureOffset) + level);
  const I32 left = wrap(x0, w, use), top = base + wrap(y0, h, use) * w;
  RawSample raw;
  F32 t00[4];
  read_texel<kChannels>(words, top + left, t00);
  if (nearest) {
    for (int c = 0; c < kChannels; ++c) raw.c[c] = t00[c];
    return raw;
  }
  const I32 right = wrap(x0 + i32(1), w, use), bottom = base + wrap(y0 + i32(1), h, use) * w;
  const F32 fx = to_f32(x & i32(255)) * f32(0x1p-8f), fy = to_f32(y & i32(255)) * f32(0x1p-8f);
  F32 t10[4], t01[4], t11[4];
  read_texel<kChannels>(words, top + right, t10);
  read_texel<kChannels>(words, bottom + left, t01);
  read_texel<kChannels>(words, bottom + right, t11);
  for (int c = 0; c < kChannels; ++c) {
    const F32 upper = mul_add(fx, t10[c] - t00[c], t00[c]), lower = mul_add(fx, t11[c] - t01[c], t01[c]);
    raw.c[c] = mul_add(fy, lower - upper, upper);
  }
  return raw;
}

// The nearer level of one lane, and for trilinear the next one with its weight in 1/256.
struct LevelLanes { I32 level, next; F32 weight; bool blend; };

HWY_INLINE LevelLanes choose_levels(const SceneData& scene, const UseLanes& use, Filter filter) {
  const I32 rounded = shift_right<8>(use.level_256 + i32(128));
  if (filter != Filter::kTrilinear) return {rounded, rounded, F32::zero(), false};
  const I32 last = use.texture_word(scene, 2) - i32(1), level = shift_right<8>(use.level_256);
  const I32 weight = use.level_256 & i32(255);
  return {level, min_(level + i32(1), last), to_f32(weight) * f32(0x1p-8f), any(use.active & (weight != i32(0)))};
}

// The filtered sample. A level whose weight is 0 in every lane is not read: adding 0 times a difference changes nothing.
template <int kChannels>
HWY_INLINE RawSample sample(const SceneData& scene, const UseLanes& use, Filter filter) {
  const bool nearest = filter == Filter::kNearest;
  const LevelLanes levels = choose_levels(scene, use, filter);
  RawSample near_level = sample_level<kChannels>(scene, use, levels.level, nearest, 0, 0);
  if (!levels.blend) return near_level;
  const RawSample far_level = sample_level<kChannels>(scene, use, levels.next, nearest, 0, 0);
  for (int c = 0; c < kChannels; ++c)
    near_level.c[c] = mul_add(levels.weight, far_level.c[c] - near_level.c[c], near_level.c[c]);
  return near_level;
}

// base + gain * sample (-mm).
HWY_INLINE F32 remap(const SceneData& scene, const UseLanes& use, F32 raw) {
  return mul_add(use.real(scene, kUseGain), raw * f32(kRawToUnit), use.real(scene, kUseBase));
}

// The channel that -imfchan names; luminance (Rec. 709 weights, relative to green so that gray stays exactly gray) by default.
HWY_INLINE F32 choose_channel(const SceneData& scene, const UseLanes& use, const RawSample& raw) {
  const I32 channel = use.word(scene, kUseChannel);
  const F32 g = raw.c[1];
  F32 value = mul_add(f32(0.0722f), raw.c[2] - g, mul_add(f32(0.2126f), raw.c[0] - g, g));
  for (int c = 0; c < 4; ++c) value = select(channel == i32(c), raw.c[c], value);
  return value;
}

HWY_INLINE V3f sample_color(const SceneData& scene, const UseLanes& use, Filter filter) {
  const RawSample raw = sample<3>(scene, use, filter);
  const F32 zero = F32::zero();
  return {max_(remap(scene, use, raw.c[0]), zero), max_(remap(scene, use, raw.c[1]), zero), max_(remap(scene, use, raw.c[2]), zero)};
}
HWY_INLINE F32 sample_scalar(const SceneData& scene, const UseLanes& use, Filter filter) {
  return remap(scene, use, choose_channel(scene, use, sample<4>(scene, use, filter)));
}

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_TEXTURE_INL_H_
