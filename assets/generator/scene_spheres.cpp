// Spheres of many materials on a marble chessboard, a standing mirror behind them, a warm and a cool lamp.
#include "scenes.h"
#include "shapes.h"

namespace spanray::assets {
namespace {

const char* const kMtl = R"(# Marble floor, paper backdrop, and what the spheres are made of.
newmtl chessboard
illum 3
Kd 1 1 1
Ks 0.10 0.10 0.10
Ns 300
map_Kd textures/chessboard.png
newmtl backdrop
illum 1
Kd 0.42 0.40 0.39
newmtl walnut
illum 2
Kd 0.55 0.42 0.34
Ks 0.15 0.15 0.15
Ns 60
map_Kd textures/plank.png
newmtl mirror
illum 3
Kd 0.01 0.01 0.012
Ks 0.88 0.90 0.90
Ns 1000
newmtl warm_panel
illum 1
Kd 0 0 0
Ke 2.2 1.8 1.25
newmtl cool_panel
illum 1
Kd 0 0 0
Ke 0.85 1.2 1.7
newmtl chrome
illum 3
Kd 0.03 0.03 0.03
Ks 0.82 0.83 0.85
Ns 600
newmtl gold
illum 3
Kd 0.16 0.09 0.015
Ks 0.90 0.62 0.24
Ns 300
newmtl red_lacquer
illum 3
Kd 0.55 0.025 0.02
Ks 0.07 0.07 0.07
Ns 500
newmtl blue_glaze
illum 2
Kd 0.03 0.10 0.38
Ks 0.45 0.45 0.45
Ns 180
newmtl clay
illum 1
Kd 0.58 0.27 0.16
newmtl pearl
illum 2
Kd 0.72 0.68 0.64
Ks 0.25 0.25 0.27
Ns 30
newmtl globe
illum 2
Kd 1 1 1
Ks 0.12 0.12 0.12
Ns 80
map_Kd textures/globe.png
newmtl marble
illum 2
Kd 1 1 1
Ks 0.20 0.20 0.20
Ns 120
map_Kd textures/marble_red.png
newmtl stone
illum 1
Kd 1 1 1
map_Kd textures/limestone.png
map_bump -bm 7 textures/limestone_height.png
)";

const char* const kToml = R"(# What a mirror sees, and what it sees in another mirror: two lamps, warm from the left, cool from the right.
obj = "spheres.obj"
background = [0.11, 0.13, 0.17]
ambient = [0.07, 0.075, 0.085]

[[camera]]
name = "table"
eye = [0.35, 1.35, 3.9]
target = [0.02, 0.52, -0.5]
fov_y = 37.0

[[camera]]
name = "low"
eye = [-1.55, 0.34, 2.35]
target = [0.05, 0.42, -0.35]
fov_y = 44.0

[[camera]]
name = "above"
eye = [0.6, 3.9, 2.6]
target = [0.05, 0.2, -0.35]
fov_y = 42.0

[[light]]
kind = "point"
position = [-2.7, 3.3, 2.3]
intensity = [58.0, 46.0, 31.0]

[[light]]
kind = "point"
position = [3.1, 2.3, 1.1]
intensity = [9.0, 13.0, 20.0]

[technique]
shadows = "ray"
reflections = "ray"
max_bounces = 5
)";

// Floor and backdrop: a chessboard that ends in a smooth cove and a wall, as in a photographer's studio.
void studio(ObjMesh& mesh) {
  const double half = 7, front = 6, back = -2.5, radius = 1.2, top = 5;
  mesh.object("floor", "chessboard");
  rectangle(mesh, {-half, 0, front}, {2 * half, 0, 0}, {0, 0, back - front}, 28, 17, 1.0);
  mesh.object("backdrop", "backdrop");
  const auto cove = arc({back, radius}, radius, radius, 270, 180, 12);
  patch(mesh, 28, 12, [&](double s, double t) {
    const glm::dvec2 p = cove[static_cast<size_t>(t * 12 + 0.5)];
    return Corner{{half * (2 * s - 1), p.y, p.x}, {0, (radius - p.y) / radius, (back - p.x) / radius}, {s, t}};
  });
  rectangle(mesh, {-half, radius, back - radius}, {2 * half, 0, 0}, {0, top - radius, 0}, 28, 8);
}

void standing_mirror(ObjMesh& mesh) {
  const double width = 2.5, height = 1.25;
  const Placement at = placed({0.12, height / 2 + 0.11, -1.75}, 7);
  mesh.object("mirror_glass", "mirror");
  rectangle(mesh, at.point({-width / 2 - 0.02, -height / 2 - 0.02, 0}), (width + 0.04) * at.x, (height + 0.04) * at.y, 8, 5);
  mesh.object("mirror_frame", "walnut");
  picture_frame(mesh, at, width, height, 0.12, 0.12, 0.5);
  Placement board = at;
  board.origin = at.point({0, 0, -0.03});
  box(mesh, board, {width + 0.06, height + 0.06, 0.02}, 0.002, 0, 0.5);
}

}  // namespace

SceneFiles make_spheres() {
  ObjMesh mesh("spheres.mtl");
  studio(mesh);
  standing_mirror(mesh);
  // What the lamps look like in a mirror: panels just behind the two points of light.
  mesh.object("warm_lamp", "warm_panel");
  Placement warm = placed({-2.95, 3.6, 2.62}, 130);
  warm.y = normalize3(warm.y + 0.75 * warm.z, warm.y), warm.z = cross3(warm.x, warm.y);
  box(mesh, warm, {1.1, 1.1, 0.05}, 0.01);
  mesh.object("cool_lamp", "cool_panel");
  box(mesh, placed({3.6, 2.35, 1.3}, -70), {0.8, 1.4, 0.05}, 0.01);
  struct Ball { const char* material; double x, z, radius; int segments; glm::dvec2 uv; };
  static const Ball kBalls[] = {{"chrome", -0.92, -0.62, 0.56, 52, {1, 1}},      {"globe", 1.02, -0.72, 0.46, 44, {1, 1}},
                                {"red_lacquer", 0.10, -0.42, 0.37, 44, {1, 1}},  {"clay", 0.74, 0.22, 0.26, 36, {1, 1}},
                                {"gold", -0.30, 0.42, 0.23, 36, {1, 1}},         {"stone", 1.46, 0.12, 0.21, 36, {3, 1.5}},
                                {"blue_glaze", -0.98, 0.48, 0.18, 32, {1, 1}},   {"marble", 0.24, 0.56, 0.16, 32, {2, 1}},
                                {"pearl", -0.58, 0.92, 0.10, 24, {1, 1}},        {"chrome", 0.62, 0.86, 0.11, 28, {1, 1}}};
  for (const Ball& b : kBalls) {
    mesh.object("sphere", b.material);
    sphere(mesh, {b.x, b.radius, b.z}, b.radius, b.segments, b.uv);
  }
  return {mesh, kMtl, kToml};
}

}  // namespace spanray::assets
