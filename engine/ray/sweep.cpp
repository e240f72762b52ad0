// One sphere at a time, in double: a few hundred triangles a question.
#include "ray/sweep.h"

#include <limits>

#include "ray/bvh_data.h"
#include "ray/bvh_instances.h"
#include "ray/sweep_exact.h"

namespace spanray {
namespace {

// Boxes grow by this times the largest coordinate seen from the center: 64 times what first_contact() and nearest_point() may be off
// by, so that what they find depends on no tree, and far less than anybody sees.
constexpr double kSlack = 0x1p-38;

// A sphere in the space of a tree, moved or at rest: it touches nothing that is farther than reach[k] from its center along axis k.
struct SpherePath {
  glm::dvec3 start, motion, reach;

  // When the center enters a box of the node, grown by the reach; infinity if never, or after `latest`.
  double enters(const BvhNode& node, int child, double latest) const {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    double low[3], high[3], most = std::max({reach[0], reach[1], reach[2]});
    for (int k = 0; k < 3; ++k) {
      low[k] = static_cast<double>(node.bounds[k][child]) - start[k];
      high[k] = static_cast<double>(node.bounds[k + 3][child]) - start[k];
      most = std::max({most, -low[k], high[k]});
    }
    double near = 0, far = latest;
    for (int k = 0; k < 3; ++k) {
      const double more = reach[k] + kSlack * most, from = low[k] - more, to = high[k] + more;
      if (motion[k] == 0) {
        if (from > 0 || to < 0) return kNever;
        continue;
      }
      const double a = from / motion[k], b = to / motion[k];
      near = std::max(near, std::min(a, b)), far = std::min(far, std::max(a, b));
    }
    return near <= far ? near : kNever;
  }
};

// In the space of a part: an ellipsoid, of which the reach is the half of its box. Why nothing is lost stands at PlacedPart.
SpherePath enter_part(const SpherePath& world, const PlacedPart& place) {
  SpherePath path;
  const glm::dvec3 from = world.start - glm::dvec3(place.offset[0], place.offset[1], place.offset[2]);
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 row(place.part_from_world[k][0], place.part_from_world[k][1], place.part_from_world[k][2]);
    path.start[k] = dot3(row, from), path.motion[k] = dot3(row, world.motion);
    path.reach[k] = world.reach[k] * length3(row) + place.slack[k];
  }
  return path;
}

// visit(child) of the leaves that the sphere may touch by `latest`, which may shrink meanwhile: near ones first.
template <class Visit>
void descend(const AlignedBuffer<BvhNode>& nodes, const SpherePath& path, const double& latest, const Visit& visit) {
  struct { double near; uint32_t child; } stack[kBvhStackSize + kBvhWidth];  // trees of parts may be a node deeper
  stack[0] = {0, 0};
  for (int top = nodes.empty() ? 0 : 1; top > 0;) {
    const auto entry = stack[--top];
    if (entry.near > latest) continue;
    if ((entry.child & kLeafBit) != 0) {
      visit(entry.child);
      continue;
    }
    const BvhNode& node = nodes[entry.child];
    const int first = top;
    for (int c = 0; c < kBvhWidth; ++c) {
      if (!(node.bounds[0][c] <= node.bounds[3][c])) continue;
      const double near = path.enters(node, c, latest);
      if (!std::isfinite(near)) continue;
      int at = top++;  // the nearest comes to the top
      for (; at > first && stack[at - 1].near < near; --at) stack[at] = stack[at - 1];
      stack[at] = {near, node.child[c]};
    }
  }
}

// test(primitive, triangle) of what the sphere may touch by `latest`; a triangle that stands in several leaves comes from each.
template <class Test>
void each_near(const SceneData& scene, const Bvh::Data& data, const SpherePath& path, const double& latest, const Test& test) {
  const auto seen = [&](const auto& coordinate) {
    glm::dvec3 corner[3];
    for (int v = 0; v < 3; ++v)
      for (int k = 0; k < 3; ++k) corner[v][k] = static_cast<double>(coordinate(v, k)) - path.start[k];
    return SphereTriangle(corner[0], corner[1], corner[2]);
  };
  descend(data.nodes, path, latest, [&](uint32_t leaf) {
    const TriangleBlock& block = data.blocks[leaf_block(leaf)];
    for (uint32_t i = 0; i < leaf_triangles(leaf); ++i)
      test(block.primitive[i], seen([&](int v, int k) { return block.vertex[v][k][i]; }));
  });
  if (!data.instances) return;
  const InstanceTrees& trees = *data.instances;
  descend(trees.top, path, latest, [&](uint32_t leaf) {
    const PlacedPart& place = trees.placed[leaf & ~kLeafBit];
    descend(trees.parts[place.part], enter_part(path, place), latest, [&](uint32_t of_part) {
      const uint32_t primitive = place.first + (of_part & ~kLeafBit);
      const Triangle& triangle = scene.triangles[primitive];
      test(primitive, seen([&](int v, int k) { return scene.vertices[triangle.vertex[v]].position[k]; }));
    });
  });
}

}  // namespace

SphereHit sweep_sphere(const SceneData& scene, const Bvh& bvh, const glm::dvec3& start, const glm::dvec3& end, double radius) {
  const SpherePath path{start, end - start, glm::dvec3(radius)};
  const double length = length3(path.motion);
  SphereHit best;
  double latest = 1;  // of what is still of interest
  each_near(scene, bvh.data(), path, latest, [&](uint32_t primitive, const SphereTriangle& triangle) {
    SphereContact contact;
    if (!first_contact(triangle, path.motion, length, radius, latest, contact)) return;
    const bool first = contact.time < best.contact.time || (contact.time == best.contact.time && primitive < best.primitive);
    if (best.primitive != kNoPrimitive && !first) return;
    best.primitive = primitive, best.contact = contact;
    latest = contact.time;
  });
  sweep_exact(bvh.data().exact, start, path.motion, radius, best);
  return best;
}

std::vector<SphereHit> touch_sphere(const SceneData& scene, const Bvh& bvh, const glm::dvec3& center, double radius) {
  std::vector<SphereHit> hits;
  const SpherePath path{center, glm::dvec3(0), glm::dvec3(radius)};
  each_near(scene, bvh.data(), path, 0, [&](uint32_t primitive, const SphereTriangle& triangle) {
    const NearestPoint nearest = nearest_point(triangle, glm::dvec3(0));
    if (!(nearest.distance <= radius)) return;
    hits.push_back({primitive, {0, nearest.away * -nearest.distance, nearest.away}, nearest.distance});
  });
  touch_exact(bvh.data().exact, center, radius, hits);
  std::sort(hits.begin(), hits.end(), [](const SphereHit& a, const SphereHit& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.primitive < b.primitive;
  });
  // A triangle that stands in several leaves was found in each.
  hits.erase(std::unique(hits.begin(), hits.end(), [](const SphereHit& a, const SphereHit& b) { return a.primitive == b.primitive; }), hits.end());
  return hits;
}

}  // namespace spanray
