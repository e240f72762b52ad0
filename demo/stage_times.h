// The stages of a frame by name, and what is typical of many frames.
#pragma once
#include <vector>

#include "spanray/stats.h"

namespace spanray::demo {

inline constexpr struct {
  const char* name;
  double StageTimes::*time;
} kStages[] = {{"pose", &StageTimes::pose},             {"bvh_refit", &StageTimes::bvh_refit},
               {"transform", &StageTimes::transform},   {"clip", &StageTimes::clip},
               {"bin", &StageTimes::bin},               {"raster", &StageTimes::raster},
               {"shade", &StageTimes::shade},           {"shadow_rays", &StageTimes::shadow_rays},
               {"bounce_rays", &StageTimes::bounce_rays}, {"composite", &StageTimes::composite},
               {"encode", &StageTimes::encode},         {"frame", &StageTimes::frame},
               {"bvh_build", &StageTimes::bvh_build}};

// The median (mean of the two middle values) and the 95th percentile (nearest rank); 0 of nothing.
double median(std::vector<double> values);
double percentile_95(std::vector<double> values);

}  // namespace spanray::demo
