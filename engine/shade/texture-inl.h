// Texture sampling: coordinates and level of detail -> filtered texels. Include inside a *_kernel.cpp.
// Raw samples count in 1 / 65535: a texel is 16 bits, weights are quantised to 1/256 (DESIGN 3.13), so the horizontal
// blend is exact, equal texels blend to exactly themselves, and a sample at a texel center is that texel.
#if defined(SPANRAY_TEXTURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_TEXTURE_INL_H_
#undef SPANRAY_TEXTURE_INL_H_
#else
#define SPANRAY_TEXTURE_INL_H_
#endif

#include "shade/texture_use-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace surface_lanes {

inline constexpr float kRawToUnit = 1.0f / 65535.0f;  // 65535 * kRawToUnit rounds to exactly 1

struct RawSample { F32 c[4]; };

// Texels i, i + 1, .. by the rule of the use; i in [-1, size - 1].
template <int kCount> struct Neighbours { I32 texel[kCount]; };
template <int kCount> HWY_INLINE Neighbours<kCount> neighbours(I32 i, I32 size, const UseLanes& use) {
  const I32 zero = I32::zero(), one = i32(1), last = size - one;
  Neighbours<kCount> n;
  n.texel[0] = min_unsigned(i, last);
  for (int k = 1; k < kCount; ++k) n.texel[k] = select(n.texel[k - 1] == last, zero, n.texel[k - 1] + one);
  for (int k = 0; k < kCount && use.any_clamp; ++k) n.texel[k] = select(use.clamp, min_(max_(i + i32(k), zero), last), n.texel[k]);
  return n;
}

// The first kChannels channels of texel `index`.
template <int kChannels> HWY_INLINE void read_texel(const uint32_t* words, I32 index, F32 out[4]) {
  const WordPair texel = gather_pair<8>(words, index);
  const I32 low16 = i32(0xffff);
  out[0] = to_f32(texel.low & low16), out[1] = to_f32(shift_right_logical<16>(texel.low)), out[2] = to_f32(texel.high & low16);
  if constexpr (kChannels > 3) out[3] = to_f32(shift_right_logical<16>(texel.high));
}

inline constexpr int kLevelWords = kMaxMipLevels + 1;  // a table by level: whole vectors

// Where a vector has as many lanes, one load and a permutation.
HWY_INLINE I32 word_of_level(const uint32_t* table, I32 level) {
  if constexpr (kLanes == kLevelWords) return lookup(table, level);
  else return gather(table, level);
}

HWY_INLINE I32 first_texel(const SceneData& scene, const UseLanes& use, I32 level) {
  const uint32_t* textures = reinterpret_cast<const uint32_t*>(scene.textures.data());
  // From the word before the table, which exists.
  if (use.texture.uniform) return word_of_level(textures + use.texture.first + kTextureOffset - 1, level + i32(1));
  return gather(textures, use.texture.offset + i32(kTextureOffset) + level);
}

// The point of a use on a level: its size and first texel, and the point in 1/256 texels.
struct LevelPlace { I32 width, height, base, x, y; };

HWY_INLINE LevelPlace place_on_level(const SceneData& scene, const UseLanes& use, I32 level) {
  LevelPlace p;
  p.width = max_(shift_right_by(use.width, level), i32(1)), p.height = max_(shift_right_by(use.height, level), i32(1));
  const F32 steps = f32(256.0f);
  p.x = nearest_i32_small(use.s * (to_f32(p.width) * steps));  // of a position in [0, 2^22]
  p.y = nearest_i32_small(use.t * (to_f32(p.height) * steps));
  p.base = first_texel(scene, use, level);
  return p;
}

// Where a sample of one level reads: the texels to the upper left, upper right, lower left and lower right of it, and how far it is from the
// first, in 1/256 texels.
struct TexelLanes {
  I32 index[4];
  I32 fx, fy;
};

