#include "rivals.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "raster/fixed_point.h"

namespace spanray::hard {

bool moller_trumbore(const glm::vec3& origin, const glm::vec3& direction, const std::array<glm::vec3, 3>& v, float epsilon, float* t) {
  const glm::vec3 e1 = v[1] - v[0], e2 = v[2] - v[0], p = cross3(direction, e2);
  const float det = dot3(e1, p);
  if (std::fabs(det) <= epsilon) return false;
  const float inverse = 1 / det;
  const glm::vec3 s = origin - v[0];
  const float u = dot3(s, p) * inverse;
  if (u < 0 || u > 1) return false;
  const glm::vec3 q = cross3(s, e1);
  const float w = dot3(direction, q) * inverse;
  if (w < 0 || u + w > 1) return false;
  *t = dot3(e2, q) * inverse;
  return *t > 0;
}

namespace {
// d = f / (f - n) (1 - n / z), and back; extended precision, since 1 - n / z is nearly 1.
long double standard_depth(long double z, long double n, long double f) { return f / (f - n) * (1 - n / z); }
long double view_depth(long double d, long double n, long double f) { return f * n / (f - d * (f - n)); }
}  // namespace

double depth_step_fixed24(double z, double near_plane, double far_plane) {
  const long double codes = (1 << 24) - 1, code = std::floor(standard_depth(z, near_plane, far_plane) * codes);
  const long double here = view_depth(code / codes, near_plane, far_plane),
                    next = view_depth(std::min((code + 1) / codes, 1.0L), near_plane, far_plane);
  return static_cast<double>((next - here) / here);
}

double depth_step_float(double z, double near_plane, double far_plane) {
  const float d = std::min(static_cast<float>(standard_depth(z, near_plane, far_plane)), std::nextafter(1.0f, 0.0f));
  const long double here = view_depth(d, near_plane, far_plane), next = view_depth(std::nextafter(d, 1.0f), near_plane, far_plane);
  return static_cast<double>((next - here) / here);
}

double depth_step_reversed(double z, double near_plane) {
  const float d = static_cast<float>(near_plane / z);
  const double here = near_plane / static_cast<double>(d), next = near_plane / static_cast<double>(std::nextafter(d, 0.0f));
  return (next - here) / here;
}

std::array<double, 3> weights_in_float(const glm::vec3& direction, const std::array<glm::vec3, 3>& v) {
  float e[3], sum = 0;
  for (size_t i = 0; i < 3; ++i) sum += e[i] = dot3(direction, cross3(v[(i + 1) % 3], v[(i + 2) % 3]));
  return {double{e[0] / sum}, double{e[1] / sum}, double{e[2] / sum}};
}

std::array<double, 3> weights_of_snapped(double x, double y, const std::array<double, 3>& px, const std::array<double, 3>& py,
                                         const std::array<double, 3>& w) {
  double sx[3], sy[3], e[3], sum = 0;
  for (size_t i = 0; i < 3; ++i) sx[i] = snap_24_8(px[i]) / 256.0, sy[i] = snap_24_8(py[i]) / 256.0;
  for (size_t i = 0; i < 3; ++i) {
    const size_t j = (i + 1) % 3, k = (i + 2) % 3;
    sum += e[i] = ((sx[k] - sx[j]) * (y - sy[j]) - (sy[k] - sy[j]) * (x - sx[j])) / w[i];
  }
  return {e[0] / sum, e[1] / sum, e[2] / sum};
}

}  // namespace spanray::hard
