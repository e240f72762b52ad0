#include "raster/clusters.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "raster/cluster_kernel.h"

namespace spanray {
namespace {

// Collects the blocks that vertices are in. Never leaves one out.
class BlockCollector {
 public:
  void add(uint32_t block) {
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

double twice_area(const SceneData& scene, const Triangle& t) {
  glm::dvec3 v[3];
  for (int i = 0; i < 3; ++i) {
    const float* const p = scene.vertices[t.vertex[i]].position;
    v[i] = {p[0], p[1], p[2]};
  }
  return length3(cross3(v[1] - v[0], v[2] - v[0]));
}

// The largest triangles, among those of at least a thousandth of the square of the scene's size.
std::vector<uint32_t> find_large(const SceneData& scene, const Clusters& clusters) {
  double low[3], high[3], least = 0;
  for (int a = 0; a < 3; ++a) {
    low[a] = std::numeric_limits<double>::infinity(), high[a] = -low[a];
    for (size_t i = 0; i < clusters.count(); ++i) {
      if (std::isinf(clusters.half[a][i])) continue;
      low[a] = std::min(low[a], double{clusters.center[a][i]} - clusters.half[a][i]);
      high[a] = std::max(high[a], double{clusters.center[a][i]} + clusters.half[a][i]);
    }
    least += (high[a] - low[a]) * (high[a] - low[a]) / 1000;
  }
  struct Large {
    double area;
    uint32_t primitive;
  };
  std::vector<Large> found;
  for (size_t i = 0; i < clusters.count(); ++i) {
    if (!(clusters.area[i] * 1.001 >= least)) continue;
    const size_t end = std::min(clusters.triangles, (i + 1) * kClusterTriangles);
    for (size_t t = i * kClusterTriangles; t < end; ++t) {
      const double area = twice_area(scene, scene.triangles[t]);
      if (area >= least) found.push_back({area, static_cast<uint32_t>(t)});
    }
  }
  std::sort(found.begin(), found.end(),
            [](const Large& a, const Large& b) { return a.area != b.area ? a.area > b.area : a.primitive < b.primitive; });
  found.resize(std::min(found.size(), kMostOccluders));
  std::vector<uint32_t> out;
  for (const Large& l : found) out.push_back(l.primitive);
  return out;
}

}  // namespace

ClusterBlocks collect_blocks(const int32_t block[3][kClusterTriangles], int count) {
  BlockCollector blocks;
  for (int i = 0; i < count; ++i)
    for (int k = 0; k < 3; ++k) blocks.add(static_cast<uint32_t>(block[k][i]));
  return blocks.blocks();
}

size_t Clusters::memory_bytes() const {
  size_t bytes =
      cosine.bytes() + sine.bytes() + offset.bytes() + blocks.bytes() + area.bytes() + large.capacity() * sizeof(uint32_t);
  for (int a = 0; a < 3; ++a) bytes += center[a].bytes() + half[a].bytes() + axis[a].bytes();
  return bytes;
}

Clusters make_clusters(const SceneData& scene, const std::vector<MovingRun>& moving, Isa isa, Parallel& parallel) {
  Clusters out;
  out.triangles = scene.triangles.size(), out.vertices = scene.vertices.size();
  const size_t count = (out.triangles + kClusterTriangles - 1) / kClusterTriangles;
  for (int a = 0; a < 3; ++a) out.center[a].resize(count), out.half[a].resize(count), out.axis[a].resize(count);
  out.cosine.resize(count), out.sine.resize(count), out.offset.resize(count), out.blocks.resize(count), out.area.resize(count);
  constexpr size_t kTask = 64;
  parallel.for_each((count + kTask - 1) / kTask, [&](size_t task, int) {
    kMakeClusters[isa_index(isa)](scene, task * kTask, std::min(count, (task + 1) * kTask), out);
  });
  out.large = find_large(scene, out);
  for (const ClusterBlocks& b : out.blocks) out.scattered += b.runs == 0;
  for (const MovingRun& run : moving)
    for (size_t i = run.first / kClusterTriangles; i * kClusterTriangles < size_t{run.first} + run.count; ++i)
      for (int a = 0; a < 3; ++a) out.half[a][i] = std::numeric_limits<float>::infinity();
  return out;
}

}  // namespace spanray
