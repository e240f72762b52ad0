// From pixels to lines of sight, and from radiance to bytes, in double.
#pragma once
#include <cstdint>

#include "math/vec.h"
#include "spanray/camera.h"

namespace spanray::reference {

// A pinhole camera: rays through positions of the picture, in pixels from its upper left corner, of view depth 1.
struct View {
  glm::dvec3 eye{0}, forward{0}, right{0}, down{0};  // right, down: by one pixel at view depth 1
  double half_width = 0, half_height = 0, near = 0;
  View(const Camera& camera, int width, int height);
  glm::dvec3 direction(double x, double y) const { return forward + right * (x - half_width) + down * (y - half_height); }
};

// The sRGB code of linear light, clamped to [0, 1], in [0, 255], and the byte that is nearest to it.
double srgb_code(double linear);
inline uint8_t srgb_byte(double linear) { return static_cast<uint8_t>(srgb_code(linear) + 0.5); }

}  // namespace spanray::reference
