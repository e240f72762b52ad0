#include "frame/primary_rays.h"

#include <algorithm>
#include <cmath>

#include "math/elementary.h"

namespace spanray {
namespace {

glm::dvec3 to_dvec(const double* p) { return {p[0], p[1], p[2]}; }

// Scaled by its largest component first, so that no length over- or underflows.
glm::dvec3 safe_unit(const glm::dvec3& a, const glm::dvec3& fallback) {
  const double m = std::max(std::fabs(a.x), std::max(std::fabs(a.y), std::fabs(a.z)));
  if (!(m > 0) || !std::isfinite(m)) return fallback;
  return normalize3(glm::dvec3(a.x / m, a.y / m, a.z / m), fallback);
}

glm::dvec3 unit_right(const glm::dvec3& forward, const glm::dvec3& camera_up) {
  constexpr double kParallel = 1e-9;  // sine of the angle between view and up
  glm::dvec3 right = cross3(forward, safe_unit(camera_up, forward));
  if (!(length3(right) > kParallel))
    right = cross3(forward, std::fabs(forward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, forward.y > 0 ? 1 : -1));
  right = normalize3(right, glm::dvec3(1, 0, 0));
  // Once more: the cross product of nearly parallel vectors is not perpendicular to them in its last digits.
  const double slip = dot3(right, forward);
  return normalize3(right - glm::dvec3(forward.x * slip, forward.y * slip, forward.z * slip), glm::dvec3(1, 0, 0));
}

}  // namespace

PrimaryRays make_primary_rays(const Camera& camera, int width, int height) {
  PrimaryRays rays;
  rays.eye = to_dvec(camera.eye);
  rays.near_plane = camera.near_plane;
  rays.width = width;
  rays.height = height;
  rays.forward = safe_unit(to_dvec(camera.target) - rays.eye, glm::dvec3(0, 0, -1));
  const glm::dvec3 right = unit_right(rays.forward, to_dvec(camera.up));
  const glm::dvec3 up = normalize3(cross3(right, rays.forward), glm::dvec3(0, 1, 0));

  const double half_width = 0.5 * width, half_height = 0.5 * height;
  const double pixel_size = tan_(camera.fov_y_degrees * (kPi / 360)) / half_height;  // at view depth 1
  rays.step_x = right * pixel_size;
  rays.step_y = up * -pixel_size;
  for (int k = 0; k < 3; ++k)
    rays.single_step_x[k] = static_cast<float>(rays.step_x[k]), rays.single_step_y[k] = static_cast<float>(rays.step_y[k]);
  rays.corner = rays.forward - rays.step_x * half_width - rays.step_y * half_height;
  rays.pixel_row_x = right * (1 / pixel_size) + rays.forward * half_width;
  rays.pixel_row_y = up * (-1 / pixel_size) + rays.forward * half_height;
  return rays;
}

void round_primary_ray(const PrimaryRays& primary, double x, double y, float (&origin)[3], float (&direction)[3]) {
  const glm::dvec3 d = primary.corner + primary.step_x * x + primary.step_y * y;
  const glm::dvec3 o = primary.eye + d * primary.near_plane;
  for (int k = 0; k < 3; ++k) origin[k] = static_cast<float>(o[k]), direction[k] = static_cast<float>(d[k]);
}

}  // namespace spanray
