// Copies of parts of a scene.
#pragma once
#include <cstdint>
#include <vector>

namespace spanray {

// p -> linear * p + offset
struct AffineMap {
  double linear[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  double offset[3] = {0, 0, 0};
};

// A part that is instanced, as the OBJ places it: what a tree of its own is built from (ray/bvh_instances.h).
struct InstancedPart {
  std::vector<float> corners;  // 9 a triangle
  size_t triangles() const { return corners.size() / 9; }
};

// The triangles from `first` on are those of a part, in its order, put through the map in double and rounded to float once.
struct Instance {
  uint32_t first = 0, count = 0;  // into SceneData::triangles; count: as many as the part has
  uint32_t part = 0;              // index into SceneData::instanced_parts
  AffineMap world_from_part;
};

}  // namespace spanray
