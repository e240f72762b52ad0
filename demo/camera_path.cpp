#include "camera_path.h"

namespace spanray::demo {

Camera camera_at(const std::vector<CameraKey>& keys, double time) {
  if (!(time > keys.front().time)) return keys.front().camera;
  if (time >= keys.back().time) return keys.back().camera;
  size_t next = 1;
  while (keys[next].time <= time) ++next;
  const CameraKey &a = keys[next - 1], &b = keys[next];
  const double weight = (time - a.time) / (b.time - a.time);  // b.time > time >= a.time
  const auto mix = [weight](double from, double to) { return from + (to - from) * weight; };
  Camera camera = a.camera;
  for (int k = 0; k < 3; ++k) {
    camera.eye[k] = mix(a.camera.eye[k], b.camera.eye[k]);
    camera.target[k] = mix(a.camera.target[k], b.camera.target[k]);
    camera.up[k] = mix(a.camera.up[k], b.camera.up[k]);
  }
  camera.fov_y_degrees = mix(a.camera.fov_y_degrees, b.camera.fov_y_degrees);
  camera.near_plane = mix(a.camera.near_plane, b.camera.near_plane);
  return camera;
}

double time_of_frame(const std::vector<CameraKey>& keys, int index, int count) {
  const double first = keys.front().time, length = keys.back().time - first;
  return count > 1 ? first + length * index / (count - 1) : first;
}

}  // namespace spanray::demo
