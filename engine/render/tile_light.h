// Lighting of one batch of surfaces inside a tile, and the stage clock.
#pragma once
#include <chrono>

#include "render/tile.h"

namespace spanray {

// Adds the time of a scope to one stage of a worker.
class StageTimer {
 public:
  StageTimer(TileWorker& worker, TileStage stage)
      : seconds_(worker.seconds[static_cast<size_t>(stage)]), start_(std::chrono::steady_clock::now()) {}
  ~StageTimer() { seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  double& seconds_;
  std::chrono::steady_clock::time_point start_;
};

// worker.radiance = ambient + emission + every light in index order, each with its shadow bits.
void light_surfaces(const FrameJob& job, TileWorker& worker, const SurfaceBatch& surfaces, const HitBatch& hits, bool primary);

}  // namespace spanray
