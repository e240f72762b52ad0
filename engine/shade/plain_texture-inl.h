// Colors and heights of a texture where all lanes read the same one and its use is plain: not scaled, moved, clamped or remapped. So
// are nearly all. What depends on the level alone stands in tables then, and a vector that sees one level, as most do, broadcasts it.
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
  int32_t use = -1;      // in SceneData::texture_uses; -1: none so far
  bool plain = false;    // its colors can be read
  bool heights = false;  // its rows of heights can (scene/height_rows.h)
  float slope = 0;       // of heights: unit, gain and multiplier
  int32_t levels = 0;
  float width = 0, height = 0;
  alignas(64) float steps_x[kLevelWords], steps_y[kLevelWords];  // size in 1/256 texels
  alignas(64) int32_t last_column[kLevelWords], last_row[kLevelWords], columns[kLevelWords], first[kLevelWords];
  alignas(64) int32_t first_height[kLevelWords];

  // index: of a use, in SceneData::texture_uses.
  void open(const SceneData& scene, int32_t index) {
    use = index;
    const TextureUse& u = scene.texture_uses[static_cast<size_t>(index)];
    const bool placed = u.texture > -1 && u.clamp == 0 && u.scale[0] == 1.0f && u.scale[1] == 1.0f &&
                        u.offset[0] == 0.0f && u.offset[1] == 0.0f;
    plain = placed && u.base == 0.0f && u.gain == 1.0f, heights = false;
    if (!placed) return;
    const Texture& texture = scene.textures[static_cast<size_t>(u.texture)];
    levels = texture.levels, width = static_cast<float>(texture.width), height = static_cast<float>(texture.height);
    for (int i = 0; i < kLevelWords; i += kLanes) {
      const auto size = [&](int32_t of, float* steps, int32_t* last) HWY_ATTR {
        const I32 n = max_(shift_right_by(i32(of), lane_iota(i)), i32(1));
        (to_f32(n) * f32(256.0f)).store(steps + i), (n - i32(1)).store(last + i);
        return n;
      };
      size(texture.height, steps_y, last_row);
      size(texture.width, steps_x, last_column).store(columns + i);
    }
    std::memcpy(first, texture.offset, sizeof texture.offset), first[kLevelWords - 1] = 0;
    if (scene.height_rows.empty()) return;
    const HeightRows& rows = scene.height_rows[static_cast<size_t>(index)];
    heights = rows.offset[0] > -1, slope = (u.gain * kRawToUnit) * u.bump_multiplier;
    static_assert(sizeof rows.offset == sizeof first_height);
    std::memcpy(first_height, rows.offset, sizeof rows.offset);
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
    return word_of_level(reinterpret_cast<const uint32_t*>(table), level);
  }
  HWY_INLINE F32 operator()(const float* table) const {
    return float_from_bits((*this)(reinterpret_cast<const int32_t*>(table)));
  }
};

// Those that were read last, by the lower bits of their uses.
struct PlainTextures {
  static constexpr int kEntries = 8;
  PlainTexture entry[kEntries];
  HWY_INLINE const PlainTexture& open(const SceneData& scene, int32_t use) {
    PlainTexture& texture = entry[use % kEntries];
    if (use != texture.use) texture.open(scene, use);
    return texture;
  }
};

// find_texels() for bilinear samples at (s, t).
template <class At> HWY_INLINE TexelLanes find_plain_texels(const PlainTexture& texture, F32 s, F32 t, const At& at) {
  const I32 byte = i32(255), one = i32(1), half = i32(128), zero = I32::zero();
  const I32 x = nearest_i32_small(s * at(texture.steps_x)) - half, y = nearest_i32_small(t * at(texture.steps_y)) - half;
  const I32 last_column = at(texture.last_column), last_row = at(texture.last_row);
  const I32 columns = at(texture.columns), first = at(texture.first);
  const I32 left = min_unsigned(shift_right<8>(x), last_column), right = select(left == last_column, zero, left + one);
  const I32 row = min_unsigned(shift_right<8>(y), last_row), top = row * columns + first;
  const I32 bottom = select(row == last_row, first, top + columns);
  return {{top + left, top + right, bottom + left, bottom + right}, x & byte, y & byte};
}

// A point of a texture, and which levels it is read at.
struct PlainPlace {
  F32 s, t;
  I32 level, next, weight;  // of the next one, in 1/256
  bool blend;               // two levels, else only the first
};

HWY_INLINE PlainPlace place_of(const PlainTexture& texture, const UvLanes& uv, Mask active, Filter filter) {
  PlainPlace p;
  p.s = fraction(uv.u), p.t = f32(1.0f) - fraction(uv.v);
  const I32 level_256 = level_of_detail(uv, f32(texture.width), f32(texture.height), i32(texture.levels));
  const bool trilinear = filter == Filter::kTrilinear;
  p.level = shift_right<8>(trilinear ? level_256 : level_256 + i32(128));
  p.next = min_(p.level + i32(1), i32(texture.levels - 1));
  p.weight = level_256 & i32(255);
  p.blend = trilinear && any(active & (p.weight != i32(0)));
  return p;
}

// visit(tables at the level, tables at the next one).
template <class Visit> HWY_INLINE void with_tables(const PlainPlace& p, const Visit& visit) {
  const int32_t first = first_lane(p.level);
  if (all(p.level == i32(first))) visit(OneLevel{first}, OneLevel{first_lane(p.next)});
  else visit(ManyLevels{p.level}, ManyLevels{p.next});
}

// Where a sample of a plain texture reads.
struct PlainSample {
  int32_t use = -1;    // of that texture
  bool blend = false;  // two levels, else only the first is set
  TexelLanes near_level, far_level;
  I32 weight;          // of the second, in 1/256
};

// Contract: with read_plain_sample(), the bits that open_use(), sample<3>() and color_of() give in the active lanes. Not for
//           Filter::kNearest.
HWY_INLINE void find_plain_sample(const PlainTexture& texture, const UvLanes& uv, Mask active, Filter filter,
                                  PlainSample& sample) {
  const PlainPlace place = place_of(texture, uv, active, filter);
  sample.weight = place.weight, sample.blend = place.blend, sample.use = texture.use;
  with_tables(place, [&](const auto& at, const auto& at_next) HWY_ATTR {
    sample.near_level = find_plain_texels(texture, place.s, place.t, at);
    if (sample.blend) sample.far_level = find_plain_texels(texture, place.s, place.t, at_next);
  });
}

// Gain 1 and base 0 would change no bit, nor does max_() with 0: blends of texels are not negative.
HWY_INLINE V3f read_plain_sample(const SceneData& scene, const PlainSample& sample) {
  RawSample raw = blend_texels<3>(scene, sample.near_level, false);
  if (sample.blend) blend_levels(raw, blend_texels<3>(scene, sample.far_level, false), to_f32(sample.weight) * f32(0x1p-8f), 3);
  const F32 unit = f32(kRawToUnit);
  return {raw.c[0] * unit, raw.c[1] * unit, raw.c[2] * unit};
}

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_PLAIN_TEXTURE_INL_H_
