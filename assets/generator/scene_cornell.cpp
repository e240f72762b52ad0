// A Cornell box of our own: two meters a side, a mirror block, a block, and a lamp under the ceiling.
#include "scenes.h"
#include "shapes.h"

namespace spanray::assets {
namespace {

const char* const kMtl = R"(# White and gray paint, red and green paint, a mirror, a lamp.
newmtl white
illum 1
Kd 0.73 0.71 0.68
newmtl red
illum 1
Kd 0.61 0.06 0.05
newmtl green
illum 1
Kd 0.13 0.43 0.09
newmtl outside
illum 1
Kd 0.35 0.35 0.36
newmtl block
illum 2
Kd 0.70 0.66 0.58
Ks 0.06 0.06 0.06
Ns 40
newmtl mirror
illum 3
Kd 0.02 0.02 0.02
Ks 0.90 0.90 0.92
Ns 800
newmtl lamp
illum 1
Kd 0 0 0
Ke 1.6 1.45 1.2
)";

const char* const kToml = R"(# A closed room of painted walls with one lamp: hard shadows, one mirror, no textures.
obj = "cornell.obj"
background = [0.03, 0.035, 0.045]
ambient = [0.13, 0.12, 0.11]

[[camera]]
name = "front"
eye = [0.0, 1.0, 3.75]
target = [0.0, 1.0, 0.0]
fov_y = 41.0

[[camera]]
name = "corner"
eye = [0.82, 1.55, 0.85]
target = [-0.25, 0.55, -0.4]
fov_y = 62.0

[[camera]]
name = "outside"
eye = [2.6, 2.3, 4.2]
target = [0.0, 0.95, 0.0]
fov_y = 38.0

[[light]]
kind = "point"
position = [0.0, 1.9, 0.0]
intensity = [6.6, 5.9, 4.9]
attenuation = [0.45, 0.0, 1.0]   # softened near the lamp, as a panel of some size would

[technique]
shadows = "ray"
reflections = "ray"
)";

// The shell around the room: outer faces, and the rim that joins them to the inner ones.
void shell(ObjMesh& mesh, int n) {
  const double w = 0.08;  // thickness
  const Point a[4] = {{-1, 0, 1}, {1, 0, 1}, {1, 2, 1}, {-1, 2, 1}};
  const Point b[4] = {{-1 - w, -w, 1}, {1 + w, -w, 1}, {1 + w, 2 + w, 1}, {-1 - w, 2 + w, 1}};
  const Point back{0, 0, -2 - w}, sides[4] = {{0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
  for (int k = 0; k < 4; ++k) {
    const int m = (k + 1) & 3;
    const auto between = [](const Point& p, const Point& q, double s) { return p + s * (q - p); };
    patch(mesh, n, 1, [&](double s, double t) {
      return Corner{between(between(b[k], b[m], s), between(a[k], a[m], s), t), {0, 0, 1}, {s, t}};
    });
    patch(mesh, n, n, [&](double s, double t) { return Corner{between(b[m], b[k], s) + t * back, sides[k], {s, t}}; });
  }
  rectangle(mesh, b[1] + back, b[0] - b[1], b[3] - b[0], n, n);
}

}  // namespace

SceneFiles make_cornell() {
  ObjMesh mesh("cornell.mtl");
  const int n = 14;
  mesh.object("floor", "white");
  rectangle(mesh, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, n, n);
  mesh.object("ceiling", "white");
  rectangle(mesh, {-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, n, n);
  mesh.object("back", "white");
  rectangle(mesh, {-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, n, n);
  mesh.object("left", "red");
  rectangle(mesh, {-1, 0, 1}, {0, 0, -2}, {0, 2, 0}, n, n);
  mesh.object("right", "green");
  rectangle(mesh, {1, 0, -1}, {0, 0, 2}, {0, 2, 0}, n, n);
  mesh.object("shell", "outside");
  shell(mesh, n);
  mesh.object("tall_block", "mirror");
  box(mesh, placed({-0.36, 0.59, -0.36}, 31), {0.58, 1.20, 0.58}, 0.006, 0.15);
  mesh.object("short_block", "block");
  box(mesh, placed({0.37, 0.28, 0.34}, -17), {0.58, 0.58, 0.58}, 0.006, 0.10);
  mesh.object("lamp", "lamp");
  box(mesh, placed({0, 1.995, 0}), {0.52, 0.05, 0.40}, 0.006, 0);
  return {mesh, kMtl, kToml};
}

}  // namespace spanray::assets
