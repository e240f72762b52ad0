// Discs and panes of colored glass, one before the other and one through the other, in a small gallery with a mirror.
#include "architecture.h"
#include "math/elementary.h"
#include "scenes.h"

namespace spanray::assets {
namespace {

const char* const kMtl = R"(# Glass by alpha: its own color where it is dense, what stands behind where it is not.
newmtl glass_red
illum 2
Kd 0.80 0.05 0.04
Ks 0.30 0.30 0.30
Ns 200
d 0.45
newmtl glass_yellow
illum 2
Kd 0.85 0.60 0.04
Ks 0.30 0.30 0.30
Ns 200
d 0.42
newmtl glass_blue
illum 2
Kd 0.04 0.16 0.70
Ks 0.30 0.30 0.30
Ns 200
d 0.48
newmtl glass_cyan
illum 2
Kd 0.03 0.50 0.60
Ks 0.25 0.25 0.25
Ns 200
d 0.50
newmtl glass_violet
illum 2
Kd 0.45 0.08 0.55
Ks 0.25 0.25 0.25
Ns 200
d 0.50
newmtl glass_amber
illum 2
Kd 0.80 0.32 0.03
Ks 0.25 0.25 0.25
Ns 200
d 0.55
newmtl glass_green
illum 2
Kd 0.06 0.45 0.14
Ks 0.25 0.25 0.25
Ns 200
d 0.35
newmtl floor
illum 2
Kd 0.85 0.85 0.85
Ks 0.08 0.08 0.08
Ns 60
map_Kd textures/terrazzo.png
newmtl wall
illum 1
Kd 0.66 0.64 0.60
newmtl plinth
illum 1
Kd 0.80 0.79 0.76
newmtl plaster
illum 2
Kd 0.78 0.76 0.72
Ks 0.04 0.04 0.04
Ns 12
newmtl marble
illum 2
Kd 1 1 1
Ks 0.20 0.20 0.20
Ns 100
map_Kd textures/marble_white.png
newmtl ceramic
illum 2
Kd 1 1 1
Ks 0.18 0.18 0.18
Ns 160
map_Kd textures/ceramic.png
newmtl brass
illum 2
Kd 0.40 0.28 0.10
Ks 0.50 0.40 0.22
Ns 120
newmtl oak
illum 1
Kd 0.50 0.42 0.36
map_Kd textures/plank.png
newmtl mirror
illum 3
Kd 0.01 0.01 0.01
Ks 0.88 0.89 0.90
Ns 1000
)";

const char* const kToml = R"(# Order matters: panes that stand one behind the other, and two that cross, where no order of whole panes is right.
obj = "glass.obj"
background = [0.10, 0.11, 0.13]
ambient = [0.20, 0.20, 0.21]

[[camera]]
name = "gallery"
eye = [-0.55, 1.45, 3.9]
target = [0.05, 0.92, -0.6]
fov_y = 42.0

[[camera]]
name = "crossing"
eye = [2.05, 1.20, 1.95]
target = [0.95, 0.75, -0.25]
fov_y = 46.0

[[camera]]
name = "behind"
eye = [-0.6, 1.6, -2.3]
target = [0.5, 0.8, 0.6]
fov_y = 60.0

[[light]]
kind = "point"
position = [-2.0, 2.9, 2.4]
intensity = [24.0, 21.0, 16.5]
attenuation = [0.5, 0.0, 1.0]

[[light]]
kind = "point"
position = [1.7, 2.8, 1.6]
intensity = [6.0, 7.5, 10.0]
attenuation = [0.5, 0.0, 1.0]

[technique]
shadows = "ray"
reflections = "ray"
max_bounces = 2
transparency = "alpha"
)";

void gallery(ObjMesh& mesh) {
  const double left = -3.2, right = 3.2, back = -2.4, front = 4.6, high = 3.2;
  mesh.object("floor", "floor");
  rectangle(mesh, {left, 0, front}, {right - left, 0, 0}, {0, 0, back - front}, 16, 18, 0.9);
  mesh.object("walls", "wall");
  rectangle(mesh, {left, 0, back}, {right - left, 0, 0}, {0, high, 0}, 16, 8);
  rectangle(mesh, {left, 0, front}, {0, 0, back - front}, {0, high, 0}, 18, 8);
  rectangle(mesh, {right, 0, back}, {0, 0, front - back}, {0, high, 0}, 18, 8);
  rectangle(mesh, {right, 0, front}, {left - right, 0, 0}, {0, high, 0}, 16, 8);
  mesh.object("ceiling", "plinth");
  rectangle(mesh, {left, high, back}, {right - left, 0, 0}, {0, 0, front - back}, 16, 18);
  mesh.object("skirting", "plinth");
  box(mesh, placed({0, 0.05, back}), {right - left + 0.02, 0.14, 0.04}, 0.006, 0);
  box(mesh, placed({left, 0.05, (front + back) / 2}), {0.04, 0.14, front - back}, 0.006, 0);
  box(mesh, placed({right, 0.05, (front + back) / 2}), {0.04, 0.14, front - back}, 0.006, 0);
}

