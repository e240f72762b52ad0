#include "ray/sphere_tree.h"

#include <algorithm>
#include <cmath>

#include "frame/exact_hit.h"
#include "ray/triangle_test.h"

namespace spanray {
namespace {

constexpr size_t kLeaf = 4;
constexpr int kStack = 64;             // lists are halved: 2^24 spheres are 24 levels
constexpr double kMargin = 0x1p-20;    // of a radius: far more than rounding moves a tangent's hits
constexpr double kRounding = 0x1p-48;  // of distances to the planes of a box: four roundings

float round_out(double x, float direction) {
  const float f = static_cast<float>(x);
  return direction > 0 ? (static_cast<double>(f) < x ? std::nextafterf(f, direction) : f)
                       : (static_cast<double>(f) > x ? std::nextafterf(f, direction) : f);
}

}  // namespace

SphereTree::SphereTree(const SceneData& scene, const uint32_t* material_flags, uint32_t mask, uint32_t value) {
  for (size_t i = 0; i < scene.spheres.size(); ++i)
    if ((material_flags[scene.spheres[i].material] & mask) == value)
      spheres_.push_back({scene.spheres[i], static_cast<uint32_t>(scene.triangles.size() + i)});
  if (!spheres_.empty()) build(0, spheres_.size());
}

// Halves of equal number, along the longest axis of the centers.
void SphereTree::build(size_t begin, size_t end) {
  const size_t at = nodes_.size();
  Node node{};
  float least[3], most[3];
  for (int k = 0; k < 3; ++k) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    least[k] = std::numeric_limits<float>::infinity(), most[k] = -least[k];
    for (size_t i = begin; i < end; ++i) {
      const Sphere& s = spheres_[i].sphere;
      const double reach = s.radius * (1 + kMargin);
      low = std::min(low, s.center[k] - reach), high = std::max(high, s.center[k] + reach);
      least[k] = std::min(least[k], s.center[k]), most[k] = std::max(most[k], s.center[k]);
    }
    node.low[k] = round_out(low, -kLargestT), node.high[k] = round_out(high, kLargestT);
  }
  nodes_.push_back(node);
  if (end - begin <= kLeaf) {
    nodes_[at].first = static_cast<uint32_t>(begin), nodes_[at].count = static_cast<uint32_t>(end - begin);
    return;
  }
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (most[k] - least[k] > most[axis] - least[axis]) axis = k;
  const size_t middle = begin + (end - begin) / 2;
  const auto item = [&](size_t i) { return spheres_.begin() + static_cast<ptrdiff_t>(i); };
  std::nth_element(item(begin), item(middle), item(end), [axis](const Item& a, const Item& b) {
    const float p = a.sphere.center[axis], q = b.sphere.center[axis];
    return p != q ? p < q : a.primitive < b.primitive;
  });
  build(begin, middle);
  nodes_[at].first = static_cast<uint32_t>(nodes_.size());
  build(middle, end);
}

// visit(item, limit) for every sphere of the leaves that the ray meets within (.., limit], limit being t_max or less, near ones
// first; true ends the walk.
template <class Visit>
void SphereTree::walk(const ExactRay& ray, const Visit& visit) const {
  double limit = ray.t_max, inverse[3];
  if (nodes_.empty()) return;
  for (int k = 0; k < 3; ++k) inverse[k] = 1 / ray.direction[k];
  const auto enters = [&](const Node& node, double& near) {
    double far = limit;
    near = 0;
    for (int k = 0; k < 3; ++k) {
      const double low = node.low[k] - ray.origin[k], high = node.high[k] - ray.origin[k];
      if (!std::isfinite(inverse[k])) {  // along the planes, or all but
        if (ray.direction[k] == 0 && (low > 0 || high < 0)) return false;
        continue;
      }
      const double first = (inverse[k] < 0 ? high : low) * inverse[k], last = (inverse[k] < 0 ? low : high) * inverse[k];
      near = std::max(near, first - kRounding * std::fabs(first)), far = std::min(far, last + kRounding * std::fabs(last));
    }
    return near <= far;
  };
  struct Pending {
    uint32_t node;
    double near;
  } stack[kStack];
  int top = 0;
  if (double near; enters(nodes_[0], near)) stack[top++] = {0, near};
  while (top > 0) {
    const Pending next = stack[--top];
    if (next.near > limit) continue;
    for (uint32_t at = next.node;;) {
      const Node& node = nodes_[at];
      if (node.count > 0) {
        for (uint32_t i = node.first; i < node.first + node.count; ++i)
          if (visit(spheres_[i], limit)) return;
        break;
      }
      double near_left, near_right;
      const bool left = enters(nodes_[at + 1], near_left), right = enters(nodes_[node.first], near_right);
      if (!left && !right) break;
      const bool left_first = left && (!right || near_left <= near_right);
      if (left && right) stack[top++] = left_first ? Pending{node.first, near_right} : Pending{at + 1, near_left};
      at = left_first ? at + 1 : node.first;
    }
  }
}

ExactMeeting SphereTree::closest(const ExactRay& ray) const {
  ExactMeeting best;
  walk(ray, [&](const Item& item, double& limit) {
    const double t = first_hit(ray, item.sphere, item.primitive).t;
    if (t <= limit && best.improve(item.primitive, t)) limit = t;
    return false;
  });
  return best;
}

bool SphereTree::any(const ExactRay& ray) const {
  bool found = false;
  walk(ray, [&](const Item& item, double& limit) {
    const double t = first_hit(ray, item.sphere, item.primitive).t;
    return found = t <= limit && t != std::numeric_limits<double>::infinity();
  });
  return found;
}

}  // namespace spanray
