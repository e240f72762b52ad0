// A gallery hall: marble, brick, iron, gauze, glass and bronze in late sun. Its detail can be chosen.
#include <cmath>
#include <iterator>

#include "hall.h"
#include "scenes.h"

namespace spanray::assets {
namespace {

const char* const kMtl = R"(# Stone, brick and inlaid marble; metals; gauze (screen-door), iron (masks), glass (alpha).
newmtl ashlar
illum 1
Kd 1 1 1
map_Kd textures/hall_ashlar.png
map_bump -bm 5 textures/hall_ashlar_height.png
newmtl stone
illum 2
Kd 1 1 1
Ks 0.04 0.04 0.04
Ns 20
map_Kd textures/hall_stone.png
newmtl plaster
illum 1
Kd 0.92 0.85 0.74
map_Kd textures/hall_stone.png
newmtl niche
illum 1
Kd 0.62 0.52 0.42
map_Kd textures/hall_ashlar.png
newmtl apse
illum 1
Kd 0.92 0.80 0.62
map_Kd textures/hall_ashlar.png
map_bump -bm 4 textures/hall_ashlar_height.png
newmtl coffer
illum 1
Kd 1 1 1
map_Kd textures/hall_coffer.png
newmtl brick
illum 1
Kd 1 1 1
map_Kd textures/hall_brick.png
map_bump -bm 3.5 textures/hall_brick_height.png
newmtl relief_sun
illum 2
Kd 1 1 1
Ks 0.03 0.03 0.03
Ns 15
map_Kd textures/hall_relief_sun.png
map_bump -bm 9 textures/hall_relief_sun_height.png
newmtl relief_vine
illum 2
Kd 1 1 1
Ks 0.03 0.03 0.03
Ns 15
map_Kd textures/hall_relief_vine.png
map_bump -bm 9 textures/hall_relief_vine_height.png
newmtl floor
illum 3
Kd 0.86 0.86 0.86
Ks 0.26 0.26 0.26
Ns 400
map_Kd textures/hall_floor.png
newmtl marble_rose
illum 2
Kd 1 1 1
Ks 0.24 0.23 0.22
Ns 90
map_Kd textures/hall_rose.png
newmtl marble_verde
illum 2
Kd 1 1 1
Ks 0.24 0.24 0.24
Ns 120
map_Kd textures/hall_verde.png
newmtl alabaster
illum 2
Kd 0.70 0.66 0.60
Ks 0.16 0.16 0.16
Ns 70
newmtl bronze
illum 2
Kd 0.16 0.10 0.055
Ks 0.55 0.38 0.20
Ns 45
newmtl polished_bronze
illum 3
Kd 0.13 0.075 0.035
Ks 0.50 0.34 0.19
Ns 300
newmtl gilt
illum 2
Kd 0.50 0.33 0.11
Ks 0.80 0.60 0.26
Ns 50
newmtl gold
illum 3
Kd 0.40 0.24 0.06
Ks 0.42 0.30 0.12
Ns 200
newmtl brass
illum 2
Kd 0.42 0.30 0.12
Ks 0.45 0.36 0.20
Ns 120
newmtl walnut
illum 2
Kd 0.50 0.36 0.27
Ks 0.10 0.10 0.10
Ns 60
map_Kd textures/plank.png
newmtl plank
illum 1
Kd 0.60 0.50 0.42
map_Kd textures/plank.png
map_bump -bm 3 textures/plank_height.png
newmtl beam
illum 1
Kd 0.36 0.28 0.22
map_Kd textures/plank.png
newmtl velvet
illum 1
Kd 0.22 0.04 0.05
newmtl ceramic
illum 2
Kd 1 1 1
Ks 0.18 0.18 0.18
Ns 160
map_Kd textures/ceramic.png
newmtl clay
illum 1
Kd 0.58 0.30 0.18
newmtl glass
illum 2
Kd 0.55 0.62 0.62
Ks 0.60 0.60 0.60
Ns 400
d 0.10
newmtl gauze
illum 1
Kd 0.95 0.93 0.88
d 0.5
map_Kd textures/gauze.png
newmtl ironwork
illum 2
Kd 0.035 0.035 0.04
Ks 0.2 0.2 0.2
Ns 40
map_d textures/ironwork.png
newmtl lattice
illum 1
Kd 0.06 0.055 0.05
map_d textures/hall_lattice.png
newmtl iron
illum 2
Kd 0.035 0.035 0.04
Ks 0.2 0.2 0.2
Ns 40
newmtl sky_glass
illum 1
Kd 0.1 0.1 0.1
Ke 0.62 0.78 0.95
newmtl lamp
illum 1
Kd 0 0 0
Ke 1.35 1.02 0.62
newmtl foliage
illum 1
Kd 0.9 0.9 0.8
map_Kd textures/foliage.png
newmtl lawn
illum 1
Kd 0.45 0.62 0.30
map_Kd textures/limestone.png
)";

const char* const kToml = R"(# The gallery: sun through garden windows, the cool light of the entrance, lamps; an inlaid floor that mirrors it all.
obj = "hall.obj"
background = [0.66, 0.80, 1.0]
ambient = [0.092, 0.090, 0.094]

[[camera]]
name = "nave"
eye = [-0.75, 1.62, -0.9]
target = [0.35, 1.95, -12.0]
fov_y = 50.0

[[camera]]
name = "aisle"
eye = [-4.05, 1.62, -5.3]
target = [-5.0, 1.72, -10.0]
fov_y = 58.0

[[camera]]
name = "back"
eye = [0.9, 1.62, -19.0]
target = [-0.4, 2.5, -8.0]
fov_y = 56.0

[[camera]]
name = "case"
eye = [0.75, 1.45, -3.35]
target = [1.95, 1.15, -5.1]
fov_y = 48.0

# Late sun, through the windows on the right.
[[light]]
kind = "directional"
direction = [-0.88, -0.215, 0.158]
intensity = [8.0, 6.1, 3.9]

# What the sunlit floor throws back.
[[light]]
kind = "point"
position = [0.4, 0.005, -8.2]
intensity = [40.0, 34.0, 26.0]
attenuation = [9.0, 0.0, 1.0]

# The sky, through the entrance.
[[light]]
kind = "point"
position = [0.5, 4.3, 0.2]
intensity = [23.0, 25.5, 30.0]
attenuation = [25.0, 0.0, 1.0]

[[light]]
kind = "point"
position = [0.0, 4.7, -6.0]
intensity = [16.0, 12.0, 7.4]
attenuation = [3.0, 0.0, 1.0]

[[light]]
kind = "point"
position = [0.0, 4.7, -15.0]
intensity = [16.0, 12.0, 7.4]
attenuation = [3.0, 0.0, 1.0]

[[light]]
kind = "point"
position = [0.0, 4.3, -21.0]
intensity = [10.0, 7.4, 4.4]
attenuation = [0.8, 0.0, 1.0]

)";

