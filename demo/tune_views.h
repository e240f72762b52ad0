// What `tune` measures settings on: views of a scene, each with its ground truth.
#pragma once
#include <vector>

#include "image/metrics.h"
#include "pareto.h"
#include "truth.h"

namespace spanray::demo {

struct TunedView {
  Camera camera;
  Truth truth;
};

// Less is better, whatever the metric: those of which more is better change their sign.
inline double as_error(const MetricWord& metric, double value) { return metric.more_is_better ? -value : value; }

// `count` views spread over the scene's camera path; without a path, or where path_wanted is false, the job's own. Without
// truths yet.
std::vector<TunedView> find_views(const Job& job, int count, bool path_wanted);
Result<void> make_truths(const Job& job, const Settings& exact, int grid, std::vector<TunedView>& views,
                         const TruthProgress& progress);

// The largest of the truths' own errors.
double truth_error(const std::vector<TunedView>& views, const MetricWord& metric);

// The median time of the view where the settings are slowest, and the error of that where they err most.
Result<Cost> measure_settings(const Job& job, const std::vector<TunedView>& views, const Settings& settings,
                              const MetricWord& metric, int frames);

// Times of several settings beside each other, in turns of five frames after one that is not counted: of the slowest view of
// each.
struct Timed {
  double median_ms = 0, p95_ms = 0;
};
Result<std::vector<Timed>> time_in_turns(const Job& job, const std::vector<TunedView>& views,
                                         const std::vector<Settings>& settings, int frames, const TruthProgress& progress);

}  // namespace spanray::demo
