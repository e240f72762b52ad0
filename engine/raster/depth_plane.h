// The depth of a triangle as a linear function of the pixel position.
#pragma once
#include "frame/frame.h"

namespace spanray {

// depth = depth0 + x * dx + y * dy, clamped to [min, max], 0 < min <= max <= 1.
struct DepthPlane {
  double depth0, dx, dy;
  float min, max;
};

// view_depth: W of the three vertices, in the order of t.vertex.
DepthPlane make_depth_plane(const Frame& frame, const Triangle& t, const double view_depth[3]);

}  // namespace spanray
