// One sphere at a time, in double: a few hundred triangles a question.
#include "ray/sweep.h"

#include <limits>

#include "ray/bvh_data.h"
#include "ray/sweep_exact.h"

namespace spanray {
namespace {

constexpr double kSlack = 0x1p-40;  // far more than the rounding of any test below, far less than anybody sees

struct Interval {
  double low, high;
};

// The interval of coordinates of a box along one axis, from `start`, grown by the radius and by what arithmetic may lose.
Interval grown(float low, float high, double start, double radius) {
  const double a = static_cast<double>(low) - start, b = static_cast<double>(high) - start;
  const double more = radius + kSlack * (radius + std::max(std::fabs(a), std::fabs(b)));
  return {a - more, b + more};
}

SphereTriangle triangle_of(const TriangleBlock& block, uint32_t i, const glm::dvec3& start) {
  glm::dvec3 corner[3];
  for (int v = 0; v < 3; ++v)
    for (int k = 0; k < 3; ++k) corner[v][k] = static_cast<double>(block.vertex[v][k][i]) - start[k];
  return {corner[0], corner[1], corner[2]};
}

struct Sweep {
  glm::dvec3 start, motion;
  double radius, length;
  double latest = 1;  // of what is still of interest

  // When the center enters a box grown by the radius; infinity if never, or too late.
  double enters(const BvhNode& node, int child) const {
    double near = 0, far = latest;
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = grown(node.bounds[k][child], node.bounds[k + 3][child], start[k], radius);
      if (motion[k] == 0) {
        if (low > 0 || high < 0) return std::numeric_limits<double>::infinity();
        continue;
      }
      const double a = low / motion[k], b = high / motion[k];
      near = std::max(near, std::min(a, b)), far = std::min(far, std::max(a, b));
    }
    return near <= far ? near : std::numeric_limits<double>::infinity();
  }
};

struct Pending {
  double near;
  uint32_t child;
};

void sweep_leaf(const TriangleBlock& block, uint32_t triangles, Sweep& sweep, SphereHit& best) {
  for (uint32_t i = 0; i < triangles; ++i) {
    SphereContact contact;
    if (!first_contact(triangle_of(block, i, sweep.start), sweep.motion, sweep.length, sweep.radius, sweep.latest, contact)) continue;
    const bool first = contact.time < best.contact.time || (contact.time == best.contact.time && block.primitive[i] < best.primitive);
    if (best.primitive != kNoPrimitive && !first) continue;
    best.primitive = block.primitive[i], best.contact = contact;
    sweep.latest = contact.time;
  }
}

}  // namespace

SphereHit sweep_sphere(const Bvh& bvh, const glm::dvec3& start, const glm::dvec3& end, double radius) {
  const Bvh::Data& data = bvh.data();
  SphereHit best;
  Sweep sweep{start, end - start, radius, 0};
  sweep.length = length3(sweep.motion);
  Pending stack[kBvhStackSize];
  stack[0] = {0, 0};
  for (int top = data.nodes.empty() ? 0 : 1; top > 0;) {
    const Pending entry = stack[--top];
    if (entry.near > sweep.latest) continue;
    if ((entry.child & kLeafBit) != 0) {
      sweep_leaf(data.blocks[leaf_block(entry.child)], leaf_triangles(entry.child), sweep, best);
      continue;
    }
    const BvhNode& node = data.nodes[entry.child];
    const int first = top;
    for (int c = 0; c < kBvhWidth; ++c) {
      if (!(node.bounds[0][c] <= node.bounds[3][c])) continue;
      const Pending child{sweep.enters(node, c), node.child[c]};
      if (!std::isfinite(child.near)) continue;
      int at = top++;  // the nearest comes to the top
      for (; at > first && stack[at - 1].near < child.near; --at) stack[at] = stack[at - 1];
      stack[at] = child;
    }
  }
  sweep_exact(data.exact, start, sweep.motion, radius, best);
  return best;
}

std::vector<SphereHit> touch_sphere(const Bvh& bvh, const glm::dvec3& center, double radius) {
  const Bvh::Data& data = bvh.data();
  std::vector<SphereHit> hits;
  std::vector<uint32_t> stack;
  if (!data.nodes.empty()) stack.push_back(0);
  while (!stack.empty()) {
    const uint32_t child = stack.back();
    stack.pop_back();
    if ((child & kLeafBit) != 0) {
      const TriangleBlock& block = data.blocks[leaf_block(child)];
      for (uint32_t i = 0; i < leaf_triangles(child); ++i) {
        const NearestPoint nearest = nearest_point(triangle_of(block, i, center), glm::dvec3(0));
        if (!(nearest.distance <= radius)) continue;
        hits.push_back({block.primitive[i], {0, nearest.away * -nearest.distance, nearest.away}, nearest.distance});
      }
      continue;
    }
    const BvhNode& node = data.nodes[child];
    for (int c = 0; c < kBvhWidth; ++c) {
      bool near = node.bounds[0][c] <= node.bounds[3][c];
      for (int k = 0; k < 3 && near; ++k) {
        const auto [low, high] = grown(node.bounds[k][c], node.bounds[k + 3][c], center[k], radius);
        near = low <= 0 && high >= 0;
      }
      if (near) stack.push_back(node.child[c]);
    }
  }
  touch_exact(data.exact, center, radius, hits);
  std::sort(hits.begin(), hits.end(), [](const SphereHit& a, const SphereHit& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.primitive < b.primitive;
  });
  // A triangle that stands in several leaves was found in each.
  hits.erase(std::unique(hits.begin(), hits.end(), [](const SphereHit& a, const SphereHit& b) { return a.primitive == b.primitive; }), hits.end());
  return hits;
}

}  // namespace spanray
