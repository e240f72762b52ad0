// Marching tetrahedra: each cube of the grid is cut into six tetrahedra about its diagonal (Kuhn), which fit from cube to cube.
#include <cmath>

#include "forms.h"

namespace spanray::assets {
namespace {

struct Grid {
  int n[3];  // cubes
  Point low, step;
  size_t points() const { return static_cast<size_t>(n[0] + 1) * static_cast<size_t>(n[1] + 1) * static_cast<size_t>(n[2] + 1); }
  size_t index(int x, int y, int z) const {
    return (static_cast<size_t>(z) * static_cast<size_t>(n[1] + 1) + static_cast<size_t>(y)) * static_cast<size_t>(n[0] + 1) + static_cast<size_t>(x);
  }
  Point at(int x, int y, int z) const { return low + Point{step.x * x, step.y * y, step.z * z}; }
};

struct Surface {
  std::vector<Point> points;
  std::vector<std::array<int, 3>> triangles;
};

class Marching {
 public:
  Marching(const Grid& grid, const Field& field) : grid_(grid), edge_point_(grid.points() * 8, -1) {
    values_.reserve(grid.points());
    for (int z = 0; z <= grid.n[2]; ++z) {
      for (int y = 0; y <= grid.n[1]; ++y) {
        for (int x = 0; x <= grid.n[0]; ++x) values_.push_back(field(grid.at(x, y, z)).value);
      }
    }
  }

  Surface run() {
    for (int z = 0; z < grid_.n[2]; ++z) {
      for (int y = 0; y < grid_.n[1]; ++y) {
        for (int x = 0; x < grid_.n[0]; ++x) cube(x, y, z);
      }
    }
    return std::move(surface_);
  }

 private:
  struct Node { int x, y, z; };
  bool inside(const Node& a) const { return values_[grid_.index(a.x, a.y, a.z)] > 0; }

  // Six paths from corner 0 to corner 7 along the axes, in the orders of the axes; odd ones are mirrored.
  void cube(int x, int y, int z) {
    static constexpr int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (int t = 0; t < 6; ++t) {
      Node node[4] = {{x, y, z}, {x, y, z}, {x, y, z}, {x + 1, y + 1, z + 1}};
      const auto go = [](Node& a, int axis) { ++(axis == 0 ? a.x : axis == 1 ? a.y : a.z); };
      go(node[1], kOrders[t][0]), go(node[2], kOrders[t][0]), go(node[2], kOrders[t][1]);
      if (t >= 3) std::swap(node[1], node[2]);
      tetrahedron(node);
    }
  }

  // a, b, c, d: an even permutation of a positively oriented tetrahedron, so that the turns below look outward.
  void tetrahedron(const Node (&v)[4]) {
    static constexpr int kAlone[4][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}};
    static constexpr int kPairs[6][4] = {{0, 1, 2, 3}, {2, 3, 0, 1}, {0, 2, 3, 1}, {1, 3, 2, 0}, {0, 3, 1, 2}, {1, 2, 0, 3}};
    bool in[4];
    int count = 0;
    for (int i = 0; i < 4; ++i) count += in[i] = inside(v[i]);
    for (int i = 0; (count == 1 || count == 3) && i < 4; ++i) {
      if (in[i] != (count == 1)) continue;
      const int* p = kAlone[i];
      const int b = cut(v[p[0]], v[p[1]]), c = cut(v[p[0]], v[p[2]]), d = cut(v[p[0]], v[p[3]]);
      if (count == 1) surface_.triangles.push_back({b, c, d});
      else surface_.triangles.push_back({b, d, c});
    }
    for (int i = 0; count == 2 && i < 6; ++i) {
      const int* p = kPairs[i];
      if (!in[p[0]] || !in[p[1]]) continue;
      const int ac = cut(v[p[0]], v[p[2]]), ad = cut(v[p[0]], v[p[3]]), bd = cut(v[p[1]], v[p[3]]), bc = cut(v[p[1]], v[p[2]]);
      surface_.triangles.push_back({ac, ad, bd});
      surface_.triangles.push_back({ac, bd, bc});
    }
  }

  int cut(const Node& a, const Node& b) {
    const bool forward = a.x <= b.x && a.y <= b.y && a.z <= b.z;
    const Node &from = forward ? a : b, &to = forward ? b : a;
    const size_t direction = static_cast<size_t>((to.x - from.x) + 2 * (to.y - from.y) + 4 * (to.z - from.z));
    int& point = edge_point_[grid_.index(from.x, from.y, from.z) * 8 + direction];
    if (point < 0) {
      const double f = values_[grid_.index(from.x, from.y, from.z)], g = values_[grid_.index(to.x, to.y, to.z)];
      const Point p = grid_.at(from.x, from.y, from.z), q = grid_.at(to.x, to.y, to.z);
      point = static_cast<int>(surface_.points.size());
      surface_.points.push_back(p + (f / (f - g)) * (q - p));
    }
    return point;
  }

  Grid grid_;
  std::vector<double> values_;
  std::vector<int> edge_point_;
  Surface surface_;
};

// Newton's step along the gradient, at most `most` long.
Point onto_surface(const Field& field, Point p, double most) {
  for (int k = 0; k < 2; ++k) {
    const FieldValue f = field(p);
    const double slope = dot3(f.gradient, f.gradient);
    if (!(slope > 0)) return p;
    Point step = (-f.value / slope) * f.gradient;
    const double length = length3(step);
    if (length > most) step = (most / length) * step;
    p = p + step;
  }
  return p;
}

// Slivers come where the surface passes near a grid point: move each vertex halfway to the middle of its neighbors, and back onto the surface.
void even_out(Surface& s, const Field& field, double cell) {
  for (int pass = 0; pass < 8; ++pass) {
    std::vector<Point> sum(s.points.size(), Point{0, 0, 0});
    std::vector<double> weight(s.points.size(), 0);
    for (const auto& t : s.triangles) {
      for (size_t k = 0; k < 3; ++k) {
        const size_t i = static_cast<size_t>(t[k]);
        sum[i] = sum[i] + s.points[static_cast<size_t>(t[(k + 1) % 3])] + s.points[static_cast<size_t>(t[(k + 2) % 3])];
        weight[i] += 2;
      }
    }
    for (size_t i = 0; i < s.points.size(); ++i) {
      const Point n = normalize3(field(s.points[i]).gradient, Point{0, 0, 0}), move = 0.5 * ((1 / weight[i]) * sum[i] - s.points[i]);
      s.points[i] = onto_surface(field, s.points[i] + (move - dot3(move, n) * n), 0.5 * cell);  // along the surface, or necks would close
    }
  }
}

}  // namespace

void implicit_surface(ObjMesh& mesh, const Placement& at, const Field& field, const Point& low, const Point& high, double cell) {
  Grid grid{{0, 0, 0}, low, {0, 0, 0}};
  for (int k = 0; k < 3; ++k) {
    grid.n[k] = 1 + static_cast<int>(std::floor((high[k] - low[k]) / cell));
    grid.step[k] = (high[k] - low[k]) / grid.n[k];
  }
  Surface surface = Marching(grid, field).run();
  even_out(surface, field, cell);
  std::vector<Corner> corners;
  for (const Point& p : surface.points) {
    corners.push_back({at.point(p), normalize3(at.direction(-field(p).gradient), Point{0, 1, 0}), {0, 0}});
  }
  for (const auto& t : surface.triangles) {
    mesh.face({corners[static_cast<size_t>(t[0])], corners[static_cast<size_t>(t[1])], corners[static_cast<size_t>(t[2])]});
  }
}

}  // namespace spanray::assets
