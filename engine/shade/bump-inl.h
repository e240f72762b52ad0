// Perturbed normals: height maps (map_bump) and tangent-space normal maps (norm). Include inside a *_kernel.cpp.
#if defined(SPANRAY_BUMP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_BUMP_INL_H_
#undef SPANRAY_BUMP_INL_H_
#else
#define SPANRAY_BUMP_INL_H_
#endif

#include "shade/plain_texture-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace surface_lanes {

// Cosine to the geometric normal that a shading normal is clamped to.
inline constexpr float kHorizonCosine = 0x1p-10f;

struct TangentLanes {
  V3f u, v;    // unit, along growing s and t of the texture (v up), orthogonal to the normal
  Mask valid;  // false where the triangle has no area in space or uv, or the normal lies in a tangent
};

// The part of the uv tangent orthogonal to n, as a unit vector; direction < 0 where the use mirrors the texture.
HWY_INLINE V3f tangent(const V3f& along, F32 direction, const V3f& n, Mask* valid) {
  const V3f zero{F32::zero(), F32::zero(), F32::zero()};
  const V3f flat = unit_or(along - n * dot(along, n), 0x1p-20f, zero);
  *valid = *valid & (dot(flat, flat) > F32::zero());
  return select(direction < F32::zero(), -flat, flat);
}

HWY_INLINE TangentLanes make_tangents(F32 scale_u, F32 scale_v, const UvLanes& uv, const V3f& n) {
  TangentLanes t;
  t.valid = first_lanes(kLanes);
  t.u = tangent(uv.tangent_u, scale_u, n, &t.valid);
  t.v = tangent(uv.tangent_v, scale_v, n, &t.valid);
  return t;
}
HWY_INLINE TangentLanes make_tangents(const SceneData& scene, const MapLanes& use, const UvLanes& uv, const V3f& n) {
  return make_tangents(use.real(scene, kUseScale), use.real(scene, kUseScale + 1), uv, n);
}

struct SlopeLanes { F32 s, t; };

// The raw heights of 3 x 3 texels around a point.
struct HeightLanes { F32 h[3][3]; };

HWY_INLINE void read_row(const SceneData& scene, I32 index, F32 h[3]) {
  const WordPair heights = gather_pair<sizeof(uint16_t)>(scene.heights.data(), index);
  h[0] = to_f32(heights.low & i32(0xffff)), h[1] = to_f32(shift_right_logical<16>(heights.low)), h[2] = to_f32(heights.high & i32(0xffff));
}

// Whether all active lanes find theirs in SceneData::heights.
HWY_INLINE bool has_height_rows(const SceneData& scene, const UseLanes& use) {
  if (scene.height_rows.empty() || use.any_clamp) return false;
  const I32 first = use.rows.word(reinterpret_cast<const uint32_t*>(scene.height_rows.data()), 0);
  return all((first > i32(-1)) | !use.active);
}

// x: the first column.
HWY_INLINE HeightLanes read_rows(const SceneData& scene, const UseLanes& use, I32 level, I32 width, I32 x, const Neighbours<3>& row) {
  const uint32_t* const offsets = reinterpret_cast<const uint32_t*>(scene.height_rows.data());
  const I32 base = use.rows.uniform ? word_of_level(offsets + use.rows.first, level) : gather(offsets, use.rows.offset + level);
  const I32 column = min_unsigned(x, width - i32(1)), stride = width + i32(2);
  HeightLanes r;
  for (int j = 0; j < 3; ++j) {
    const I32 index = base + row.texel[j] * stride + column;
    read_row(scene, select(use.active, index, I32::zero()), r.h[j]);
  }
  return r;
}

HWY_INLINE HeightLanes read_texels(const SceneData& scene, const UseLanes& use, I32 level, I32 width, I32 x, const Neighbours<3>& row) {
  const uint32_t* const words = reinterpret_cast<const uint32_t*>(scene.texels.data());
  const I32 base = first_texel(scene, use, level);
  const Neighbours<3> column = neighbours<3>(x, width, use);
  HeightLanes r;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      RawSample raw;
      read_texel<4>(words, base + row.texel[j] * width + column.texel[i], raw.c);
      r.h[j][i] = choose_channel(scene, use, raw);
    }
  return r;
}

