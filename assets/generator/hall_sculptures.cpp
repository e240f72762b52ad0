// The sculptures of the hall and what they stand on.
#include <cmath>

#include "forms.h"
#include "hall.h"
#include "math/elementary.h"

namespace spanray::assets::hall {
namespace {

// Soft balls that flow together: the sum of (1 - r^2 / R^2)^3 within each radius R, less a threshold.
// Source: Wyvill, McPheeters, Wyvill 1986, "Data structure for soft objects".
struct Ball { Point center; double radius; };
Field soft_balls(std::vector<Ball> balls, double threshold) {
  return [balls = std::move(balls), threshold](const Point& p) {
    FieldValue sum{-threshold, {0, 0, 0}};
    for (const Ball& b : balls) {
      const Point r = p - b.center;
      const double square = b.radius * b.radius, q = 1 - dot3(r, r) / square;
      if (q <= 0) continue;
      sum.value += q * q * q;
      sum.gradient = sum.gradient + (-6 * q * q / square) * r;
    }
    return sum;
  };
}

// Three strands that rise from one foot, wind about each other and part: a flame.
Field flame() {
  std::vector<Ball> balls;
  for (int strand = 0; strand < 3; ++strand) {
    const int beads = 26;
    for (int k = 0; k < beads; ++k) {
      const double t = static_cast<double>(k) / (beads - 1) * (1 - 0.13 * strand);
      double s, c, open, unused;
      sin_cos(2 * kPi * (strand / 3.0 + 0.80 * t), &s, &c);
      sin_cos(0.72 * kPi * t, &open, &unused);
      const double out = 0.07 + 0.20 * open * (1 - 0.35 * t);
      balls.push_back({{out * c, 0.10 + 1.42 * t, out * s}, 0.215 - 0.090 * t * t});
    }
  }
  return soft_balls(balls, 0.9);
}

// One of the two rooms that the gyroid parts, rounded off by a ball of radius 1 (its own unit).
// Source: Schoen 1970, "Infinite periodic minimal surfaces without self-intersections".
Field gyroid_ball() {
  return [](const Point& p) {
    const double k = 2 * kPi / 1.6;
    double s[3], c[3];
    for (int i = 0; i < 3; ++i) sin_cos(k * p[i], &s[i], &c[i]);
    const double a = s[0] * c[1] + s[1] * c[2] + s[2] * c[0] + 0.30;
    const Point da = k * Point{c[0] * c[1] - s[2] * s[0], c[1] * c[2] - s[0] * s[1], c[2] * c[0] - s[1] * s[2]};
    const double b = 2.6 * (1 - dot3(p, p));
    const Point db = -5.2 * p;
    const double difference = a - b, root = std::sqrt(difference * difference + 0.06), w = difference / root;  // a smooth minimum
    return FieldValue{0.5 * (a + b - root), 0.5 * ((1 - w) * da + (1 + w) * db)};
  };
}

void plinth(ObjMesh& mesh, const Detail& d, const Placement& at, double width, double high, const char* material) {
  const auto part = [&](double y, double w, double h, double chamfer) {
    Placement p = at;
    p.origin = at.point({0, y, 0});
    box(mesh, p, {w, h, w}, d.chamfer(chamfer), d.cell(0.8), kStone);
  };
  mesh.object("plinth", material);
  part(high / 2 - 0.01, width, high - 0.02, 0.012);
  mesh.object("plinth_moldings", "stone");
  part(0.07, width + 0.12, 0.18, 0.015);
  part(high - 0.03, width + 0.09, 0.06, 0.012);
}

Placement scaled(const Point& origin, double degrees, double size) {
  Placement p = placed(origin, degrees);
  p.x = size * p.x, p.y = size * p.y, p.z = size * p.z;
  return p;
}

Cage smooth_cage(const Detail& d, Cage cage) {
  // Each step doubles the divisions of an edge; the shipped level has four.
  for (int n = 1; n < d.count(4, 1); n *= 2) cage = subdivided(cage);
  return cage;
}

// The edges of a cube, as 20 cells.
Cage cube_frame() {
  std::vector<std::array<int, 3>> cells;
  for (int z = 0; z < 3; ++z) {
    for (int y = 0; y < 3; ++y) {
      for (int x = 0; x < 3; ++x) {
        if ((x == 1) + (y == 1) + (z == 1) <= 1) cells.push_back({x, y, z});
      }
    }
  }
  Cage cage = cage_of_cells(cells);
  for (Point& p : cage.points) p = p - Point{1.5, 0, 1.5};
  return cage;
}

}  // namespace

void add_sculptures(ObjMesh& mesh, const Detail& d) {
  plinth(mesh, d, placed({-1.65, 0, -5.85}, 8), 0.62, 0.62, "marble_verde");
  mesh.object("flame", "alabaster");
  implicit_surface(mesh, placed({-1.65, 0.58, -5.85}, 60), flame(), {-0.6, -0.3, -0.6}, {0.6, 2.0, 0.6}, d.cell(0.050));

  plinth(mesh, d, placed({1.80, 0, -10.4}, -12), 0.66, 0.70, "marble_verde");
  mesh.object("linked_rings", "polished_bronze");
  for (int k = 0; k < 2; ++k) {
    const Placement at = placed({1.80 + (k == 0 ? -0.13 : 0.13), 0.69 + 0.42, -10.4}, k == 0 ? 62 : -28);
    supertoroid(mesh, {at.origin, at.x, at.z, -at.y}, {0.26, 0.08, 0.08}, 1.0, 1.0, d.count(40, 12));
  }

  plinth(mesh, d, placed({-1.85, 0, -16.4}, 6), 0.60, 0.80, "marble_verde");
  mesh.object("cube_frame", "bronze");
  add_cage(mesh, scaled({-1.85, 0.795, -16.4}, 30, 0.22), smooth_cage(d, cube_frame()));

  mesh.object("apse_plinth", "stone");
  const Profile steps = Outline(0, -0.02).line(1.05, -0.02).line(1.05, 0.16).line(0.86, 0.16).line(0.86, 0.32).line(0.50, 0.32).line(0.50, 0.42)
                            .smooth({{0.42, 0.46}, {0.36, 0.56}, {0.36, 0.95}, {0.42, 1.05}, {0.52, 1.10}}).line(0.52, 1.18).line(0, 1.18).done();
  lathe(mesh, placed({0, 0, -kLength - 0.75}), refined(steps, d.cell(0.4)), d.count(30, 10), 2, kStone);
  mesh.object("gyroid", "gold");
  implicit_surface(mesh, scaled({0, 1.99, -kLength - 0.75}, 20, 0.85), gyroid_ball(), {-1.05, -1.05, -1.05}, {1.05, 1.05, 1.05}, d.cell(0.115));

  // In the niches; their sills are at 0.965.
  const double sill = 0.955, x = -kWallX - 0.42;
  mesh.object("niche_urn", "clay");
  urn(mesh, scaled({x, sill, bay_center(3)}, 0, 1), d.count(24, 6));
  for (const int bay : {1, 5}) {
    mesh.object("niche_foot", "stone");
    box(mesh, placed({x, sill + 0.06, bay_center(bay)}), {0.42, 0.16, 0.42}, d.chamfer(0.012), d.cell(0.8), kStone);
  }
  mesh.object("niche_ring", "bronze");
  Placement upright = placed({x, sill + 0.14 + 0.44, bay_center(1)}, 70);
  const Placement lying = upright;
  upright.y = lying.z, upright.z = -lying.y;
  supertoroid(mesh, upright, {0.24, 0.09, 0.10}, 1.0, 0.8, d.count(36, 12));
  mesh.object("niche_egg", "alabaster");
  superellipsoid(mesh, placed({x, sill + 0.13 + 0.36, bay_center(5)}), {0.24, 0.37, 0.24}, 1.0, 0.6, d.count(26, 10));
}

}  // namespace spanray::assets::hall
