// Molecules of exact spheres, sixty atoms of them a cage, on a floor before a mirroring one.
#include <vector>

#include "scenes.h"
#include "shapes.h"

namespace spanray::assets {
namespace {

const char* const kMtl = R"(newmtl floor
illum 1
Kd 0.62 0.60 0.56
newmtl wall
illum 1
Kd 0.46 0.52 0.60
newmtl carbon
illum 2
Kd 0.10 0.10 0.11
Ks 0.35 0.35 0.35
Ns 60
newmtl oxygen
illum 2
Kd 0.72 0.05 0.04
Ks 0.40 0.40 0.40
Ns 90
newmtl hydrogen
illum 2
Kd 0.82 0.82 0.82
Ks 0.25 0.25 0.25
Ns 60
newmtl lanthanum
illum 2
Kd 0.80 0.45 0.05
Ks 0.45 0.40 0.25
Ns 120
newmtl chrome
illum 3
Kd 0.02 0.02 0.02
Ks 0.75 0.76 0.78
Ns 800
)";

const char* const kToml =
    R"(# Spheres beside a mesh: a metal atom in a cage of sixty carbon atoms, water around it, a mirroring ball. The mesh has
# the floor, the wall and the materials.
obj = "molecule.obj"
background = [0.20, 0.22, 0.26]
ambient = [0.16, 0.16, 0.18]

[[camera]]
name = "cage"
eye = [0.9, 1.7, 4.2]
target = [0.1, 0.8, 0.0]
fov_y = 40.0

[[camera]]
name = "within"
eye = [0.0, 0.95, 0.55]
target = [0.6, 1.2, -1.0]
fov_y = 75.0
near = 0.02

[[light]]
kind = "point"
position = [-2.2, 3.4, 2.6]
intensity = [42.0, 40.0, 36.0]

[[light]]
kind = "directional"
direction = [-0.6, -0.8, -0.5]
intensity = [1.1, 1.2, 1.4]

[technique]
shadows = "ray"
reflections = "ray"
max_bounces = 3
)";

std::string atom(const Point& at, double radius, const char* material) {
  std::string text = "\n[[sphere]]\ncenter = [";
  for (int k = 0; k < 3; ++k) {
    std::string number = fixed_text(at[k], 6);
    if (number.find('.') == std::string::npos) number += ".0";
    text += (k > 0 ? ", " : "") + number;
  }
  return text + "]\nradius = " + fixed_text(radius, 6) + "\nmaterial = \"" + material + "\"\n";
}

// The corners of a truncated icosahedron of edge 2: all signs and even permutations of three triples.
std::vector<Point> cage() {
  const double golden = 1.6180339887498949;
  const Point triples[] = {{0, 1, 3 * golden}, {1, 2 + golden, 2 * golden}, {2, 1 + 2 * golden, golden}};
  std::vector<Point> corners;
  for (const Point& t : triples)
    for (int turn = 0; turn < 3; ++turn)
      for (int signs = 0; signs < 8; ++signs) {
        Point p(t[turn], t[(turn + 1) % 3], t[(turn + 2) % 3]);
        bool twice = false;
        for (int k = 0; k < 3; ++k) {
          if ((signs >> k & 1) == 0) continue;
          twice |= p[k] == 0, p[k] = -p[k];
        }
        if (!twice) corners.push_back(p);
      }
  return corners;
}

std::string water(const Point& oxygen, const Point& along, const Point& up) {
  constexpr double kHalfCosine = 0.612372, kHalfSine = 0.790569;  // of half the angle of 104.5 degrees
  std::string text = atom(oxygen, 0.2, "oxygen");
  for (const double side : {-1.0, 1.0})
    text += atom(oxygen + (up * kHalfCosine + along * (side * kHalfSine)) * 0.19, 0.14, "hydrogen");
  return text;
}

}  // namespace

SceneFiles make_molecule() {
  SceneFiles scene{ObjMesh("molecule.mtl"), kMtl, kToml};
  scene.mesh.object("floor", "floor");
  rectangle(scene.mesh, {-4, 0, 5}, {8, 0, 0}, {0, 0, -7}, 40, 35);
  scene.mesh.object("back", "wall");
  rectangle(scene.mesh, {-4, 0, -2}, {8, 0, 0}, {0, 4, 0}, 8, 4);
  const Point middle(0, 0.9135, 0);
  for (const Point& p : cage()) scene.toml += atom(middle + p * (0.8 / 4.956), 0.13, "carbon");
  scene.toml += atom(middle, 0.36, "lanthanum");
  scene.toml += atom({1.45, 0.5, -0.75}, 0.5, "chrome");
  scene.toml += water({-1.3, 0.2, 0.7}, {0.6, 0, 0.8}, {0, 1, 0});
  scene.toml += water({-1.55, 0.2, -0.5}, {1, 0, 0}, {0, 0.6, 0.8});
  scene.toml += water({0.75, 0.2, 1.35}, {0.8, 0, -0.6}, {0, 1, 0});
  scene.toml += water({1.7, 1.65, -0.3}, {0.8, 0, 0.6}, {0, -1, 0});
  return scene;
}

}  // namespace spanray::assets
