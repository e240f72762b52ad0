// A scene as it stands at a time.
#pragma once
#include "core/parallel.h"
#include "scene/scene_data.h"
#include "spanray/scene.h"

namespace spanray {

// Vertices and triangles of a scene with moving parts, posed again for each frame; textures stay those of the scene at rest. What
// it holds is a function of scene and time, whatever was posed before: every promise of SceneData is kept (bounds, order of vertices),
// but that normals have length 1 within 4e-7 and positions may lie up to 1e31 out.
class PosedScene {
 public:
  // Standing as at rest. `rest` must outlive it.
  explicit PosedScene(const SceneData& rest);
  // Without motions of its own: a scene like any other.
  const SceneData& data() const { return data_; }
  // False if no part stands elsewhere than before. Each vertex is rounded once, from double.
  bool pose(double seconds, Parallel& parallel);
  size_t memory_bytes() const { return data_.vertices.bytes() + data_.triangles.bytes(); }

 private:
  struct Bounds { float lo[3], hi[3]; };
  Bounds pose_vertices(const MovingRun& run, const RigidPose& pose);

  const SceneData& rest_;
  SceneData data_;
  std::vector<RigidPose> poses_;     // of each motion
  bool broken_off_ = false;          // the last posing ended in the middle, by an exception
  Bounds still_;                     // of all vertices that never move
  std::vector<Bounds> run_bounds_;   // of the runs of moving vertices
};

}  // namespace spanray
