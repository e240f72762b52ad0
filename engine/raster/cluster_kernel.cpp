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
  ClusterTester(const Frame& frame, const Clusters& clusters) : primary_(frame.primary), clusters_(clusters) {
    cull_back_ = frame.settings.culling == Culling::kBack;
    right_row_ = primary_.pixel_row_x - primary_.forward * static_cast<double>(primary_.width);
    bottom_row_ = primary_.pixel_row_y - primary_.forward * static_cast<double>(primary_.height);
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
  }

 private:
  struct Bounds { F64 low, high, most; };  // most: above all magnitudes on the way, here and of each vertex

  // Of dot(row, v - eye) for all v in the box.
  Bounds bounds(const glm::dvec3& row) const {
    const auto a = [](double x) HWY_ATTR { return f64(x < 0 ? -x : x); };
    const F64 middle = f64(row.x) * from_eye_[0] + f64(row.y) * from_eye_[1] + f64(row.z) * from_eye_[2];
    const F64 reach = a(row.x) * half_[0] + a(row.y) * half_[1] + a(row.z) * half_[2];
    return {middle - reach, middle + reach, a(row.x) * reach_[0] + a(row.y) * reach_[1] + a(row.z) * reach_[2]};
  }

  // The comparisons of outcodes() in transform_kernel.cpp, for all vertices of a cluster. What is computed for a vertex is off by less than
  // 2^-49 of `most` of what is compared, what is computed here by as little.
  Mask is_outside() const {
    const F64 margin = f64(0x1p-40), zero = f64(0.0);
    const Bounds x = bounds(primary_.pixel_row_x), y = bounds(primary_.pixel_row_y), w = bounds(primary_.forward);
    const Bounds right = bounds(right_row_), bottom = bounds(bottom_row_);
    const F64 least = f64(1e-280);  // above all that underflows
    const F64 margin_x = (x.most + w.most * f64(primary_.width)) * margin + least;
    const F64 margin_y = (y.most + w.most * f64(primary_.height)) * margin + least;
    // Not invalid, any of them. Infinite boxes end here.
    const Mask finite = x.most + y.most + w.most * f64(kGuardBandPixels) < f64(1e300);
    const Mask off = (w.high + w.most * margin + least < f64(primary_.near_plane)) | (x.high + margin_x < zero) | (zero < right.low - margin_x) |
                     (y.high + margin_y < zero) | (zero < bottom.low - margin_y);
    return finite & off;
  }

  // For a unit normal N of a triangle with corner v: N . (eye - v) = N . (eye - center) + N . (center - v)
  // <= |eye - center| cos(angle of axis and eye - center, less that of the cone) + offset = x cosine + y sine + offset. facing() is off by
  // less than 2^-50 |N| |eye - v|, this by as little; clusters.cpp has added what the stored numbers are off.
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

  const PrimaryRays& primary_;
  const Clusters& clusters_;
  bool cull_back_;
  glm::dvec3 right_row_, bottom_row_;
  F64 from_eye_[3], half_[3], reach_[3];
};

void test_clusters(const Frame& frame, const Clusters& clusters, size_t begin, size_t end, uint8_t* fate) {
  ClusterTester tester(frame, clusters);
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
  frame.parallel->for_each((count + kTask - 1) / kTask, [&](size_t task, int) {
    const size_t begin = task * kTask, end = std::min(count, begin + kTask);
    kTestClusters[isa_index(frame.isa)](frame, clusters, begin, end, out.fate.data());
    for (size_t i = begin; i < end && !out.all_blocks; ++i)
      if (out.fate[i] == kClusterKept) mark_blocks(*frame.scene, clusters, i, out);
  });
}

}  // namespace spanray
#endif
