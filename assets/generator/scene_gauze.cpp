// Curtains of gauze before painted vessels, in the lacy light of an iron gate; a pot of leaves cut out of squares.
#include "architecture.h"
#include "math/elementary.h"
#include "noise.h"
#include "scenes.h"

namespace spanray::assets {
namespace {

const char* const kMtl = R"(# gauze: the scene file makes it a screen-door. ironwork and leaf: masks.
newmtl gauze
illum 1
Kd 1 1 1
d 0.5
map_Kd textures/gauze.png
newmtl ironwork
illum 2
Kd 0.035 0.035 0.04
Ks 0.2 0.2 0.2
Ns 40
map_d textures/ironwork.png
newmtl leaf
illum 2
Kd 1 1 1
Ks 0.06 0.06 0.05
Ns 30
map_Kd textures/leaf.png
map_d textures/leaf_mask.png
newmtl floor
illum 2
Kd 1 1 1
Ks 0.08 0.08 0.08
Ns 50
map_Kd textures/plank.png
map_bump -bm 2 textures/plank_height.png
newmtl wall
illum 1
Kd 0.72 0.70 0.64
map_bump -bm 2 textures/limestone_height.png
newmtl stone
illum 1
Kd 1 1 1
map_Kd textures/limestone.png
map_bump -bm 5 textures/limestone_height.png
newmtl brick
illum 1
Kd 1 1 1
map_Kd textures/brick.png
map_bump -bm 3.5 textures/brick_height.png
newmtl ceramic
illum 2
Kd 1 1 1
Ks 0.18 0.18 0.18
Ns 160
map_Kd textures/ceramic.png
newmtl globe
illum 2
Kd 1 1 1
Ks 0.12 0.12 0.12
Ns 90
map_Kd textures/globe.png
newmtl brass
illum 2
Kd 0.42 0.30 0.12
Ks 0.45 0.36 0.20
Ns 120
newmtl clay
illum 1
Kd 0.58 0.27 0.16
map_bump -bm 1 textures/limestone_height.png
newmtl earth
illum 1
Kd 0.06 0.04 0.03
)";

const char* const kToml = R"(# Transparency without blending: a curtain as a screen-door, iron and leaves as masks; shadows obey both.
obj = "gauze.obj"
background = [0.62, 0.74, 0.92]
ambient = [0.19, 0.20, 0.22]

[[camera]]
name = "room"
eye = [0.95, 1.40, 3.3]
target = [0.12, 1.08, -1.0]
fov_y = 43.0

[[camera]]
name = "fold"
eye = [1.15, 1.25, 0.75]
target = [0.35, 0.85, -1.4]
fov_y = 48.0

[[camera]]
name = "gate"
eye = [2.2, 1.55, 1.9]
target = [-2.2, 1.15, -0.5]
fov_y = 46.0

[[light]]
kind = "directional"
direction = [0.80, -0.42, -0.30]
intensity = [6.4, 5.4, 4.0]

[[light]]
kind = "point"
position = [1.9, 2.7, 2.6]
intensity = [13.0, 13.5, 14.5]
attenuation = [0.5, 0.0, 1.0]

[technique]
shadows = "ray"
reflections = "none"

[material.gauze]
transparency = "screen-door"
[material.ironwork]
transparency = "mask"
[material.leaf]
transparency = "mask"
)";

constexpr double kLeft = -2.4, kBack = -2.8, kRight = 3.0, kFront = 4.2, kHigh = 3.1;

