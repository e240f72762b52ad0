// A dahlia of instances: three petals and a seed, each modelled once, stand hundreds of times in the spiral of a flower.
#include "forms.h"
#include "math/elementary.h"
#include "scenes.h"

namespace spanray::assets {
namespace {

const char* const kMtl = R"(# Petals from the heart to the rim, a glazed bowl, a table of black lacquer.
newmtl heart
illum 2
Kd 0.34 0.015 0.05
Ks 0.10 0.08 0.08
Ns 30
newmtl rose
illum 2
Kd 0.62 0.06 0.13
Ks 0.10 0.09 0.09
Ns 30
newmtl blush
illum 2
Kd 0.86 0.34 0.36
Ks 0.10 0.10 0.10
Ns 30
newmtl seed
illum 2
Kd 0.80 0.52 0.08
Ks 0.20 0.18 0.10
Ns 50
newmtl glaze
illum 5
Kd 0.03 0.10 0.13
Ks 0.06 0.06 0.06
Ni 1.5
Ns 300
newmtl lacquer
illum 3
Kd 0.012 0.010 0.012
Ks 0.30 0.29 0.28
Ns 400
newmtl wall
illum 1
Kd 0.36 0.38 0.40
)";

const char* const kToml = R"(# Copies of parts: [[template]] names what the mesh only models, [[instance]] places it: scaled, turned, then moved.
obj = "dahlia.obj"
background = [0.02, 0.022, 0.026]
ambient = [0.10, 0.10, 0.11]

[[camera]]
name = "bowl"
eye = [0.42, 1.16, 1.12]
target = [0.0, 0.25, 0.0]
fov_y = 34.0

[[camera]]
name = "heart"
eye = [0.12, 1.05, 0.34]
target = [0.0, 0.36, 0.0]
fov_y = 42.0

[[light]]
kind = "point"
position = [-0.9, 2.1, 1.2]
intensity = [17.0, 15.6, 13.6]
attenuation = [0.3, 0.0, 1.0]

[[light]]
kind = "directional"
direction = [-0.55, -1.0, -0.5]
intensity = [0.50, 0.56, 0.70]

[technique]
shadows = "ray"
reflections = "ray"
max_bounces = 2

)";

constexpr double kDegrees = kPi / 180;
constexpr double kGoldenAngle = 137.50776405003785;
constexpr int kPetals = 330, kSeeds = 60;
const char* const kPetalNames[] = {"petal_heart", "petal_rose", "petal_blush"};
const char* const kPetalMaterials[] = {"heart", "rose", "blush"};

struct Quaternion {
  double w;
  Point v;
};
Quaternion turn(const Point& axis, double degrees) {
  double sine, cosine;
  sin_cos(0.5 * degrees * kDegrees, &sine, &cosine);
  return {cosine, sine * axis};
}
Quaternion operator*(const Quaternion& a, const Quaternion& b) { return {a.w * b.w - dot3(a.v, b.v), a.w * b.v + b.w * a.v + cross3(a.v, b.v)}; }

std::string number(double x) {
  const std::string text = fixed_text(x, 4);
  return text.find('.') == std::string::npos ? text + ".0" : text;
}
std::string list(const Point& p) { return "[" + number(p.x) + ", " + number(p.y) + ", " + number(p.z) + "]"; }

std::string instance_text(const std::string& part, const Point& place, const Quaternion& q, const std::string& scale) {
  const double sine = length3(q.v);
  const Point axis = normalize3(q.v, Point{0, 1, 0});
  const double degrees = 2 * (q.w < 0 ? 180 - acos_(-q.w) / kDegrees : acos_(q.w) / kDegrees);
  std::string text = "[[instance]]\npart = \"" + part + "\"\ntranslate = " + list(place) + "\n";
  if (sine > 1e-6) text += "axis = " + list(axis) + "\ndegrees = " + number(degrees) + "\n";
  return text + "scale = " + scale + "\n\n";
}

