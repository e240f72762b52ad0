#include "scene/pose.h"

#include <algorithm>
#include <limits>

#include "core/fp_env.h"
#include "scene/scene_builder.h"

namespace spanray {
namespace {

template <class Bounds> Bounds no_bounds() {
  constexpr float inf = std::numeric_limits<float>::infinity();
  return {{inf, inf, inf}, {-inf, -inf, -inf}};
}

template <class Bounds> void add(Bounds& bounds, const float* lo, const float* hi) {
  for (int k = 0; k < 3; ++k) bounds.lo[k] = std::min(bounds.lo[k], lo[k]), bounds.hi[k] = std::max(bounds.hi[k], hi[k]);
}

float turned(const double* row, const float* v, double offset) {
  return static_cast<float>((row[0] * v[0] + row[1] * v[1] + row[2] * v[2]) + offset) + 0.0f;  // never -0: equal positions have equal bits
}

}  // namespace

PosedScene::PosedScene(const SceneData& rest) : rest_(rest), poses_(rest.motions.size()), still_(no_bounds<Bounds>()) {
  static_cast<SceneTables&>(data_) = rest;
  data_.motions.clear(), data_.moving_vertices.clear(), data_.moving_triangles.clear();
  data_.vertices = AlignedBuffer<Vertex>::copy(rest.vertices);
  data_.triangles = AlignedBuffer<Triangle>::copy(rest.triangles);
  data_.borrow_texels(rest);
  run_bounds_.assign(rest.moving_vertices.size(), no_bounds<Bounds>());
  size_t next = 0;
  const auto add_still = [&](size_t end) {
    for (; next < end; ++next) add(still_, rest.vertices[next].position, rest.vertices[next].position);
  };
  for (size_t r = 0; r < run_bounds_.size(); ++r) {
    const MovingRun& run = rest.moving_vertices[r];
    add_still(run.first);
    for (next = run.first; next < run.first + run.count; ++next) add(run_bounds_[r], rest.vertices[next].position, rest.vertices[next].position);
  }
  add_still(rest.vertices.size());
  for (const Sphere& s : rest.spheres) {
    float low[3], high[3];
    for (int k = 0; k < 3; ++k) low[k] = s.center[k] - s.radius, high[k] = s.center[k] + s.radius;
    add(still_, low, high);
  }
}

PosedScene::Bounds PosedScene::pose_vertices(const MovingRun& run, const RigidPose& pose) {
  Bounds bounds = no_bounds<Bounds>();
  for (uint32_t i = run.first; i < run.first + run.count; ++i) {
    const Vertex& from = rest_.vertices[i];
    Vertex& to = data_.vertices[i];
    for (int k = 0; k < 3; ++k) {
      to.position[k] = turned(pose.rotation[k], from.position, pose.offset[k]);
      to.normal[k] = turned(pose.rotation[k], from.normal, 0);
    }
    add(bounds, to.position, to.position);
  }
  return bounds;
}

bool PosedScene::pose(double seconds, Parallel& parallel) {
  const std::vector<RigidPose> poses = poses_at(rest_.motions, seconds);
  std::vector<bool> moved(poses.size());
  for (size_t m = 0; m < poses.size(); ++m) moved[m] = broken_off_ || !(poses[m] == poses_[m]);
  if (std::find(moved.begin(), moved.end(), true) == moved.end()) return false;
  broken_off_ = true;
  parallel.for_each(rest_.moving_vertices.size(), [&](size_t r, int) {
    const MovingRun& run = rest_.moving_vertices[r];
    if (moved[run.motion]) run_bounds_[r] = pose_vertices(run, poses[run.motion]);
  });
  parallel.for_each(rest_.moving_triangles.size(), [&](size_t r, int) {
    const MovingRun& run = rest_.moving_triangles[r];
    if (!moved[run.motion]) return;
    for (uint32_t t = run.first; t < run.first + run.count; ++t) {
      data_.triangles[t] = rest_.triangles[t];  // not the order of the last pose: among equal positions it would depend on the past
      order_vertices(data_.vertices, data_.triangles[t]);
    }
  });
  poses_ = poses, broken_off_ = false;
  if (data_.vertices.empty()) return true;
  Bounds all = still_;
  for (const Bounds& b : run_bounds_) add(all, b.lo, b.hi);
  for (int k = 0; k < 3; ++k) data_.bounds_min[k] = all.lo[k], data_.bounds_max[k] = all.hi[k];
  return true;
}

Scene scene_at(const Scene& scene, double seconds) {
  if (scene.data().motions.empty()) return scene;
  const FpEnvGuard guard;
  struct Kept {
    Scene rest;
    PosedScene posed;
  };
  const auto kept = std::make_shared<Kept>(Kept{scene, PosedScene(scene.data())});
  Parallel parallel(1);
  kept->posed.pose(seconds, parallel);
  return Scene(std::shared_ptr<const SceneData>(kept, &kept->posed.data()));
}

}  // namespace spanray