// nearest: only index[0] is set.
HWY_INLINE TexelLanes find_texels(const SceneData& scene, const UseLanes& use, I32 level, bool nearest) {
  TexelLanes r;
  const LevelPlace p = place_on_level(scene, use, level);
  const I32 to_first = i32(nearest ? 256 : 128), x = p.x - to_first, y = p.y - to_first;
  const Neighbours<2> column = neighbours<2>(shift_right<8>(x), p.width, use), row = neighbours<2>(shift_right<8>(y), p.height, use);
  const I32 bottom = p.base + row.texel[1] * p.width;
  r.index[0] = bottom + column.texel[1];
  if (nearest) return r;
  const I32 top = p.base + row.texel[0] * p.width;
  r.index[0] = top + column.texel[0], r.index[1] = top + column.texel[1];
  r.index[2] = bottom + column.texel[0], r.index[3] = bottom + column.texel[1];
  r.fx = x & i32(255), r.fy = y & i32(255);
  return r;
}

// Nearest or bilinear. Channels from kChannels on are 0.
// Contract: in units of a texel's 1/65535. The blend along x is exact in float: a 16-bit difference times 8 bits of weight.
template <int kChannels> HWY_INLINE RawSample blend_texels(const SceneData& scene, const TexelLanes& at, bool nearest) {
  const uint32_t* words = reinterpret_cast<const uint32_t*>(scene.texels.data());
  RawSample raw;
  for (int c = kChannels; c < 4; ++c) raw.c[c] = F32::zero();
  F32 t00[4], t10[4], t01[4], t11[4];
  read_texel<kChannels>(words, at.index[0], t00);
  if (nearest) {
    for (int c = 0; c < kChannels; ++c) raw.c[c] = t00[c];
    return raw;
  }
  const F32 fx = to_f32(at.fx) * f32(0x1p-8f), fy = to_f32(at.fy) * f32(0x1p-8f);
  read_texel<kChannels>(words, at.index[1], t10);
  read_texel<kChannels>(words, at.index[2], t01);
  read_texel<kChannels>(words, at.index[3], t11);
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

HWY_INLINE void blend_levels(RawSample& near_level, const RawSample& far_level, F32 weight, int channels) {
  for (int c = 0; c < channels; ++c) near_level.c[c] = mul_add(weight, far_level.c[c] - near_level.c[c], near_level.c[c]);
}

// The filtered sample. A level whose weight is 0 in every lane is not read: adding 0 times a difference changes nothing.
template <int kChannels>
HWY_INLINE RawSample sample(const SceneData& scene, const UseLanes& use, Filter filter) {
  const bool nearest = filter == Filter::kNearest;
  const LevelLanes levels = choose_levels(scene, use, filter);
  RawSample near_level = blend_texels<kChannels>(scene, find_texels(scene, use, levels.level, nearest), nearest);
  if (!levels.blend) return near_level;
  const RawSample far_level = blend_texels<kChannels>(scene, find_texels(scene, use, levels.next, nearest), nearest);
  blend_levels(near_level, far_level, levels.weight, kChannels);
  return near_level;
}

// base + gain * sample (-mm).
HWY_INLINE F32 remap(const SceneData& scene, const MapLanes& use, F32 raw) {
  return mul_add(use.real(scene, kUseGain), raw * f32(kRawToUnit), use.real(scene, kUseBase));
}

// The channel that -imfchan names; luminance (Rec. 709 weights, relative to green so that gray stays exactly gray) by default.
HWY_INLINE F32 choose_channel(const SceneData& scene, const MapLanes& use, const RawSample& raw) {
  const I32 channel = use.word(scene, kUseChannel);
  const F32 g = raw.c[1];
  F32 value = mul_add(f32(0.0722f), raw.c[2] - g, mul_add(f32(0.2126f), raw.c[0] - g, g));
  for (int c = 0; c < 4; ++c) value = select(channel == i32(c), raw.c[c], value);
  return value;
}

HWY_INLINE V3f color_of(const SceneData& scene, const MapLanes& use, const RawSample& raw) {
  const F32 zero = F32::zero();
  return {max_(remap(scene, use, raw.c[0]), zero), max_(remap(scene, use, raw.c[1]), zero), max_(remap(scene, use, raw.c[2]), zero)};
}
HWY_INLINE F32 scalar_of(const SceneData& scene, const MapLanes& use, const RawSample& raw) {
  return remap(scene, use, choose_channel(scene, use, raw));
}

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_TEXTURE_INL_H_
