// Colonnades, walls, ends, floor and garden of the hall.
#include <cmath>

#include "hall.h"
#include "math/elementary.h"

namespace spanray::assets::hall {
namespace {

// Its own column, 3.41 high: a base with two rolls, a shaft that swells a little, a bell of a capital with a gilded ring.
void column(ObjMesh& mesh, const Detail& d, const Placement& at, const std::string& name, const char* marble) {
  const int around = d.count(22, 6);
  mesh.object(name + "_base", "stone");
  Placement plinth = at, abacus = at;
  plinth.origin = at.point({0, 0.06, 0}), abacus.origin = at.point({0, 3.33, 0});
  box(mesh, plinth, {0.82, 0.16, 0.82}, d.chamfer(0.012), d.cell(1), kStone);
  box(mesh, abacus, {0.86, 0.16, 0.86}, d.chamfer(0.012), d.cell(1), kStone);
  const int roll = d.count(5, 2);
  if (!d.keep(0.15)) {  // from far away: two cones
    lathe(mesh, at, Outline(0, 0.12).line(0.38, 0.12).line(0.30, 0.39).line(0, 0.39).done(), around, 1, kStone);
    lathe(mesh, at, Outline(0, 2.86).line(0.25, 2.86).line(0.40, 3.26).line(0, 3.26).done(), around, 1, kStone);
    mesh.object(name + "_shaft", marble);
    return lathe(mesh, at, Outline(0, 0.37).line(0.29, 0.37).line(0.25, 2.89).line(0, 2.89).done(), around, 1, 2.0);
  }
  const Profile base = Outline(0, 0.12).line(0.33, 0.12).smooth(arc({0.33, 0.18}, 0.060, 0.060, -90, 90, roll)).line(0.325, 0.245)
                           .smooth(arc({0.345, 0.285}, 0.045, 0.040, -110, -230, d.count(3, 2))).line(0.318, 0.325)
                           .smooth(arc({0.318, 0.355}, 0.036, 0.030, -90, 90, d.count(4, 2))).line(0.30, 0.39).line(0, 0.39).done();
  lathe(mesh, at, refined(base, d.cell(0.5)), around, 1, kStone);
  const Profile capital = Outline(0, 2.90).line(0.255, 2.90).smooth({{0.250, 2.95}, {0.250, 3.00}}).line(0.270, 3.00).line(0.270, 3.03)
                              .smooth(arc({0.27, 3.20}, 0.115, 0.17, -90, -8, d.count(5, 2))).line(0.40, 3.26).line(0, 3.26).done();
  lathe(mesh, at, refined(capital, d.cell(0.5)), around, 1, kStone);
  if (d.keep(0.30)) {
    mesh.object(name + "_ring", "gilt");
    lathe(mesh, at, {arc({0.258, 2.885}, 0.030, 0.030, -180, 180, d.count(6, 4))}, around);
  }
  mesh.object(name + "_shaft", marble);
  std::vector<glm::dvec2> side = {{0.30, 0.385}, {0.288, 0.42}};
  const int rows = d.count(5, 2);
  for (int k = 1; k <= rows; ++k) {
    const double t = static_cast<double>(k) / rows;
    side.push_back({0.288 - 0.042 * t * t, 0.42 + 2.47 * t});
  }
  lathe(mesh, at, refined(Outline(0, 0.37).line(0.30, 0.37).smooth(side).line(0, 2.89).done(), d.cell(0.6)), d.count(24, 6), 1, 2.0);
}

void arcade_side(ObjMesh& mesh, const Detail& d, double side) {
  const std::string where = side < 0 ? "left_" : "right_";
  const Placement toward_nave = placed({0, 0, 0}, side < 0 ? 90 : -90);
  for (int bay = 0; bay < kBays; ++bay) {
    Placement at = toward_nave;
    at.origin = {side * kColumnX, 0, bay_center(bay)};
    ArchWall wall{kBay, kArchRadius, kSpring, kSpring, kArcadeTop, kArcadeDepth, kStone, d.count(18, 6), d.count(2), d.count(1), d.count(1), stone_shift(bay)};
    mesh.object("arcade_" + where + std::to_string(bay), "ashlar");
    arch_wall(mesh, at, wall);
    if (!d.keep(0.20)) continue;
    mesh.object("archivolt_" + where + std::to_string(bay), "stone");
    archivolt(mesh, at, wall, 0.26, 0.06, d.count(18, 8));
  }
  for (int k = 1; k < kBays; ++k) column(mesh, d, placed({side * kColumnX, 0, axis_z(k)}), "column_" + where + std::to_string(k), "marble_rose");
  // Half piers where the colonnade meets the end walls.
  mesh.object("respond_" + where, "ashlar");
  for (const double z : {-0.19, -kLength + 0.19}) {
    box(mesh, placed({side * kColumnX, 1.66, z}), {0.66, 3.36, 0.42}, d.chamfer(0.015), d.cell(1), kStone);
    box(mesh, placed({side * kColumnX, 3.33, z}), {0.86, 0.16, 0.50}, d.chamfer(0.012), d.cell(1), kStone);
    box(mesh, placed({side * kColumnX, 0.10, z}), {0.80, 0.24, 0.50}, d.chamfer(0.012), d.cell(1), kStone);
  }
  // The cornice, along the nave, hides the foot of the vault.
  mesh.object("cornice_" + where, "stone");
  const Profile section = Outline(-0.20, 0.40).line(-0.20, -0.05).line(0.10, -0.05).line(0.10, 0.04).smooth(arc({0.22, 0.04}, 0.12, 0.12, 180, 90, d.count(4, 2)))
                              .line(0.22, 0.20).line(0.30, 0.20).line(0.30, 0.32).smooth(arc({0.30, 0.40}, 0.08, 0.08, -90, 0, d.count(3, 2))).line(-0.20, 0.40).done();
  Placement along{{side * (kColumnX - kArcadeDepth / 2), kArcadeTop, 0}, {-side, 0, 0}, {0, 1, 0}, {0, 0, -side}};
  along.origin.z = side > 0 ? 0.02 : -kLength - 0.02;
  bar(mesh, along, section, kLength + 0.04, d.count(14, 7), kStone);
  const int dentils = d.linear < 0.75 ? 0 : 98;
  if (dentils > 0) mesh.object("dentils_" + where, "stone");
  for (int k = 0; k < dentils; ++k) {
    box(mesh, placed({side * (kColumnX - kArcadeDepth / 2 - 0.13), kArcadeTop + 0.005, -kLength * (k + 0.5) / dentils}), {0.10, 0.09, 0.11}, 0, d.cell(0.5), kStone);
  }
}

// Transverse arches of the aisles, from each column to the outer wall, where a pilaster takes them; and the ceiling.
void aisle_side(ObjMesh& mesh, const Detail& d, double side) {
  const std::string where = side < 0 ? "left_" : "right_";
  const double middle = side * (kColumnX + kWallX) / 2;
  for (int k = 1; k < kBays; ++k) {
    const ArchWall wall{kWallX - kColumnX, 1.04, kSpring, kSpring, kAisleCeiling + 0.04, 0.42, kStone, d.count(14, 6), d.count(2), d.count(1), d.count(1), stone_shift(k)};
    mesh.object("aisle_arch_" + where + std::to_string(k), "ashlar");
    arch_wall(mesh, placed({middle, 0, axis_z(k)}), wall);
    mesh.object("pilaster_" + where + std::to_string(k), "stone");
    box(mesh, placed({side * (kWallX - 0.12), 1.65, axis_z(k)}), {0.44, 3.36, 0.56}, d.chamfer(0.012), d.cell(0.9), kStone);
    if (!d.keep(0.12)) continue;
    box(mesh, placed({side * (kWallX - 0.13), 3.33, axis_z(k)}), {0.58, 0.16, 0.68}, d.chamfer(0.010), d.cell(1), kStone);
    box(mesh, placed({side * (kWallX - 0.12), 0.10, axis_z(k)}), {0.56, 0.24, 0.66}, d.chamfer(0.010), d.cell(1), kStone);
  }
  mesh.object("aisle_ceiling_" + where, "plank");
  box(mesh, placed({middle + side * 0.15, kAisleCeiling + 0.15, -kLength / 2}), {kWallX - kColumnX + 0.5, 0.30, kLength + 0.3}, 0, d.cell(1), 1.6);
  mesh.object("purlins_" + where, "beam");
  for (int k = 0; k < 3; ++k) {
    box(mesh, placed({middle + side * 0.7 * (k - 1), kAisleCeiling - 0.07, -kLength / 2}), {0.14, 0.18, kLength + 0.2}, 0, d.cell(1.5), 1.2);
  }
}

void window_wall(ObjMesh& mesh, const Detail& d) {
  for (int bay = 0; bay < kBays; ++bay) {
    const Placement at = placed({kWallX + 0.3, 0, bay_center(bay)}, -90);
    const ArchWall wall{kBay, 0.80, 1.0, 3.0, kAisleCeiling + 0.2, 0.6, kStone, d.count(16, 8), d.count(2), d.count(1), d.count(1), stone_shift(bay + 3)};
    mesh.object("window_wall_" + std::to_string(bay), "ashlar");
    arch_wall(mesh, at, wall);
    if (!d.keep(0.26)) continue;
    mesh.object("window_ring_" + std::to_string(bay), "stone");
    archivolt(mesh, at, wall, 0.16, 0.05, d.count(16, 8));
  }
  mesh.object("window_parapet", "ashlar");
  box(mesh, placed({kWallX + 0.3, 0.49, -kLength / 2}), {0.64, 0.98, kLength + 0.4}, d.chamfer(0.01), d.cell(1), kStone);
  mesh.object("window_sill", "stone");
  box(mesh, placed({kWallX + 0.27, 1.0, -kLength / 2}), {0.80, 0.09, kLength + 0.4}, d.chamfer(0.012), d.cell(1), kStone);
}

void relief(ObjMesh& mesh, const Detail& d, int bay) {
  const double high = 1.7, y = 2.35;
  const char* const kReliefs[2] = {"relief_sun", "relief_vine"};
  mesh.object("relief_" + std::to_string(bay), kReliefs[(bay / 2) & 1]);
  const Placement at = placed({-kWallX + 0.05, y, bay_center(bay)}, 90);
  const int n = d.count(2);
  rectangle(mesh, at.point({-high / 2 - 0.01, -high / 2 - 0.01, 0}), (high + 0.02) * at.x, (high + 0.02) * at.y, n, n, high + 0.02);
  mesh.object("relief_frame_" + std::to_string(bay), "stone");
  picture_frame(mesh, at, high, high, 0.14, 0.20, kStone);
}

void brick_wall(ObjMesh& mesh, const Detail& d) {
  for (int bay = 0; bay < kBays; ++bay) {
    const Placement at = placed({-kWallX - 0.3, 0, bay_center(bay)}, 90);
    const double top = kAisleCeiling + 0.2;
    if (bay % 2 == 1) {
      const ArchWall wall{kBay, 0.72, 0.9, 2.75, top, 0.6, 2.0, d.count(14, 8), d.count(2), d.count(1), d.count(1), {0.25 * (bay * 3 % 8), 0}};
      mesh.object("niche_wall_" + std::to_string(bay), "brick");
      arch_wall(mesh, at, wall);
      if (d.keep(0.22)) {
        mesh.object("niche_arch_" + std::to_string(bay), "stone");
        archivolt(mesh, at, wall, 0.18, 0.06, d.count(14, 8));
      }
      mesh.object("niche_" + std::to_string(bay), "niche");
      hollow(mesh, at, 0.80, 0.85, 2.75, d.count(14, 8), d.count(3, 2), kStone);
    } else {
      mesh.object("brick_wall_" + std::to_string(bay), "brick");
      const int columns = d.count(3), rows = d.count(4, 2);
      rectangle(mesh, at.point({-kBay / 2, 0, 0.3}), kBay * at.x, top * at.y, columns, rows, 2.0, {0.25 * (bay * 3 % 8), 0});
      relief(mesh, d, bay);
    }
  }
  mesh.object("brick_parapet", "ashlar");
  box(mesh, placed({-kWallX - 0.42, 0.43, -kLength / 2}), {0.92, 0.98, kLength + 0.4}, d.chamfer(0.01), d.cell(1), kStone);
  mesh.object("brick_sill", "stone");
  box(mesh, placed({-kWallX - 0.38, 0.92, -kLength / 2}), {0.98, 0.09, kLength + 0.4}, d.chamfer(0.012), d.cell(1), kStone);
}

}  // namespace

void add_arcades(ObjMesh& mesh, const Detail& d) {
  for (const double side : {-1.0, 1.0}) arcade_side(mesh, d, side), aisle_side(mesh, d, side);
}

void add_walls(ObjMesh& mesh, const Detail& d) {
  window_wall(mesh, d);
  brick_wall(mesh, d);
}

void hollow(ObjMesh& mesh, const Placement& at, double radius, double bottom, double spring, int segments, int rows, double texture_size) {
  patch(mesh, segments, rows, [&](double s, double t) {
    double sn, c;
    sin_cos(kPi * (1 - s), &sn, &c);  // from -x over -z to +x, seen from within
    const double y = bottom + (spring - bottom) * t;
    return Corner{at.point({radius * c, y, -radius * sn}), at.direction({-c, 0, sn}), glm::dvec2{kPi * radius * s, y} / texture_size};
  });
  patch(mesh, segments, segments / 2, [&](double s, double t) {
    double sn, c, up, out;
    sin_cos(kPi * (1 - s), &sn, &c);
    sin_cos(0.5 * kPi * t, &up, &out);
    if (t == 1) out = 0;
    const Point n{-out * c, -up, out * sn};
    return Corner{at.point({radius * out * c, spring + radius * up, -radius * out * sn}), at.direction(n),
                  glm::dvec2{kPi * radius * s, spring + 0.5 * kPi * radius * t} / texture_size};
  });
}

// The entrance: three open arches; the far end: the apse, and above it a round window.
void add_ends(ObjMesh& mesh, const Detail& d) {
  const double top = kVaultSpring + kVaultRadius + 0.6;
  const auto wall_of = [&](double width, double radius, double spring, double high) {
    return ArchWall{width, radius, -0.02, spring, high, 0.6, kStone, d.count(22, 8), d.count(3), d.count(1), d.count(1), {0.5, 0}};
  };
  const auto end = [&](const std::string& name, const Placement& at, const ArchWall& wall, double ring) {
    mesh.object(name, "ashlar");
    arch_wall(mesh, at, wall);
    if (!d.keep(0.18)) return;
    mesh.object(name + "_ring", "stone");
    archivolt(mesh, at, wall, ring, 0.07, d.count(22, 8));
  };
  end("entrance", placed({0, 0, 0.3}, 180), wall_of(6.4, 1.7, 2.9, top), 0.30);
  for (const double side : {-1.0, 1.0}) {
    end(side < 0 ? "entrance_left" : "entrance_right", placed({side * 4.6, 0, 0.3}, 180), wall_of(3.0, 0.80, 2.6, kAisleCeiling + 0.3), 0.20);
  }
  end("apse_arch", placed({0, 0, -kLength - 0.3}), wall_of(6.4, 1.95, 3.1, top), 0.32);
  mesh.object("apse", "apse");
  hollow(mesh, placed({0, 0, -kLength - 0.42}), 2.2, -0.02, 3.1, d.count(28, 10), d.count(5, 2), kStone);
  const Placement eye{{0, 6.75, -kLength}, {1, 0, 0}, {0, 0, 1}, {0, -1, 0}};  // turned about z
  mesh.object("oculus_ring", "stone");
  const Profile ring = Outline(0.62, -0.05).line(0.90, -0.05).line(0.90, 0.05).smooth(arc({0.84, 0.05}, 0.06, 0.06, 0, 90, d.count(3, 2))).line(0.72, 0.11)
                           .smooth({{0.66, 0.08}, {0.62, 0.02}}).line(0.62, -0.05).done();
  lathe(mesh, eye, refined(ring, d.cell(0.3)), d.count(28, 12), 1, kStone);
  mesh.object("oculus_glass", "sky_glass");
  lathe(mesh, eye, refined(Outline(0, -0.04).line(0.64, -0.04).line(0.64, 0.004).line(0, 0.004).done(), d.cell(0.4)), d.count(28, 12));
  mesh.object("oculus_bars", "iron");
  for (int k = 0; k < 4; ++k) {
    double s, c;
    sin_cos(kPi * k / 4, &s, &c);
    box(mesh, {{0, 6.75, -kLength + 0.02}, {c, s, 0}, {-s, c, 0}, {0, 0, 1}}, {1.27, 0.028, 0.028}, 0, d.cell(0.5));
  }
  for (const double side : {-1.0, 1.0}) {
    mesh.object("far_wall", "ashlar");
    box(mesh, placed({side * 4.6, 2.5, -kLength - 0.31}), {3.0, 5.4, 0.6}, 0, d.cell(1), kStone);
  }
}

void add_floor(ObjMesh& mesh, const Detail& d) {
  mesh.object("floor", "floor");
  // A repeat of the pattern is a bay; its middle lies on the axis of the nave.
  rectangle(mesh, {-kWallX - 0.1, 0, 0.6}, {2 * kWallX + 0.2, 0, 0}, {0, 0, -kLength - 3.4}, d.count(8), d.count(16), kBay, {0.5 - (kWallX + 0.1) / kBay, -0.6 / kBay});
  mesh.object("floor_edge", "stone");
  box(mesh, placed({0, -0.17, -kLength / 2 - 0.4}), {2 * kWallX + 1.4, 0.30, kLength + 5.0}, d.chamfer(0.02), d.cell(2), kStone);
}

void add_garden(ObjMesh& mesh, const Detail& d) {
  mesh.object("garden", "lawn");
  rectangle(mesh, {-40, -0.30, 40}, {80, 0, 0}, {0, 0, -90}, d.count(8), d.count(8), 2.5);
  mesh.object("hedge", "foliage");
  box(mesh, placed({13.6, 0.9, -10}), {1.2, 2.5, 44}, d.chamfer(0.05), d.cell(2), 1.6);
  box(mesh, placed({0, 0.9, 13}), {30, 2.5, 1.2}, d.chamfer(0.05), d.cell(2), 1.6);
  mesh.object("cypress", "foliage");
  for (int k = 0; k < 9; ++k) {
    const double x = k < 6 ? 15.2 + 0.8 * (k & 1) : -6.0 + 6.0 * (k - 6), z = k < 6 ? 5.0 - 6.2 * k : 15.5;
    lathe(mesh, placed({x, -0.35, z}), refined(Outline(0, 0).line(0.2, 0).line(0.2, 0.5).smooth({{0.62, 0.9}, {0.75, 1.6}, {0.66, 3.0}, {0.40, 4.6}, {0.02, 6.2}, {0, 6.2}}).done(), d.cell(1.5)), d.count(12, 4), 3, 1.6);
  }
}

}  // namespace spanray::assets::hall
