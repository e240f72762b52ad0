#include "ray/bvh_instances.h"

#include <algorithm>
#include <cmath>

#include "ray/bvh_parts.h"

namespace spanray {
namespace {

using bvh::Box;
using bvh::box_of;
using bvh::F4;

// Boxes of leaves grow by this times kPartMargin of a triangle's extent, at most. Rotations and uniform scales need 3. Spheres count
// on it, too (PlacedPart).
constexpr double kMostStretch = 16;
// Boxes grow by at most this share of the part's extent on the way of a ray: the whole part is that much larger.
constexpr double kMostSlack = 1.0 / 64;
// One tree is faster for rays: two levels must spare that many triangles in leaves, some 200 MB and two seconds of one processor.
constexpr uint64_t kLeastSaved = uint64_t{1} << 22;

// The triangles of an instance that the tree holds.
struct Candidate {
  uint32_t instance;
  PlacedPart placed;
  Box box = Box::empty();
  uint32_t triangles = 0;
  double stretch = 0;
  bool usable = false;
};

bool invert(const double (&m)[3][3], double (&inverse)[3][3]) {
  double cofactor[3][3];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      const int a = (i + 1) % 3, b = (i + 2) % 3, c = (k + 1) % 3, d = (k + 2) % 3;
      cofactor[i][k] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
    }
  const double det = m[0][0] * cofactor[0][0] + m[0][1] * cofactor[0][1] + m[0][2] * cofactor[0][2];
  bool finite = true;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) inverse[k][i] = cofactor[i][k] / det, finite = finite && std::isfinite(inverse[k][i]);
  return finite;
}

// The largest |coordinates| of a part, and the largest side of its box.
struct Extent {
  double reach[3] = {0, 0, 0}, side = 0;
};
Extent extent_of(const InstancedPart& part) {
  Box box = Box::empty();
  for (size_t i = 0; i < part.corners.size(); i += 3) box.add(box_of(&part.corners[i], &part.corners[i]));
  Extent e;
  for (int k = 0; k < 3 && !part.corners.empty(); ++k) {
    const double lo = static_cast<double>(box.lo[k]), hi = static_cast<double>(box.hi[k]);
    e.reach[k] = std::max(std::fabs(lo), std::fabs(hi)), e.side = std::max(e.side, hi - lo);
  }
  return e;
}

// PlacedPart's numbers (bvh_instances.h says why they suffice), and whether boxes stay tight enough.
void take_map(const AffineMap& map, const Extent& part, Candidate& c) {
  constexpr double kRounding = 0x1p-45, kGenerous = 1 + 0x1p-20;
  PlacedPart& p = c.placed;
  if (!invert(map.linear, p.part_from_world)) return;
  double rough[3], far_out = 0, most_row = 0, most_inverse = 0;  // rough: what a coordinate is off by
  for (int j = 0; j < 3; ++j) {
    p.offset[j] = map.offset[j];
    double row = 0, size = std::fabs(map.offset[j]);
    for (int i = 0; i < 3; ++i) row += std::fabs(map.linear[j][i]), size += std::fabs(map.linear[j][i]) * part.reach[i];
    far_out = std::max(far_out, size), most_row = std::max(most_row, row);
  }
  for (int j = 0; j < 3; ++j)
    rough[j] = 1.01 * 0x1p-24 * static_cast<double>(std::max(std::fabs(c.box.lo[j]), std::fabs(c.box.hi[j]))) + 0x1p-32 * far_out + 0x1p-120;
  c.usable = true;
  for (int k = 0; k < 3; ++k) {
    double slack = 0, inverse_row = 0;
    for (int j = 0; j < 3; ++j) slack += std::fabs(p.part_from_world[k][j]) * rough[j], inverse_row += std::fabs(p.part_from_world[k][j]);
    for (int i = 0; i < 3; ++i) {
      double product = 0, size = 0;
      for (int j = 0; j < 3; ++j) {
        const double term = p.part_from_world[k][j] * map.linear[j][i];
        product += term, size += std::fabs(term);
      }
      slack += (std::fabs(product - (i == k)) + 0x1p-50 * (size + 1)) * part.reach[i];
    }
    p.slack[k] = slack * kGenerous, p.slack_of_origin[k] = inverse_row * kRounding * kGenerous;
    most_inverse = std::max(most_inverse, inverse_row);
    c.usable = c.usable && slack <= kMostSlack * part.side;
  }
  c.stretch = most_row * most_inverse * kGenerous;
  c.usable = c.usable && c.stretch <= kMostStretch;
}

