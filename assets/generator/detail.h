// How finely a scene is divided. Every curved or long surface asks here, so that one number scales the whole scene.
#pragma once
#include <cmath>

namespace spanray::assets {

struct Detail {
  double linear = 1;  // divisions along a line, relative to the shipped scene: triangles grow with its square

  // Divisions where the shipped scene has `shipped`, but at least `least`.
  int count(double shipped, int least = 1) const {
    const int n = static_cast<int>(std::floor(shipped * linear + 0.5));
    return n < least ? least : n;
  }
  // Length of a division where the shipped scene has `shipped` meters.
  double cell(double shipped) const { return shipped / linear; }
  // Small parts are left out below a level of their own each, so that counts fall without a step.
  bool keep(double from) const { return linear >= from; }
  // Edges are cut only where somebody may come near enough to see it.
  double chamfer(double size) const { return linear < 0.75 ? 0 : size; }
};

}  // namespace spanray::assets
