// How long a worker spends in each stage of a tile.
#pragma once
#include <array>
#include <chrono>

namespace spanray {

enum class TileStage { kRaster, kShade, kShadowRays, kBounceRays, kComposite, kEncode };
inline constexpr int kTileStageCount = 6;

// One stage at a time; it lasts until the next is entered. Reading the clock takes as long as shading some pixels: once a change.
class StageClock {
 public:
  void reset() { *this = {}; }  // an exception may have left it running
  // Returns the stage that ends.
  TileStage enter(TileStage stage) {
    const TileStage before = stage_;
    if (running_ && before == stage) return before;
    const auto now = std::chrono::steady_clock::now();
    if (running_) add(now);
    running_ = true, stage_ = stage, start_ = now;
    return before;
  }
  void stop() {
    if (running_) add(std::chrono::steady_clock::now());
    running_ = false;
  }
  double seconds(size_t stage) const { return seconds_[stage]; }

 private:
  void add(std::chrono::steady_clock::time_point now) {
    seconds_[static_cast<size_t>(stage_)] += std::chrono::duration<double>(now - start_).count();
  }
  std::array<double, kTileStageCount> seconds_{};
  std::chrono::steady_clock::time_point start_;
  TileStage stage_ = TileStage::kRaster;
  bool running_ = false;
};

}  // namespace spanray
