// What every builder makes nodes and leaves from.
#pragma once
#include <algorithm>
#include <limits>

#include "frame/frame.h"
#include "ray/bvh_data.h"
#include "ray/bvh_split.h"

namespace spanray::bvh {

inline Box triangle_box(const SceneData& scene, const Triangle& t) {
  Box box = Box::empty();
  for (const uint32_t v : t.vertex) {
    const float* p = scene.vertices[v].position;
    box.add(Box::of(F4{p[0], p[1], p[2], 0}));
  }
  return box;
}

inline Box box_of(const float* lo, const float* hi) { return {F4{lo[0], lo[1], lo[2], 0}, F4{hi[0], hi[1], hi[2], 0}}; }

inline BvhNode empty_node() {
  constexpr float inf = std::numeric_limits<float>::infinity();
  BvhNode node;
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < kBvhWidth; ++i) node.bounds[k][i] = inf, node.bounds[k + 3][i] = -inf;
  std::fill(node.child, node.child + kBvhWidth, 0u);
  return node;
}

inline void set_box(BvhNode& node, int slot, const Box& box) {
  for (int k = 0; k < 3; ++k) node.bounds[k][slot] = box.lo[k], node.bounds[k + 3][slot] = box.hi[k];
}

// The triangles of a leaf, each once, ascending: lanes do not depend on how references were shuffled.
struct LeafIds {
  uint32_t id[kBvhWidth];
  uint32_t count = 0;
  void add(uint32_t primitive) {
    uint32_t at = count;
    while (at > 0 && id[at - 1] > primitive) --at;
    if (at > 0 && id[at - 1] == primitive) return;
    std::copy_backward(id + at, id + count, id + count + 1);
    id[at] = primitive;
    ++count;
  }
};

inline TriangleBlock make_block(const SceneData& scene, const LeafIds& ids) {
  TriangleBlock block{};
  for (uint32_t i = 0; i < ids.count; ++i) {
    const Triangle& t = scene.triangles[ids.id[i]];
    block.primitive[i] = ids.id[i];
    for (int v = 0; v < 3; ++v)
      for (int k = 0; k < 3; ++k) block.vertex[v][k][i] = scene.vertices[t.vertex[v]].position[k];
  }
  return block;
}

}  // namespace spanray::bvh
