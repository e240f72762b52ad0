#include "raster/clusters.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spanray {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

glm::dvec3 position_of(const SceneData& scene, uint32_t vertex) {
  const float* const p = scene.vertices[vertex].position;
  return {p[0], p[1], p[2]};
}

// Collects the blocks that vertices are in. Deterministic, and never leaves one out.
class BlockCollector {
 public:
  void add(uint32_t vertex) {
    const uint32_t block = vertex / kBlockVertices;
    if (last_ < runs_ && block >= run_[last_].first && block < run_[last_].end) return;
    int nearest = 0;
    uint32_t least = std::numeric_limits<uint32_t>::max();
    for (int i = 0; i < runs_; ++i) {
      const BlockRun& r = run_[i];
      const uint32_t gap = block < r.first ? r.first - block : block >= r.end ? block - r.end + 1 : 0;
      if (gap < least) least = gap, nearest = i;
    }
    if (least > kNear && runs_ < ClusterBlocks::kMostRuns) {
      run_[last_ = runs_++] = {block, block + 1};
      return;
    }
    BlockRun& r = run_[last_ = nearest];
    r = {std::min(r.first, block), std::max(r.end, block + 1)};
  }
  ClusterBlocks blocks() const {
    ClusterBlocks out{};
    uint32_t sum = 0;
    for (int i = 0; i < runs_; ++i) out.run[i] = run_[i], sum += run_[i].end - run_[i].first;
    out.runs = sum <= ClusterBlocks::kMostBlocks ? static_cast<uint32_t>(runs_) : 0;
    return out;
  }

 private:
  static constexpr uint32_t kNear = 2;  // a new run is not worth while for a smaller gap
  BlockRun run_[ClusterBlocks::kMostRuns];
  int runs_ = 0, last_ = 0;
};

// The numbers of one cluster.
class ClusterMaker {
 public:
  ClusterMaker(const SceneData& scene, Clusters& out) : scene_(scene), out_(out) {}

  void make(size_t cluster) {
    begin_ = static_cast<uint32_t>(cluster * kClusterTriangles);
    count_ = static_cast<int>(std::min<size_t>(kClusterTriangles, scene_.triangles.size() - begin_));
    BlockCollector blocks;
    read(blocks);
    out_.blocks[cluster] = blocks.blocks();
    set_box(cluster);
    set_cone(cluster);
  }

 private:
  // Normals as facing() of frame/frame.h has them, bit for bit, turned to the front; the bounds of all corners.
  void read(BlockCollector& blocks) {
    low_ = glm::dvec3(std::numeric_limits<double>::infinity()), high_ = -low_, finite_ = true;
    for (int i = 0; i < count_; ++i) {
      const Triangle& t = scene_.triangles[begin_ + static_cast<uint32_t>(i)];
      glm::dvec3 v[3];
      for (int k = 0; k < 3; ++k) {
        blocks.add(t.vertex[k]);
        v[k] = position_of(scene_, t.vertex[k]);
        for (int a = 0; a < 3; ++a) low_[a] = std::min(low_[a], v[k][a]), high_[a] = std::max(high_[a], v[k][a]);
        finite_ &= (v[k].x - v[k].x) + (v[k].y - v[k].y) + (v[k].z - v[k].z) == 0;
      }
      const glm::dvec3 normal = cross3(v[1] - v[0], v[2] - v[0]);
      normal_[i] = (t.bits & kTriangleFlipped) ? -normal : normal;
      corner_[i] = v[0];
    }
  }

  void set_box(size_t cluster) const {
    for (int a = 0; a < 3; ++a) {
      const float center = static_cast<float>(0.5 * (low_[a] + high_[a]));
      const double half = std::max(high_[a] - center, center - low_[a]);
      out_.center[a][cluster] = finite_ ? center : 0;
      // Rounded up, though both the difference and the conversion may have rounded it down.
      out_.half[a][cluster] = finite_ ? static_cast<float>(half * (1 + 0x1p-20)) + std::numeric_limits<float>::denorm_min() : kInfinity;
    }
  }

