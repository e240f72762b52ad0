#pragma once
#include "raster/clusters.h"
#include "simd/isa.h"

namespace spanray {

// Writes clusters [begin, end) to out, whose arrays have room.
using MakeClustersFn = void (*)(const SceneData& scene, size_t begin, size_t end, Clusters& out);
extern const MakeClustersFn kMakeClusters[kIsaCount];

// Blocks of the vertices of `count` triangles, block[corner][triangle] (clusters.cpp).
ClusterBlocks collect_blocks(const int32_t block[3][kClusterTriangles], int count);

// ClusterFate of clusters [begin, end), to fate[begin] and on; begin is a multiple of 16. May write up to 15 entries past end.
using TestClustersFn = void (*)(const Frame& frame, const Clusters& clusters, const OccluderDepths& occluders, size_t begin,
                                size_t end, uint8_t* fate);
extern const TestClustersFn kTestClusters[kIsaCount];

}  // namespace spanray
