// Which clusters a frame drops, one a lane.
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "raster/cluster_kernel.h"
#include "simd/dispatch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/cluster_kernel.cpp"
#include "hwy/foreach_target.h"
#include "simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

class ClusterTester {
 public:
  ClusterTester(const Frame& frame, const Clusters& clusters, const OccluderDepths& occluders)
      : primary_(frame.primary), clusters_(clusters), occluders_(occluders) {
    cull_back_ = frame.settings.culling == Culling::kBack;
    right_row_ = primary_.pixel_row_x - primary_.forward * static_cast<double>(primary_.width);
    bottom_row_ = primary_.pixel_row_y - primary_.forward * static_cast<double>(primary_.height);
    middle_row_x_ = primary_.pixel_row_x - primary_.forward * (0.5 * primary_.width);
    middle_row_y_ = primary_.pixel_row_y - primary_.forward * (0.5 * primary_.height);
  }

  void test(size_t first, uint8_t* fate) {
    for (int a = 0; a < 3; ++a) {
      half_[a] = to_f64(F32::load(clusters_.half[a].data() + first));
      from_eye_[a] = to_f64(F32::load(clusters_.center[a].data() + first)) - f64(primary_.eye[a]);
      reach_[a] = abs_(from_eye_[a]) + half_[a];
    }
    const Mask outside = is_outside();
    const Mask back = cull_back_ ? is_back_face(first) : first_lanes(0);
    int32_t code[16];
    select(outside, i32(int32_t{kClusterOutside}), select(back, i32(int32_t{kClusterBackFace}), I32::zero())).store(code);
    for (int k = 0; k < kLanes; ++k) fate[k] = static_cast<uint8_t>(code[k]);
    if (occluders_.any && any(!(outside | back))) hide(fate);
  }

 private:
  struct Bounds {
    F64 low, high, most;
  };  // most: above all magnitudes on the way, here and of each vertex

  // Of dot(row, v - eye) for all v in the box.
  Bounds bounds(const glm::dvec3& row) const {
    const auto a = [](double x) HWY_ATTR { return f64(x < 0 ? -x : x); };
    const F64 middle = f64(row.x) * from_eye_[0] + f64(row.y) * from_eye_[1] + f64(row.z) * from_eye_[2];
    const F64 reach = a(row.x) * half_[0] + a(row.y) * half_[1] + a(row.z) * half_[2];
    return {middle - reach, middle + reach, a(row.x) * reach_[0] + a(row.y) * reach_[1] + a(row.z) * reach_[2]};
  }

  // The comparisons of outcodes() in transform_kernel.cpp, for all vertices of a cluster. What is computed for a vertex is off
  // by less than 2^-49 of `most` of what is compared, what is computed here by as little.
  Mask is_outside() const {
    const F64 margin = f64(0x1p-40), zero = f64(0.0);
    const Bounds x = bounds(primary_.pixel_row_x), y = bounds(primary_.pixel_row_y), w = bounds(primary_.forward);
    const Bounds right = bounds(right_row_), bottom = bounds(bottom_row_);
    const F64 least = f64(1e-280);  // above all that underflows
    const F64 margin_x = (x.most + w.most * f64(primary_.width)) * margin + least;
    const F64 margin_y = (y.most + w.most * f64(primary_.height)) * margin + least;
    // Not invalid, any of them. Infinite boxes end here.
    const Mask finite = x.most + y.most + w.most * f64(kGuardBandPixels) < f64(1e300);
    const Mask off = (w.high + w.most * margin + least < f64(primary_.near_plane)) | (x.high + margin_x < zero) |
                     (zero < right.low - margin_x) | (y.high + margin_y < zero) | (zero < bottom.low - margin_y);
    return finite & off;
  }

  // For a unit normal N of a triangle with corner v: N . (eye - v) = N . (eye - center) + N . (center - v)
  // <= |eye - center| cos(angle of axis and eye - center, less that of the cone) + offset = x cosine + y sine + offset.
  // facing() is off by less than 2^-50 |N| |eye - v|, this by as little; clusters.cpp has added what the stored numbers are
  // off.
  Mask is_back_face(size_t first) const {
    F64 axis[3];
    for (int a = 0; a < 3; ++a) axis[a] = to_f64(F32::load(clusters_.axis[a].data() + first));
    const F64* const d = from_eye_;
    const F64 x = -(d[0] * axis[0] + d[1] * axis[1] + d[2] * axis[2]);
    // By the cross product: nothing cancels where the eye lies near the axis.
    const F64 s = d[1] * axis[2] - d[2] * axis[1], t = d[2] * axis[0] - d[0] * axis[2], u = d[0] * axis[1] - d[1] * axis[0];
    const F64 y = sqrt_(s * s + t * t + u * u);
    const auto number = [&](const AlignedBuffer<float>& a) HWY_ATTR { return to_f64(F32::load(a.data() + first)); };
    const F64 most = x * number(clusters_.cosine) + y * number(clusters_.sine) + number(clusters_.offset);
    const F64 reach = reach_[0] + reach_[1] + reach_[2];
    // Infinite boxes fail the second comparison; finite ones end far below.
    return (most < -(reach * f64(0x1p-40)) - f64(1e-140)) & (reach < f64(1e100));
  }

