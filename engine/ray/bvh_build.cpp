// Builds the eight-wide tree top-down: each node is opened from one range, largest surface first, until it has eight parts.
// Source:   Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies" (binning); Wald, Benthin, Boulos 2008,
//           "Getting Rid of Packets" (opening the child of largest area).
// Input:    triangles in canonical vertex order, finite.
// Contract: the bytes of the tree depend on the triangles only, never on threads; depth <= kBvhMaxDepth.
// Settings::tree "high" goes another way: ray/bvh_high.h.
#include <algorithm>
#include <limits>
#include <vector>

#include "ray/bvh_high.h"
#include "ray/bvh_instances.h"
#include "ray/bvh_parts.h"

namespace spanray {
namespace {

using bvh::Box;
using bvh::Range;
using bvh::Ref;
using bvh::Splitter;

// From here on ranges are halved by count: 2^28 triangles need at most 9 more eight-wide levels, and 28 if they were binary.
constexpr int kMedianDepth = kBvhMaxDepth - 30;

struct PendingSubtree {
  uint32_t node, slot;  // where its root's index goes
  Range range;
  int depth;
};

struct Tree {
  std::vector<BvhNode> nodes;
  std::vector<TriangleBlock> blocks;
  int depth = 0;
};

class NodeBuilder {
 public:
  // With `pending`, ranges of at most kSubtreeSize are left to later tasks.
  NodeBuilder(const SceneData& scene, const Ref* refs, const Splitter& splitter, std::vector<PendingSubtree>* pending)
      : scene_(scene), refs_(refs), splitter_(splitter), pending_(pending) {}

  uint32_t build(const Range& range, int depth) {
    const uint32_t index = static_cast<uint32_t>(tree.nodes.size());
    tree.nodes.push_back(bvh::empty_node());
    tree.depth = std::max(tree.depth, depth);
    Range part[kBvhWidth];
    const int parts = open(range, depth, part);
    for (int i = 0; i < parts; ++i) {
      bvh::set_box(tree.nodes[index], i, part[i].box);
      if (part[i].leaf) {
        tree.nodes[index].child[i] = leaf_child(add_block(part[i]), part[i].count());
      } else if (pending_ != nullptr && part[i].count() <= bvh::kSubtreeSize) {
        pending_->push_back({index, static_cast<uint32_t>(i), part[i], depth + 1});
      } else {
        const uint32_t child = build(part[i], depth + 1);  // may move tree.nodes
        tree.nodes[index].child[i] = child;
      }
    }
    return index;
  }

  Tree tree;

 private:
  int open(const Range& range, int depth, Range* part) {
    const bool by_median = depth >= kMedianDepth;
    part[0] = range;
    int parts = 1;
    while (parts < kBvhWidth) {
      int widest = -1;
      float widest_size = -1;
      for (int i = 0; i < parts; ++i) {
        if (part[i].leaf) continue;
        const float size = by_median ? static_cast<float>(part[i].count()) : part[i].box.half_area();
        if (size > widest_size) widest = i, widest_size = size;
      }
      if (widest < 0) break;
      const Range opened = part[widest];
      const uint32_t middle = splitter_.partition(opened);
      std::copy_backward(part + widest + 1, part + parts, part + parts + 1);
      part[widest] = splitter_.analyse(opened.begin, middle, by_median);
      part[widest + 1] = splitter_.analyse(middle, opened.end, by_median);
      ++parts;
    }
    // A range whose split was chosen on the last level before must not be opened by area below.
    if (depth + 1 >= kMedianDepth)
      for (int i = 0; i < parts; ++i) part[i].axis = -1, part[i].leaf = part[i].count() <= kBvhWidth;
    return parts;
  }

  uint32_t add_block(const Range& range) {
    bvh::LeafIds ids;
    for (uint32_t i = 0; i < range.count(); ++i) ids.add(refs_[range.begin + i].primitive());
    tree.blocks.push_back(bvh::make_block(scene_, ids));
    return static_cast<uint32_t>(tree.blocks.size() - 1);
  }

