// Nodes of the trees that rays go down: of triangles (ray/bvh_data.h), of spheres (ray/sphere_tree.h).
#pragma once
#include <cstdint>

namespace spanray {

inline constexpr int kBvhWidth = 8;       // children of a node, triangles of a leaf block
inline constexpr int kBvhMaxDepth = 64;   // nodes on any path from the root
inline constexpr int kBvhStackSize = kBvhMaxDepth * (kBvhWidth - 1) + 1;

// Boxes of eight children as arrays. Unused slots hold the empty box (+inf, -inf), which every ray misses.
struct alignas(64) BvhNode {
  float bounds[6][kBvhWidth];  // min x, y, z, max x, y, z
  uint32_t child[kBvhWidth];   // the index of a node, or of triangles kLeafBit | block << 3 | (triangles - 1)
};
inline constexpr uint32_t kLeafBit = 0x80000000u;
inline uint32_t leaf_child(uint32_t block, uint32_t triangles) { return kLeafBit | block << 3 | (triangles - 1); }
inline uint32_t leaf_block(uint32_t child) { return (child & ~kLeafBit) >> 3; }
inline uint32_t leaf_triangles(uint32_t child) { return (child & 7) + 1; }
inline uint32_t leaf_lanes(uint32_t child) { return (2u << (child & 7)) - 1; }  // bits of the triangles in their block

}  // namespace spanray