// A petal of length 1 along z, its face up: broad, hollow, curled at the tip.
Cage petal_cage() {
  std::vector<std::array<int, 3>> cells;
  for (int z = 0; z < 5; ++z) cells.push_back({0, 0, z}), cells.push_back({1, 0, z});
  Cage cage = cage_of_cells(cells);
  constexpr double kHalfWidth[] = {0.06, 0.16, 0.25, 0.27, 0.20, 0.035};
  constexpr double kRise[] = {0.0, -0.02, -0.01, 0.03, 0.10, 0.20};
  for (Point& p : cage.points) {
    const int along = static_cast<int>(p.z + 0.5);
    const double side = p.x - 1, thick = 0.06 * (1 - 0.12 * along);
    p = {side * kHalfWidth[along], (p.y - 0.5) * thick + kRise[along] + 0.35 * side * side * kHalfWidth[along], 0.2 * along};
  }
  return subdivided(subdivided(cage));
}

void add_still_life(ObjMesh& mesh) {
  mesh.object("table", "lacquer");
  lathe(mesh, {}, Outline(0, -0.05).line(1.3, -0.05).smooth(arc({1.3, -0.025}, 0.025, 0.025, -90, 90, 8)).line(0, 0).done(), 96);
  mesh.object("backdrop", "wall");
  rectangle(mesh, {-6, -1.2, -2.6}, {12, 0, 0}, {0, 6, 0}, 6, 3);
  mesh.object("bowl", "glaze");
  lathe(mesh, {}, Outline(0, -0.004).line(0.13, -0.004).line(0.14, 0.015).smooth(arc({0.14, 0.215}, 0.20, 0.20, -90, 0, 20)).line(0.32, 0.215)
                      .smooth(arc({0.14, 0.215}, 0.18, 0.18, 0, -90, 20)).line(0, 0.035).done(), 80);
}

std::string flower_text() {
  std::string text;
  for (const char* name : kPetalNames) text += std::string("[[template]]\npart = \"") + name + "\"\n\n";
  text += "[[template]]\npart = \"seed\"\n\n";
  for (int i = 0; i < kPetals; ++i) {
    const double t = (i + 0.5) / kPetals, out = std::sqrt(t);
    const double around = i * kGoldenAngle, up = 84 - 78 * out;
    const Quaternion q = turn({0, 1, 0}, around) * turn({1, 0, 0}, -up);
    const Point place = placed({0, 0.26 - 0.05 * t, 0}, around).point({0, 0, 0.025 + 0.10 * out});
    const double size = 0.10 + 0.24 * out;
    const std::string scale = "[" + number((i % 2 == 0 ? size : -size) * 0.9) + ", " + number(size) + ", " + number(size) + "]";
    text += instance_text(kPetalNames[t < 0.22 ? 0 : t < 0.6 ? 1 : 2], place, q, scale);
  }
  for (int i = 0; i < kSeeds; ++i) {
    const double out = std::sqrt((i + 0.5) / kSeeds), around = i * kGoldenAngle;
    text += instance_text("seed", placed({0, 0.315 - 0.02 * out * out, 0}, around).point({0.036 * out, 0, 0}), turn({0, 1, 0}, 0), number(0.006 + 0.002 * out));
  }
  text.pop_back();  // no empty line at the end
  return text;
}

}  // namespace

SceneFiles make_dahlia() {
  ObjMesh mesh("dahlia.mtl");
  add_still_life(mesh);
  const Cage petal = petal_cage();
  for (int i = 0; i < 3; ++i) {
    mesh.object(kPetalNames[i], kPetalMaterials[i]);
    add_cage(mesh, {}, petal);
  }
  mesh.object("seed", "seed");
  sphere(mesh, {0, 0, 0}, 1, 12);
  return {mesh, kMtl, kToml + flower_text()};
}

}  // namespace spanray::assets
