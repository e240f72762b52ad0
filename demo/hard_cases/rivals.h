// What other renderers do, written plainly from its sources, to be compared with what this one does. Nothing of the renderer uses it.
#pragma once
#include <array>

#include "math/vec.h"

namespace spanray::hard {

// Ray against triangle in float, two-sided. False where |determinant| <= epsilon.
// Source: Moeller and Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection" (their code has epsilon = 1e-6).
bool moller_trumbore(const glm::vec3& origin, const glm::vec3& direction, const std::array<glm::vec3, 3>& v, float epsilon, float* t);

// Distance between a view depth z and the next one that the buffer can tell from it, relative to z.
// near_plane <= z <= far_plane. Formats: fixed point of 24 bits, and float, both of z' = f / (f - n) (1 - n / z) as OpenGL and
// Direct3D have it.
double depth_step_fixed24(double z, double near_plane, double far_plane);
double depth_step_float(double z, double near_plane, double far_plane);
// Reversed z in float, infinite far plane: z' = n / z. Source: Lapidous and Jouppi 1999; Upchurch and Desbrun 2012.
double depth_step_reversed(double z, double near_plane);

// Barycentric weights of a pixel's ray by edge functions e_i = d . (v_j x v_k), vertices relative to the eye, everything in float.
// Source: Olano and Greer 1997, "Triangle Scan Conversion using 2D Homogeneous Coordinates"; without the set-up in double.
std::array<double, 3> weights_in_float(const glm::vec3& direction, const std::array<glm::vec3, 3>& v);

// Weights from screen positions snapped to 1/256 pixel, made perspective by 1/w, everything else in double: how most rasterizers
// interpolate. x, y: the pixel's center; px, py: unsnapped pixel positions of the vertices, w their view depths.
std::array<double, 3> weights_of_snapped(double x, double y, const std::array<double, 3>& px, const std::array<double, 3>& py,
                                         const std::array<double, 3>& w);

}  // namespace spanray::hard
