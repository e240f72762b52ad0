// The numbers of clusters, a triangle a lane. Sums run in order of triangles, so every instruction set makes the same clusters.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "raster/cluster_kernel.h"
#include "simd/dispatch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/make_clusters_kernel.cpp"
#include "hwy/foreach_target.h"
#include "simd/lanes-inl.h"
#include "raster/depth_plane-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

class ClusterMaker {
 public:
  ClusterMaker(const SceneData& scene, Clusters& out) : scene_(scene), out_(out) {}

  void make(size_t cluster) {
    begin_ = static_cast<int>(cluster * kClusterTriangles);
    count_ = static_cast<int>(std::min<size_t>(kClusterTriangles, scene_.triangles.size() - cluster * kClusterTriangles));
    read();
    out_.blocks[cluster] = find_blocks();
    set_box(cluster);
    set_cone(cluster);
  }

 private:
  // Normals as unturned_facing() has them, bit for bit, turned to the front; the bounds of all corners. Past the last triangle,
  // that again.
  void read() {
    const uint32_t* const triangle = scene_.triangles.data()->vertex;
    const float* const position = scene_.vertices.data()->position;
    const F32 infinity = f32(std::numeric_limits<float>::infinity());
    F32 low[3] = {infinity, infinity, infinity}, high[3] = {-infinity, -infinity, -infinity};
    Mask finite = first_lanes(kLanes);
    for (int i = 0; i < count_; i += kLanes) {
      const I32 word = min_(lane_iota(begin_ + i), i32(begin_ + count_ - 1)) * i32(kTriangleStride);
      Dvec3Lanes v[3];
      for (int k = 0; k < 3; ++k) {
        const I32 vertex = gather(triangle + k, word), at = vertex * i32(kVertexStride);
        shift_right<kBlockBits>(vertex).store(block_[k] + i);
        const F32 p[3] = {gather(position, at), gather(position + 1, at), gather(position + 2, at)};
        for (int a = 0; a < 3; ++a) {
          low[a] = min_(low[a], p[a]), high[a] = max_(high[a], p[a]);
          finite = finite & (p[a] - p[a] == F32::zero());
          if (k == 0) p[a].store(corner_[a] + i);
        }
        v[k] = {to_f64(p[0]), to_f64(p[1]), to_f64(p[2])};
      }
      const Dvec3Lanes normal = cross3(v[1] - v[0], v[2] - v[0]);
      const Mask flipped = gather(triangle + 3, word) < I32::zero();  // kTriangleFlipped is the sign
      select(flipped, -normal.x, normal.x).store(normal_[0] + i);
      select(flipped, -normal.y, normal.y).store(normal_[1] + i);
      select(flipped, -normal.z, normal.z).store(normal_[2] + i);
    }
    finite_ = all(finite);
    for (int a = 0; a < 3; ++a) low_[a] = min_of_lanes(low[a]), high_[a] = -min_of_lanes(-high[a]);
  }

