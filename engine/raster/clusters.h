// Runs of consecutive triangles that are dropped together, before their vertices are transformed: what lies outside the
// picture, what turns its back on the eye, and what lies behind something large (raster/occluders.h).
// Source:   normal cones: Shirman and Abi-Ezzi 1993, "The Cone of Normals Technique for Fast Processing of Curved Patches";
//           clusters: Haar and Aaltonen 2015, "GPU-Driven Rendering Pipelines".
// Contract: a cluster is dropped only if the tests of each triangle (clip_kernel.cpp) would drop all of its triangles, or the
//           depth test all of its fragments, with margins above all rounding. No pixel depends on clusters (DESIGN 3, rule 6),
//           and the same ones are dropped on every instruction set.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "frame/frame.h"
#include "raster/occluders.h"

namespace spanray {

inline constexpr uint32_t kClusterTriangles = 64;  // a multiple of all vectors' lanes
inline constexpr uint32_t kBlockVertices = 64;     // what is transformed or not: consecutive vertices
inline constexpr uint32_t kFewTriangles = 4096;    // scenes up to here have no use for clusters

// Blocks of vertices [first, end).
struct BlockRun {
  uint32_t first, end;
};

// What a cluster's triangles use. Few runs, which may hold blocks that none uses.
struct ClusterBlocks {
  static constexpr int kMostRuns = 4;
  static constexpr uint32_t kMostBlocks = 32;
  BlockRun run[kMostRuns];
  uint32_t runs;  // 0: scattered over more than kMostBlocks
};

// Of all clusters of a scene, made once. One array a number, so that lanes are clusters. Where `half` is infinite, a cluster is
// never dropped: one that holds moving triangles or positions that are not finite. Where `offset` is infinite, it is never
// dropped as facing away.
struct Clusters {
  size_t triangles = 0, vertices = 0;
  AlignedBuffer<float> center[3], half[3];  // all vertices lie in center +- half
  // Each unit normal N, on the side that faces front, has N . axis / |axis| >= cosine, and each vertex v of its triangle
  // N . (center - v) <= offset. sine: of the same angle, less than a right one.
  AlignedBuffer<float> axis[3], cosine, sine, offset;
  AlignedBuffer<ClusterBlocks> blocks;
  size_t scattered = 0;         // clusters
  AlignedBuffer<float> area;    // of the largest triangle, twice
  std::vector<uint32_t> large;  // the largest triangles of the scene, at most kMostOccluders

  size_t count() const { return blocks.size(); }
  size_t memory_bytes() const;
};

// moving: runs of triangles whose vertices may stand elsewhere in a later frame; isa: concrete, any makes the same. Parallel.
Clusters make_clusters(const SceneData& scene, const std::vector<MovingRun>& moving, Isa isa, Parallel& parallel);

// What becomes of a cluster in a frame; all of its triangles count as that.
enum ClusterFate : uint8_t { kClusterKept, kClusterOutside, kClusterBackFace, kClusterHidden };

struct ClusterFates {
  AlignedBuffer<uint8_t> fate;   // ClusterFate of each cluster
  AlignedBuffer<uint8_t> block;  // by block of vertices: 1 if a cluster that is kept uses it
  bool all_blocks = true;        // whatever `block` says: so many clusters are scattered that a choice would save nothing
  OccluderDepths occluders;
  size_t memory_bytes() const { return fate.bytes() + block.bytes() + occluders.depth.bytes(); }
};

// Parallel. frame.scene: the scene that the clusters are of, its moving parts anywhere.
void find_cluster_fates(const Frame& frame, const Clusters& clusters, ClusterFates& out);

}  // namespace spanray
