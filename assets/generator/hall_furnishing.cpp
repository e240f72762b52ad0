// What hangs and stands in the hall: iron, gauze, lamps, glass cases, benches.
#include "forms.h"
#include "hall.h"
#include "math/elementary.h"
#include "noise.h"

namespace spanray::assets::hall {
namespace {

double wave(double turns) {
  double s, c;
  sin_cos(2 * kPi * turns, &s, &c);
  return s;
}

// One half of a pair of curtains in an arch, tied back to its column: s from the column (0) to the middle, t down from the rod.
// In the arch's own frame: x along the wall, the column at x = -1.05.
Point half_curtain(double s, double t) {
  const double knot = 0.60, above = smooth_step(0, knot, t), below = smooth_step(knot, 1, t);
  const double width = t < knot ? mix(1.02, 0.13, above) : mix(0.13, 0.30, below);
  const double start = t < knot ? mix(-1.03, -0.93, above) : mix(-0.93, -0.95, below);
  const double deep = t < knot ? mix(0.040, 0.007, above) : mix(0.007, 0.016, below);
  const double sag = 0.22 * s * above * (t < knot ? 1 : 1 - below);
  return {start + width * (s + 0.010 * wave(5 * s)), 3.34 - 3.24 * t - sag, deep * wave(5 * s + 0.12 * wave(1.7 * s)) + 0.02 * t * wave(1.1 * s)};
}

void curtain(ObjMesh& mesh, const Detail& d, const Placement& at) {
  for (int side = 0; side < 2; ++side) {
    mesh.object("half_curtain", "gauze");
    const auto point = [&](double s, double t) {
      Point p = half_curtain(side == 0 ? s : 1 - s, 1 - t);
      if (side == 1) p.x = -p.x;
      return at.point(p);
    };
    smooth_patch(mesh, d.count(46, d.keep(0.25) ? 20 : 10), d.count(13, d.keep(0.25) ? 8 : 4), point, [](double s, double t) { return glm::dvec2{s * 2, t * 4}; }, 1e-3, at.z);
    if (!d.keep(0.20)) continue;
    mesh.object("curtain_cord", "gilt");
    const Point tie = half_curtain(0.5, 0.60);
    Placement ring = at;
    ring.origin = at.point({side == 0 ? tie.x : -tie.x, tie.y, 0});
    lathe(mesh, ring, {arc({0.075, 0}, 0.014, 0.014, -180, 180, d.count(4, 3))}, d.count(10, 6));
  }
  mesh.object("curtain_rod", "bronze");
  const Placement rod{at.point({-1.2, 3.36, 0}), -at.z, at.y, at.x};
  bar(mesh, rod, {arc({0, 0}, 0.020, 0.020, 0, 360, d.count(8, 5))}, 2.4, d.count(4));
}

void chandelier(ObjMesh& mesh, const Detail& d, const Point& middle) {
  mesh.object("chandelier", "bronze");
  const Placement at = placed(middle);
  const int around = d.count(28, 10), thick = d.count(6, 4);
  const Profile hoop = Outline(0.60, -0.035).line(0.63, -0.035).line(0.63, 0.035).line(0.60, 0.035).line(0.60, -0.035).done();
  lathe(mesh, at, refined(hoop, d.cell(0.2)), around);
  lathe(mesh, placed(middle + Point{0, 0.95, 0}), Outline(0, -0.06).smooth(arc({0, 0}, 0.06, 0.06, -90, 90, thick)).done(), d.count(10, 6));
  const double top = kVaultSpring + kVaultRadius - 0.05;
  lathe(mesh, placed({middle.x, 0, middle.z}), refined(Outline(0, middle.y + 0.95).line(0.012, middle.y + 0.95).line(0.012, top).line(0, top).done(), d.cell(1)), d.count(6, 4));
  for (int k = 0; k < 4; ++k) {
    const Placement spoke = placed(middle, 90.0 * k + 45);
    const Point from = spoke.point({0.615, 0.02, 0}), to = middle + Point{0, 0.95, 0} + 0.035 * spoke.x, z = normalize3(to - from, spoke.y);
    const Placement rod{from, spoke.z, cross3(z, spoke.z), z};
    bar(mesh, rod, {arc({0, 0}, 0.010, 0.010, 0, 360, d.count(5, 3))}, length3(to - from), d.count(2));
  }
  for (int k = 0; k < 10; ++k) {
    const Placement p = placed(middle, 36.0 * k);
    if (d.keep(0.32)) {
      mesh.object("lamp_cup", "bronze");
      lathe(mesh, placed(p.point({0.615, 0, 0})), Outline(0, 0.02).line(0.02, 0.02).smooth({{0.055, 0.045}, {0.065, 0.085}}).line(0, 0.085).done(), d.count(8, 5));
    }
    mesh.object("lamp_globe", "lamp");
    superellipsoid(mesh, placed(p.point({0.615, 0.14, 0})), {0.062, 0.075, 0.062}, 1, 1, d.count(8, 4));
  }
}

// A plinth of walnut, a hood of glass with edges of brass; `foot` is its middle on the floor. The top of the plinth is at 0.86.
void glass_case(ObjMesh& mesh, const Detail& d, const Placement& foot, double width, double depth, double high) {
  const double base = 0.86;
  const auto part = [&](double x, double y, double z, const Point& size, double chamfer) {
    Placement at = foot;
    at.origin = foot.point({x, y, z});
    box(mesh, at, size, d.chamfer(chamfer), d.cell(0.8), 0.8);
  };
  mesh.object("case_plinth", "walnut");
  part(0, 0.43, 0, {width - 0.06, 0.82, depth - 0.06}, 0.012);
  part(0, 0.05, 0, {width + 0.02, 0.14, depth + 0.02}, 0.012);
  part(0, base - 0.03, 0, {width + 0.04, 0.06, depth + 0.04}, 0.012);
  mesh.object("case_cloth", "velvet");
  part(0, base, 0, {width - 0.05, 0.02, depth - 0.05}, 0);
  if (d.keep(0.16)) mesh.object("case_edges", "brass");
  const double e = 0.022;
  for (const double sx : {-1.0, 1.0}) {
    for (const double sz : {-1.0, 1.0}) if (d.keep(0.16)) part(sx * (width / 2 - e / 2), base + high / 2 - 0.005, sz * (depth / 2 - e / 2), {e, high, e}, 0.003);
  }
  for (const double level : {base + 0.008, base + high}) {
    for (const double s : {-1.0, 1.0}) {
      if (!d.keep(0.16)) continue;
      part(0, level, s * (depth / 2 - e / 2), {width + 0.002, e, e + 0.002}, 0.003);
      part(s * (width / 2 - e / 2), level, 0, {e + 0.002, e + 0.002, depth + 0.002}, 0.003);
    }
  }
  mesh.object("case_glass", "glass");
  const double x = width / 2 - e / 2, z = depth / 2 - e / 2, low = base + 0.01;
  const int n = d.count(2);
  const auto pane = [&](const Point& corner, const Point& u, const Point& v) { rectangle(mesh, foot.point(corner), foot.direction(u), foot.direction(v), n, n); };
  pane({-x, low, z}, {2 * x, 0, 0}, {0, high, 0});
  pane({x, low, -z}, {-2 * x, 0, 0}, {0, high, 0});
  pane({x, low, z}, {0, 0, -2 * z}, {0, high, 0});
  pane({-x, low, -z}, {0, 0, 2 * z}, {0, high, 0});
  pane({-x, low + high - 0.01, z}, {2 * x, 0, 0}, {0, 0, -2 * z});
}

void bench(ObjMesh& mesh, const Detail& d, const Placement& at) {
  mesh.object("bench", "walnut");
  const auto part = [&](double x, double y, const Point& size) {
    Placement p = at;
    p.origin = at.point({x, y, 0});
    box(mesh, p, size, d.chamfer(0.012), d.cell(0.7), 0.8);
  };
  part(0, 0.45, {1.5, 0.07, 0.46});
  part(-0.58, 0.20, {0.09, 0.46, 0.38});
  part(0.58, 0.20, {0.09, 0.46, 0.38});
  part(0, 0.16, {1.2, 0.06, 0.08});
}

}  // namespace

void add_ironwork(ObjMesh& mesh, const Detail& d) {
  for (int bay = 0; bay < kBays; ++bay) {
    if (bay == 2) continue;  // its leaves are taken out: the sun falls on the flame through it, and bars would draw on that
    mesh.object("lattice", "lattice");
    const Placement at = placed({kWallX + 0.34, 0, bay_center(bay)}, -90);
    rectangle(mesh, at.point({-0.85, 0.96, 0}), 1.7 * at.x, {0, 2.89, 0}, d.count(2), d.count(3), 1.6, {-0.85 / 1.6 + 0.5, 0});
  }
  const auto gate = [&](double x, double half, double high, double tile) {
    mesh.object("gate", "ironwork");
    rectangle(mesh, {x + half, 0.0, 0.30}, {-2 * half, 0, 0}, {0, high, 0}, d.count(2), d.count(2), tile, {0, 0});
  };
  // The leaves of the middle gate stand open.
  for (const double side : {-1.0, 1.0}) {
    mesh.object("gate", "ironwork");
    rectangle(mesh, {side * 1.66, 0.0, side < 0 ? 0.0 : -1.6}, {0, 0, side < 0 ? -1.6 : 1.6}, {0, 3.2, 0}, d.count(2), d.count(2), 1.6);
  }
  for (const double side : {-1.0, 1.0}) gate(side * 4.6, 0.82, 2.46, 0.82);
  // The rail before the apse.
  const double z = -kLength + 0.75, half = 2.55;
  mesh.object("rail_iron", "ironwork");
  rectangle(mesh, {-half, 0.05, z}, {2 * half, 0, 0}, {0, 0.85, 0}, d.count(6), d.count(1), 0.85, {0, 0});
  mesh.object("rail", "bronze");
  const Placement along{{-half, 0.92, z}, {0, 0, -1}, {0, 1, 0}, {1, 0, 0}};
  bar(mesh, along, {arc({0, 0}, 0.030, 0.026, 0, 360, d.count(8, 5))}, 2 * half, d.count(8, 2));
  for (int k = 0; k <= 4 && d.keep(0.14); ++k) {
    lathe(mesh, placed({-half + k * half / 2, 0, z}), Outline(0, -0.02).line(0.05, -0.02).line(0.05, 0.03).line(0.022, 0.05).line(0.022, 0.92).smooth(arc({0, 0.97}, 0.045, 0.05, -60, 90, d.count(5, 3))).done(), d.count(8, 5));
  }
}

void add_curtains(ObjMesh& mesh, const Detail& d) {
  for (const int bay : {1, 3, 5}) curtain(mesh, d, placed({-kColumnX, 0, bay_center(bay)}, 90));
  for (const int bay : {1, 4}) curtain(mesh, d, placed({kColumnX, 0, bay_center(bay)}, -90));
}

void add_lanterns(ObjMesh& mesh, const Detail& d) {
  for (const double z : {-6.0, -15.0}) chandelier(mesh, d, {0, 5.0, z});
}

void add_cases(ObjMesh& mesh, const Detail& d) {
  const Placement first = placed({1.80, 0, -5.0}, -16), second = placed({-1.85, 0, -10.6}, 12), third = placed({1.85, 0, -16.4}, -8);
  glass_case(mesh, d, first, 0.95, 0.70, 0.80);
  glass_case(mesh, d, second, 0.95, 0.70, 0.80);
  glass_case(mesh, d, third, 0.80, 0.80, 0.90);
  const auto on = [](const Placement& at, double x, double y, double z) {
    Placement p = at;
    p.origin = at.point({x, y, z});
    return p;
  };
  mesh.object("vase", "ceramic");
  vase(mesh, on(first, -0.22, 0.872, 0.02), d.count(26, 6));
  mesh.object("case_torus", "gilt");
  Placement ring = on(first, 0.20, 1.052, 0.05);
  const Placement lying = ring;
  ring.y = lying.z, ring.z = -lying.y;
  supertoroid(mesh, ring, {0.075, 0.05, 0.055}, 0.7, 1.0, d.count(28, 10));
  mesh.object("urn", "clay");
  urn(mesh, on(second, 0.16, 0.872, 0), d.count(24, 6));
  mesh.object("case_stone", "marble_verde");
  superellipsoid(mesh, on(second, -0.24, 0.985, 0.04), {0.125, 0.125, 0.125}, 0.35, 0.35, d.count(24, 10));
  mesh.object("vase", "ceramic");
  vase(mesh, on(third, 0, 0.872, 0), d.count(24, 6));
  for (const double z : {-8.0, -13.5}) bench(mesh, d, placed({-4.7, 0, z}, 90));
  bench(mesh, d, placed({4.9, 0, -10.5}, 90));
}

}  // namespace spanray::assets::hall