// The box of a triangle of a part; margin: in units of its extent.
Box grown_box(const InstancedPart& part, uint32_t triangle, double margin) {
  const float* corner = &part.corners[size_t{9} * triangle];
  Box box = box_of(corner, corner);
  box.add(box_of(corner + 3, corner + 3)), box.add(box_of(corner + 6, corner + 6));
  double side = 0;
  for (int k = 0; k < 3; ++k) side = std::max(side, static_cast<double>(box.hi[k]) - static_cast<double>(box.lo[k]));
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = float_below(static_cast<double>(box.lo[k]) - margin * side);
    box.hi[k] = float_above(static_cast<double>(box.hi[k]) + margin * side);
  }
  return box;
}

// A node's boxes and those below it, made anew from those of the leaves.
template <class BoxOf> Box refit(SingleTree& tree, uint32_t index, const BoxOf& box_of_leaf) {
  Box whole = Box::empty();
  for (int c = 0; c < kBvhWidth; ++c) {
    const uint32_t child = tree[index].child[c];
    if (!(tree[index].bounds[0][c] <= tree[index].bounds[3][c])) continue;
    const Box box = (child & kLeafBit) != 0 ? box_of_leaf(child & ~kLeafBit) : refit(tree, child, box_of_leaf);
    bvh::set_box(tree[index], c, box);
    whole.add(box);
  }
  return whole;
}

// From a tree over triangles that have the leaves' boxes, or smaller ones: each of its leaves becomes a node.
template <class BoxOf> SingleTree make_single(const Bvh& flat, const BoxOf& box_of_leaf) {
  SingleTree tree = SingleTree::copy(flat.data().nodes);
  const size_t inner = tree.size();
  for (size_t n = 0; n < inner; ++n)
    for (int c = 0; c < kBvhWidth; ++c) {
      const uint32_t child = tree[n].child[c];
      if (!(tree[n].bounds[0][c] <= tree[n].bounds[3][c]) || (child & kLeafBit) == 0) continue;
      const TriangleBlock& block = flat.data().blocks[leaf_block(child)];
      BvhNode leaf = bvh::empty_node();
      for (uint32_t i = 0; i < leaf_triangles(child); ++i)
        bvh::set_box(leaf, static_cast<int>(i), box_of_leaf(block.primitive[i])), leaf.child[i] = kLeafBit | block.primitive[i];
      tree[n].child[c] = leaf_triangles(child) == 1 ? leaf.child[0] : static_cast<uint32_t>(tree.size());
      if (leaf_triangles(child) > 1) tree.push_back(leaf);
    }
  refit(tree, 0, box_of_leaf);
  return tree;
}

// The triangles of a part as a scene of their own. model: an instance of it, for the materials.
SceneData scene_of(const InstancedPart& part, const SceneData& scene, const Instance& model) {
  SceneData own;
  own.vertices.reserve(3 * part.triangles()), own.triangles.reserve(part.triangles());
  for (uint32_t t = 0; t < part.triangles(); ++t) {
    for (uint32_t v = 0; v < 3; ++v) {
      Vertex vertex{};
      std::copy_n(&part.corners[9 * size_t{t} + 3 * v], 3, vertex.position);
      own.vertices.push_back(vertex);
    }
    own.triangles.push_back({{3 * t, 3 * t + 1, 3 * t + 2}, material_of(scene.triangles[model.first + t])});
  }
  return own;
}

// The tree over all places, built over triangles that have their boxes.
SingleTree make_top(const std::vector<Candidate>& places, Parallel& parallel, TreeQuality quality) {
  SceneData boxes;
  for (const Candidate& c : places) {
    const uint32_t first = static_cast<uint32_t>(boxes.vertices.size());
    for (const F4& corner : {c.box.lo, c.box.hi}) {
      Vertex vertex{};
      for (int k = 0; k < 3; ++k) vertex.position[k] = corner[k];
      boxes.vertices.push_back(vertex);
    }
    boxes.triangles.push_back({{first, first + 1, first + 1}, 0});
  }
  constexpr uint32_t kNoFlags = 0;
  const Bvh flat = build_bvh(boxes, &kNoFlags, 0, 0, parallel, quality, true, InstanceUse::kNever);
  return make_single(flat, [&](uint32_t place) { return places[place].box; });
}

