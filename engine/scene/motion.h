// How parts of a scene move: rigid motions in time.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace spanray {

struct MotionKey {
  double time;            // seconds
  double translation[3];
  double axis[3];         // unit length
  double degrees;         // counter-clockwise seen from the tip of the axis, about the motion's pivot
};

// Rotates a part about `pivot`, then translates it: at a constant speed, or by keys. Between two keys translation and angle change
// linearly; where the axes differ, the rotation goes the shortest way from one to the other at a constant speed. Before the first
// key and after the last, the part rests.
struct Motion {
  std::string part;                // name of an object or a group of the OBJ
  int32_t carrier = -1;            // index of a motion before this one that carries this part along; -1: none
  double pivot[3] = {0, 0, 0};     // as the file places the part
  double axis[3] = {0, 1, 0};      // unit length
  double degrees_per_second = 0;   // about axis, 0 degrees at time 0; only without keys
  std::vector<MotionKey> keys;     // times increase
  bool repeat = false;             // the keys, again and again: the last one is the first one once more
};

// p -> rotation * p + offset
struct RigidPose {
  double rotation[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  double offset[3] = {0, 0, 0};
  bool operator==(const RigidPose&) const = default;
};

// The pose of every motion at a time, carriers included, in double without libm: the same bits on every machine. A motion that is
// at 0 degrees and translation 0 gives exactly the identity. |seconds| <= kMostSeconds.
std::vector<RigidPose> poses_at(const std::vector<Motion>& motions, double seconds);

}  // namespace spanray
