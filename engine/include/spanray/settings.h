// What to compute and how: plain values, each a knob of speed against error.
#pragma once
#include <cstdint>

namespace spanray {

enum class Isa { kAuto, kScalar, kSse4, kAvx2, kAvx512 };
enum class Shading { kFlat, kGouraud, kPhong };
enum class Shadows { kNone, kRay };
enum class Reflections { kNone, kRay };
enum class Visibility { kRaster, kRay };
enum class Filter { kNearest, kBilinear, kTrilinear };
// How surfaces with 0 < opacity < 1 look: ignored (opaque), blended by alpha, or as a screen-door pattern. kScene: as each
// material says (alpha unless the scene file asks for screen-door).
enum class Transparency { kScene, kNone, kAlpha, kScreenDoor };
enum class Culling { kNone, kBack };
// What is shaded where a pixel has several samples: each distinct surface that they see, once, or every sample on its own.
enum class Antialiasing { kMultisample, kSupersample };
// Normals between the corners of a triangle: blended, hence shorter than 1 where corners differ, or made unit vectors again, as
// Phong 1975 has them. Shorter ones darken highlights and bend reflections within coarse triangles.
enum class Normals { kInterpolated, kRenormalized };
// The power in highlights: its error bounds stand in math/elementary-inl.h (pow_, fast_pow_).
enum class Powers { kFast, kExact };
// Pixels shaded at once. k2x2: an aligned square of 2 x 2 pixels is shaded once, with its shadow and mirror rays, where all
// four see one surface (render/coarse_quads.h); edges, layers of translucent surfaces, ids and depth keep every pixel.
enum class ShadingRate { k2x2, k1x1 };
// The tree that rays go down: built fast, or built to be traced fast (ray/bvh_high.h). No picture depends on it.
enum class TreeQuality { kFast, kHigh };
// Where light ends on triangles with interpolated normals. Off: shadow rays start on the flat triangle and nothing comes from behind
// it, so the edge of light is one of blocks. Lifted: they start above it, where the curved surface is that the normals speak of
// (Hanika 2021; docs/decisions/0015-shadow-terminator.md).
enum class ShadowTerminator { kOff, kLifted };

// Triangles sorted by what shadow rays from each part of the space around a light may meet: shadows in half the time, for memory and
// a build that costs several times that of the tree. No picture depends on them. kAuto: from the second frame of a scene on, if nothing
// moves; kAlways: also for the first, should it be the only one.
enum class LightGridUse { kAuto, kNever, kAlways };

inline constexpr int kSampleCounts[] = {1, 4, 8, 16};
constexpr bool sample_count_ok(int count) {
  for (const int known : kSampleCounts)
    if (count == known) return true;
  return false;
}

// Ranges of Settings.
inline constexpr int kMaxImageSide = 16384;  // pixels, also of the pictures that are read
inline constexpr int kMaxBounces = 64, kMaxThreads = 1024;
inline constexpr double kMostSeconds = 1e6;  // |time|

struct Settings {
  int width = 1280, height = 720;  // pixels, 1 to 16384
  Shading shading = Shading::kPhong;
  Shadows shadows = Shadows::kRay;
  Reflections reflections = Reflections::kRay;
  int max_bounces = 4;  // mirror bounces after the primary hit, 0 to 64
  Visibility visibility = Visibility::kRaster;
  Filter filter = Filter::kTrilinear;
  Transparency transparency = Transparency::kScene;
  Culling culling = Culling::kNone;
  int samples = 1;  // a pixel, one of kSampleCounts, in the standard patterns of Direct3D 11 (docs/decisions/0007-samples.md)
  Antialiasing antialiasing = Antialiasing::kMultisample;  // only with more than one sample
  Normals normals = Normals::kRenormalized;  // only with Phong shading
  Powers powers = Powers::kExact;
  ShadingRate shading_rate = ShadingRate::k1x1;  // 2x2 only where a pixel is shaded once: not when supersampling
  ShadowTerminator shadow_terminator = ShadowTerminator::kOff;  // only with Gouraud and Phong shading
  double time = 0;  // seconds: where moving parts stand (docs of scene files: [[moving]]); nothing else depends on it
  bool textures = true;
  bool bump = true;
  TreeQuality tree = TreeQuality::kFast;
  LightGridUse light_grids = LightGridUse::kAuto;
  int threads = 0;  // 0: one per processor
  Isa isa = Isa::kAuto;
};

}  // namespace spanray
