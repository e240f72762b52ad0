#include "scene/motion.h"

#include <cmath>

#include "math/elementary.h"
#include "math/vec.h"

namespace spanray {
namespace {

struct Quaternion {
  double w = 1, x = 0, y = 0, z = 0;
};

Quaternion rotation_about(const double axis[3], double degrees) {
  // Half the angle goes from 0 to 180: after a full turn, exactly where it began.
  const double turned = degrees - 360 * std::floor(degrees / 360);
  double sine, cosine;
  sin_cos(turned * (kPi / 360), &sine, &cosine);
  return {cosine, sine * axis[0], sine * axis[1], sine * axis[2]};
}

double mix(double a, double b, double weight) { return a + (b - a) * weight; }

// Source: Shoemake 1985, "Animating Rotation with Quaternion Curves".
Quaternion slerp(const Quaternion& a, const Quaternion& b, double weight) {
  const double dot = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
  const double sign = dot < 0 ? -1 : 1;
  double from = 1 - weight, to = weight * sign;
  if (dot * sign < 1 - 1e-9) {
    const double angle = acos_(dot * sign);
    double whole, part, rest, unused;
    sin_cos(angle, &whole, &unused);
    sin_cos(angle * (1 - weight), &rest, &unused);
    sin_cos(angle * weight, &part, &unused);
    from = rest / whole, to = part / whole * sign;
  }
  const Quaternion q{a.w * from + b.w * to, a.x * from + b.x * to, a.y * from + b.y * to, a.z * from + b.z * to};
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w / length, q.x / length, q.y / length, q.z / length};
}

// Rotation about `pivot`, then translation.
RigidPose make_pose(const Quaternion& q, const double pivot[3], const double translation[3]) {
  RigidPose pose;
  const double x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
  const double m[3][3] = {{1 - (q.y * y2 + q.z * z2), q.x * y2 - q.w * z2, q.x * z2 + q.w * y2},
                          {q.x * y2 + q.w * z2, 1 - (q.x * x2 + q.z * z2), q.y * z2 - q.w * x2},
                          {q.x * z2 - q.w * y2, q.y * z2 + q.w * x2, 1 - (q.x * x2 + q.y * y2)}};
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) pose.rotation[i][k] = m[i][k];
    const double turned = m[i][0] * pivot[0] + m[i][1] * pivot[1] + m[i][2] * pivot[2];
    pose.offset[i] = (pivot[i] - turned) + translation[i];
  }
  return pose;
}

// outer after inner
RigidPose carried(const RigidPose& outer, const RigidPose& inner) {
  RigidPose pose;
  for (int i = 0; i < 3; ++i) {
    const double* r = outer.rotation[i];
    for (int k = 0; k < 3; ++k) pose.rotation[i][k] = r[0] * inner.rotation[0][k] + r[1] * inner.rotation[1][k] + r[2] * inner.rotation[2][k];
    pose.offset[i] = (r[0] * inner.offset[0] + r[1] * inner.offset[1] + r[2] * inner.offset[2]) + outer.offset[i];
  }
  return pose;
}

RigidPose pose_between(const Motion& motion, const MotionKey& a, const MotionKey& b, double weight) {
  double translation[3];
  for (int k = 0; k < 3; ++k) translation[k] = mix(a.translation[k], b.translation[k], weight);
  // At 0 degrees any axis will do.
  const double* const axis = a.degrees == 0 ? b.axis : a.axis;
  const bool one_axis = a.degrees == 0 || b.degrees == 0 || (a.axis[0] == b.axis[0] && a.axis[1] == b.axis[1] && a.axis[2] == b.axis[2]);
  const Quaternion q = one_axis ? rotation_about(axis, mix(a.degrees, b.degrees, weight))
                                : slerp(rotation_about(a.axis, a.degrees), rotation_about(b.axis, b.degrees), weight);
  return make_pose(q, motion.pivot, translation);
}

RigidPose own_pose(const Motion& motion, double seconds) {
  constexpr double kNowhere[3] = {0, 0, 0};
  const std::vector<MotionKey>& keys = motion.keys;
  if (keys.empty()) return make_pose(rotation_about(motion.axis, motion.degrees_per_second * seconds), motion.pivot, kNowhere);
  double time = seconds;
  const double period = keys.back().time - keys.front().time;
  if (motion.repeat && period > 0) {
    const double turns = (time - keys.front().time) / period;
    time = keys.front().time + (turns - std::floor(turns)) * period;
  }
  if (!(time > keys.front().time)) return pose_between(motion, keys.front(), keys.front(), 0);
  if (!(time < keys.back().time)) return pose_between(motion, keys.back(), keys.back(), 0);
  size_t next = 1;
  while (keys[next].time <= time) ++next;
  const MotionKey &a = keys[next - 1], &b = keys[next];
  return pose_between(motion, a, b, (time - a.time) / (b.time - a.time));  // b.time > time >= a.time
}

}  // namespace

std::vector<RigidPose> poses_at(const std::vector<Motion>& motions, double seconds) {
  std::vector<RigidPose> poses;
  poses.reserve(motions.size());
  for (const Motion& motion : motions) {
    const RigidPose own = own_pose(motion, seconds);
    poses.push_back(motion.carrier < 0 ? own : carried(poses[static_cast<size_t>(motion.carrier)], own));
  }
  return poses;
}

}  // namespace spanray
