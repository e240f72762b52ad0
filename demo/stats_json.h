// The numbers of many frames as one JSON object (DESIGN 6).
#pragma once
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "job.h"
#include "spanray/render.h"
#include "stage_times.h"

namespace spanray::demo {

struct Measurement {
  int warmup = 0;
  std::vector<FrameStats> frames;     // after the warm-up
  std::vector<double> bvh_builds;     // milliseconds of each build, warm-up included: later frames need none
};

nlohmann::ordered_json stats_json(const Job& job, const Measurement& measured, uint64_t picture_hash);
nlohmann::ordered_json plan_json(const std::vector<PlanLine>& plan);

}  // namespace spanray::demo
