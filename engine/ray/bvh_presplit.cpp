#include "ray/bvh_presplit.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/vec.h"
#include "ray/triangle_test.h"

namespace spanray::bvh {
namespace {

constexpr double kMore = 0.2;         // references, as a share of those that there are
constexpr double kEmpty = 0.75;       // of a box's surface: only triangles that leave so much of it
constexpr double kNeedle = 0x1p-16;   // of a box's surface: triangles that cover less are left alone
constexpr int kMostParts = 64;        // of a triangle
constexpr int kLevels = 24;           // of the grid
constexpr size_t kChunk = 4096;

struct Polygon {
  static constexpr int kMost = 64;  // corners; a cut adds one, or some more where rounding made the polygon not quite convex
  glm::dvec3 corner[kMost];
  int count = 0;
};

struct DoubleBox {
  glm::dvec3 lo, hi;
};

DoubleBox box_of(const Polygon& p) {
  DoubleBox b{p.corner[0], p.corner[0]};
  for (int i = 1; i < p.count; ++i)
    for (int k = 0; k < 3; ++k) b.lo[k] = std::min(b.lo[k], p.corner[i][k]), b.hi[k] = std::max(b.hi[k], p.corner[i][k]);
  return b;
}

Polygon triangle_polygon(const SceneData& scene, uint32_t primitive) {
  Polygon p;
  for (const uint32_t v : scene.triangles[primitive].vertex) {
    const float* at = scene.vertices[v].position;
    p.corner[p.count++] = {at[0], at[1], at[2]};
  }
  return p;
}

// What of a convex polygon lies on one side of a plane across an axis; the plane belongs to both sides. Corners are off by some 2^-51 of
// coordinates, which is far less than kPartMargin.
Polygon clip(const Polygon& p, int axis, double at, bool below) {
  Polygon out;  // of at most twice as many corners
  const auto inside = [&](const glm::dvec3& c) { return below ? c[axis] <= at : c[axis] >= at; };
  for (int i = 0; i < p.count; ++i) {
    const glm::dvec3 &a = p.corner[i], &b = p.corner[i + 1 == p.count ? 0 : i + 1];
    if (inside(a)) out.corner[out.count++] = a;
    if (inside(a) == inside(b) || a[axis] == at || b[axis] == at) continue;
    glm::dvec3 c = a + (b - a) * ((at - a[axis]) / (b[axis] - a[axis]));
    c[axis] = at;
    out.corner[out.count++] = c;
  }
  return out;
}

float not_above(double x) {
  const float f = static_cast<float>(x);
  return static_cast<double>(f) > x ? std::nextafter(f, -kLargestT) : f;
}

// Planes that halve the scene, halve the halves, and so on, along each axis.
struct Grid {
  Box scene;
  struct Plane {
    int level = kLevels;  // kLevels: none
    int axis = 0;
    double at = 0;
  };
  // The coarsest plane through a box; of these the one across its longest side.
  Plane through(const DoubleBox& box) const {
    Plane best;
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
      const double origin = scene.lo[k], size = static_cast<double>(scene.hi[k]) - origin;
      const double side = box.hi[k] - box.lo[k];
      if (!(side > 0)) continue;
      double cell = 0.5 * size;
      for (int level = 1; level < std::min(best.level + 1, kLevels); ++level, cell *= 0.5) {
        const double at = origin + cell * (std::floor((box.lo[k] - origin) / cell) + 1);
        if (!(at > box.lo[k] && at < box.hi[k])) continue;
        if (level < best.level || side > longest) best = {level, k, at}, longest = side;
        break;
      }
    }
    return best;
  }
};

// What splitting a triangle is worth: the area that its box has too much, less the finer the first plane through it.
double priority_of(const Polygon& p, const Grid& grid) {
  const DoubleBox box = box_of(p);
  const glm::dvec3 side = box.hi - box.lo, n = cross3(p.corner[1] - p.corner[0], p.corner[2] - p.corner[0]);
  const double area = side.x * side.y + side.y * side.z + side.z * side.x;
  const double covered = 0.5 * (std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z));
  if (!(area - covered > kEmpty * area && covered > kNeedle * area)) return 0;
  const Grid::Plane plane = grid.through(box);
  return plane.level == kLevels ? 0 : std::sqrt((area - covered) * std::ldexp(1.0, -plane.level));
}

struct Candidate {
  uint32_t ref;
  double priority;
};

int splits_of(const Candidate& c, double scale) { return static_cast<int>(std::min(scale * c.priority, kMostParts - 1.0)); }

