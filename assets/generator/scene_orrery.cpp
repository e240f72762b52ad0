// An orrery that runs: planets on brass arms about a sun of glass, their shadows on the walls, all of it again in a table of black lacquer.
#include "math/elementary.h"
#include "scenes.h"
#include "shapes.h"

namespace spanray::assets {
namespace {

const char* const kMtl = R"(# Brass and lacquer mirror; the sun is glass, so that the lamp inside it shines out.
newmtl lacquer
illum 3
Kd 0.012 0.010 0.012
Ks 0.34 0.33 0.32
Ns 400
newmtl brass
illum 3
Kd 0.30 0.19 0.06
Ks 0.42 0.31 0.14
Ns 120
newmtl sun
illum 2
Kd 0.35 0.16 0.03
Ke 1.05 0.62 0.20
Ks 0.20 0.20 0.20
Ns 100
d 0.72
newmtl mercury
illum 2
Kd 0.46 0.36 0.28
Ks 0.10 0.10 0.10
Ns 30
newmtl earth
illum 2
Kd 1 1 1
Ks 0.14 0.14 0.14
Ns 60
map_Kd textures/globe.png
newmtl moon
illum 1
Kd 0.62 0.61 0.58
newmtl saturn
illum 2
Kd 1 1 1
Ks 0.12 0.12 0.12
Ns 50
map_Kd textures/ceramic.png
newmtl ring
illum 2
Kd 0.72 0.62 0.44
Ks 0.15 0.15 0.15
Ns 80
d 0.45
newmtl plaster
illum 1
Kd 0.78 0.72 0.66
map_Kd textures/limestone.png
map_bump -bm 5 textures/limestone_height.png
newmtl floor
illum 2
Kd 1 1 1
Ks 0.06 0.06 0.06
Ns 40
map_Kd textures/plank.png
map_bump -bm 4 textures/plank_height.png
)";

const char* const kToml = R"(# What moves: [[moving]] names objects of the mesh. An arm turns about the column and carries its planet, which turns about itself.
obj = "orrery.obj"
background = [0.015, 0.016, 0.022]
ambient = [0.035, 0.037, 0.045]

[[camera]]
name = "table"
eye = [0.75, 1.42, 2.75]
target = [0.0, 0.42, -0.12]
fov_y = 40.0

[[camera]]
name = "low"
eye = [1.30, 0.70, 1.60]
target = [-0.12, 0.54, -0.25]
fov_y = 48.0

[[camera]]
name = "above"
eye = [0.25, 3.1, 1.6]
target = [0.0, 0.3, -0.1]
fov_y = 44.0

[[light]]
kind = "point"                       # in the sun
position = [0.0, 0.75, 0.0]
intensity = [4.6, 3.7, 2.5]
attenuation = [0.35, 0.0, 1.0]

[[light]]
kind = "directional"                 # a window at night
direction = [-0.55, -1.0, -0.62]
intensity = [0.16, 0.20, 0.30]

[[path]]
time = 0.0
eye = [0.75, 1.42, 2.75]
target = [0.0, 0.42, -0.12]

[[path]]
time = 8.0
eye = [-1.25, 0.95, 1.85]
target = [0.05, 0.5, -0.2]

[[path]]
time = 16.0
eye = [0.25, 2.3, 2.0]
target = [0.0, 0.35, -0.1]

[technique]
shadows = "ray"
reflections = "ray"
max_bounces = 2

)";

constexpr double kHeight = 0.75;  // of the sun and of every planet's center

// A round rod from one point to another.
void rod(ObjMesh& mesh, const Point& from, const Point& to, double radius, int segments = 12) {
  const Point along = to - from;
  const double length = length3(along);
  Placement at;
  at.origin = from;
  at.y = normalize3(along, at.y);
  at.x = at.y.y * at.y.y > 0.5 ? Point{1, 0, 0} : normalize3(cross3(at.y, Point{0, 1, 0}), at.x);
  at.z = cross3(at.x, at.y);
  lathe(mesh, at, Outline(0, 0).line(radius, 0).line(radius, length).line(0, length).done(), segments);
}

struct Arm {
  const char* planet;
  double angle;           // degrees, at rest
  double radius, height;  // of the arm: how far it reaches, how high it turns
  double size;            // of the planet
  double speed, spin;     // degrees a second; of the planet about itself
};
constexpr Arm kArms[] = {{"mercury", 205, 0.42, 0.42, 0.048, 64, 30}, {"earth", 330, 0.76, 0.30, 0.095, 25, -150}, {"saturn", 120, 1.14, 0.18, 0.125, 10, 90}};
constexpr double kMoonWay = 0.20, kMoonHeight = 0.545;

Point place_of(const Arm& arm, double height) { return placed({0, 0, 0}, arm.angle).point({arm.radius, height, 0}); }

std::string spin_text(const std::string& part, const std::string& carrier, const Point& pivot, double speed) {
  const auto number = [](double x) {
    const std::string text = fixed_text(x, 4);
    return text.find('.') == std::string::npos ? text + ".0" : text;
  };
  std::string text = "[[moving]]\npart = \"" + part + "\"\n";
  if (!carrier.empty()) text += "carried_by = \"" + carrier + "\"\n";
  text += "pivot = [" + number(pivot.x) + ", " + number(pivot.y) + ", " + number(pivot.z) + "]\naxis = [0.0, 1.0, 0.0]\n";
  return text + "degrees_per_second = " + number(speed) + "\n\n";
}