void room(ObjMesh& mesh) {
  mesh.object("floor", "floor");
  rectangle(mesh, {kLeft - 0.4, 0, kFront}, {kRight - kLeft + 0.4, 0, 0}, {0, 0, kBack - kFront}, 20, 24, 0.9);
  mesh.object("back_wall", "wall");
  rectangle(mesh, {kLeft - 0.4, 0, kBack}, {kRight - kLeft + 0.4, 0, 0}, {0, kHigh, 0}, 20, 10);
  mesh.object("right_wall", "wall");
  rectangle(mesh, {kRight, 0, kBack}, {0, 0, kFront - kBack}, {0, kHigh, 0}, 24, 10);
  mesh.object("ceiling", "wall");
  rectangle(mesh, {kLeft - 0.4, kHigh, kBack}, {kRight - kLeft + 0.4, 0, 0}, {0, 0, kFront - kBack}, 10, 12);
  const ArchWall gate{2.4, 0.80, -0.01, 1.70, kHigh + 0.01, 0.34, 1.0, 24};
  const Placement left = placed({kLeft - 0.17, 0, -0.30}, 90);  // its front looks into the room, along +x
  mesh.object("gate_wall", "wall");
  arch_wall(mesh, left, gate);
  rectangle(mesh, {kLeft, 0, -1.50}, {0, 0, kBack + 1.50}, {0, kHigh, 0}, 4, 10);
  rectangle(mesh, {kLeft, 0, kFront}, {0, 0, 0.90 - kFront}, {0, kHigh, 0}, 10, 10);
  mesh.object("gate_ring", "stone");
  archivolt(mesh, left, gate, 0.20, 0.05);
  mesh.object("gate_iron", "ironwork");
  for (int k = 0; k < 2; ++k) {
    const double side = 1.64, low = k * side;
    patch(mesh, 4, 4, [&](double s, double t) {
      return Corner{{kLeft - 0.20, low + side * t, -0.30 + side * (0.5 - s)}, {1, 0, 0}, {s, t}};
    });
  }
}

// A hanging cloth: s across, t down from the rod; returns its point.
using Cloth = Point (*)(double s, double t);

double wave(double turns) {
  double s, c;
  sin_cos(2 * kPi * turns, &s, &c);
  return s;
}

Point hanging(double s, double t) {
  const double drift = 0.10 * wave(s * 1.3 + 0.2) + 0.04 * t * wave(s * 2.1);
  const double deep = 0.030 + 0.035 * t + 0.02 * t * wave(s * 0.9 + 0.4);
  return {-1.25 + 1.85 * (s + 0.010 * wave(s * 8)), 2.30 - 2.22 * t + 0.010 * wave(s * 8 + 0.1) * t, -0.55 + deep * wave(s * 8 + drift) + 0.05 * t * t * wave(s * 0.7)};
}

// Gathered by a cord at two fifths of its height, and falling free below it.
Point gathered(double s, double t) {
  const double knot = 0.58, above = smooth_step(0, knot, t), below = smooth_step(knot, 1, t);
  const double width = t < knot ? mix(1.35, 0.20, above) : mix(0.20, 0.62, below);
  const double middle = t < knot ? mix(1.72, 2.27, above) : mix(2.27, 2.20, below);
  const double deep = t < knot ? mix(0.040, 0.020, above) : mix(0.020, 0.060, below);
  const double sag = 0.10 * (1 - s) * above * (t < knot ? 1 : 1 - below);
  return {middle + width * (s - 0.5), 2.30 - 2.20 * t - sag, -0.55 + deep * wave(s * 6 + 0.15 * wave(s * 1.7)) + 0.02 * t * wave(s * 1.1)};
}

void cloth(ObjMesh& mesh, const std::string& name, Cloth point, int columns, int rows, double repeat_u) {
  mesh.object(name, "gauze");
  const double h = 1e-3;
  patch(mesh, columns, rows, [&](double s, double up) {
    const double t = 1 - up;
    const Point ds = point(s + h, t) - point(s - h, t), dup = point(s, t - h) - point(s, t + h);
    return Corner{point(s, t), normalize3(cross3(ds, dup), Point{0, 0, 1}), {s * repeat_u, up * 3}};
  });
}