// The largest scale of priorities that does not split more often than `most`, nearly.
double scale_for(const std::vector<Candidate>& candidates, double most) {
  const auto fits = [&](double scale) {
    int64_t splits = 0;
    for (const Candidate& c : candidates) splits += splits_of(c, scale);
    return static_cast<double>(splits) <= most;
  };
  double least = INFINITY;
  for (const Candidate& c : candidates) least = std::min(least, c.priority);
  double low = 0, high = kMostParts / least;
  if (fits(high)) return high;
  for (int i = 0; i < 40; ++i) {
    const double middle = i < 20 && low > 0 ? std::sqrt(low) * std::sqrt(high) : 0.5 * (low + high);
    (fits(middle) ? low : high) = middle;
  }
  return low;
}

class TriangleSplitter {
 public:
  TriangleSplitter(const Grid& grid, std::vector<Ref>& out) : grid_(grid), out_(out) {}

  void split(const Polygon& triangle, uint32_t primitive, int splits) {
    const DoubleBox box = box_of(triangle);
    const glm::dvec3 side = box.hi - box.lo;
    margin_ = kPartMargin * std::max(side.x, std::max(side.y, side.z)), primitive_ = primitive;
    split(triangle, splits, 0);
  }

 private:
  void split(const Polygon& p, int splits, int depth) {
    const DoubleBox box = box_of(p);
    const bool may = splits > 0 && depth < kLevels && 2 * p.count <= Polygon::kMost;
    const Grid::Plane plane = may ? grid_.through(box) : Grid::Plane();
    if (plane.level == kLevels) return add(box);
    const Polygon side[2] = {clip(p, plane.axis, plane.at, true), clip(p, plane.axis, plane.at, false)};
    double length[2];
    for (int i = 0; i < 2; ++i) {
      if (side[i].count == 0) return add(box);
      const DoubleBox b = box_of(side[i]);
      length[i] = std::max(b.hi.x - b.lo.x, std::max(b.hi.y - b.lo.y, b.hi.z - b.lo.z));
    }
    const double share = length[0] / (length[0] + length[1]);
    const int left = static_cast<int>((splits - 1) * share + 0.5);
    split(side[0], left, depth + 1);
    split(side[1], splits - 1 - left, depth + 1);
  }

  void add(const DoubleBox& box) {
    Ref ref;
    for (int k = 0; k < 3; ++k) {
      ref.box.lo[k] = not_above(box.lo[k] - margin_);
      ref.box.hi[k] = -not_above(-(box.hi[k] + margin_));
    }
    ref.set_primitive(primitive_);
    out_.push_back(ref);
  }

  const Grid& grid_;
  std::vector<Ref>& out_;
  double margin_ = 0;
  uint32_t primitive_ = 0;
};

}  // namespace

AlignedBuffer<Ref> presplit(const SceneData& scene, const AlignedBuffer<Ref>& refs, const Box& box, Parallel& parallel) {
  const Grid grid{box};
  const auto in_chunks = [&](size_t count, const auto& body) {
    parallel.for_each((count + kChunk - 1) / kChunk, [&](size_t c, int) {
      for (size_t i = c * kChunk; i < std::min(count, (c + 1) * kChunk); ++i) body(c, i);
    });
  };
  std::vector<double> priority(refs.size());
  in_chunks(refs.size(), [&](size_t, size_t i) {
    priority[i] = priority_of(triangle_polygon(scene, refs[i].primitive()), grid);
  });
  std::vector<Candidate> candidates;
  for (uint32_t i = 0; i < refs.size(); ++i)
    if (priority[i] > 0) candidates.push_back({i, priority[i]});
  AlignedBuffer<Ref> out = AlignedBuffer<Ref>::copy(refs);
  if (candidates.empty()) return out;

  const double scale = scale_for(candidates, kMore * static_cast<double>(refs.size()));
  std::vector<std::vector<Ref>> parts((candidates.size() + kChunk - 1) / kChunk);
  in_chunks(candidates.size(), [&](size_t chunk, size_t i) {
    const uint32_t primitive = refs[candidates[i].ref].primitive();
    const int splits = splits_of(candidates[i], scale);
    if (splits > 0) TriangleSplitter(grid, parts[chunk]).split(triangle_polygon(scene, primitive), primitive, splits);
  });
  size_t kept = 0;
  for (size_t i = 0, c = 0; i < refs.size(); ++i) {
    const bool candidate = c < candidates.size() && candidates[c].ref == i;
    if (candidate && splits_of(candidates[c++], scale) > 0) continue;
    out[kept++] = refs[i];
  }
  out.resize(kept);
  for (const std::vector<Ref>& chunk : parts)
    for (const Ref& ref : chunk) out.push_back(ref);
  return out;
}

}  // namespace spanray::bvh
