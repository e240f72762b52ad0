#pragma once
#include "raster/clusters.h"
#include "simd/isa.h"

namespace spanray {

// ClusterFate of clusters [begin, end), to fate[begin] and on; begin is a multiple of 16. May write up to 15 entries past end.
using TestClustersFn = void (*)(const Frame& frame, const Clusters& clusters, size_t begin, size_t end, uint8_t* fate);
extern const TestClustersFn kTestClusters[kIsaCount];

}  // namespace spanray
