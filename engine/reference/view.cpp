#include "reference/view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spanray::reference {

View::View(const Camera& c, int width, int height) : half_width(0.5 * width), half_height(0.5 * height), near(c.near_plane) {
  const auto vec = [](const double* v) { return glm::dvec3(v[0], v[1], v[2]); };
  eye = vec(c.eye), forward = normalize3(vec(c.target) - eye, glm::dvec3(0, 0, -1));
  const glm::dvec3 axis = std::fabs(forward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, forward.y > 0 ? 1 : -1);
  glm::dvec3 side = cross3(forward, normalize3(vec(c.up), axis));
  if (!(length3(side) > 1e-9)) side = cross3(forward, axis);  // an up vector along the view is none
  side = normalize3(side, glm::dvec3(1, 0, 0));
  const double pixel = std::tan(c.fov_y_degrees * (std::numbers::pi / 360)) / half_height;
  right = side * pixel, down = cross3(forward, side) * pixel;
}

double srgb_code(double linear) {
  const double v = std::clamp(linear, 0.0, 1.0);
  return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
}

}  // namespace spanray::reference
