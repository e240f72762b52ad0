#include "ray/sphere_tree.h"

#include <algorithm>
#include <cmath>

#include "ray/bvh_parts.h"

namespace spanray {
namespace {

using bvh::Box;
using bvh::Range;
using bvh::Ref;

constexpr double kMargin = 0x1p-20;  // of a radius: far more than rounding moves a tangent's hits
// Where splits by areas make too deep a tree: from here on ranges are halved by count, and 2^24 spheres need 21 levels more.
constexpr int kSafeDepth = kBvhMaxDepth - 22;

float round_out(double x, float direction) {
  const float f = static_cast<float>(x);
  return direction > 0 ? (static_cast<double>(f) < x ? std::nextafterf(f, direction) : f)
                       : (static_cast<double>(f) > x ? std::nextafterf(f, direction) : f);
}

Box sphere_box(const Sphere& s) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const double reach = static_cast<double>(s.radius) * (1 + kMargin);
  float low[3], high[3];
  for (int k = 0; k < 3; ++k) {
    const double center = static_cast<double>(s.center[k]);
    low[k] = round_out(center - reach, -kInf), high[k] = round_out(center + reach, kInf);
  }
  return bvh::box_of(low, high);
}

class Builder {
 public:
  Builder(const SceneData& scene, AlignedBuffer<Ref>& refs, AlignedBuffer<Ref>& second, SphereTree& tree)
      : scene_(scene), splitter_(refs.data(), second.data(), nullptr), tree_(tree) {}

  // A node of up to eight spheres, or of up to eight parts that are nodes. Returns its index.
  uint32_t add_node(const Range& range, int depth) {
    const uint32_t index = static_cast<uint32_t>(tree_.nodes.size());
    tree_.nodes.push_back(bvh::empty_node());
    if (range.count() <= kBvhWidth) {
      for (uint32_t i = 0; i < range.count(); ++i)
        add_sphere(splitter_.refs(range)[i], tree_.nodes[index], static_cast<int>(i));
      return index;
    }
    Range part[kBvhWidth] = {range};
    int n = 1;
    while (n < kBvhWidth) {
      Range &largest = *std::max_element(part, part + n, smaller), left, right;
      if (largest.count() <= kBvhWidth) break;
      splitter_.split(largest, depth >= kSafeDepth, left, right);
      largest = left, part[n++] = right;
    }
    for (int i = 0; i < n; ++i) {
      bvh::set_box(tree_.nodes[index], i, part[i].bounds.box);
      const uint32_t child = add_node(part[i], depth + 1);  // may move tree_.nodes
      tree_.nodes[index].child[i] = child;
    }
    return index;
  }

 private:
  // Parts of eight spheres and fewer are not split: they are smaller than any other.
  static bool smaller(const Range& a, const Range& b) {
    const auto size = [](const Range& r) { return r.count() <= kBvhWidth ? -1.0f : r.bounds.box.half_area(); };
    return size(a) < size(b);
  }

  void add_sphere(const Ref& ref, BvhNode& node, int slot) {
    const Sphere& s = scene_.sphere(ref.primitive());
    bvh::set_box(node, slot, ref.box);
    node.child[slot] = sphere_child(static_cast<uint32_t>(tree_.spheres.size()));
    tree_.spheres.push_back({{s.center[0], s.center[1], s.center[2]}, s.radius, ref.primitive()});
  }

  const SceneData& scene_;
  const bvh::Splitter splitter_;
  SphereTree& tree_;
};

}  // namespace

SphereTree build_sphere_tree(const SceneData& scene, const uint32_t* material_flags, uint32_t mask, uint32_t value) {
  SphereTree tree;
  AlignedBuffer<Ref> refs;
  Range all;
  for (size_t i = 0; i < scene.spheres.size(); ++i) {
    if ((material_flags[scene.spheres[i].material] & mask) != value) continue;
    Ref ref{sphere_box(scene.spheres[i])};
    ref.set_primitive(static_cast<uint32_t>(scene.triangles.size() + i));
    refs.push_back(ref), all.bounds.add(ref);
  }
  if (refs.empty()) return tree;
  all.end = static_cast<uint32_t>(refs.size());
  AlignedBuffer<Ref> second(refs.size());
  tree.spheres.reserve(refs.size());
  Builder(scene, refs, second, tree).add_node(all, 1);
  return tree;
}

}  // namespace spanray