// From a point in 1/256 texels to the first of the 3 x 3 texels: half a texel for the center, half to the first sample.
inline constexpr int kToFirstHeight = 256;

// Raw height difference over one texel of `level`, per texel of level 0: of bilinear samples half a texel to either side. All four
// lie among the 3 x 3 texels around the point; the two samples of a direction share their weights.
// fx, fy: of the point from the first texel, in 1/256 texels.
HWY_INLINE SlopeLanes slope_of(const HeightLanes& read, I32 fx, I32 fy, I32 level) {
  const I32 byte = i32(255), half = i32(128);
  const auto& h = read.h;
  const F32 step = f32(0x1p-8f);
  const auto blend = [](F32 f, F32 a, F32 b) HWY_ATTR { return mul_add(f, b - a, a); };
  // Differences along a line of three, and which two of the lines lie around the point, how far from the first.
  const auto along = [&](const F32 (&d)[3], I32 f) HWY_ATTR {
    const Mask second = f > i32(127);
    return blend(to_f32((f + half) & byte) * step, select(second, d[1], d[0]), select(second, d[2], d[1]));
  };
  const F32 at_x = to_f32(fx) * step, at_y = to_f32(fy) * step;
  F32 ds[3], dt[3];
  for (int k = 0; k < 3; ++k) {
    ds[k] = blend(at_x, h[k][1] - h[k][0], h[k][2] - h[k][1]);
    dt[k] = blend(at_y, h[0][k] - h[1][k], h[1][k] - h[2][k]);  // rows go down, t up
  }
  const F32 shrink = float_from_bits(shift_left<23>(i32(127) - level));
  return {along(ds, fy) * shrink, along(dt, fx) * shrink};
}

[[maybe_unused]] static HWY_NOINLINE SlopeLanes level_slope(const SceneData& scene, const UseLanes& use, I32 level, bool in_rows) {
  const LevelPlace p = place_on_level(scene, use, level);
  const I32 x = p.x - i32(kToFirstHeight), y = p.y - i32(kToFirstHeight), first_column = shift_right<8>(x);
  const Neighbours<3> row = neighbours<3>(shift_right<8>(y), p.height, use);
  const HeightLanes read = in_rows ? read_rows(scene, use, level, p.width, first_column, row)
                                   : read_texels(scene, use, level, p.width, first_column, row);
  return slope_of(read, x & i32(255), y & i32(255), level);
}

// The same on a level of a plain texture with rows of heights.
template <class At>
HWY_INLINE SlopeLanes plain_slope(const SceneData& scene, const PlainTexture& texture, const PlainPlace& p, I32 level, const At& at) {
  const I32 zero = I32::zero(), one = i32(1), first = i32(kToFirstHeight);
  const I32 x = nearest_i32_small(p.s * at(texture.steps_x)) - first, y = nearest_i32_small(p.t * at(texture.steps_y)) - first;
  const I32 last_row = at(texture.last_row), stride = at(texture.columns) + i32(2);
  const I32 column = min_unsigned(shift_right<8>(x), at(texture.last_column)) + at(texture.first_height);
  const I32 row = min_unsigned(shift_right<8>(y), last_row), next_row = select(row == last_row, zero, row + one);
  const I32 upper = row * stride + column, middle = select(row == last_row, column, upper + stride);
  HeightLanes r;
  read_row(scene, upper, r.h[0]), read_row(scene, middle, r.h[1]);
  read_row(scene, select(next_row == last_row, column, middle + stride), r.h[2]);
  return slope_of(r, x & i32(255), y & i32(255), level);
}

// n' = normalize(n - bm * (dh/ds * T + dh/dt * B)).
// Source:   Blinn 1978, "Simulation of Wrinkled Surfaces", with slopes per texel, free of world units: a step of height 1 over
//           one texel of level 0 is a slope of 1 for bm = 1. Differences are central, of bilinear samples half a texel to
//           either side, on the level of the footprint; trilinear blends the slopes of two levels.
// Contract: exactly n where the slope or bm is 0, or where there is no tangent.
HWY_INLINE V3f apply_slope(const SlopeLanes& slope, F32 scale, const TangentLanes& tangents, Mask active, const V3f& n) {
  const F32 limit = f32(0x1p20f);  // steeper is vertical
  const F32 s = clamp_(slope.s * scale, -limit, limit), t = clamp_(slope.t * scale, -limit, limit);
  const V3f bumped = unit_or(n - tangents.u * s - tangents.v * t, 1e-12f, n);
  const Mask flat = (s == F32::zero()) & (t == F32::zero());
  return select(active & tangents.valid & !flat, bumped, n);
}