  const SceneData& scene_;
  const Ref* refs_;
  const Splitter& splitter_;
  std::vector<PendingSubtree>* pending_;
};

// left_out: ascending.
AlignedBuffer<Ref> collect_refs(const SceneData& scene, const uint32_t* material_flags, uint32_t mask, uint32_t value,
                                const std::vector<TriangleRange>& left_out, Parallel& parallel) {
  AlignedBuffer<Ref> refs(scene.triangles.size());
  size_t n = 0, next = 0;
  const auto take_up_to = [&](size_t end) {
    for (; next < end; ++next)
      if ((material_flags[material_of(scene.triangles[next])] & mask) == value) refs[n++].set_primitive(static_cast<uint32_t>(next));
  };
  for (const TriangleRange& r : left_out) take_up_to(r.first), next = r.first + r.count;
  take_up_to(scene.triangles.size());
  refs.resize(n);
  constexpr size_t kChunk = 16384;
  parallel.for_each((n + kChunk - 1) / kChunk, [&](size_t c, int) {
    for (size_t i = c * kChunk; i < std::min(n, (c + 1) * kChunk); ++i) {
      const uint32_t primitive = refs[i].primitive();
      refs[i].box = bvh::triangle_box(scene, scene.triangles[primitive]);
      refs[i].set_primitive(primitive);
    }
  });
  return refs;
}

// Lays the subtrees one after the other behind the top of the tree, in the order of their tasks.
void assemble(const Tree& top, const std::vector<PendingSubtree>& pending, const std::vector<Tree>& subtrees, Parallel& parallel,
              Bvh::Data& data) {
  std::vector<uint32_t> node_base, block_base;
  size_t nodes = top.nodes.size(), blocks = top.blocks.size();
  data.depth = top.depth;
  for (const Tree& t : subtrees) {
    node_base.push_back(static_cast<uint32_t>(nodes)), block_base.push_back(static_cast<uint32_t>(blocks));
    nodes += t.nodes.size(), blocks += t.blocks.size();
    data.depth = std::max(data.depth, t.depth);
  }
  data.nodes.reserve(nodes), data.nodes.resize(nodes);
  data.blocks.reserve(blocks), data.blocks.resize(blocks);
  std::copy(top.nodes.begin(), top.nodes.end(), data.nodes.begin());
  std::copy(top.blocks.begin(), top.blocks.end(), data.blocks.begin());
  parallel.for_each(subtrees.size(), [&](size_t s, int) {
    const Tree& t = subtrees[s];
    for (size_t i = 0; i < t.nodes.size(); ++i) {
      BvhNode& node = data.nodes[node_base[s] + i] = t.nodes[i];
      for (int c = 0; c < kBvhWidth; ++c) {
        if (!(node.bounds[0][c] <= node.bounds[3][c])) continue;
        node.child[c] += (node.child[c] & kLeafBit) ? block_base[s] << 3 : node_base[s];
      }
    }
    std::copy(t.blocks.begin(), t.blocks.end(), data.blocks.begin() + block_base[s]);
  });
  for (size_t s = 0; s < pending.size(); ++s) data.nodes[pending[s].node].child[pending[s].slot] = node_base[s];
}

void build_fast(const SceneData& scene, AlignedBuffer<Ref>& refs, Parallel& parallel, Bvh::Data& data) {
  const uint32_t n = static_cast<uint32_t>(refs.size());
  AlignedBuffer<Ref> scratch(n);
  const Splitter splitter(refs.data(), scratch.data(), &parallel);
  std::vector<PendingSubtree> pending;
  NodeBuilder top(scene, refs.data(), splitter, &pending);
  top.build(splitter.analyse(0, n, false), 1);

  std::vector<Tree> subtrees(pending.size());
  parallel.for_each(pending.size(), [&](size_t s, int) {
    const Splitter serial(refs.data(), scratch.data(), nullptr);
    NodeBuilder builder(scene, refs.data(), serial, nullptr);
    builder.build(pending[s].range, pending[s].depth);
    subtrees[s] = std::move(builder.tree);
  });
  assemble(top.tree, pending, subtrees, parallel, data);
}

template <class T> void copy_to(const std::vector<T>& from, AlignedBuffer<T>& to) {
  to.reserve(from.size()), to.resize(from.size());
  std::copy(from.begin(), from.end(), to.begin());
}

void take(const bvh::WideTree& wide, Bvh::Data& data) {
  copy_to(wide.nodes, data.nodes), copy_to(wide.blocks, data.blocks);
  data.depth = wide.depth, data.references = wide.references;
}

}  // namespace

Bvh::Bvh() : data_(std::make_unique<Data>()) {}
Bvh::Bvh(Bvh&&) noexcept = default;
Bvh& Bvh::operator=(Bvh&&) noexcept = default;
Bvh::~Bvh() = default;
size_t Bvh::memory_bytes() const {
  const size_t instances = data_->instances ? data_->instances->memory_bytes() : 0;
  return data_->nodes.bytes() + data_->blocks.bytes() + data_->exact.memory_bytes() + instances;
}
size_t Bvh::primitive_count() const { return data_->primitives + data_->exact.size(); }

Bvh build_bvh(const SceneData& scene, const uint32_t* material_flags, uint32_t mask, uint32_t value, Parallel& parallel,
              TreeQuality quality, bool follows_motion, InstanceUse use) {
  Bvh bvh;
  Bvh::Data& data = *bvh.data_;
  data.instances = build_instances(scene, material_flags, mask, value, parallel, quality, use);
  AlignedBuffer<Ref> refs =
      collect_refs(scene, material_flags, mask, value, data.instances ? data.instances->ranges : std::vector<TriangleRange>(), parallel);
  data.primitives = data.references = refs.size();
  if (scene.has_exact()) data.exact = ExactSet(scene, material_flags, mask, value);
  if (refs.empty() && !data.instances) return bvh;
  Box all = Box::empty();
  if (refs.empty()) {
    data.nodes.push_back(bvh::empty_node()), data.depth = 1;
  } else {
    if (bvh::WideTree wide; quality == TreeQuality::kHigh && bvh::build_high(scene, follows_motion, refs, parallel, wide)) take(wide, data);
    else build_fast(scene, refs, parallel, data);
    const BvhNode& root = data.nodes[0];
    for (int c = 0; c < kBvhWidth; ++c)
      all.add({bvh::F4{root.bounds[0][c], root.bounds[1][c], root.bounds[2][c], 0},
               bvh::F4{root.bounds[3][c], root.bounds[4][c], root.bounds[5][c], 0}});
  }
  if (data.instances) {
    all.add(bvh::box_of(data.instances->bounds_min, data.instances->bounds_max));
    data.primitives += data.instances->triangles, data.references += data.instances->triangles;
  }
  for (int k = 0; k < 3; ++k) data.bounds_min[k] = all.lo[k], data.bounds_max[k] = all.hi[k];
  return bvh;
}

}  // namespace spanray
