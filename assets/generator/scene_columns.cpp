// A cloister: a colonnade of five arches, the vaulted walk behind it, a basin of still water before it, late sun.
#include "architecture.h"
#include "scenes.h"

namespace spanray::assets {
namespace {

const char* const kMtl = R"(# Stone, brick, marble, wood, iron, water. All colors are in the textures where there is one.
newmtl limestone
illum 2
Kd 1 1 1
Ks 0.03 0.03 0.03
Ns 12
map_Kd textures/limestone.png
map_bump -bm 5 textures/limestone_height.png
newmtl plaster
illum 1
Kd 0.86 0.80 0.72
map_Kd textures/limestone.png
map_bump -bm 1.5 textures/limestone_height.png
newmtl brick
illum 1
Kd 1 1 1
map_Kd textures/brick.png
map_bump -bm 3.5 textures/brick_height.png
newmtl marble_red
illum 2
Kd 1 1 1
Ks 0.28 0.28 0.28
Ns 140
map_Kd textures/marble_red.png
newmtl marble_white
illum 2
Kd 1 1 1
Ks 0.22 0.22 0.22
Ns 110
map_Kd textures/marble_white.png
newmtl slab
illum 2
Kd 1 1 1
Ks 0.06 0.06 0.06
Ns 30
map_Kd textures/slab.png
map_bump -bm 4 textures/slab_height.png
newmtl gravel
illum 1
Kd 0.62 0.58 0.50
map_Kd textures/limestone.png
map_bump -bm 6 textures/limestone_height.png
newmtl plank
illum 1
Kd 0.62 0.55 0.50
map_Kd textures/plank.png
map_bump -bm 3 textures/plank_height.png
newmtl beam
illum 1
Kd 0.40 0.34 0.30
map_Kd textures/plank.png
newmtl clay
illum 1
Kd 0.52 0.25 0.15
map_bump -bm 1 textures/limestone_height.png
newmtl foliage
illum 1
Kd 1 1 1
map_Kd textures/foliage.png
map_bump -bm 5 textures/foliage_height.png
newmtl iron
illum 2
Kd 0.03 0.03 0.035
Ks 0.25 0.25 0.25
Ns 50
newmtl lantern_glass
illum 1
Kd 0.10 0.06 0.03
Ke 1.3 0.85 0.42
newmtl water
illum 3
Kd 0.015 0.035 0.035
Ks 0.55 0.58 0.60
Ns 2000
map_bump -bm 0.8 textures/ripple_height.png
)";

const char* const kToml = R"(# A colonnade in late sun: bump-mapped stone and brick, polished marble, two lanterns, and water that mirrors it all.
obj = "columns.obj"
background = [0.36, 0.55, 0.86]
ambient = [0.105, 0.12, 0.145]

[[camera]]
name = "basin"
eye = [-5.6, 1.25, 8.3]
target = [0.35, 1.35, -0.3]
fov_y = 42.0

[[camera]]
name = "walk"
eye = [5.35, 1.62, -1.75]
target = [-2.2, 1.50, -1.35]
fov_y = 56.0

[[camera]]
name = "court"
eye = [0.0, 1.45, 8.6]
target = [0.0, 1.45, 0.0]
fov_y = 44.0

[[camera]]
name = "capital"
eye = [-0.15, 1.75, 1.75]
target = [-1.1, 2.15, 0.0]
fov_y = 44.0

[[light]]
kind = "directional"
direction = [-0.60, -0.44, -0.66]
intensity = [4.3, 3.6, 2.7]

[[light]]
kind = "point"
position = [0.0, 2.62, -1.62]
intensity = [4.6, 2.9, 1.45]
attenuation = [0.1, 0.0, 1.0]

[[light]]
kind = "point"
position = [-4.8, 2.62, -1.62]
intensity = [4.6, 2.9, 1.45]
attenuation = [0.1, 0.0, 1.0]

[[path]]
time = 0.0
eye = [-6.6, 1.15, 8.4]
target = [0.4, 1.4, 0.0]
[[path]]
time = 4.0
eye = [-1.6, 1.30, 7.4]
target = [0.0, 1.5, 0.0]
[[path]]
time = 8.0
eye = [3.9, 1.55, 4.9]
target = [1.2, 1.7, 0.0]
[[path]]
time = 11.0
eye = [3.0, 1.62, 1.6]
target = [1.6, 1.65, -2.0]
[[path]]
time = 14.0
eye = [2.5, 1.62, -1.1]
target = [-1.5, 1.55, -1.6]
[[path]]
time = 18.0
eye = [-1.4, 1.62, -1.45]
target = [-5.0, 1.55, -1.5]
[[path]]
time = 22.0
eye = [-4.6, 1.62, -1.9]
target = [-1.2, 1.75, 0.0]
[[path]]
time = 26.0
eye = [-2.6, 1.62, -2.2]
target = [1.6, 1.5, 0.6]

[technique]
shadows = "ray"
reflections = "ray"
max_bounces = 2
)";

