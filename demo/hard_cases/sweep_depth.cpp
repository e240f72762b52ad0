// Steps of depth buffers, and the error of ours, by distance.
#include <algorithm>
#include <cmath>

#include "rivals.h"
#include "support/camera_at.h"
#include "support/random.h"
#include "support/raster_front_end.h"
#include "sweep.h"

namespace spanray::hard {
namespace {

constexpr double kNear = 1e-4, kFar = 1e6;

// The largest relative error of the rasterizer's depth on tilted walls at that distance, against the exact ray.
double depth_error(const Effort& effort, double z) {
  TestRandom random(91);
  Worst error;
  for (int n = 0; n < effort.count(20, 4); ++n) {
    const glm::dvec3 tilt = random_point(random, 0.3);
    const auto corner = [&](double x, double y) { return glm::dvec3(x, y, -1 + x * tilt.x + y * tilt.y) * z; };
    const auto t = make_test_frame(make_test_scene({soup_triangle(corner(-3, -1), corner(3, -1), corner(0, 2))}),
                                   camera_at({0, 0, 0}, {0, 0, -1}, kNear), test_settings(70, 70));
    const Picture p = rasterize(t->frame);
    const PrimaryRays& r = t->frame.primary;
    glm::dvec3 v[3];
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) v[i][k] = t->scene.vertices[t->scene.triangles[0].vertex[i]].position[k];
    const glm::dvec3 normal = cross3(v[1] - v[0], v[2] - v[0]);
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x) {
        if (p.id(x, y) == kNoPrimitive) continue;
        const glm::dvec3 d = r.corner + (x + 0.5) * r.step_x + (y + 0.5) * r.step_y;
        error.add(std::fabs(p.z(x, y) / (kNear * dot3(d, normal) / dot3(v[0] - r.eye, normal)) - 1));
      }
  }
  return error.value();
}

}  // namespace

Sweep sweep_depth_steps(const Effort& effort) {
  Sweep s;
  s.title = "What a depth buffer can tell apart, by distance";
  s.what =
      "The least relative difference of view depths that a buffer can tell apart, near plane at 1e-4, far plane at 1e6. Above "
      "1 it cannot "
      "tell a surface from one twice as far. Standard formats spend nearly all of their codes right behind the near plane, "
      "also in float; z "
      "reversed in float keeps float's own relative step everywhere, and needs no far plane. The lowest curve is the measured "
      "error of this "
      "renderer's depth on tilted walls, against the exact ray.";
  s.x_name = "view depth", s.y_name = "relative step";
  s.x = decades(-3.5, 5.5, 0.5);
  s.curves = {{"spanray: measured error of its depth", true, {}}, {"reversed z in float, infinite far plane (spanray's format)", true, {}},
              {"24-bit fixed point", false, {}}, {"float, not reversed", false, {}}};
  for (const double z : s.x) {
    s.curves[0].y.push_back(depth_error(effort, z)), s.curves[1].y.push_back(depth_step_reversed(z, kNear));
    s.curves[2].y.push_back(depth_step_fixed24(z, kNear, kFar)), s.curves[3].y.push_back(depth_step_float(z, kNear, kFar));
  }
  s.bound_name = "contract: relative error 1.6e-7", s.bound.assign(s.x.size(), 1.6e-7);
  return s;
}

}  // namespace spanray::hard
