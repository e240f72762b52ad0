#include "forms.h"

#include <cmath>
#include <map>

#include "math/elementary.h"

namespace spanray::assets {
namespace {

// sign(x) |x|^e
double signed_power(double x, double e) { return x == 0 ? 0 : x < 0 ? -pow_(-x, e) : pow_(x, e); }

struct Turn { double c, s; };
// The point k of n on a circle, exact on the axes.
Turn turn(int k, int n, double full) {
  Turn t;
  sin_cos(full * k / n, &t.s, &t.c);
  if (std::fabs(t.c) < 1e-12) t.c = 0;
  if (std::fabs(t.s) < 1e-12) t.s = 0;
  return t;
}

}  // namespace

void superellipsoid(ObjMesh& mesh, const Placement& at, const Point& size, double e1, double e2, int segments) {
  const int columns = 4 * ((segments + 3) / 4), rows = columns / 2;
  patch(mesh, columns, rows, [&](double s, double t) {
    const int i = static_cast<int>(s * columns + 0.5), j = static_cast<int>(t * rows + 0.5);
    const Turn u = turn(i == columns ? 0 : i, columns, 2 * kPi), v = turn(j, rows, kPi);
    const Point p{size.x * signed_power(v.s, e1) * signed_power(u.c, e2), -size.y * signed_power(v.c, e1), -size.z * signed_power(v.s, e1) * signed_power(u.s, e2)};
    const Point n{signed_power(v.s, 2 - e1) * signed_power(u.c, 2 - e2) / size.x, -signed_power(v.c, 2 - e1) / size.y,
                  -signed_power(v.s, 2 - e1) * signed_power(u.s, 2 - e2) / size.z};
    return Corner{at.point(p), at.direction(normalize3(n, Point{0, v.c > 0 ? -1.0 : 1.0, 0})), {0, 0}};
  });
}

void supertoroid(ObjMesh& mesh, const Placement& at, const Point& size, double e1, double e2, int segments) {
  const int columns = 4 * ((segments + 3) / 4), rows = columns / 2;
  patch(mesh, columns, rows, [&](double s, double t) {
    const int i = static_cast<int>(s * columns + 0.5), j = static_cast<int>(t * rows + 0.5);
    const Turn u = turn(i == columns ? 0 : i, columns, 2 * kPi), v = turn(j == rows ? 0 : j, rows, 2 * kPi);
    const double radius = size.x + size.z * signed_power(v.c, e1);
    const Point p{radius * signed_power(u.c, e2), size.y * signed_power(v.s, e1), -radius * signed_power(u.s, e2)};
    const double out = signed_power(v.c, 2 - e1) / size.z;
    const Point n{out * signed_power(u.c, 2 - e2), signed_power(v.s, 2 - e1) / size.y, -out * signed_power(u.s, 2 - e2)};
    return Corner{at.point(p), at.direction(normalize3(n, Point{0, 1, 0})), {0, 0}};
  });
}

Cage cage_of_cells(const std::vector<std::array<int, 3>>& cells) {
  std::map<std::array<int, 3>, int> filled, index;
  for (const auto& c : cells) filled[c] = 1;
  Cage cage;
  for (const auto& c : cells) {
    for (size_t k = 0; k < 3; ++k) {
      for (int side = 0; side < 2; ++side) {
        auto beyond = c;
        beyond[k] += side == 0 ? -1 : 1;
        if (filled.count(beyond)) continue;
        const size_t i = (k + 1) % 3, j = (k + 2) % 3;
        std::array<int, 4> quad;
        for (int corner = 0; corner < 4; ++corner) {
          std::array<int, 3> p = c;
          p[k] += side;
          p[i] += (corner == 1 || corner == 2) == (side == 1) ? 1 : 0;  // mirrored on the low side
          p[j] += corner >= 2;
          const auto [it, is_new] = index.try_emplace(p, static_cast<int>(cage.points.size()));
          if (is_new) cage.points.emplace_back(p[0], p[1], p[2]);
          quad[static_cast<size_t>(corner)] = it->second;
        }
        cage.quads.push_back(quad);
      }
    }
  }
  return cage;
}

Cage subdivided(const Cage& cage) {
  struct Edge { Point sum{0, 0, 0}; int index = 0; };
  struct Around { Point faces{0, 0, 0}, edges{0, 0, 0}; double valence = 0; };
  const auto at = [](auto& v, int i) -> auto& { return v[static_cast<size_t>(i)]; };
  std::map<std::pair<int, int>, Edge> edges;
  std::vector<Around> around(cage.points.size());
  std::vector<Point> centers;
  const auto key = [](int a, int b) { return a < b ? std::pair{a, b} : std::pair{b, a}; };
  for (const auto& q : cage.quads) {
    centers.push_back(0.25 * (at(cage.points, q[0]) + at(cage.points, q[1]) + at(cage.points, q[2]) + at(cage.points, q[3])));
    for (size_t k = 0; k < 4; ++k) {
      Edge& e = edges[key(q[k], q[(k + 1) & 3])];
      e.sum = e.sum + centers.back();
      Around& a = at(around, q[k]);
      a.faces = a.faces + centers.back(), a.valence += 1;
    }
  }
  Cage out;
  for (auto& [ends, e] : edges) {
    const Point &a = at(cage.points, ends.first), &b = at(cage.points, ends.second), middle = 0.5 * (a + b);
    at(around, ends.first).edges = at(around, ends.first).edges + middle;
    at(around, ends.second).edges = at(around, ends.second).edges + middle;
  }
  for (size_t i = 0; i < cage.points.size(); ++i) {
    const double n = around[i].valence;
    out.points.push_back((1 / n) * ((1 / n) * around[i].faces + (2 / n) * around[i].edges + (n - 3) * cage.points[i]));
  }
  for (auto& [ends, e] : edges) {
    e.index = static_cast<int>(out.points.size());
    out.points.push_back(0.25 * (at(cage.points, ends.first) + at(cage.points, ends.second) + e.sum));
  }
  for (size_t f = 0; f < cage.quads.size(); ++f) {
    const auto& q = cage.quads[f];
    const int center = static_cast<int>(out.points.size());
    out.points.push_back(centers[f]);
    for (size_t k = 0; k < 4; ++k) out.quads.push_back({q[k], edges[key(q[k], q[(k + 1) & 3])].index, center, edges[key(q[(k + 3) & 3], q[k])].index});
  }
  return out;
}

void add_cage(ObjMesh& mesh, const Placement& at, const Cage& cage) {
  std::vector<Point> normals(cage.points.size(), Point{0, 0, 0});
  const auto point = [&](int i) { return cage.points[static_cast<size_t>(i)]; };
  for (const auto& q : cage.quads) {
    const Point n = cross3(point(q[2]) - point(q[0]), point(q[3]) - point(q[1]));
    for (const int i : q) normals[static_cast<size_t>(i)] = normals[static_cast<size_t>(i)] + n;
  }
  for (const auto& q : cage.quads) {
    const auto corner = [&](size_t k) {
      return Corner{at.point(point(q[k])), normalize3(at.direction(normals[static_cast<size_t>(q[k])]), Point{0, 1, 0}), {0, 0}};
    };
    mesh.face({corner(0), corner(1), corner(2), corner(3)});
  }
}

}  // namespace spanray::assets
