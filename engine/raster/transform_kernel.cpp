// World vertices -> homogeneous pixels, outcodes, snapped positions.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "raster/fixed_point.h"
#include "raster/raster.h"
#include "raster/transform_kernel.h"
#include "simd/dispatch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/transform_kernel.cpp"
#include "hwy/foreach_target.h"
#include "simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// dot3 of math/vec.h, in lanes: the same order of operations.
HWY_INLINE F64 dot_row(const glm::dvec3& row, const F64 v[3]) {
  return v[0] * f64(row.x) + v[1] * f64(row.y) + v[2] * f64(row.z);
}

HWY_INLINE I32 bit_if_less(F64 a, F64 b, uint32_t bit) { return select(a < b, i32(bit), I32::zero()); }

// The bits of enum Outcode. The guard band is 2^15, so its products are exact, and the clipper's comparisons agree.
HWY_INLINE I32 outcodes(const Frame& frame, F64 x, F64 y, F64 w) {
  const F64 zero = f64(0.0);
  const F64 guard = w * f64(kGuardBandPixels);
  I32 code = bit_if_less(w, f64(frame.primary.near_plane), kOutNear);
  code = code | bit_if_less(x, -guard, kOutLeft) | bit_if_less(guard, x, kOutRight);
  code = code | bit_if_less(y, -guard, kOutTop) | bit_if_less(guard, y, kOutBottom);
  code = code | bit_if_less(x, zero, kOffLeft) | bit_if_less(w * f64(frame.primary.width), x, kOffRight);
  code = code | bit_if_less(y, zero, kOffTop) | bit_if_less(w * f64(frame.primary.height), y, kOffBottom);
  const F64 nan_if_invalid = x * zero + y * zero + w * zero;
  return select(nan_if_invalid == zero, code, i32(kOutInvalid));
}

// One vertex a lane, in double.
// Input:    positions; frame.primary.
// Output:   X, Y, W of frame/rays.h; outcode; round(256 X / W), halves up.
// Contract: exact order of IEEE operations; scalar code that repeats it (math/vec.h dot3, fixed_point.h) gets the same bits.
void transform_range(const Frame& frame, size_t begin, size_t end, ScreenVertices& out) {
  const PrimaryRays& primary = frame.primary;
  const I32 last = i32(static_cast<int32_t>(frame.scene->vertices.size() - 1));
  const float* base = frame.scene->vertices[0].position;
  for (size_t i = begin; i < end; i += kLanes) {
    const I32 word = min_(lane_iota(static_cast<int32_t>(i)), last) * i32(kVertexStride);
    F64 v[3];
    for (int k = 0; k < 3; ++k) v[k] = to_f64(gather(base + k, word)) - f64(primary.eye[k]);
    const F64 x = dot_row(primary.pixel_row_x, v), y = dot_row(primary.pixel_row_y, v), w = dot_row(primary.forward, v);
    x.store(out.x.data() + i);
    y.store(out.y.data() + i);
    w.store(out.w.data() + i);
    round_i32(x / w * f64(kSubpixels)).store(out.x_24_8.data() + i);
    round_i32(y / w * f64(kSubpixels)).store(out.y_24_8.data() + i);
    int32_t code[16];
    outcodes(frame, x, y, w).store(code);
    for (int k = 0; k < kLanes; ++k) out.outcode[i + static_cast<size_t>(k)] = static_cast<uint16_t>(code[k]);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {

const TransformFn kTransformRange[kIsaCount] = SPANRAY_KERNEL_TABLE(transform_range);

void transform_vertices(const Frame& frame, ScreenVertices& out, const ClusterFates* fates) {
  constexpr size_t kChunk = 8192;
  static_assert(kChunk % kBlockVertices == 0 && kBlockVertices % 16 == 0);
  const size_t n = frame.scene->vertices.size();
  const auto fit = [n](auto& buffer) {
    buffer.reserve(n + 16);  // whole vectors are written
    buffer.resize(n);
  };
  fit(out.x), fit(out.y), fit(out.w), fit(out.x_24_8), fit(out.y_24_8), fit(out.outcode);
  const TransformFn transform = kTransformRange[isa_index(frame.isa)];
  frame.parallel->for_each((n + kChunk - 1) / kChunk, [&](size_t chunk, int) {
    const size_t end = std::min(n, (chunk + 1) * kChunk);
    if (fates == nullptr || fates->all_blocks) {
      transform(frame, chunk * kChunk, end, out);
      return;
    }
    const auto wanted = [&](size_t i) { return fates->block[i / kBlockVertices] != 0; };
    for (size_t first = chunk * kChunk; first < end;) {
      size_t last = first;
      while (last < end && wanted(last)) last += kBlockVertices;
      if (last > first) transform(frame, first, std::min(end, last), out);
      for (first = last; first < end && !wanted(first);) first += kBlockVertices;
    }
  });
}

}  // namespace spanray
#endif
