// The coffered barrel vault of the hall: blue panels with gilded rosettes, ribs over the columns.
#include "hall.h"
#include "math/elementary.h"
#include "noise.h"

namespace spanray::assets::hall {
namespace {

constexpr double kRib = 0.56;                     // width of a rib
constexpr double kFirst = 11, kLast = 169;        // degrees, where they begin and end

// A point of the vault `deep` meters behind its face.
Point vault_point(double degrees, double z, double deep) {
  double s, c;
  sin_cos(degrees * kPi / 180, &s, &c);
  const double r = kVaultRadius + deep;
  return {r * c, kVaultSpring + r * s, z};
}

struct Cell { double angle0, angle1, z0, z1; };
Cell inset(const Cell& c, double by) {
  const double degrees = by / kVaultRadius * 180 / kPi;
  return {c.angle0 + degrees, c.angle1 - degrees, c.z0 - by, c.z1 + by};  // z1 < z0
}

// The surface between the outlines of two cells, at two depths: a flat border, a step or a slope.
void ring(ObjMesh& mesh, const Cell& outer, double deep0, const Cell& inner, double deep1, int along, int around) {
  const auto side = [&](double a0, double z0, double a1, double z1, double b0, double y0, double b1, double y1, int n) {
    smooth_patch(mesh, n, 1, [&](double s, double t) {
      const double angle = mix(mix(a0, a1, s), mix(b0, b1, s), t), z = mix(mix(z0, z1, s), mix(y0, y1, s), t);
      return vault_point(angle, z, mix(deep0, deep1, t));
    }, [&](double s, double t) {
      const double angle = mix(mix(a0, a1, s), mix(b0, b1, s), t), z = mix(mix(z0, z1, s), mix(y0, y1, s), t);
      return glm::dvec2{(angle * kPi / 180 * kVaultRadius + mix(deep0, deep1, t)) / kStone, z / kStone};
    });
  };
  const Cell &o = outer, &i = inner;
  side(o.angle0, o.z0, o.angle1, o.z0, i.angle0, i.z0, i.angle1, i.z0, around);
  side(o.angle1, o.z0, o.angle1, o.z1, i.angle1, i.z0, i.angle1, i.z1, along);
  side(o.angle1, o.z1, o.angle0, o.z1, i.angle1, i.z1, i.angle0, i.z1, around);
  side(o.angle0, o.z1, o.angle0, o.z0, i.angle0, i.z1, i.angle0, i.z0, along);
}

void sheet(ObjMesh& mesh, const Cell& c, double deep, int along, int around) {
  smooth_patch(mesh, around, along, [&](double s, double t) { return vault_point(mix(c.angle0, c.angle1, s), mix(c.z0, c.z1, t), deep); },
               [&](double s, double t) { return glm::dvec2{mix(c.angle0, c.angle1, s) * kPi / 180 * kVaultRadius / kStone, mix(c.z0, c.z1, t) / kStone}; });
}

// Eight petals around a knob, flat side against the panel.
void rosette(ObjMesh& mesh, const Detail& d, const Cell& c, double deep) {
  double s, cosine;
  const double angle = 0.5 * (c.angle0 + c.angle1);
  sin_cos(angle * kPi / 180, &s, &cosine);
  const Placement at{vault_point(angle, 0.5 * (c.z0 + c.z1), deep + 0.004), {s, -cosine, 0}, {-cosine, -s, 0}, {0, 0, -1}};
  const int around = 2 * d.count(8, 4), rows = d.count(2, 1);
  const auto point = [&](double a, double t) {
    double sn, cs, petal, unused;
    sin_cos(2 * kPi * a, &sn, &cs);
    sin_cos(2 * kPi * 8 * a, &unused, &petal);
    const double r = 0.17 * t * (1 + 0.12 * t * petal), rise = 0.055 * (1 - t * t) + 0.02 * t * (1 - t) * petal;
    return at.point({r * cs, rise, -r * sn});
  };
  smooth_patch(mesh, around, rows, [&](double a, double t) { return point(a, 1 - t); }, [](double a, double t) { return glm::dvec2{a, t}; }, 1e-3, at.y);
}

}  // namespace

void add_vault(ObjMesh& mesh, const Detail& d) {
  const int along = d.count(1), around = d.count(2);
  const int rows = d.keep(0.34) ? 8 : 5, columns = d.keep(0.24) ? 3 : d.keep(0.14) ? 2 : 1;  // coffers of a bay: around, along
  std::vector<Cell> cells;
  for (int bay = 0; bay < kBays; ++bay) {
    const double z0 = axis_z(bay) - kRib / 2 + 0.02, z1 = axis_z(bay + 1) + kRib / 2 - 0.02;
    for (int i = 0; i < columns; ++i) {
      for (int j = 0; j < rows; ++j) {
        cells.push_back({mix(kFirst, kLast, static_cast<double>(j) / rows), mix(kFirst, kLast, static_cast<double>(j + 1) / rows),
                         mix(z0, z1, static_cast<double>(i) / columns), mix(z0, z1, static_cast<double>(i + 1) / columns)});
      }
    }
  }
  mesh.object("vault_coffers", "plaster");
  for (const Cell& c : cells) {
    const Cell a = inset(c, 0.065), b = inset(a, 0.010), e = inset(b, 0.05), f = inset(e, 0.010);
    ring(mesh, c, 0, a, 0, along, around);
    if (!d.keep(0.10)) {
      ring(mesh, a, 0, f, 0.11, along, around);
      continue;
    }
    ring(mesh, a, 0, b, 0.06, along, around);
    ring(mesh, b, 0.06, e, 0.06, along, around);
    ring(mesh, e, 0.06, f, 0.11, along, around);
  }
  mesh.object("vault_panels", "coffer");
  for (const Cell& c : cells) sheet(mesh, inset(c, 0.131), 0.108, along, around);
  if (d.keep(0.28)) {
    mesh.object("vault_rosettes", "gilt");
    for (const Cell& c : cells) rosette(mesh, d, c, 0.095);
  }
  mesh.object("vault_bands", "plaster");
  const int pieces = d.count(14, 7);
  sheet(mesh, {-4, kFirst, 0.05, -kLength - 0.05}, 0, pieces, 1);
  sheet(mesh, {kLast, 184, 0.05, -kLength - 0.05}, 0, pieces, 1);
  mesh.object("vault_ribs", "stone");
  const double r = kVaultRadius;
  for (int k = 0; k <= kBays; ++k) {
    const double half = kRib / 2;
    const Profile plain = Outline(r + 0.05, -half).line(r + 0.05, half).line(r - 0.09, half).line(r - 0.09, -half).line(r + 0.05, -half).done();
    const Profile molded = refined(Outline(r + 0.05, -half).line(r + 0.05, half).line(r - 0.06, half).line(r - 0.09, half - 0.05).line(r - 0.09, half - 0.12).line(r - 0.06, half - 0.14)
                                .line(r - 0.06, -half + 0.14).line(r - 0.09, -half + 0.12).line(r - 0.09, -half + 0.05).line(r - 0.06, -half).line(r + 0.05, -half).done(), d.cell(0.5));
    arch(mesh, placed({0, kVaultSpring, axis_z(k)}), d.keep(0.10) ? molded : plain, d.count(24, 6), kStone);
  }
}

}  // namespace spanray::assets::hall