// All instances that have triangles with this mask and value, with their numbers.
std::vector<Candidate> find_candidates(const SceneData& scene, const uint32_t* material_flags, uint32_t mask, uint32_t value, Parallel& parallel) {
  std::vector<Extent> extents;
  for (const InstancedPart& part : scene.instanced_parts) extents.push_back(extent_of(part));
  std::vector<Candidate> all(scene.instances.size());
  parallel.for_each(all.size(), [&](size_t i, int) {
    const Instance& instance = scene.instances[i];
    Candidate& c = all[i];
    c.instance = static_cast<uint32_t>(i);
    c.placed.first = instance.first, c.placed.part = instance.part;
    for (uint32_t t = instance.first; t < instance.first + instance.count; ++t) {
      const Triangle& triangle = scene.triangles[t];
      if ((material_flags[material_of(triangle)] & mask) != value) continue;
      c.box.add(bvh::triangle_box(scene, triangle)), ++c.triangles;
    }
    if (c.triangles > 0) take_map(instance.world_from_part, extents[instance.part], c);
  });
  return all;
}

// Whether one tree a part, instead of one a place, spares enough: all triangles but those of the first place of each part. part(place) and
// triangles(place) of `places`.
template <class Place, class Part, class Triangles>
bool worth_it(const std::vector<Place>& places, size_t parts, const Part& part, const Triangles& triangles) {
  std::vector<bool> seen(parts, false);
  uint64_t saved = 0;
  for (const Place& p : places) {
    if (seen[part(p)]) saved += triangles(p);
    seen[part(p)] = true;
  }
  return saved >= kLeastSaved;
}

// The instances for which a tree of their part is to be used.
std::vector<Candidate> choose_places(const SceneData& scene, const uint32_t* material_flags, uint32_t mask, uint32_t value, Parallel& parallel,
                                     InstanceUse use) {
  if (scene.instances.empty() || use == InstanceUse::kNever) return {};
  const size_t parts = scene.instanced_parts.size();
  // Before anything is looked at closely: were all of them usable, would it be worth it?
  if (use == InstanceUse::kAuto &&
      !worth_it(scene.instances, parts, [](const Instance& i) { return i.part; }, [](const Instance& i) { return i.count; }))
    return {};
  std::vector<Candidate> places = find_candidates(scene, material_flags, mask, value, parallel);
  std::erase_if(places, [](const Candidate& c) { return !c.usable; });
  if (use == InstanceUse::kAuto &&
      !worth_it(places, parts, [](const Candidate& c) { return c.placed.part; }, [](const Candidate& c) { return c.triangles; }))
    return {};
  return places;
}

}  // namespace

size_t InstanceTrees::memory_bytes() const {
  size_t bytes = top.bytes() + placed.capacity() * sizeof(PlacedPart) + ranges.capacity() * sizeof(TriangleRange);
  for (const SingleTree& part : parts) bytes += part.bytes();
  return bytes;
}

std::shared_ptr<const InstanceTrees> build_instances(const SceneData& scene, const uint32_t* material_flags, uint32_t mask, uint32_t value,
                                                     Parallel& parallel, TreeQuality quality, InstanceUse use) {
  const std::vector<Candidate> places = choose_places(scene, material_flags, mask, value, parallel, use);
  if (places.empty()) return nullptr;
  const auto trees = std::make_shared<InstanceTrees>();
  std::vector<double> stretch(scene.instanced_parts.size(), 0);
  std::vector<uint32_t> model(scene.instanced_parts.size(), 0);
  Box all = Box::empty();
  for (const Candidate& c : places) {
    const Instance& instance = scene.instances[c.instance];
    stretch[instance.part] = std::max(stretch[instance.part], c.stretch), model[instance.part] = c.instance;
    trees->placed.push_back(c.placed);
    trees->triangles += c.triangles;
    trees->ranges.push_back({instance.first, instance.count});
    all.add(c.box);
  }
  for (int k = 0; k < 3; ++k) trees->bounds_min[k] = all.lo[k], trees->bounds_max[k] = all.hi[k];
  trees->parts.resize(scene.instanced_parts.size());
  for (size_t p = 0; p < trees->parts.size(); ++p) {
    if (stretch[p] == 0) continue;
    const InstancedPart& part = scene.instanced_parts[p];
    const SceneData own = scene_of(part, scene, scene.instances[model[p]]);
    const Bvh flat = build_bvh(own, material_flags, mask, value, parallel, quality, true, InstanceUse::kNever);
    const double margin = stretch[p] * kPartMargin;
    trees->parts[p] = make_single(flat, [&](uint32_t triangle) { return grown_box(part, triangle, margin); });
  }
  trees->top = make_top(places, parallel, quality);
  return trees;
}

}  // namespace spanray