// Leaning against the back wall.
void mirror(ObjMesh& mesh) {
  const double width = 1.5, height = 1.9, lean = 4;
  double s, c;
  sin_cos(lean * kPi / 180, &s, &c);
  Placement at = placed({1.75, 0.07 + height / 2, -2.16}, -24);
  const Point y = c * at.y - s * at.z, z = c * at.z + s * at.y;
  at.y = y, at.z = z;
  mesh.object("mirror_glass", "mirror");
  rectangle(mesh, at.point({-width / 2 - 0.01, -height / 2 - 0.01, 0}), (width + 0.02) * at.x, (height + 0.02) * at.y, 5, 6);
  mesh.object("mirror_frame", "oak");
  picture_frame(mesh, at, width, height, 0.07, 0.07, 0.6);
}

void disc(ObjMesh& mesh, const char* material, const Point& center, double radius, double turn) {
  const Placement at = placed(center, turn);
  mesh.object("disc", material);
  const int segments = 48;
  patch(mesh, segments, 4, [&](double s, double t) {  // t: from the rim to the center
    double sn, c;
    sin_cos(s < 1 ? 2 * kPi * s : 0, &sn, &c);
    const double r = radius * (1 - t);
    return Corner{at.point({r * c, r * sn, 0}), at.z, {0.5 + 0.5 * c * (1 - t), 0.5 + 0.5 * sn * (1 - t)}};
  });
  mesh.object("disc_stand", "brass");
  Placement ring = at;
  ring.y = at.z, ring.z = -at.y;  // a lathe about the disc's axis
  lathe(mesh, ring, {arc({radius + 0.008, 0}, 0.016, 0.016, -180, 180, 8)}, segments);
  const double post = center.y - radius;
  lathe(mesh, placed({center.x, 0, center.z}), Outline(0, -0.01).line(0.16, -0.01).line(0.16, 0.012).line(0.02, 0.035).line(0.014, 0.05).line(0.014, post).line(0, post).done(), 24);
}

void pane(ObjMesh& mesh, const char* material, const Point& foot, double turn, double width, double height) {
  const Placement at = placed(foot, turn);
  mesh.object("pane", material);
  rectangle(mesh, at.point({-width / 2, 0.02, 0}), width * at.x, height * at.y, 6, 8);
  mesh.object("pane_edge", "brass");
  Placement middle = at;
  middle.origin = at.point({0, 0.02 + height / 2, 0});
  picture_frame(mesh, middle, width - 0.004, height - 0.004, 0.011, 0.012);
  mesh.object("pane_foot", "brass");
  for (int side = -1; side <= 1; side += 2) {
    Placement block = at;
    block.origin = at.point({side * (width / 2 - 0.12), 0.02, 0});
    box(mesh, block, {0.10, 0.06, 0.07}, 0.006);
  }
}

void sculptures(ObjMesh& mesh) {
  mesh.object("plinth", "plinth");
  box(mesh, placed({-0.75, 0.34, -1.45}, 10), {0.55, 0.70, 0.55}, 0.01);
  box(mesh, placed({0.25, 0.21, -1.55}, -14), {0.50, 0.44, 0.50}, 0.01);
  box(mesh, placed({-1.75, 0.44, -1.55}, 22), {0.50, 0.90, 0.50}, 0.01);
  mesh.object("ball", "marble");
  sphere(mesh, {-0.75, 0.955, -1.45}, 0.27, 40, {2, 1});
  mesh.object("vase", "ceramic");
  vase(mesh, placed({0.25, 0.434, -1.55}), 36);
  mesh.object("urn", "plaster");
  urn(mesh, placed({-1.75, 0.892, -1.55}), 32);
  mesh.object("cone", "plaster");
  lathe(mesh, placed({0.98, 0, -1.25}), Outline(0, -0.01).line(0.30, -0.01).line(0.004, 0.78).line(0, 0.782).done(), 48);
}

}  // namespace

SceneFiles make_glass() {
  ObjMesh mesh("glass.mtl");
  gallery(mesh);
  mirror(mesh);
  sculptures(mesh);
  disc(mesh, "glass_red", {-1.02, 1.22, -0.28}, 0.46, 8);
  disc(mesh, "glass_yellow", {-0.62, 0.92, 0.10}, 0.42, -6);
  disc(mesh, "glass_blue", {-0.30, 1.28, -0.55}, 0.48, 3);
  pane(mesh, "glass_cyan", {0.88, 0, -0.10}, 42, 1.20, 1.55);
  pane(mesh, "glass_violet", {0.88, 0, -0.10}, -38, 1.20, 1.30);
  pane(mesh, "glass_amber", {0.06, 0, 0.75}, 8, 0.55, 0.70);
  pane(mesh, "glass_green", {-1.62, 0, 0.20}, 28, 0.75, 1.30);
  return {mesh, kMtl, kToml};
}

}  // namespace spanray::assets