constexpr double kBay = 2.4, kSpring = 2.65, kRadius = 0.93, kTop = 4.1, kWall = 0.5, kStone = 1.0;
constexpr double kBackZ = -3.0;  // front of the back wall

ArchWall bay_wall() { return {kBay, kRadius, kSpring, kSpring, kTop, kWall, kStone, 24}; }

void columns(ObjMesh& mesh) {
  for (int k = 0; k < 6; ++k) {
    const Placement at = placed({(k - 2.5) * kBay, 0, 0});
    mesh.object("column_" + std::to_string(k) + "_stone", "limestone");
    column_base_and_capital(mesh, at, 0.5);
    static const char* const kShafts[6] = {"brick", "limestone", "marble_red", "marble_white", "limestone", "brick"};
    mesh.object("column_" + std::to_string(k) + "_shaft", kShafts[k]);
    column_shaft(mesh, at, kShafts[k][0] == 'b' ? 1 : 2, kShafts[k][0] == 'b' ? 1.0 : 0.6);
  }
}

void arcade(ObjMesh& mesh) {
  for (int k = 0; k < 5; ++k) {
    const Placement at = placed({(k - 2) * kBay, 0, 0});
    mesh.object("bay_" + std::to_string(k), "plaster");
    arch_wall(mesh, at, bay_wall());
    mesh.object("archivolt_" + std::to_string(k), "limestone");
    archivolt(mesh, at, bay_wall(), 0.24, 0.05);
  }
  mesh.object("cornice", "limestone");
  const Profile section = Outline(-0.30, 0.28).line(-0.30, -0.02).line(0.04, -0.02).line(0.04, 0.05).smooth(arc({0.14, 0.05}, 0.10, 0.12, 180, 90, 5))
                              .line(0.14, 0.20).line(0.20, 0.20).line(0.20, 0.28).line(-0.30, 0.28).done();
  Placement along{{-6.75, kTop, kWall / 2}, {0, 0, 1}, {0, 1, 0}, {-1, 0, 0}};  // profile's a runs toward +z
  along.origin.x = 6.75;
  bar(mesh, along, section, 13.5, 24, kStone);
}

// The walk's back wall with its dado, pilasters, arches across, and the two end walls.
void walls(ObjMesh& mesh) {
  mesh.object("back_wall", "brick");
  box(mesh, placed({0, 2.05, kBackZ - 0.25}), {13.6, 4.16, 0.5}, 0.01, 0.5, 1.0);
  mesh.object("dado", "limestone");
  box(mesh, placed({0, 0.38, kBackZ}), {12.9, 0.80, 0.10}, 0.015, 0.6, kStone);
  box(mesh, placed({0, 0.80, kBackZ}), {12.9, 0.07, 0.16}, 0.02, 0.6, kStone);
  const ArchWall across{2.76, 1.16, kSpring - 0.05, kSpring - 0.05, kTop - 0.05, 0.34, kStone, 24};
  for (int k = 1; k < 5; ++k) {
    const double x = (k - 2.5) * kBay;
    mesh.object("pilaster_" + std::to_string(k), "limestone");
    box(mesh, placed({x, 1.30, kBackZ + 0.06}), {0.40, 2.62, 0.24}, 0.015, 0.5, kStone);
    box(mesh, placed({x, 2.60, kBackZ + 0.08}), {0.50, 0.12, 0.36}, 0.012, 0, kStone);
    mesh.object("arch_across_" + std::to_string(k), "plaster");
    arch_wall(mesh, placed({x, 0, (kBackZ - 0.25) / 2}, 90), across);
  }
  const ArchWall door{3.3, 0.72, 0.0, 2.0, kTop, 0.45, kStone, 24};
  mesh.object("door_wall", "plaster");
  const Placement left = placed({-6.5, 0, -1.45}, 90);
  arch_wall(mesh, left, door);
  mesh.object("door_ring", "limestone");
  archivolt(mesh, left, door, 0.18, 0.05);
  mesh.object("end_wall", "plaster");
  box(mesh, placed({6.5, 2.05, -1.45}), {0.45, 4.12, 3.3}, 0.01, 0.5, kStone);
}

