#include "architecture.h"

#include "math/elementary.h"

namespace spanray::assets {
namespace {

using Points = std::vector<glm::dvec2>;

// Bezier curve with three control points: the line of a vessel.
Points curve(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, int segments) {
  Points points;
  for (int k = 0; k <= segments; ++k) {
    const double t = static_cast<double>(k) / segments, s = 1 - t;
    points.push_back(s * s * a + 2 * s * t * b + t * t * c);
  }
  return points;
}

Points operator+(Points a, const Points& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

void arch_wall(ObjMesh& mesh, const Placement& at, const ArchWall& w) {
  const double half = w.width / 2, z = w.depth / 2;
  const auto corner = [&](double x, double y, double cz, const Point& n) {
    const glm::dvec2 uv = n.z != 0 ? glm::dvec2{x + w.uv_start.x, y + w.uv_start.y} : glm::dvec2{cz, n.x != 0 ? y : x};
    return Corner{at.point({x, y, cz}), at.direction(n), uv / w.texture_size};
  };
  const auto on_arch = [&](double s, double* c, double* sn) { sin_cos(kPi * (1 - s), sn, c); };  // s: left to right
  const int rows = w.rows;
  for (int side = -1; side <= 1; side += 2) {
    const Point n{0, 0, static_cast<double>(side)};
    const auto face = [&](int columns, int r, const std::function<glm::dvec2(double, double)>& xy) {
      patch(mesh, columns, r, [&](double s, double t) {
        const glm::dvec2 p = xy(side > 0 ? s : 1 - s, t);
        return corner(p.x, p.y, side * z, n);
      });
    };
    face(w.segments, rows, [&](double s, double t) {
      double c, sn;
      on_arch(s, &c, &sn);
      const double low = w.spring + w.radius * sn;
      return glm::dvec2{w.radius * c, low + (w.top - low) * t};
    });
    for (int jamb = -1; jamb <= 1; jamb += 2) {
      const double left = jamb < 0 ? -half : w.radius, right = jamb < 0 ? -w.radius : half;
      face(w.columns, rows, [&](double s, double t) { return glm::dvec2{left + (right - left) * s, w.spring + (w.top - w.spring) * t}; });
      if (w.bottom < w.spring) face(w.columns, rows, [&](double s, double t) { return glm::dvec2{left + (right - left) * s, w.bottom + (w.spring - w.bottom) * t}; });
    }
  }
  patch(mesh, w.deep, w.segments, [&](double s, double t) {  // the inside of the arch
    double c, sn;
    on_arch(t, &c, &sn);
    return Corner{at.point({w.radius * c, w.spring + w.radius * sn, z - 2 * z * s}), at.direction({-c, -sn, 0}),
                  glm::dvec2{2 * z * s, kPi * w.radius * t} / w.texture_size};
  });
  for (int jamb = -1; jamb <= 1; jamb += 2) {
    const double inner = jamb * w.radius, outer = jamb * half;
    patch(mesh, w.deep, w.columns, [&](double s, double t) {  // the underside
      return corner(inner + (outer - inner) * t, w.bottom, jamb * (z - 2 * z * s), {0, -1, 0});
    });
    if (w.bottom < w.spring) {
      patch(mesh, w.deep, rows, [&](double s, double t) {
        return corner(inner, w.bottom + (w.spring - w.bottom) * t, jamb * (2 * z * s - z), {-static_cast<double>(jamb), 0, 0});
      });
    }
  }
}

void archivolt(ObjMesh& mesh, const Placement& at, const ArchWall& w, double wide, double proud, int segments) {
  const double r = w.radius + 0.03, z = w.depth / 2, q = proud / 2;
  const double step = r + wide * 0.55;
  const Profile section = Outline(r, z - 0.02).line(r + wide, z - 0.02).line(r + wide, z + q).smooth(arc({r + wide - q, z + q}, q, q, 0, 90, 4))
                              .line(step, z + 2 * q).smooth(arc({step - q, z + 2 * q}, q, q, 0, -90, 3)).line(r, z + q).line(r, z - 0.02).done();
  Placement up = at;
  up.origin = at.point({0, w.spring, 0});
  arch(mesh, up, section, segments, w.texture_size);
}

void column_base_and_capital(ObjMesh& mesh, const Placement& at, double texture_size) {
  Placement plinth = at, abacus = at;
  plinth.origin = at.point({0, 0.05, 0});
  abacus.origin = at.point({0, 2.60, 0});
  box(mesh, plinth, {0.56, 0.12, 0.56}, 0.008, 0, texture_size);
  box(mesh, abacus, {0.60, 0.12, 0.60}, 0.010, 0, texture_size);
  const Profile base = Outline(0, 0.10).line(0.205, 0.10).smooth(arc({0.205, 0.155}, 0.055, 0.055, -90, 90, 6)).line(0.222, 0.21).line(0.222, 0.225)
                           .smooth(arc({0.222, 0.262}, 0.037, 0.037, -90, -180, 4)).line(0.185, 0.275).line(0.197, 0.275)
                           .smooth(arc({0.197, 0.305}, 0.032, 0.030, -90, 90, 5)).line(0.19, 0.345).line(0, 0.345).done();
  lathe(mesh, at, base, 24, 1, texture_size);
  const Profile capital = Outline(0, 2.28).line(0.158, 2.28).smooth(arc({0.158, 2.30}, 0.022, 0.020, -90, 90, 4)).smooth({{0.150, 2.33}, {0.150, 2.41}})
                              .line(0.165, 2.41).line(0.165, 2.43).line(0.178, 2.43).line(0.178, 2.445)
                              .smooth(arc({0.178, 2.545}, 0.095, 0.100, -90, 0, 5)).line(0, 2.545).done();
  lathe(mesh, at, capital, 24, 1, texture_size);
}

void column_shaft(ObjMesh& mesh, const Placement& at, double repeat_u, double texture_size) {
  Points side;
  side.push_back({0.205, 0.345}), side.push_back({0.195, 0.36}), side.push_back({0.19, 0.38});
  for (int k = 1; k <= 5; ++k) {  // entasis: straight at the foot, drawing in toward the top
    const double t = k / 5.0;
    side.push_back({0.19 - 0.038 * t * t, 0.38 + 1.88 * t});
  }
  side.push_back({0.157, 2.285});
  lathe(mesh, at, Outline(0, 0.335).line(0.205, 0.335).smooth(side).line(0, 2.29).done(), 32, repeat_u, texture_size);
}

void urn(ObjMesh& mesh, const Placement& at, int segments) {
  const Profile outline = Outline(0, -0.01).line(0.16, -0.01).line(0.16, 0.03).line(0.15, 0.035)
                              .smooth(curve({0.15, 0.035}, {0.06, 0.06}, {0.07, 0.13}, 5)).line(0.085, 0.135).line(0.085, 0.15).line(0.07, 0.155)
                              .smooth(curve({0.07, 0.155}, {0.28, 0.20}, {0.25, 0.48}, 8)).line(0.275, 0.50)
                              .smooth(arc({0.275, 0.535}, 0.035, 0.035, -90, 90, 6)).line(0.24, 0.57)
                              .smooth(curve({0.24, 0.57}, {0.21, 0.30}, {0.10, 0.22}, 5)).line(0, 0.22).done();
  lathe(mesh, at, outline, segments, 2, 0.5);
}

void vase(ObjMesh& mesh, const Placement& at, int segments) {
  const Points belly = curve({0.085, 0.0}, {0.22, 0.10}, {0.19, 0.27}, 8) + curve({0.19, 0.27}, {0.165, 0.40}, {0.075, 0.44}, 7) +
                       curve({0.075, 0.44}, {0.045, 0.49}, {0.11, 0.55}, 5);
  const Points inside = curve({0.10, 0.555}, {0.04, 0.49}, {0.06, 0.44}, 4);
  // v runs once up the picture along the outside, about 0.75 long.
  lathe(mesh, at, Outline(0, -0.005).line(0.08, -0.005).line(0.085, 0).smooth(belly).line(0.10, 0.555).smooth(inside).line(0, 0.40).done(), segments, 1, 0.80);
}

void flower_pot(ObjMesh& mesh, const Placement& at, int segments) {
  const Profile outline = Outline(0, -0.005).line(0.13, -0.005).line(0.175, 0.27).line(0.195, 0.27).line(0.205, 0.34).line(0.18, 0.34)
                              .line(0.17, 0.29).line(0, 0.30).done();
  lathe(mesh, at, outline, segments, 2, 0.5);
}

void lantern_iron(ObjMesh& mesh, const Placement& at, double chain) {
  lathe(mesh, at, Outline(0, -0.10).line(0.15, -0.10).line(0.15, -0.085).smooth(curve({0.15, -0.085}, {0.06, -0.06}, {0.012, 0}, 5)).line(0.012, chain).line(0, chain).done(), 12);
  lathe(mesh, at, Outline(0, -0.40).line(0.11, -0.40).line(0.12, -0.375).line(0, -0.375).done(), 12);
  for (int k = 0; k < 6; ++k) {
    double s, c;
    sin_cos(kPi * k / 3, &s, &c);
    Placement p = placed(at.point({0.125 * c, -0.24, -0.125 * s}), k * 60.0);
    const Point x = normalize3(p.x - 0.12 * p.y, p.x), y = normalize3(p.y + 0.12 * p.x, p.y);
    p.x = x, p.y = y;
    box(mesh, p, {0.012, 0.31, 0.012}, 0.002);
  }
}

void lantern_glass(ObjMesh& mesh, const Placement& at) {
  lathe(mesh, at, Outline(0, -0.378).line(0.10, -0.378).line(0.135, -0.102).line(0, -0.102).done(), 18);
}

}  // namespace spanray::assets
