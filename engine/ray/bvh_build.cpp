// The tree of a scene: references, a binary tree of them, and wide nodes of that.
// Input:    triangles in canonical vertex order, finite.
// Contract: the bytes of the tree depend on the triangles only, never on threads; depth <= kBvhMaxDepth.
#include <algorithm>
#include <limits>
#include <vector>

#include "ray/bvh_high.h"
#include "ray/bvh_instances.h"
#include "ray/bvh_parts.h"

namespace spanray {
namespace {

using bvh::Box;
using bvh::Ref;

// Where splits by areas make too deep a tree: from here on ranges are halved by count, and 2^28 triangles need at most 28 levels more.
constexpr int kSafeDepth = kBvhMaxDepth - 30;

// left_out: ascending. bounds: of all references.
AlignedBuffer<Ref> collect_refs(const SceneData& scene, const uint32_t* material_flags, uint32_t mask, uint32_t value,
                                const std::vector<TriangleRange>& left_out, Parallel& parallel, bvh::Bounds& bounds) {
  AlignedBuffer<uint32_t> primitives(scene.triangles.size());
  size_t n = 0, next = 0;
  const auto take_up_to = [&](size_t end) {
    for (; next < end; ++next) {
      primitives[n] = static_cast<uint32_t>(next);
      n += (material_flags[material_of(scene.triangles[next])] & mask) == value;
    }
  };
  for (const TriangleRange& r : left_out) take_up_to(r.first), next = r.first + r.count;
  take_up_to(scene.triangles.size());
  AlignedBuffer<Ref> refs(n);
  constexpr size_t kChunk = 8192;
  std::vector<bvh::Bounds> parts((n + kChunk - 1) / kChunk);
  parallel.for_each(parts.size(), [&](size_t c, int) {
    bvh::Bounds part;
    for (size_t i = c * kChunk; i < std::min(n, (c + 1) * kChunk); ++i) {
      refs[i].box = bvh::triangle_box(scene, scene.triangles[primitives[i]]);
      refs[i].set_primitive(primitives[i]);
      part.add(refs[i]);
    }
    parts[c] = part;
  });
  for (const bvh::Bounds& p : parts) bounds.add(p);
  return refs;
}

// Few: the build takes a tenth longer, and rays 5 to 15 % less (docs/decisions/0014-high-tree.md).
constexpr bvh::Reinsertion kQuickReinsertion{4, 50};

void build_fast(const SceneData& scene, AlignedBuffer<Ref>& refs, const bvh::Bounds& bounds, Parallel& parallel, bvh::WideTree& wide) {
  bvh::BinaryTree tree = bvh::build_binary(refs, bounds, parallel);
  bvh::reinsert(tree, kQuickReinsertion, parallel);
  if (!bvh::collapse(scene, tree, refs, parallel, wide))  // too deep; the other one cannot be, for a wide node takes in a level at least
    bvh::collapse(scene, bvh::build_binary(refs, bounds, parallel, kSafeDepth), refs, parallel, wide);
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
int Bvh::levels() const { return data_->instances ? 2 : 1; }
size_t Bvh::instance_count() const { return data_->instances ? data_->instances->placed.size() : 0; }
size_t Bvh::primitive_count() const { return data_->primitives + data_->exact.size(); }

Bvh build_bvh(const SceneData& scene, const uint32_t* material_flags, uint32_t mask, uint32_t value, Parallel& parallel,
              TreeQuality quality, bool follows_motion, InstanceUse use) {
  Bvh bvh;
  Bvh::Data& data = *bvh.data_;
  data.instances = build_instances(scene, material_flags, mask, value, parallel, quality, use);
  bvh::Bounds bounds;
  AlignedBuffer<Ref> refs = collect_refs(scene, material_flags, mask, value,
                                         data.instances ? data.instances->ranges : std::vector<TriangleRange>(), parallel, bounds);
  data.primitives = data.references = refs.size();
  if (scene.has_exact()) data.exact = ExactSet(scene, material_flags, mask, value);
  if (refs.empty() && !data.instances) return bvh;
  Box all = Box::empty();
  if (refs.empty()) {
    data.nodes.push_back(bvh::empty_node()), data.depth = 1;
  } else {
    bvh::WideTree wide;
    if (quality != TreeQuality::kHigh || !bvh::build_high(scene, follows_motion, refs, bounds, parallel, wide))
      build_fast(scene, refs, bounds, parallel, wide);
    data.nodes = std::move(wide.nodes), data.blocks = std::move(wide.blocks);
    data.depth = wide.depth, data.references = wide.references;
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