// Stations of the walk: seconds, eye, target. Between them the camera moves on a Catmull-Rom curve, written out in short steps.
struct Station { double time; Point eye, target; };
const Station kWalk[] = {
    {0, {-0.75, 1.62, -0.9}, {0.35, 1.95, -12.0}},   {5, {-0.45, 1.62, -2.6}, {1.9, 1.20, -5.6}},     {9, {0.55, 1.60, -4.6}, {-1.7, 1.40, -6.6}},
    {13, {0.35, 1.62, -7.4}, {1.9, 1.2, -10.6}},     {17, {0.15, 1.66, -10.4}, {-3.2, 1.7, -13.6}},   {20, {-2.2, 1.66, -13.4}, {-5.4, 1.85, -13.6}},
    {23, {-4.1, 1.64, -13.4}, {-5.7, 2.15, -13.2}},  {25.5, {-4.25, 1.62, -11.4}, {-4.9, 1.8, -6.0}},   {28, {-4.1, 1.64, -9.2}, {-1.0, 2.2, -6.6}},
    {31, {-2.5, 1.66, -7.5}, {1.2, 2.4, -11.0}},     {35, {0.2, 1.70, -11.0}, {0.3, 4.5, -18.0}},     {40, {0.3, 1.66, -15.8}, {0.0, 2.05, -21.7}}};

