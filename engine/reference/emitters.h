// Triangles that glow, as lamps with an area. Spheres and planes that glow are not among them: paths find these by chance.
#pragma once
#include "reference/world.h"

namespace spanray::reference {

class Emitters {
 public:
  explicit Emitters(const World& world);
  bool empty() const { return list_.empty(); }
  // How densely pick() chooses points on a triangle, 1/m^2; 0 if it does not glow. Proportional to the greatest channel of its
  // radiance (that of its texture at its greatest), whatever its area.
  double density(uint32_t primitive) const;

  struct Point {
    uint32_t primitive = kNoPrimitive;
    glm::dvec3 position{0};
  };
  // From three numbers in (0, 1). There must be an emitter.
  Point pick(double which, double u, double v) const;

 private:
  struct Item {
    uint32_t primitive;
    double until;  // sum of power up to and with this one, over the whole
    glm::dvec3 corner[3];
  };
  double glow(const Material& m) const;

  const World& world_;
  std::vector<Item> list_;
  std::vector<double> glow_;  // by material, W/(m^2 sr)
  double power_ = 0;          // sum of area * glow, W/sr
};

}  // namespace spanray::reference
