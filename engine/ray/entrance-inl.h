// Where the rays of a group enter the tree. Included once a target.
// Source:   Haines and Wallace 1991, "Shaft Culling for Efficient Ray-Cast Radiosity" (candidate lists); Reshetov, Soupikov, Hurley 2005,
//           "Multi-Level Ray Tracing Algorithm" (entry points).
#if defined(SPANRAY_ENTRANCE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_ENTRANCE_INL_H_
#undef SPANRAY_ENTRANCE_INL_H_
#else
#define SPANRAY_ENTRANCE_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "ray/shaft-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// With s1, s2 the largest coordinates of the edges at v0 and r = Shaft::reach, n . (x - v0) is off by at most 6e-6 s1 s2 r in float and
// 4e-15 s1 s2 r in double. The margins are larger, since hit_triangle() rounds, too: by at most 1e-14 s r^2, s the larger edge, which is
// little beside the margins where no edge is short.
inline constexpr float kSideError = 2e-5f, kShortEdge = 1e-4f;
inline constexpr double kSideError64 = 0x1p-32;

// Of the triangles of a leaf: those that segments may cross, and those whose plane passes so near to the origins that each must be asked.
struct ShaftTriangles { uint32_t crossed, near; };

HWY_INLINE ShaftTriangles shaft_triangles(const Shaft& shaft, const TriangleBlock& block, int first) {
  F8 v0[3], edge1[3], edge2[3], bounds[6];
  F8 size1 = f8(0.0f), size2 = f8(0.0f);
  for (int k = 0; k < 3; ++k) {
    v0[k] = F8::load(block.vertex[0][k] + first);
    const F8 v1 = F8::load(block.vertex[1][k] + first), v2 = F8::load(block.vertex[2][k] + first);
    bounds[k] = cull_min(cull_min(v0[k], v1), v2), bounds[k + 3] = cull_max(cull_max(v0[k], v1), v2);
    edge1[k] = v1 - v0[k], edge2[k] = v2 - v0[k];
    size1 = cull_max(abs_(edge1[k]), size1), size2 = cull_max(abs_(edge2[k]), size2);
  }
  const uint32_t inside = shaft_boxes(shaft, [&](int r) HWY_ATTR { return bounds[r]; });
  if (inside == 0) return {0, 0};
  F8 least[2] = {f8(0.0f), f8(0.0f)}, greatest[2] = {f8(0.0f), f8(0.0f)};  // of n . (x - v0), x in the boxes of starts and ends
  for (int k = 0; k < 3; ++k) {
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    const F8 n = edge1[a] * edge2[b] - edge1[b] * edge2[a];
    const ShaftBox* const boxes[2] = {&shaft.starts, &shaft.ends};
    for (int i = 0; i < 2; ++i) {
      const F8 low = n * (f8(boxes[i]->low[k]) - v0[k]), high = n * (f8(boxes[i]->high[k]) - v0[k]);
      least[i] = least[i] + cull_min(low, high), greatest[i] = greatest[i] + cull_max(low, high);
    }
  }
  const F8 error = size1 * size2 * f8(shaft.reach * kSideError);
  const Mask8 sound = cull_min(size1, size2) > f8(shaft.reach * kShortEdge);
  const Mask8 front = sound & (least[1] > error), back = sound & (greatest[1] < -error);
  const uint32_t clear = to_bits((front & (least[0] > error)) | (back & (greatest[0] < -error)));
  const uint32_t near = to_bits((front & (greatest[0] > -error)) | (back & (least[0] < error))) & inside & ~clear;
  return {inside & ~clear & ~near, near};
}

// Every segment lies on one side of the plane of a triangle, where the ends do: no ray crosses it. In double where float leaves it open:
// rays start just off the surface that they leave.
HWY_NOINLINE bool on_one_side(const Shaft& shaft, const TriangleBlock& block, int triangle) {
  double v0[3], edge1[3], edge2[3], size1 = 0, size2 = 0;
  for (int k = 0; k < 3; ++k) {
    v0[k] = block.vertex[0][k][triangle];
    edge1[k] = block.vertex[1][k][triangle] - v0[k], edge2[k] = block.vertex[2][k][triangle] - v0[k];
    size1 = std::max(size1, std::fabs(edge1[k])), size2 = std::max(size2, std::fabs(edge2[k]));
  }
  double n[3] = {edge1[1] * edge2[2] - edge1[2] * edge2[1], edge1[2] * edge2[0] - edge1[0] * edge2[2], edge1[0] * edge2[1] - edge1[1] * edge2[0]};
  double at_end = 0;
  for (int k = 0; k < 3; ++k) at_end += n[k] * (static_cast<double>(shaft.ends.low[k]) - v0[k]);
  if (at_end < 0)
    for (double& x : n) x = -x;
  const double scale = size1 * size2 * static_cast<double>(shaft.reach);
  const F32 error = f32(static_cast<float>(scale) * kSideError);
  Mask open = first_lanes(0);
  for (int i = 0; i < shaft.vectors * kLanes; i += kLanes) {
    F32 side = F32::zero();
    for (int k = 0; k < 3; ++k) side = side + f32(static_cast<float>(n[k])) * (F32::load(shaft.start[k] + i) - f32(static_cast<float>(v0[k])));
    if (any(side < -error)) return false;
    open = open | (side <= error);
  }
  if (!any(open)) return true;
  for (int i = 0; i < shaft.vectors * kLanes; i += kLanes) {
    F64 side = f64(0.0);
    for (int k = 0; k < 3; ++k) side = side + f64(n[k]) * (to_f64(F32::load(shaft.start[k] + i)) - f64(v0[k]));
    if (bits_less(f64(scale * kSideError64), side) != (1u << kLanes) - 1) return false;
  }
  return true;
}

