// Colors of a texture where all lanes read the same one and its use is plain: not scaled, moved, clamped or remapped. So are nearly all.
// What depends on the level alone stands in tables then, and a vector that sees one level, as most do, broadcasts it from memory.
// Include inside a *_kernel.cpp (simd/dispatch.h), after the project headers.
#if defined(SPANRAY_PLAIN_TEXTURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_PLAIN_TEXTURE_INL_H_
#undef SPANRAY_PLAIN_TEXTURE_INL_H_
#else
#define SPANRAY_PLAIN_TEXTURE_INL_H_
#endif

#include "shade/texture-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace surface_lanes {

// The texture of one use, level by level.
struct PlainTexture {
  static constexpr int kLevels = kMaxMipLevels + 1;  // whole vectors
  int32_t use = -1;    // in SceneData::texture_uses; -1: none so far
  bool plain = false;  // else nothing below is set
  int32_t levels = 0;
  float width = 0, height = 0;
  alignas(64) float steps_x[kLevels], steps_y[kLevels];  // size in 1/256 texels
  alignas(64) int32_t last_column[kLevels], last_row[kLevels], columns[kLevels], first[kLevels];

  void open(const SceneData& scene, int32_t index) {
    if (index == use) return;
    use = index;
    const TextureUse& u = scene.texture_uses[static_cast<size_t>(index)];
    plain = u.texture > -1 && u.clamp == 0 && u.scale[0] == 1.0f && u.scale[1] == 1.0f && u.offset[0] == 0.0f && u.offset[1] == 0.0f &&
            u.base == 0.0f && u.gain == 1.0f;
    if (!plain) return;
    const Texture& texture = scene.textures[static_cast<size_t>(u.texture)];
    levels = texture.levels, width = static_cast<float>(texture.width), height = static_cast<float>(texture.height);
    for (int i = 0; i < kLevels; i += kLanes) {
      const auto size = [&](int32_t of, float* steps, int32_t* last) HWY_ATTR {
        const I32 n = max_(shift_right_by(i32(of), lane_iota(i)), i32(1));
        (to_f32(n) * f32(256.0f)).store(steps + i), (n - i32(1)).store(last + i);
        return n;
      };
      size(texture.height, steps_y, last_row);
      size(texture.width, steps_x, last_column).store(columns + i);
    }
    std::memcpy(first, texture.offset, sizeof texture.offset), first[kLevels - 1] = 0;
  }
};

// The tables of a PlainTexture, read by level.
struct OneLevel {
  int32_t level;
  HWY_INLINE F32 operator()(const float* table) const { return f32(table[level]); }
  HWY_INLINE I32 operator()(const int32_t* table) const { return i32(table[level]); }
};
struct ManyLevels {
  I32 level;
  HWY_INLINE I32 operator()(const int32_t* table) const {
    if constexpr (kLanes == PlainTexture::kLevels) return lookup(reinterpret_cast<const uint32_t*>(table), level);
    else return gather(table, level);
  }
  HWY_INLINE F32 operator()(const float* table) const { return float_from_bits((*this)(reinterpret_cast<const int32_t*>(table))); }
};

// The point in a texture and its level of detail, as in UseLanes.
struct PlainPlace {
  F32 s, t;
  I32 level_256;
};

HWY_INLINE PlainPlace plain_place(const PlainTexture& texture, const UvLanes& uv) {
  return {fraction(uv.u), f32(1.0f) - fraction(uv.v), level_of_detail(uv, f32(texture.width), f32(texture.height), i32(texture.levels))};
}

// find_texels() for bilinear samples.
template <class At> HWY_INLINE TexelLanes find_plain_texels(const PlainTexture& texture, const PlainPlace& place, const At& at) {
  const I32 byte = i32(255), one = i32(1), half = i32(128), zero = I32::zero();
  const I32 x = nearest_i32_small(place.s * at(texture.steps_x)) - half, y = nearest_i32_small(place.t * at(texture.steps_y)) - half;
  const I32 last_column = at(texture.last_column), last_row = at(texture.last_row), columns = at(texture.columns), first = at(texture.first);
  const I32 left = min_unsigned(shift_right<8>(x), last_column), right = select(left == last_column, zero, left + one);
  const I32 row = min_unsigned(shift_right<8>(y), last_row), top = row * columns + first;
  const I32 bottom = select(row == last_row, first, top + columns);
  return {{top + left, top + right, bottom + left, bottom + right}, x & byte, y & byte};
}

template <class At> HWY_INLINE RawSample sample_plain_level(const SceneData& scene, const PlainTexture& texture, const PlainPlace& place, const At& at) {
  return blend_texels<3>(scene, find_plain_texels(texture, place, at), false);
}

// sample<3>() of a use without gain and base, times kRawToUnit.
HWY_INLINE V3f sample_plain(const SceneData& scene, const PlainTexture& texture, const PlainPlace& place, Mask active, Filter filter) {
  const bool trilinear = filter == Filter::kTrilinear;
  const I32 level = shift_right<8>(trilinear ? place.level_256 : place.level_256 + i32(128));
  const I32 weight = place.level_256 & i32(255), next = min_(level + i32(1), i32(texture.levels - 1));
  const bool blend = trilinear && any(active & (weight != i32(0)));
  RawSample raw;
  if (all(level == i32(first_lane(level)))) {
    raw = sample_plain_level(scene, texture, place, OneLevel{first_lane(level)});
    if (blend) blend_levels(raw, sample_plain_level(scene, texture, place, OneLevel{first_lane(next)}), to_f32(weight) * f32(0x1p-8f), 3);
  } else {
    raw = sample_plain_level(scene, texture, place, ManyLevels{level});
    if (blend) blend_levels(raw, sample_plain_level(scene, texture, place, ManyLevels{next}), to_f32(weight) * f32(0x1p-8f), 3);
  }
  const F32 unit = f32(kRawToUnit);
  return {raw.c[0] * unit, raw.c[1] * unit, raw.c[2] * unit};
}

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_PLAIN_TEXTURE_INL_H_
