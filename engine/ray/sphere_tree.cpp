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

  // Splits the largest part until there are eight. Returns the node's index.
  uint32_t add_node(const Range& range, int depth) {
    Range part[kBvhWidth] = {range};
    bool whole[kBvhWidth] = {};  // it was not worth while to split it
    int n = 1;
    while (n < kBvhWidth) {
      int largest = -1;
      for (int i = 0; i < n; ++i)
        if (!whole[i] && (largest < 0 || area(part[i]) > area(part[largest]))) largest = i;
      if (largest < 0) break;
      Range left, right;
      whole[largest] = !splitter_.split(part[largest], depth >= kSafeDepth, left, right);
      if (!whole[largest]) part[largest] = left, part[n++] = right;
    }
    const uint32_t index = static_cast<uint32_t>(tree_.nodes.size());
    tree_.nodes.push_back(bvh::empty_node());
    for (int i = 0; i < n; ++i) {
      const uint32_t child = part[i].count() <= kBvhWidth ? add_leaf(part[i]) : add_node(part[i], depth + 1);
      tree_.nodes[index].child[i] = child;
      bvh::set_box(tree_.nodes[index], i, part[i].bounds.box);
    }
    return index;
  }

 private:
  static float area(const Range& range) { return range.bounds.box.half_area(); }

  uint32_t add_leaf(const Range& range) {
    SphereBlock block{};
    for (uint32_t i = 0; i < range.count(); ++i) {
      const uint32_t primitive = splitter_.refs(range)[i].primitive();
      const Sphere& sphere = scene_.sphere(primitive);
      for (int k = 0; k < 3; ++k) block.center[k][i] = sphere.center[k];
      block.radius[i] = sphere.radius, block.primitive[i] = primitive;
    }
    tree_.blocks.push_back(block);
    return leaf_child(static_cast<uint32_t>(tree_.blocks.size()) - 1, range.count());
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
  tree.count = refs.size();
  if (refs.empty()) return tree;
  all.end = static_cast<uint32_t>(refs.size());
  AlignedBuffer<Ref> second(refs.size());
  Builder(scene, refs, second, tree).add_node(all, 1);
  return tree;
}

}  // namespace spanray
