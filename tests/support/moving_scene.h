// A room with things that move: a wheel of spikes that spins, a pane of glass that it carries, a mirror that slides by keys.
#pragma once
#include <cstdio>
#include <string>

#include "support/random.h"
#include "support/temp_folder.h"

namespace spanray {

inline std::string vertex_line(double x, double y, double z) {
  char text[96];
  std::snprintf(text, sizeof text, "v %.9g %.9g %.9g\n", x, y, z);
  return text;
}

inline constexpr const char* kMovingToml = R"(obj = "moving.obj"
ambient = [0.1, 0.1, 0.12]
[[camera]]
eye = [0.4, 1.6, 4.2]
target = [0, 0.7, 0]
fov_y = 50
near = 0.01
[[light]]
kind = "point"
position = [1.5, 3, 2]
intensity = [20, 18, 16]
[[light]]
kind = "directional"
direction = [0.6, -1, -0.4]
intensity = [1, 1, 1.2]
[[moving]]
part = "wheel"
pivot = [0, 1, 0]
axis = [0.1, 0.2, 1]
degrees_per_second = 40
[[moving]]
part = "pane"
carried_by = "wheel"
pivot = [0.6, 1, 0.3]
axis = [0, 1, 0]
degrees_per_second = -75
[[moving]]
part = "slider"
repeat = true
axis = [0, 1, 0]
pivot = [-1.2, 0, -1]
key = [{time = 0}, {time = 2, translation = [0.8, 0, 0.5], degrees = 30}, {time = 3, axis = [1, 0, 0], degrees = -20}, {time = 4}]
)";

// Writes moving.obj, moving.mtl and moving.toml; returns the path of the last. spikes: tetrahedra of the wheel.
inline std::string write_moving_scene(const TempFolder& folder, int spikes = 60) {
  folder.write("moving.mtl", "newmtl floor\nKd 0.7 0.6 0.5\nillum 1\n"
                             "newmtl red\nKd 0.8 0.2 0.1\nKs 0.4 0.4 0.4\nNs 30\nillum 2\n"
                             "newmtl glass\nKd 0.2 0.7 0.5\nd 0.4\nillum 2\n"
                             "newmtl mirror\nKd 0.1 0.1 0.1\nKs 0.8 0.8 0.8\nNs 50\nillum 3\n");
  std::string obj = "mtllib moving.mtl\no room\nusemtl floor\n";
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      const double x = i - 3, z = j - 3;
      obj += vertex_line(x, 0, z) + vertex_line(x, 0, z + 1) + vertex_line(x + 1, 0, z + 1) + vertex_line(x + 1, 0, z);
      obj += "f -4 -3 -2 -1\n";
    }
  obj += "o wheel\nusemtl red\n";
  TestRandom random(11);
  for (int i = 0; i < spikes; ++i) {
    double x, y;
    do x = random.uniform(-1, 1), y = random.uniform(-1, 1);
    while (x * x + y * y > 1);
    for (int v = 0; v < 4; ++v) {
      const double aside = random.uniform(-0.1, 0.1), up = random.uniform(-0.1, 0.1), ahead = random.uniform(-0.2, 0.2);
      obj += vertex_line(0.8 * x + aside, 1 + 0.8 * y + up, ahead);
    }
    obj += "f -4 -3 -2\nf -4 -2 -1\nf -4 -1 -3\nf -3 -1 -2\n";
  }
  obj += "o glassware\ng things pane\nusemtl glass\n" + vertex_line(0.3, 0.7, 0.3) + vertex_line(0.9, 0.7, 0.3) + vertex_line(0.9, 1.3, 0.3) +
         vertex_line(0.3, 1.3, 0.3) + "f -4 -3 -2 -1\n";
  obj += "o slider\ng\nusemtl mirror\n" + vertex_line(-2, 0, -1) + vertex_line(-0.4, 0, -1) + vertex_line(-0.4, 1.5, -1.1) + vertex_line(-2, 1.5, -1.1) +
         "f -4 -3 -2 -1\n";
  folder.write("moving.obj", obj);
  return folder.write("moving.toml", kMovingToml);
}

}  // namespace spanray
