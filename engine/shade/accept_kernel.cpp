// accept(hit): alpha masks and screen-door, for both engines.
#include <cstddef>

#include "frame/transparency.h"
#include "shade/surface_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/accept_kernel.cpp"
#include "hwy/foreach_target.h"
#include "shade/texture-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
using namespace surface_lanes;
namespace {

// Masks are read at most two levels down: far enough for a stable edge; further, the mean of a fence falls below 1/2 and the
// fence disappears.
constexpr int kMaskLastLevel = 2;

// Ranks 0 .. 63 of an 8 x 8 ordered dither (Bayer 1973): the bits of (x ^ y, y), interleaved and reversed.
HWY_INLINE I32 dither_rank(I32 pixel) {
  const I32 x = pixel & i32(7), y = shift_right_logical<16>(pixel) & i32(7), d = x ^ y, one = i32(1);
  return shift_left<5>(d & one) | shift_left<4>(y & one) | shift_left<2>(d & i32(2)) | shift_left<1>(y & i32(2)) |
         shift_right<1>(d & i32(4)) | shift_right<2>(y & i32(4));
}

// Ranks at a sample are those of the pixels, shifted around: the samples of a pixel have ranks 64 / samples apart, so about
// samples * opacity of them accept.
HWY_INLINE I32 sample_shift(const Frame& frame, const HitLanes& hits) {
  return i32(hits.place == 0 ? 0 : (hits.place - 1) * (64 / frame.places.count));
}

// Exactly round(64 * opacity) of the 64 pixels of a mask tile accept, at every sample.
HWY_INLINE Mask screen_door(F32 opacity, I32 pixel, I32 shift) {
  return ((dither_rank(pixel) + shift) & i32(63)) < round_i32(clamp_(opacity, F32::zero(), f32(1.0f)) * f32(64.0f));
}

// map_d at the footprint of the hit, times factor.
F32 mask_opacity(const Frame& frame, const HitLanes& hits, int32_t map, float factor) {
  const SceneData& scene = *frame.scene;
  const RayLanes ray = load_rays(frame, hits);
  const TriangleLanes t = load_triangles(scene, hits);
  const SurfaceLanes s = resolve_lanes(ray, t);
  const DifferentialLanes d = load_differentials(frame, hits);
  const F64 distance = hit_t(s, ray);
  const UvLanes uv = resolve_uv(scene, t, s, transfer(d.origin_dx, d.direction_dx, distance, ray, s.normal),
                                transfer(d.origin_dy, d.direction_dy, distance, ray, s.normal), false);
  UseLanes use = open_use(scene, i32(map), true, hits.valid, uv);
  use.level_256 = min_(use.level_256, i32(kMaskLastLevel * 256));
  const F32 value = f32(factor) * scalar_of(scene, use, sample<4>(scene, use, frame.settings.filter));
  return select(use.active, value, f32(factor));
}

HWY_INLINE Mask accept_lanes(const Frame& frame, const HitLanes& hits, const Material& material) {
  const MaterialTransparency kind = effective_transparency(material, frame.settings);
  const float factor = frame.settings.transparency == Transparency::kNone ? 1.0f : material.opacity;
  F32 opacity = f32(factor);
  if (has_use(*frame.scene, i32(material.map_opacity), hits.valid))
    opacity = mask_opacity(frame, hits, material.map_opacity, factor);
  if (kind == MaterialTransparency::kScreenDoor) return screen_door(opacity, hits.pixel, sample_shift(frame, hits));
  if (kind == MaterialTransparency::kMask) return opacity >= f32(0.5f);
  return first_lanes(kLanes);
}

// Of 32 candidates those that accept, a vector after the other. set(first, wanted, hits): the rays of kLanes candidates from `first` on.
template <class SetRays>
HWY_INLINE uint32_t accept_in_vectors(const Frame& frame, HitLanes& hits, uint32_t candidates, const SetRays& set) {
  const Material& material = frame.scene->materials[material_of(frame.scene->triangles[hits.first_primitive])];
  constexpr uint32_t kGroup = static_cast<uint32_t>((1ull << kLanes) - 1);
  uint32_t accepted = 0;
  for (int first = 0; first < 32; first += kLanes) {
    const uint32_t wanted = (candidates >> first) & kGroup;
    if (wanted == 0) continue;
    set(first, wanted, hits);
    accepted |= (to_bits(accept_lanes(frame, hits, material)) & wanted) << first;
  }
  return accepted;
}

}  // namespace

// Which of up to 32 rays accept one primitive.
// Source:   alpha test: opacity >= 1/2. Screen-door: ordered dither, Bayer 1973.
// Contract: a function of ray (through its pixel for primary rays), primitive and frame alone, so both engines agree.
uint32_t accept_row_entry(const Frame& frame, uint32_t primitive, int x0, int y, uint32_t candidates, int place) {
  HitLanes row{nullptr, i32(0), i32(0), i32(primitive), first_lanes(kLanes), true, primitive, place};
  return accept_in_vectors(frame, row, candidates, [=](int first, uint32_t, HitLanes& hits) HWY_ATTR {
    hits.pixel = lane_iota(x0 + first) | i32(y << 16);
  });
}

uint32_t accept_rays_entry(const Frame& frame, const RayBatch& rays, int first_ray, uint32_t primitive, uint32_t candidates) {
  HitLanes some{&rays, i32(0), i32(0), i32(primitive), first_lanes(kLanes), true, primitive, rays.place};
  return accept_in_vectors(frame, some, candidates, [&](int first, uint32_t wanted, HitLanes& hits) HWY_ATTR {
    // Other lanes repeat a ray: there may be none at their place.
    hits.ray = select(mask_from_bits(wanted), lane_iota(first_ray + first), i32(first_ray + first + __builtin_ctz(wanted)));
    hits.pixel = gather(rays.pixel.data(), hits.ray);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {

const AcceptRowFn kAcceptRow[kIsaCount] = SPANRAY_KERNEL_TABLE(accept_row_entry);
const AcceptRaysFn kAcceptRays[kIsaCount] = SPANRAY_KERNEL_TABLE(accept_rays_entry);

uint32_t accept_row(const Frame& frame, uint32_t primitive, int x0, int y, uint32_t candidates, int place) {
  return kAcceptRow[isa_index(frame.isa)](frame, primitive, x0, y, candidates, place);
}

uint32_t accept_rays(const Frame& frame, const RayBatch& rays, int first, uint32_t primitive, uint32_t candidates) {
  return kAcceptRays[isa_index(frame.isa)](frame, rays, first, primitive, candidates);
}

}  // namespace spanray
#endif