std::string walk_text() {
  const int stations = static_cast<int>(std::size(kWalk));
  const auto station = [&](int k) -> const Station& { return kWalk[k < 0 ? 0 : k >= stations ? stations - 1 : k]; };
  const auto vector_text = [](const Point& p) { return "[" + fixed_text(p.x, 3) + ", " + fixed_text(p.y, 3) + ", " + fixed_text(p.z, 3) + "]"; };
  std::string text;
  for (int half_seconds = 0; half_seconds <= 2 * static_cast<int>(kWalk[stations - 1].time); ++half_seconds) {
    const double time = 0.5 * half_seconds;
    int k = 0;
    while (k + 2 < stations && kWalk[k + 1].time <= time) ++k;
    const Station &a = station(k - 1), &b = station(k), &c = station(k + 1), &d = station(k + 2);
    const double t = (time - b.time) / (c.time - b.time);
    const auto between = [&](Point Station::*value) {
      const Point p = b.*value, q = c.*value, span_b = c.*value - a.*value, span_c = d.*value - b.*value;
      const double length = c.time - b.time;
      const Point m = (k == 0 ? Point{0, 0, 0} : (length / (c.time - a.time)) * span_b), n = (k + 2 >= stations ? Point{0, 0, 0} : (length / (d.time - b.time)) * span_c);
      return (1 - t) * (1 - t) * (1 + 2 * t) * p + t * (1 - t) * (1 - t) * m + t * t * (3 - 2 * t) * q + t * t * (t - 1) * n;
    };
    text += "[[path]]\ntime = " + fixed_text(time, 1) + "\neye = " + vector_text(between(&Station::eye)) + "\ntarget = " + vector_text(between(&Station::target)) + "\n";
  }
  return text;
}

const char* const kTomlEnd = R"(
[technique]
shadows = "ray"
reflections = "ray"
max_bounces = 2

[material.gauze]
transparency = "screen-door"
[material.ironwork]
transparency = "mask"
[material.lattice]
transparency = "mask"
)";

void build(ObjMesh& mesh, const Detail& d) {
  using namespace hall;
  add_floor(mesh, d);
  add_arcades(mesh, d);
  add_walls(mesh, d);
  add_ends(mesh, d);
  add_vault(mesh, d);
  add_garden(mesh, d);
  add_ironwork(mesh, d);
  add_curtains(mesh, d);
  add_lanterns(mesh, d);
  add_cases(mesh, d);
  add_sculptures(mesh, d);
}

double triangles_at(const Detail& d) {
  ObjMesh counter = ObjMesh::counter();
  build(counter, d);
  return static_cast<double>(counter.triangle_count());
}

// Counts grow nearly with the square of the divisions; where they are many, exactly enough to stop counting.
Detail detail_for(double triangles) {
  const double searched = triangles < 500e3 ? triangles : 500e3;
  Detail best{1};
  double error = 1e9;
  const auto measure = [&](double linear) {
    const double ratio = triangles_at({linear}) / searched;
    if (std::fabs(ratio - 1) < error) best = {linear}, error = std::fabs(ratio - 1);
    return ratio;
  };
  double linear = std::sqrt(searched / kHallTriangles);
  for (int k = 0; k < 4 && error > 0.02; ++k) linear /= std::sqrt(measure(linear));
  for (double low = 0.02, high = 4; error > 0.05 && high - low > 0.004;) {  // few triangles: counts go in steps
    const double middle = 0.5 * (low + high);
    (measure(middle) < 1 ? low : high) = middle;
  }
  return {best.linear * std::sqrt(triangles / searched)};
}

}  // namespace

SceneFiles make_hall(double triangles) {
  const Detail d = detail_for(triangles);
  constexpr double kHalf = 0.5 + 1e-6;
  // Millimeters will do until divisions come near them.
  ObjMesh mesh("hall.mtl", triangles < 400e3 ? ObjMesh::Decimals{4, 3, 3, kHalf} : ObjMesh::Decimals{5, 4, 5, kHalf});
  build(mesh, d);
  return {mesh, kMtl, std::string(kToml) + walk_text() + kTomlEnd};
}

}  // namespace spanray::assets