HWY_INLINE void blend_slopes(SlopeLanes& slope, const SlopeLanes& far_slope, F32 weight) {
  slope.s = mul_add(weight, far_slope.s - slope.s, slope.s);
  slope.t = mul_add(weight, far_slope.t - slope.t, slope.t);
}

HWY_INLINE V3f apply_height_map(const SceneData& scene, const UseLanes& use, Filter filter, const UvLanes& uv, const V3f& n) {
  const LevelLanes levels = choose_levels(scene, use, filter);
  const bool in_rows = has_height_rows(scene, use);
  SlopeLanes slope = level_slope(scene, use, levels.level, in_rows);
  if (levels.blend) blend_slopes(slope, level_slope(scene, use, levels.next, in_rows), levels.weight);
  const F32 scale = (use.real(scene, kUseGain) * f32(kRawToUnit)) * use.real(scene, kUseMultiplier);
  return apply_slope(slope, scale, make_tangents(scene, use, uv, n), use.active, n);
}

// Contract: with PlainTexture::heights, the bits of open_use() and apply_height_map() in the active lanes.
HWY_INLINE V3f apply_plain_heights(const SceneData& scene, const PlainTexture& texture, Mask active, Filter filter, const UvLanes& uv,
                                   const V3f& n) {
  const PlainPlace place = place_of(texture, uv, active, filter);
  SlopeLanes slope;
  with_tables(place, [&](const auto& at, const auto& at_next) HWY_ATTR {
    slope = plain_slope(scene, texture, place, place.level, at);
    if (place.blend) blend_slopes(slope, plain_slope(scene, texture, place, place.next, at_next), to_f32(place.weight) * f32(0x1p-8f));
  });
  const F32 one = f32(1.0f);
  return apply_slope(slope, f32(texture.slope), make_tangents(one, one, uv, n), active, n);
}

// n' = normalize(x T + y B + z N), the map's y up (the OpenGL convention). A channel c of 8 bits means (c - 128) / 127, so that
// 128 is exactly flat; -bm scales x and y.
HWY_INLINE V3f apply_normal_map(const SceneData& scene, const UseLanes& use, Filter filter, const UvLanes& uv, const V3f& n) {
  const RawSample raw = sample<3>(scene, use, filter);
  const F32 middle = f32(128 * 257), unit = f32(1.0f / (127 * 257)), one = f32(1.0f);
  const F32 bm = use.real(scene, kUseMultiplier);
  const auto decode = [&](int c) HWY_ATTR { return clamp_((raw.c[c] - middle) * unit, -one, one); };
  const F32 x = decode(0) * bm, y = decode(1) * bm, z = decode(2);
  const TangentLanes frame = make_tangents(scene, use, uv, n);
  const V3f bumped = unit_or(frame.u * x + frame.v * y + n * z, 1e-12f, n);
  const Mask flat = (x == F32::zero()) & (y == F32::zero()) & (z > F32::zero());
  return select(use.active & frame.valid & !flat, bumped, n);
}

// A shading normal on or below the horizon of the geometric one is lifted to just above it: n + (kHorizonCosine - n.g) g, as a
// unit vector. Continuous, and exactly n where there is nothing to clamp.
HWY_INLINE V3f clamp_to_horizon(const V3f& n, const V3f& geometric) {
  const F32 cosine = dot(n, geometric);
  if (all(cosine >= f32(kHorizonCosine))) return n;  // nearly always
  const V3f lifted = unit_or(n + geometric * (f32(kHorizonCosine) - cosine), 1e-12f, geometric);
  return select(cosine < f32(kHorizonCosine), lifted, n);
}

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_BUMP_INL_H_