  // Triangles whose normal is zero face nobody, wherever the eye is: each product in facing() is zero.
  void set_cone(size_t cluster) const {
    glm::dvec3 sum(0);
    for (int i = 0; i < count_; ++i) sum += normal_[i];
    const glm::dvec3 unit = normalize3(sum, glm::dvec3(0));
    float axis[3];
    for (int a = 0; a < 3; ++a) axis[a] = out_.axis[a][cluster] = static_cast<float>(unit[a]);
    const glm::dvec3 axis_d(axis[0], axis[1], axis[2]), center(out_.center[0][cluster], out_.center[1][cluster], out_.center[2][cluster]);
    double cosine = 1, offset = 0;
    bool facing_one_way = finite_;
    for (int i = 0; i < count_; ++i) {
      const glm::dvec3& n = normal_[i];
      const double square = dot3(n, n);
      if (n.x == 0 && n.y == 0 && n.z == 0) continue;
      facing_one_way &= square > 1e-280;  // far above what underflow could do to it
      const double scale = 1 / std::sqrt(square);
      cosine = std::min(cosine, dot3(n, axis_d) * scale), offset = std::max(offset, dot3(n, center - corner_[i]) * scale);
    }
    cosine -= kCosineMargin;
    if (!(cosine > kLeastCosine)) facing_one_way = false;
    out_.cosine[cluster] = static_cast<float>(cosine);
    out_.sine[cluster] = static_cast<float>(std::sqrt(std::max(0.0, 1 - cosine * cosine)));
    out_.offset[cluster] = facing_one_way ? static_cast<float>(offset) : kInfinity;
  }

  // Above what the stored floats are off: |axis| by 2^-24, cosine and sine by 2^-25, offset by 2^-24 of itself. A cone that is wider by so much
  // has 2^-21 |x| more (of x, y and f in cluster_kernel.cpp) and 2^-21 y cosine / sine; where a cluster is dropped, offset < |x|.
  static constexpr double kCosineMargin = 0x1p-21;
  static constexpr double kLeastCosine = 0.25;  // wider cones drop nothing
  const SceneData& scene_;
  Clusters& out_;
  uint32_t begin_ = 0;
  int count_ = 0;
  bool finite_ = true;
  glm::dvec3 low_{0}, high_{0}, normal_[kClusterTriangles], corner_[kClusterTriangles];
};

}  // namespace

size_t Clusters::memory_bytes() const {
  size_t bytes = cosine.bytes() + sine.bytes() + offset.bytes() + blocks.bytes();
  for (int a = 0; a < 3; ++a) bytes += center[a].bytes() + half[a].bytes() + axis[a].bytes();
  return bytes;
}

Clusters make_clusters(const SceneData& scene, const std::vector<MovingRun>& moving, Parallel& parallel) {
  Clusters out;
  out.triangles = scene.triangles.size(), out.vertices = scene.vertices.size();
  const size_t count = (out.triangles + kClusterTriangles - 1) / kClusterTriangles;
  for (int a = 0; a < 3; ++a) out.center[a].resize(count), out.half[a].resize(count), out.axis[a].resize(count);
  out.cosine.resize(count), out.sine.resize(count), out.offset.resize(count), out.blocks.resize(count);
  constexpr size_t kTask = 64;
  parallel.for_each((count + kTask - 1) / kTask, [&](size_t task, int) {
    ClusterMaker maker(scene, out);
    for (size_t i = task * kTask; i < std::min(count, (task + 1) * kTask); ++i) maker.make(i);
  });
  for (const ClusterBlocks& b : out.blocks) out.scattered += b.runs == 0;
  for (const MovingRun& run : moving)
    for (size_t i = run.first / kClusterTriangles; i * kClusterTriangles < size_t{run.first} + run.count; ++i)
      for (int a = 0; a < 3; ++a) out.half[a][i] = kInfinity;
  return out;
}

}  // namespace spanray
