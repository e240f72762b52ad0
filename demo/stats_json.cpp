#include "stats_json.h"

#include "command.h"
#include "core/hash.h"

namespace spanray::demo {

using Json = nlohmann::ordered_json;

Json plan_json(const std::vector<PlanLine>& plan) {
  Json lines = Json::array();
  for (const PlanLine& line : plan) lines.push_back({{"stage", line.stage}, {"needed", line.needed}, {"reason", line.reason}});
  return lines;
}

Json stats_json(const Job& job, const Measurement& measured, uint64_t picture_hash) {
  Json out;
  for (const auto& stage : kStages) {
    std::vector<double> values;
    for (const FrameStats& frame : measured.frames) values.push_back(frame.ms.*stage.time);
    // A tree is built once, in the first frame: a median over all frames would hide what it costs.
    if (stage.time == &StageTimes::bvh_build) values = measured.bvh_builds;
    out["median_ms"][stage.name] = median(values);
    out["p95_ms"][stage.name] = percentile_95(values);
  }
  const FrameStats& last = measured.frames.back();
  out["counts"] = Json::object();
  for (const auto& [name, value] : last.counts) out["counts"][name] = value;
  for (const LaneOccupancy& l : last.lanes) {
    const double share = l.computed > 0 ? static_cast<double>(l.used) / static_cast<double>(l.computed) : 0;
    out["lane_occupancy"][l.kernel] = {{"computed", l.computed}, {"used", l.used}, {"share", share}};
  }
  // Of all measured frames: how often trees followed moving parts by a refit, and how often they were built anew.
  uint64_t refits = 0, rebuilds = 0;
  for (const FrameStats& frame : measured.frames)
    for (const auto& [name, value] : frame.counts)
      if (name == "bvh_refits") refits += value;
      else if (name == "bvh_rebuilds") rebuilds += value;
  out["trees"] = {{"refits", refits}, {"rebuilds", rebuilds}, {"light_grid_build_ms", last.ms.light_grid_build}};
  out["memory_bytes"] = last.memory_bytes;
  out["isa"] = last.isa;
  out["threads"] = last.threads;
  out["compiler"] = compiler_name();
  out["numeric_contract"] = kNumericContract;
  out["version"] = SPANRAY_VERSION;
  out["hash"] = hash_text(picture_hash);
  out["scene_hash"] = hash_text(job.scene.hash());
  out["size"] = {job.settings.width, job.settings.height};
  out["frames"] = measured.frames.size();
  out["warmup"] = measured.warmup;
  out["camera"] = camera_text(job.camera);
  for (const auto& [key, value] : settings_words(job.settings)) out["settings"][key] = value;
  out["plan"] = plan_json(plan_frame(job.scene, job.settings));
  out["warnings"] = last.warnings;
  return out;
}

}  // namespace spanray::demo