  // One run or two, where all blocks are near the first or the last one; else whatever collect_blocks makes of them.
  ClusterBlocks find_blocks() const {
    constexpr int kNear = 3;
    I32 least = I32::load(block_[0]), most = least;
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < count_; i += kLanes)
        least = min_(least, I32::load(block_[k] + i)), most = max_(most, I32::load(block_[k] + i));
    const int first = lane_min(least), last = -lane_min(I32::zero() - most);
    I32 end_low = i32(first), begin_high = i32(last);
    Mask between = first_lanes(0);
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < count_; i += kLanes) {
        const I32 block = I32::load(block_[k] + i);
        const Mask low = block < i32(first + kNear), high = and_not(low, block > i32(last - kNear));
        between = between | !(low | high);
        end_low = select(low, max_(end_low, block), end_low), begin_high = select(high, min_(begin_high, block), begin_high);
      }
    if (any(between)) return collect_blocks(block_, count_);
    const uint32_t low_end = static_cast<uint32_t>(-lane_min(I32::zero() - end_low)) + 1,
                   high_begin = static_cast<uint32_t>(lane_min(begin_high));
    ClusterBlocks out{};
    out.run[0] = {static_cast<uint32_t>(first), low_end}, out.runs = 1;
    if (static_cast<uint32_t>(last) >= low_end) out.run[1] = {high_begin, static_cast<uint32_t>(last) + 1}, out.runs = 2;
    return out;
  }

  void set_box(size_t cluster) const {
    for (int a = 0; a < 3; ++a) {
      const float center = static_cast<float>(0.5 * (low_[a] + high_[a]));
      const double half = std::max(high_[a] - center, center - low_[a]);
      out_.center[a][cluster] = finite_ ? center : 0;
      // Rounded up, though both the difference and the conversion may have rounded it down.
      out_.half[a][cluster] = finite_ ? static_cast<float>(half * (1 + 0x1p-20)) + std::numeric_limits<float>::denorm_min()
                                      : std::numeric_limits<float>::infinity();
    }
  }

  // Triangles whose normal is zero face nobody, wherever the eye is: each product in facing() is zero.
  void set_cone(size_t cluster) const {
    glm::dvec3 sum(0), center;
    for (int i = 0; i < count_; ++i) sum.x += normal_[0][i], sum.y += normal_[1][i], sum.z += normal_[2][i];
    const glm::dvec3 unit = normalize3(sum, glm::dvec3(0));
    float axis[3];
    for (int a = 0; a < 3; ++a)
      axis[a] = out_.axis[a][cluster] = static_cast<float>(unit[a]), center[a] = out_.center[a][cluster];
    const Dvec3Lanes axes = splat(glm::dvec3(axis[0], axis[1], axis[2])), middle = splat(center);
    const F64 zero = f64(0.0), one = f64(1.0);
    F64 cosines = one, offsets = zero, squares = one, largest = zero;  // the least, the greatest, the least, the greatest
    for (int i = 0; i < count_; i += kLanes) {
      const Dvec3Lanes n = {F64::load(normal_[0] + i), F64::load(normal_[1] + i), F64::load(normal_[2] + i)};
      const Dvec3Lanes corner = {to_f64(F32::load(corner_[0] + i)), to_f64(F32::load(corner_[1] + i)),
                                 to_f64(F32::load(corner_[2] + i))};
      const F64 square = dot3(n, n), scale = one / sqrt_(square);
      cosines = min_(cosines, select_eq(square, zero, one, dot3(n, axes) * scale));
      offsets = max_(offsets, select_eq(square, zero, zero, dot3(n, middle - corner) * scale));
      squares = min_(squares, select_eq(square, zero, one, square));
      largest = max_(largest, square);
    }
    const double cosine = lane_min(cosines) - kCosineMargin;
    // The last is far above what underflow could do to a normal.
    const bool narrow = finite_ && cosine > kLeastCosine && lane_min(squares) > 1e-280;
    out_.area[cluster] = finite_ ? static_cast<float>(std::sqrt(-lane_min(-largest))) : 0.0f;
    out_.cosine[cluster] = narrow ? static_cast<float>(cosine) : 1.0f;
    out_.sine[cluster] = narrow ? static_cast<float>(std::sqrt(1 - cosine * cosine)) : 0.0f;
    out_.offset[cluster] = narrow ? static_cast<float>(-lane_min(-offsets)) : std::numeric_limits<float>::infinity();
  }

  static int lane_min(I32 a) {
    int32_t lane[16];
    a.store(lane);
    return *std::min_element(lane, lane + kLanes);
  }
  static double lane_min(F64 a) {
    double lane[16];
    a.store(lane);
    return *std::min_element(lane, lane + kLanes);
  }

  // Above what the stored floats are off: |axis| by 2^-24, cosine and sine by 2^-25, offset by 2^-24 of itself. A cone that is
  // wider by so much has 2^-21 |x| more (of x, y and f in cluster_kernel.cpp) and 2^-21 y cosine / sine; where a cluster is
  // dropped, offset < |x|.
  static constexpr double kCosineMargin = 0x1p-21;
  static constexpr double kLeastCosine = 0.25;  // wider cones drop nothing
  static constexpr int kBlockBits = 6;
  static_assert(kBlockVertices == 1 << kBlockBits && kClusterTriangles % 16 == 0);
  const SceneData& scene_;
  Clusters& out_;
  int begin_ = 0, count_ = 0;
  bool finite_ = true;
  double low_[3], high_[3];
  alignas(64) double normal_[3][kClusterTriangles];
  alignas(64) float corner_[3][kClusterTriangles];
  alignas(64) int32_t block_[3][kClusterTriangles];
};

void make_cluster_range(const SceneData& scene, size_t begin, size_t end, Clusters& out) {
  ClusterMaker maker(scene, out);
  for (size_t i = begin; i < end; ++i) maker.make(i);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {

const MakeClustersFn kMakeClusters[kIsaCount] = SPANRAY_KERNEL_TABLE(make_cluster_range);

}  // namespace spanray
#endif
