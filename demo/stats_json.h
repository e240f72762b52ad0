// The numbers of many frames as one JSON object (DESIGN 6).
#pragma once
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "frame_options.h"
#include "spanray/render.h"

namespace spanray::demo {

inline constexpr struct {
  const char* name;
  double StageTimes::*time;
} kStages[] = {{"transform", &StageTimes::transform},   {"clip", &StageTimes::clip},
               {"bin", &StageTimes::bin},               {"raster", &StageTimes::raster},
               {"shade", &StageTimes::shade},           {"shadow_rays", &StageTimes::shadow_rays},
               {"bounce_rays", &StageTimes::bounce_rays}, {"composite", &StageTimes::composite},
               {"encode", &StageTimes::encode},         {"frame", &StageTimes::frame},
               {"bvh_build", &StageTimes::bvh_build}};

// The median (mean of the two middle values) and the 95th percentile (nearest rank); 0 of nothing.
double median(std::vector<double> values);
double percentile_95(std::vector<double> values);

struct Measurement {
  int warmup = 0;
  std::vector<FrameStats> frames;     // after the warm-up
  std::vector<double> bvh_builds;     // milliseconds of each build, warm-up included: later frames need none
};

nlohmann::ordered_json stats_json(const Job& job, const Measurement& measured, uint64_t picture_hash);
nlohmann::ordered_json plan_json(const std::vector<PlanLine>& plan);

}  // namespace spanray::demo
