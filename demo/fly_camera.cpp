#include "fly_camera.h"

#include "math/vec.h"

namespace spanray::demo {
namespace {

using glm::dvec3;

constexpr double kHalfTangentPerPixel = 0.0015;  // a pixel turns the view by about 0.17 degrees
constexpr double kMaxUpness = 0.998;             // |cosine| between view and up vector: 3.6 degrees

dvec3 vector(const double (&v)[3]) { return {v[0], v[1], v[2]}; }
void store(const dvec3& v, double (&out)[3]) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }

struct Axes {
  dvec3 right, up, forward;  // up is Camera::up, not perpendicular to forward
  double distance;           // from eye to target
};

Axes axes_of(const Camera& camera) {
  Axes axes;
  const dvec3 to_target = vector(camera.target) - vector(camera.eye);
  axes.distance = length3(to_target);
  axes.forward = normalize3(to_target, dvec3(0, 0, -1));
  axes.up = normalize3(vector(camera.up), dvec3(0, 1, 0));
  axes.right = normalize3(cross3(axes.forward, axes.up), dvec3(1, 0, 0));
  return axes;
}

// Cosine and sine from the tangent of half the angle: a rotation without trigonometry, the same bits everywhere.
struct Rotation {
  double cosine, sine;
  explicit Rotation(double half_tangent) {
    const double square = half_tangent * half_tangent;
    cosine = (1 - square) / (1 + square);
    sine = 2 * half_tangent / (1 + square);
  }
};

}  // namespace

void FlyCamera::turn(double dx, double dy) {
  if (dx == 0 && dy == 0) return;
  const Axes axes = axes_of(camera_);
  // Rodrigues 1840, about the up vector; to the right is the negative sense.
  const Rotation yaw(-dx * kHalfTangentPerPixel);
  const auto yawed = [&](const dvec3& v) {
    return v * yaw.cosine + cross3(axes.up, v) * yaw.sine + axes.up * (dot3(axes.up, v) * (1 - yaw.cosine));
  };
  dvec3 forward = yawed(axes.forward);
  const dvec3 right = yawed(axes.right);
  const Rotation pitch(-dy * kHalfTangentPerPixel);
  const dvec3 pitched = normalize3(forward * pitch.cosine + cross3(right, forward) * pitch.sine, forward);
  const double before = std::fabs(dot3(forward, axes.up)), after = std::fabs(dot3(pitched, axes.up));
  if (after <= kMaxUpness || after < before) forward = pitched;
  store(vector(camera_.eye) + forward * axes.distance, camera_.target);
}

void FlyCamera::move(double right, double up, double forward) {
  if (right == 0 && up == 0 && forward == 0) return;
  const Axes axes = axes_of(camera_);
  const dvec3 step = axes.right * right + axes.up * up + axes.forward * forward;
  store(vector(camera_.eye) + step, camera_.eye);
  store(vector(camera_.target) + step, camera_.target);
}

void FlyCamera::place(const double (&eye)[3]) {
  for (int k = 0; k < 3; ++k) {
    camera_.target[k] += eye[k] - camera_.eye[k];
    camera_.eye[k] = eye[k];
  }
}

}  // namespace spanray::demo