// What a shaft holds of the tree: subtrees and leaves as children of two nodes, and triangles of leaves that were taken apart.
// A ray of the shaft that hits a triangle finds it here.
struct Entrance {
  static constexpr int kNodes = 2, kMostEntries = kNodes * kBvhWidth;
  BvhNode node[kNodes];
  int entries = 0;  // children of node[], one after the other
  TriangleBlock few{};  // whole: lanes without a triangle are read, too
  int triangles = 0;  // of few

  HWY_INLINE bool empty() const { return entries + triangles == 0; }
  HWY_INLINE int nodes() const { return (entries + kBvhWidth - 1) / kBvhWidth; }
  HWY_INLINE void add(const BvhNode& from, int child) {
    constexpr float kFar = std::numeric_limits<float>::infinity();
    BvhNode& to = node[entries / kBvhWidth];
    const int at = entries++ % kBvhWidth;
    if (at == 0)
      for (int k = 0; k < 3; ++k) std::fill_n(to.bounds[k], kBvhWidth, kFar), std::fill_n(to.bounds[k + 3], kBvhWidth, -kFar);
    for (int row = 0; row < 6; ++row) to.bounds[row][at] = from.bounds[row][child];
    to.child[at] = from.child[child];
  }
  HWY_INLINE void add(const TriangleBlock& from, uint32_t lanes) {
    for (uint32_t rest = lanes; rest != 0; rest &= rest - 1, ++triangles) {
      const int j = std::countr_zero(rest);
      for (int v = 0; v < 3; ++v)
        for (int k = 0; k < 3; ++k) few.vertex[v][k][triangles] = from.vertex[v][k][j];
      few.primitive[triangles] = from.primitive[j];
    }
  }
};

// The triangles of a leaf that rays of the shaft might hit; not sorted out to the end where more than `room` are left.
HWY_INLINE uint32_t leaf_in_shaft(const Shaft& shaft, const TriangleBlock& block, uint32_t used, int room) {
  uint32_t crossed = 0, near = 0;
  for (int s = 0; s < kBvhWidth; s += kLanes8) {
    const ShaftTriangles part = shaft_triangles(shaft, block, s);
    crossed |= part.crossed << s, near |= part.near << s;
  }
  crossed &= used, near &= used;
  for (; near != 0 && std::popcount(crossed) <= room; near &= near - 1)
    if (!on_one_side(shaft, block, std::countr_zero(near))) crossed |= near & -near;
  return crossed | near;
}

// Goes down the tree, a level after the other, as far as the entrance has room and it pays.
HWY_NOINLINE void find_entrance(const Bvh::Data& data, const Shaft& shaft, Entrance& out) {
  constexpr int kMostNodes = 16;
  struct Open { const BvhNode* parent; int child; } open[kBvhWidth * (kMostNodes + 1)];
  int head = 0, tail = 0;
  out.entries = out.triangles = 0;
  const auto expand = [&](const BvhNode& node, uint32_t children) HWY_ATTR {
    for (uint32_t rest = children; rest != 0; rest &= rest - 1) {
      const int c = std::countr_zero(rest);
      const uint32_t child = node.child[c];
      if ((child & kLeafBit) == 0) {
        open[tail++] = {&node, c};
        continue;
      }
      const TriangleBlock& block = data.blocks[leaf_block(child)];
      const int room = kBvhWidth - out.triangles;
      const uint32_t lanes = leaf_in_shaft(shaft, block, leaf_lanes(child), room);
      if (std::popcount(lanes) <= room) out.add(block, lanes);
      else out.add(node, c);
    }
  };
  expand(data.nodes[0], shaft_children(shaft, data.nodes[0]));
  for (int visited = 0; head < tail && visited < kMostNodes; ++visited) {
    const Open at = open[head++];
    const BvhNode& node = data.nodes[at.parent->child[at.child]];
    const uint32_t children = shaft_children(shaft, node);
    if (tail - head + out.entries + std::popcount(children) > Entrance::kMostEntries) out.add(*at.parent, at.child);
    else expand(node, children);
  }
  for (; head < tail; ++head) out.add(*open[head].parent, open[head].child);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_ENTRANCE_INL_H_