// A hub about the column, the arm, a post under the planet.
void add_arm(ObjMesh& mesh, const Arm& arm) {
  const std::string name = std::string(arm.planet) + "_arm";
  mesh.object(name, "brass");
  const double h = arm.height;
  lathe(mesh, placed({0, h, 0}), Outline(0, -0.035).line(0.075, -0.035).smooth(arc({0.075, 0}, 0.035, 0.035, -90, 90, 8)).line(0, 0.035).done(), 32);
  const Point elbow = place_of(arm, h);
  rod(mesh, elbow - Point{0, 0.02, 0}, place_of(arm, kHeight - 0.5 * arm.size), 0.010, 12);
  sphere(mesh, elbow, 0.026, 16);
  // With a weight at the other end.
  const Point other = placed({0, 0, 0}, arm.angle).point({-0.24 * arm.radius - 0.08, h, 0});
  rod(mesh, other, elbow, 0.013, 14);
  sphere(mesh, other, 0.036, 20);
  mesh.object(arm.planet, arm.planet);
  sphere(mesh, place_of(arm, kHeight), arm.size, 40, {1, 1});
}

void add_moon(ObjMesh& mesh, const Arm& earth) {
  const Point hub = place_of(earth, kMoonHeight), end = placed(hub, 75).point({kMoonWay, 0, 0});
  mesh.object("moon_arm", "brass");
  lathe(mesh, placed(hub), Outline(0, -0.014).line(0.024, -0.014).smooth(arc({0.024, 0}, 0.014, 0.014, -90, 90, 6)).line(0, 0.014).done(), 20);
  rod(mesh, hub, end, 0.007, 10);
  rod(mesh, end - Point{0, 0.01, 0}, {end.x, kHeight + 0.01, end.z}, 0.006, 10);
  mesh.object("moon_arm", "moon");
  sphere(mesh, {end.x, kHeight + 0.03, end.z}, 0.034, 24);
}

void add_rings(ObjMesh& mesh, const Arm& saturn) {
  mesh.object("saturn_ring", "ring");
  Placement at = placed(place_of(saturn, kHeight), 20);
  at.y = normalize3(at.y + 0.42 * at.x, at.y), at.x = cross3(at.y, at.z);
  for (const auto& [from, to] : {std::pair{0.165, 0.20}, {0.208, 0.25}})
    lathe(mesh, at, Outline(from, -0.002).line(to, -0.002).line(to, 0.002).line(from, 0.002).line(from, -0.002).done(), 56);
}

void add_room(ObjMesh& mesh) {
  const double side = 3.2, low = -0.75, high = 2.6, back = -1.75;
  mesh.object("floor", "floor");
  rectangle(mesh, {-side, low, 3.4}, {2 * side, 0, 0}, {0, 0, back - 3.4}, 16, 13, 1.1);
  mesh.object("back_wall", "plaster");
  rectangle(mesh, {-side, low, back}, {2 * side, 0, 0}, {0, high - low, 0}, 16, 8, 1.3);
  mesh.object("left", "plaster");
  rectangle(mesh, {-2.1, low, 3.4}, {0, 0, back - 3.4}, {0, high - low, 0}, 13, 8, 1.3);
}

void add_table(ObjMesh& mesh) {
  mesh.object("table", "lacquer");
  lathe(mesh, {}, Outline(0, -0.07).line(1.50, -0.07).smooth(arc({1.50, -0.035}, 0.035, 0.035, -90, 90, 8)).line(0, 0).done(), 96);
  mesh.object("leg", "brass");
  lathe(mesh, {}, Outline(0, -0.76).line(0.55, -0.76).line(0.55, -0.72).smooth(arc({0.55, -0.20}, 0.44, 0.52, 270, 180, 10)).line(0.11, -0.05).line(0, -0.05).done(), 40);
  mesh.object("column", "brass");
  lathe(mesh, {}, Outline(0, -0.01).line(0.20, -0.01).line(0.20, 0.02).smooth(arc({0.20, 0.10}, 0.165, 0.08, 270, 180, 8)).line(0.035, 0.56)
                      .smooth(arc({0.035, 0.58}, 0.03, 0.02, -90, 90, 6)).line(0.03, 0.60).line(0, 0.61).done(), 36);
  mesh.object("sun", "sun");
  sphere(mesh, {0, kHeight, 0}, 0.16, 44);
}

}  // namespace

SceneFiles make_orrery() {
  ObjMesh mesh("orrery.mtl");
  add_room(mesh);
  add_table(mesh);
  std::string toml = kToml;
  for (const Arm& arm : kArms) {
    add_arm(mesh, arm);
    const std::string planet = arm.planet, carrier = planet + "_arm";
    toml += spin_text(carrier, "", {0, 0, 0}, arm.speed) + spin_text(planet, carrier, place_of(arm, kHeight), arm.spin);
  }
  add_moon(mesh, kArms[1]);
  toml += spin_text("moon_arm", "earth_arm", place_of(kArms[1], kHeight), 110);
  add_rings(mesh, kArms[2]);
  toml += spin_text("saturn_ring", "saturn_arm", place_of(kArms[2], kHeight), -12);
  toml.pop_back();  // no empty line at the end
  return {mesh, kMtl, toml};
}

}  // namespace spanray::assets
