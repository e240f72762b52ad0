#include "reference/tree.h"

#include <algorithm>
#include <cmath>

#include "scene/coplanar.h"

namespace spanray::reference {
namespace {

constexpr size_t kLeaf = 4;
constexpr int kBins = 16;
constexpr double kMargin = 1e-12;  // far above rounding in double, far below anything that costs time

glm::dvec3 position(const SceneData& scene, uint32_t vertex) {
  const float* p = scene.vertices[vertex].position;
  return {p[0], p[1], p[2]};
}

// A triangle seen along a line: the line is the axis.
struct Sheared {
  double px[3], py[3], depth[3];
  bool good;
  Sheared(const Line& line, const glm::dvec3 (&v)[3]) {
    const glm::dvec3& d = line.direction;
    const int z = std::fabs(d.x) >= std::fabs(d.y) ? (std::fabs(d.x) >= std::fabs(d.z) ? 0 : 2)
                                                   : (std::fabs(d.y) >= std::fabs(d.z) ? 1 : 2);
    const int x = (z + 1) % 3, y = (z + 2) % 3;
    good = d[z] != 0;
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 q = v[k] - line.origin;
      px[k] = q[x] - d[x] / d[z] * q[z], py[k] = q[y] - d[y] / d[z] * q[z], depth[k] = q[z] / d[z];
    }
  }
  // Of the triangle that the edge opposite corner k makes with the line.
  double area(int k) const {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    return px[i] * py[j] - py[i] * px[j];
  }
};

}  // namespace

bool meets(const Line& line, const glm::dvec3 (&v)[3], double& t) {
  const Sheared s(line, v);
  if (!s.good) return false;
  // Rounding keeps the order of products: a difference is never of the wrong sign, at worst 0, which counts as the edge, for
  // both sides.
  bool left = false, right = false;
  double area[3], sum = 0;
  for (int k = 0; k < 3; ++k) area[k] = s.area(k), sum += area[k], left |= area[k] > 0, right |= area[k] < 0;
  if (left == right || sum == 0) return false;  // outside, or seen edge-on
  t = (area[0] * s.depth[0] + area[1] * s.depth[1] + area[2] * s.depth[2]) / sum;
  return std::isfinite(t);
}

bool meets(const Line& line, const glm::dvec3& center, double radius, double (&t)[2]) {
  using Real = long double;
  Real f[3], d[3], square = 0, along = 0;
  for (int k = 0; k < 3; ++k) {
    f[k] = Real{center[k]} - line.origin[k], d[k] = line.direction[k];
    square += d[k] * d[k], along += f[k] * d[k];
  }
  if (!(square > 0)) return false;
  const Real nearest = along / square;
  Real away = 0;
  for (int k = 0; k < 3; ++k) away += (f[k] - nearest * d[k]) * (f[k] - nearest * d[k]);
  away = std::sqrt(away);
  if (away > radius) return false;
  const Real half = std::sqrt((radius - away) * (radius + away) / square);
  t[0] = static_cast<double>(nearest - half), t[1] = static_cast<double>(nearest + half);
  return true;
}

bool meets(const Line& line, const Plane& plane, double& t) {
  using Real = long double;
  Real height = 0, slope = 0, most = 0;
  for (int k = 0; k < 3; ++k) {
    height += Real{plane.normal[k]} * (Real{line.origin[k]} - plane.point[k]), slope += Real{plane.normal[k]} * line.direction[k];
    most = std::max(most, std::fabs(Real{line.direction[k]}));
  }
  if (height == 0 || slope == 0) return false;  // it starts on the plane, or runs along it
  const Real at = -height / slope;
  t = static_cast<double>(at);
  return std::fabs(at) * most <= Real{1e30};
}

bool keeps(const Line& line, const glm::dvec3 (&v)[3]) {
  const Sheared s(line, v);
  int left = 0;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const double area = s.area(k);
    // Moved to the right, and by far less upward: an edge that runs upward is then passed on its left, a level one by its direction.
    left += area != 0 ? area > 0 : s.py[i] != s.py[j] ? s.py[i] > s.py[j] : s.px[i] < s.px[j];
  }
  return left == 0 || left == 3;
}

void Tree::Box::add(const glm::dvec3& p) {
  for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
}

double Tree::Box::half_area() const {
  const glm::dvec3 d = high - low;
  return d.x * d.y + d.y * d.z + d.z * d.x;
}

bool Tree::shows_triangle(const Met& best, uint32_t plane, double t) const {
  constexpr double kClose = 1e-3;  // only spares what follows
  return best.primitive != kNoPrimitive && scene_.is_triangle(best.primitive) && best.t <= t * (1 + kClose) &&
         lies_in(scene_, scene_.triangles[best.primitive], scene_.plane(plane));
}