void ceiling(ObjMesh& mesh) {
  mesh.object("ceiling", "plank");
  box(mesh, placed({0, 4.20, -1.55}), {13.46, 0.24, 3.6}, 0.01, 0.6, 1.2);
  mesh.object("purlins", "beam");
  for (int k = 0; k < 3; ++k) box(mesh, placed({0, 4.03, -0.78 - 0.75 * k}), {12.9, 0.15, 0.13}, 0.01, 1.2, 0.8);
}

void ground(ObjMesh& mesh) {
  mesh.object("floor", "slab");
  box(mesh, placed({0, -0.10, -1.22}), {13.2, 0.20, 4.3}, 0.015, 0.6, 1.2);
  mesh.object("steps", "limestone");
  box(mesh, placed({0, -0.24, -0.85}), {13.8, 0.18, 4.3}, 0.02, 0.6, kStone);
  mesh.object("court", "gravel");
  rectangle(mesh, {-22, -0.30, 22}, {44, 0, 0}, {0, 0, -44}, 22, 22, 1.6);
  mesh.object("basin_rim", "limestone");
  const Placement flat{{0, -0.16, 4.1}, {1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
  picture_frame(mesh, flat, 7.2, 2.9, 0.38, 0.34, kStone);
  mesh.object("water", "water");
  rectangle(mesh, {-3.62, -0.075, 5.57}, {7.24, 0, 0}, {0, 0, -2.94}, 12, 5, 2.4);
}

void furniture(ObjMesh& mesh) {
  for (int side = -1; side <= 1; side += 2) {
    const double x = side * 2.4, z = 1.75;
    mesh.object("pedestal", "limestone");
    box(mesh, placed({x, -0.06, z}), {0.52, 0.54, 0.52}, 0.02, 0, kStone);
    box(mesh, placed({x, 0.20, z}), {0.60, 0.06, 0.60}, 0.012, 0, kStone);
    mesh.object("urn", "clay");
    urn(mesh, placed({x, 0.235, z}), 24);
    mesh.object("topiary", "foliage");
    sphere(mesh, {x, 1.02, z}, 0.33, 28, {3, 1.5});
  }
  for (int k = 0; k < 2; ++k) {
    const Placement at = placed({-4.8 * k, 3.08, -1.62});
    mesh.object("lantern", "iron");
    lantern_iron(mesh, at, 1.02);
    mesh.object("lantern_glass", "lantern_glass");
    lantern_glass(mesh, at);
  }
  mesh.object("bench", "marble_white");
  box(mesh, placed({3.6, 0.44, -2.62}), {1.3, 0.08, 0.42}, 0.015, 0, 0.8);
  box(mesh, placed({3.15, 0.19, -2.62}), {0.12, 0.44, 0.34}, 0.01, 0, 0.8);
  box(mesh, placed({4.05, 0.19, -2.62}), {0.12, 0.44, 0.34}, 0.01, 0, 0.8);
}

}  // namespace

SceneFiles make_columns() {
  ObjMesh mesh("columns.mtl");
  ground(mesh);
  columns(mesh);
  arcade(mesh);
  walls(mesh);
  ceiling(mesh);
  furniture(mesh);
  return {mesh, kMtl, kToml};
}

}  // namespace spanray::assets
