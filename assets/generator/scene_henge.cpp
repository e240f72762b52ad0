// A circle of stones by a lake: planes to the horizon, spheres, instances of one stone, and a pavement that lies in the
// ground's plane.
#include "math/elementary.h"
#include "scenes.h"
#include "shapes.h"

namespace spanray::assets {
namespace {

const char* const kMtl = R"(newmtl sand
illum 1
Kd 0.60 0.53 0.40
newmtl water
illum 3
Kd 0.02 0.05 0.06
Ks 0.62 0.66 0.68
Ns 400
newmtl stone
illum 2
Kd 0.42 0.41 0.39
Ks 0.06 0.06 0.06
Ns 20
newmtl pavement
illum 1
Kd 0.26 0.24 0.23
newmtl copper
illum 2
Kd 0.55 0.24 0.12
Ks 0.55 0.40 0.30
Ns 150
newmtl chrome
illum 3
Kd 0.02 0.02 0.02
Ks 0.75 0.76 0.78
Ns 800
)";

const char* const kToml =
    R"(# Two planes meet in a shore; spheres and copies of a stone stand on the ground, a pavement of triangles lies in its plane.
obj = "henge.obj"
background = [0.50, 0.62, 0.80]
ambient = [0.20, 0.22, 0.26]

[[camera]]
name = "beach"
eye = [0.5, 2.3, 8.8]
target = [-0.1, 0.35, 0.0]
fov_y = 38.0

[[camera]]
name = "low"
eye = [-1.3, 0.62, 2.2]
target = [0.9, 0.4, -2.0]
fov_y = 60.0
near = 0.02

[[light]]
kind = "directional"
direction = [0.55, -0.62, -0.40]
intensity = [2.6, 2.4, 2.0]

[[light]]
kind = "point"
position = [0.0, 2.6, 0.0]
intensity = [9.0, 7.5, 5.0]

[technique]
shadows = "ray"
reflections = "ray"
max_bounces = 3

[[plane]]
point = [0.0, 0.0, 0.0]
normal = [0.0, 8.0, -1.0]            # of any length
material = "sand"

[[plane]]
point = [0.0, -0.25, 0.0]
normal = [0.0, 1.0, 0.0]
material = "water"

[[sphere]]
center = [0.0, 0.55, 0.0]
radius = 0.55
material = "chrome"

[[sphere]]
center = [1.35, 0.28, 0.9]
radius = 0.25
material = "copper"

[[sphere]]
center = [-0.8, -0.2, -2.8]
radius = 0.4
material = "copper"

[[template]]
part = "stone"
)";

std::string number(double x) {
  const std::string text = fixed_text(x, 4);
  return text.find('.') == std::string::npos ? text + ".0" : text;
}
std::string list(const Point& p) { return "[" + number(p.x) + ", " + number(p.y) + ", " + number(p.z) + "]"; }

// The stone is 1 wide, high and deep, its foot a little below the origin.
std::string stone_at(const Point& at, double degrees, const Point& size) {
  return "\n[[instance]]\npart = \"stone\"\ntranslate = " + list(at) +
         "\naxis = [0.0, 1.0, 0.0]\ndegrees = " + number(degrees) + "\nscale = " + list(size) + "\n";
}

double ground(double z) { return z / 8; }

}  // namespace

SceneFiles make_henge() {
  SceneFiles scene{ObjMesh("henge.mtl"), kMtl, kToml};
  scene.mesh.object("stone", "stone");
  box(scene.mesh, {{0, 0.45, 0}}, {1, 1, 1}, 0.06, 0.5);
  // Coordinates are multiples of 1/16, which four decimals write exactly: these triangles lie in the plane.
  scene.mesh.object("pavement", "pavement");
  for (int row = 0; row < 10; ++row)
    for (int column = row % 2; column < 4; column += 2) {
      const double x = 0.5 * column - 1, z = 2.0 + 0.5 * row;
      rectangle(scene.mesh, {x, ground(z), z}, {0.5, 0, 0}, {0, -ground(0.5), -0.5}, 1, 1);
    }
  constexpr int kStones = 11;
  for (int i = 0; i < kStones; ++i) {
    const double degrees = 360.0 * i / kStones + 16;
    double sine = 0, cosine = 0;
    sin_cos(degrees * (kPi / 180), &sine, &cosine);
    const Point at(3.1 * sine, ground(3.1 * cosine), 3.1 * cosine);
    scene.toml += stone_at(at, degrees + 5 * (i % 3), {0.8, 1.5 + 0.12 * (i * 7 % 5), 0.42});
    if (i % 4 == 0) scene.toml += stone_at(at + Point(0.1, 1.35 + 0.12 * (i * 7 % 5), 0.05), degrees, {1.5, 0.3, 0.5});
  }
  return scene;
}

}  // namespace spanray::assets