void curtains(ObjMesh& mesh) {
  cloth(mesh, "curtain_hanging", hanging, 110, 14, 4);
  cloth(mesh, "curtain_gathered", gathered, 90, 20, 3);
  mesh.object("rod", "brass");
  Placement rod{{2.62, 2.36, -0.55}, {0, 0, 1}, {0, 1, 0}, {-1, 0, 0}};
  bar(mesh, rod, {arc({0, 0}, 0.022, 0.022, 0, 360, 16)}, 4.10, 4);
  sphere(mesh, {2.63, 2.36, -0.55}, 0.045, 20);
  sphere(mesh, {-1.49, 2.36, -0.55}, 0.045, 20);
  mesh.object("cord", "brass");
  const Point waist = gathered(0.5, 0.58);
  Placement tie = placed({waist.x, waist.y - 0.05, -0.55});
  lathe(mesh, tie, {arc({0.11, 0}, 0.018, 0.018, -180, 180, 10)}, 24);
}

// A leaf that bends down: `aim` degrees around, rising by `lift` at the stem.
void leaf(ObjMesh& mesh, const Point& stem, double aim, double lift, double length) {
  const Placement at = placed(stem, aim);
  const double width = 0.62 * length;
  const auto point = [&](double s, double t) {
    const double x = width * (s - 0.5), out = length * t * (1 - 0.25 * t);
    const double rise = lift * length * t - 0.75 * length * t * t + 0.5 * (x * x) / length;
    return at.point({x, rise, out});
  };
  const double h = 1e-3;
  patch(mesh, 4, 5, [&](double s, double t) {
    const Point n = cross3(point(s, t + h) - point(s, t - h), point(s + h, t) - point(s - h, t));
    return Corner{point(1 - s, t), normalize3(n, Point{0, 1, 0}), {1 - s, t}};
  });
}

void plant(ObjMesh& mesh) {
  const Point foot{1.55, 0, 0.35};
  mesh.object("pot", "clay");
  flower_pot(mesh, placed(foot), 32);
  mesh.object("earth", "earth");
  lathe(mesh, placed(foot + Point{0, 0.29, 0}), Outline(0, 0).line(0.17, 0).line(0.17, 0.012).line(0, 0.03).done(), 16);
  mesh.object("stems", "earth");
  box(mesh, placed(foot + Point{0.01, 0.55, 0}), {0.014, 0.60, 0.014}, 0.002);
  mesh.object("leaves", "leaf");
  for (int k = 0; k < 44; ++k) {
    const double height = 0.36 + 0.49 * k / 44;
    const double length = mix(0.40, 0.20, k / 44.0) * (0.85 + 0.3 * random_unit(k, 1, 7));
    leaf(mesh, foot + Point{0, height, 0}, k * 137.5 + 20 * random_unit(k, 2, 7), 0.45 + 0.5 * random_unit(k, 3, 7) + 0.4 * k / 44, length);
  }
}

void still_life(ObjMesh& mesh) {
  mesh.object("plinth_low", "stone");
  box(mesh, placed({-0.55, 0.24, -1.55}, 12), {0.62, 0.50, 0.62}, 0.012, 0, 1);
  mesh.object("plinth_high", "stone");
  box(mesh, placed({0.42, 0.42, -1.80}, -8), {0.56, 0.86, 0.56}, 0.012, 0, 1);
  mesh.object("brick_block", "brick");
  box(mesh, placed({1.35, 0.30, -1.60}, 28), {0.60, 0.62, 0.60}, 0.006, 0, 1);
  mesh.object("vase", "ceramic");
  vase(mesh, placed({0.42, 0.856, -1.80}), 36);
  mesh.object("globe", "globe");
  sphere(mesh, {-0.55, 0.91, -1.55}, 0.34, 44);
  mesh.object("globe_stand", "brass");
  lathe(mesh, placed({-0.55, 0.485, -1.55}), Outline(0, 0).line(0.20, 0).line(0.20, 0.02).smooth(arc({0.20, 0.12}, 0.14, 0.10, 270, 180, 6)).line(0.14, 0.17).line(0, 0.17).done(), 32);
  mesh.object("small_vase", "ceramic");
  vase(mesh, placed({1.30, 0.615, -1.56}, 40), 32);
}

}  // namespace

SceneFiles make_gauze() {
  ObjMesh mesh("gauze.mtl");
  room(mesh);
  still_life(mesh);
  curtains(mesh);
  plant(mesh);
  return {mesh, kMtl, kToml};
}

}  // namespace spanray::assets
