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

// Where the median of all frames that could be measured lies, by those that were: between two of them, with 95 % confidence or
// more and whatever the distribution, if they are independent. Fewer than six values tell no more than their ends.
// Source: David & Nagaraja, Order Statistics, 2003, 7.1.
struct MedianInterval { double low = 0, high = 0; };
MedianInterval median_interval(std::vector<double> values);

}  // namespace spanray::demo
