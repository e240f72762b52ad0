// Speed against error of many settings of one scene: measured in turns, judged by the ground truth.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "image/metrics.h"
#include "job.h"
#include "knobs.h"
#include "pareto.h"
#include "stage_times.h"

namespace spanray::demo {

// `report` and `tune` render some thirty settings, and the ground truth with sixteen samples: smaller pictures than those of one frame are
// their default.
inline constexpr int kReportWidth = 640, kReportHeight = 360;

struct Measured {
  Candidate candidate;
  std::vector<FrameStats> frames;  // after the warm-up
  double bvh_build_ms = 0;         // once a scene, not part of a frame
  Image picture;
  Metrics error;  // against the ground truth, of the bytes
  MetricMaps maps;
  // Pixels whose center sees another triangle than the reference says. Only with one sample a pixel.
  std::optional<uint64_t> wrong_ids;
  // Against the reference with one sample at each center: what the techniques err, aliasing left out. Only with one sample a
  // pixel.
  std::optional<Metrics> error_alone;
  double median_ms(double StageTimes::*stage = &StageTimes::frame) const;
  double p95_ms(double StageTimes::*stage = &StageTimes::frame) const;
  MedianInterval interval_ms() const;  // of the median frame
};

struct TradeOptions {
  int frames = 30, warmup = 2;  // of each setting
  int grid = 4;                 // the ground truth has grid x grid samples a pixel
  std::function<void(const char* what, double fraction)> progress = {};
};

struct Trade {
  Image truth, truth_center;  // the references: of all samples; of one at each center
  Metrics truth_error;        // of the truth itself (truth.h)
  double truth_seconds = 0;   // of all references
  std::vector<Measured> settings;  // in order of the candidates
};

// The settings take turns, five frames each after one that is not measured, so that whatever else the machine does falls on
// all alike. Errors: of the renderer and of the reference.
Result<Trade> measure_trade(const Job& job, const std::vector<Knob>& knobs, const std::vector<Candidate>& candidates,
                            const TradeOptions& options);

}  // namespace spanray::demo