Tree::Tree(const SceneData& scene, const std::vector<uint32_t>& primitives) : scene_(scene) {
  std::vector<Reference> list;
  for (const uint32_t primitive : primitives) {
    if (scene.is_plane(primitive)) {
      plane_.push_back(primitive);
      continue;
    }
    Reference r{{}, {}, primitive};
    if (scene.is_sphere(primitive)) {
      const Sphere& s = scene.sphere(primitive);
      const glm::dvec3 center(s.center[0], s.center[1], s.center[2]), reach(s.radius * (1 + kMargin));
      r.box.add(center - reach), r.box.add(center + reach);
    } else {
      for (const uint32_t vertex : scene.triangles[primitive].vertex) r.box.add(position(scene, vertex));
    }
    r.center = (r.box.low + r.box.high) * 0.5;
    list.push_back(r);
  }
  if (list.empty()) return;
  build(list, 0, list.size());
  for (const Reference& r : list) {
    Item item{r.primitive, {}};
    const bool sphere = scene.is_sphere(r.primitive);
    if (sphere) item.v[0] = r.center, item.radius = scene.sphere(r.primitive).radius;
    for (int k = 0; k < 3 && !sphere; ++k) item.v[k] = position(scene, scene.triangles[r.primitive].vertex[k]);
    item_.push_back(item);
  }
}

// Sorts [begin, end) into two halves and returns where the second begins.
size_t Tree::split(std::vector<Reference>& list, size_t begin, size_t end) {
  Box centers;
  for (size_t i = begin; i < end; ++i) centers.add(list[i].center);
  double best_cost = std::numeric_limits<double>::infinity();
  int best_axis = -1, best_bin = 0;
  const auto bin_of = [&](const Reference& r, int axis) {
    const double part = (r.center[axis] - centers.low[axis]) / (centers.high[axis] - centers.low[axis]);
    return std::clamp(static_cast<int>(part * kBins), 0, kBins - 1);
  };
  for (int axis = 0; axis < 3; ++axis) {
    if (!(centers.high[axis] > centers.low[axis])) continue;
    Box box[kBins];
    size_t count[kBins] = {};
    for (size_t i = begin; i < end; ++i) {
      const int b = bin_of(list[i], axis);
      box[b].add(list[i].box), ++count[b];
    }
    for (int border = 1; border < kBins; ++border) {
      Box left, right;
      size_t n_left = 0, n_right = 0;
      for (int b = 0; b < kBins; ++b) {
        if (count[b] == 0) continue;
        (b < border ? left : right).add(box[b]), (b < border ? n_left : n_right) += count[b];
      }
      if (n_left == 0 || n_right == 0) continue;
      const double cost = left.half_area() * static_cast<double>(n_left) + right.half_area() * static_cast<double>(n_right);
      if (cost < best_cost) best_cost = cost, best_axis = axis, best_bin = border;
    }
  }
  if (best_axis < 0) return begin + (end - begin) / 2;
  const auto middle =
      std::partition(list.begin() + static_cast<std::ptrdiff_t>(begin), list.begin() + static_cast<std::ptrdiff_t>(end),
                     [&](const Reference& r) { return bin_of(r, best_axis) < best_bin; });
  return static_cast<size_t>(middle - list.begin());
}

void Tree::build(std::vector<Reference>& list, size_t begin, size_t end) {
  // Past 40 levels the heuristic is not asked any more and lists are halved: walk() never needs more than 40 + 32 entries of
  // its stack.
  struct Task {
    size_t begin, end;
    int depth;
    size_t parent;
  };
  std::vector<Task> tasks = {{begin, end, 0, SIZE_MAX}};
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    const size_t at = node_.size();
    if (task.parent != SIZE_MAX) node_[task.parent].first = static_cast<uint32_t>(at);  // this is its right child
    Node& node = node_.emplace_back();
    for (size_t i = task.begin; i < task.end; ++i) node.box.add(list[i].box);
    for (int k = 0; k < 3; ++k) {
      const double margin = kMargin * std::max(std::fabs(node.box.low[k]), std::fabs(node.box.high[k]));
      node.box.low[k] -= margin, node.box.high[k] += margin;
    }
    if (task.end - task.begin <= kLeaf) {
      node.first = static_cast<uint32_t>(task.begin), node.count = static_cast<uint32_t>(task.end - task.begin);
      continue;
    }
    const size_t middle = task.depth < 40 ? split(list, task.begin, task.end) : task.begin + (task.end - task.begin) / 2;
    tasks.push_back({middle, task.end, task.depth + 1, at});
    tasks.push_back({task.begin, middle, task.depth + 1, SIZE_MAX});  // next: the left child follows its parent
  }
}

bool Tree::enters(const Box& box, const Line& line, double t_max) {
  double near = -std::numeric_limits<double>::infinity(), far = t_max;
  for (int k = 0; k < 3; ++k) {
    if (line.direction[k] == 0) {
      if (line.origin[k] < box.low[k] || line.origin[k] > box.high[k]) return false;
      continue;
    }
    const double a = (box.low[k] - line.origin[k]) / line.direction[k], b = (box.high[k] - line.origin[k]) / line.direction[k];
    near = std::max(near, std::min(a, b)), far = std::min(far, std::max(a, b));
  }
  return near - std::fabs(near) * kMargin <= far + std::fabs(far) * kMargin && far + std::fabs(far) * kMargin >= 0;
}

}  // namespace spanray::reference
