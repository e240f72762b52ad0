// A pinhole camera. Right-handed world, y up by default.
#pragma once

namespace spanray {

inline constexpr double kMinFovDegrees = 0.01, kMaxFovDegrees = 179;  // in files, on the command line, of the renderer

struct Camera {
  double eye[3] = {0, 0, 5};
  double target[3] = {0, 0, 0};
  double up[3] = {0, 1, 0};
  double fov_y_degrees = 45;  // full vertical angle, kMinFovDegrees to kMaxFovDegrees
  double near_plane = 0.01;   // distance along the view axis, > 0; there is no far plane
};

}  // namespace spanray