  // Of dot(row, v - eye) / W, in pixels, for all v in the box, and the blocks that they are in. A sample that a triangle covers
  // lies within its box of snapped corners, 1/256 pixel farther out at most.
  struct Blocks {
    I32 first, last;
  };
  Blocks blocks_of(const glm::dvec3& row, const Bounds& w, F64 w_low, int pixels) const {
    const F64 zero = f64(0.0), middle = f64(0.5 * pixels), limit = f64(1e6);
    const Bounds b = bounds(row);
    const F64 margin = (b.most + w.most) * f64(0x1p-30) / w_low + f64(1.0 / 64);
    const F64 low = middle + b.low / select_lt(b.low, zero, w_low, w.high) - margin,
              high = middle + b.high / select_lt(zero, b.high, w_low, w.high) + margin;
    const auto block = [&](F64 x) HWY_ATTR { return shift_right<kBlockBits>(floor_of(min_(max_(x, -limit), limit))); };
    return {max_(block(low), I32::zero()), min_(block(high), i32((pixels - 1) >> kBlockBits))};
  }
  static HWY_INLINE I32 floor_of(F64 a) { return I32::zero() - ceil_i32(-a); }

  // Boxes in front of the near plane whose blocks all have something nearer.
  void hide(uint8_t* fate) const {
    const Bounds w = bounds(primary_.forward);
    const F64 w_low = w.low - w.most * f64(0x1p-40);
    const Mask in_front = f64(primary_.near_plane) < w_low;
    const F64 safe = select(in_front, w_low, f64(1.0));
    const Blocks columns = blocks_of(middle_row_x_, w, safe, primary_.width),
                 rows = blocks_of(middle_row_y_, w, safe, primary_.height);
    const F32 nearest = to_f32(f64(primary_.near_plane * (1 + 0x1p-20)) / safe);
    const Mask may = in_front & (w.most < f64(1e100)) & !(columns.last < columns.first) & !(rows.last < rows.first);
    int32_t x0[16], x1[16], y0[16], y1[16];
    float depth[16];
    columns.first.store(x0), columns.last.store(x1), rows.first.store(y0), rows.last.store(y1), nearest.store(depth);
    for (uint32_t left = to_bits(may); left != 0; left &= left - 1) {
      const int k = __builtin_ctz(left);
      if (fate[k] == kClusterKept && occluders_.hides(x0[k], x1[k], y0[k], y1[k], depth[k])) fate[k] = kClusterHidden;
    }
  }

  static constexpr int kBlockBits = 4;
  static_assert(OccluderDepths::kBlock == 1 << kBlockBits);
  const PrimaryRays& primary_;
  const Clusters& clusters_;
  const OccluderDepths& occluders_;
  bool cull_back_;
  glm::dvec3 right_row_, bottom_row_, middle_row_x_, middle_row_y_;
  F64 from_eye_[3], half_[3], reach_[3];
};

void test_clusters(const Frame& frame, const Clusters& clusters, const OccluderDepths& occluders, size_t begin, size_t end,
                   uint8_t* fate) {
  ClusterTester tester(frame, clusters, occluders);
  for (size_t i = begin; i < end; i += kLanes) tester.test(i, fate + i);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {

const TestClustersFn kTestClusters[kIsaCount] = SPANRAY_KERNEL_TABLE(test_clusters);

namespace {

// Tasks may write to one block: always the same.
void mark(uint8_t& block) { std::atomic_ref<uint8_t>(block).store(1, std::memory_order_relaxed); }

void mark_blocks(const SceneData& scene, const Clusters& clusters, size_t cluster, ClusterFates& out) {
  const ClusterBlocks& used = clusters.blocks[cluster];
  for (uint32_t r = 0; r < used.runs; ++r)
    for (uint32_t b = used.run[r].first; b < used.run[r].end; ++b) mark(out.block[b]);
  if (used.runs > 0) return;
  const size_t begin = cluster * kClusterTriangles, end = std::min<size_t>(clusters.triangles, begin + kClusterTriangles);
  for (size_t t = begin; t < end; ++t)
    for (const uint32_t v : scene.triangles[t].vertex) mark(out.block[v / kBlockVertices]);
}

}  // namespace

void find_cluster_fates(const Frame& frame, const Clusters& clusters, ClusterFates& out) {
  constexpr size_t kTask = 2048;
  const size_t count = clusters.count();
  out.fate.reserve(count + 16);  // whole vectors are written
  out.fate.resize(count);
  out.block.resize((clusters.vertices + kBlockVertices - 1) / kBlockVertices);
  std::memset(out.block.data(), 0, out.block.size());
  out.all_blocks = clusters.scattered > count / 16;
  draw_occluders(frame, clusters.large, out.occluders);
  frame.parallel->for_each((count + kTask - 1) / kTask, [&](size_t task, int) {
    const size_t begin = task * kTask, end = std::min(count, begin + kTask);
    kTestClusters[isa_index(frame.isa)](frame, clusters, out.occluders, begin, end, out.fate.data());
    for (size_t i = begin; i < end && !out.all_blocks; ++i)
      if (out.fate[i] == kClusterKept) mark_blocks(*frame.scene, clusters, i, out);
  });
}

}  // namespace spanray
#endif
