// Bounds on metrics as the command line gives them: METRIC=VALUE.
#pragma once
#include <string>

#include "image/metrics.h"

namespace spanray::demo {

struct MetricLimit {
  const MetricWord* metric = nullptr;
  double value = 0;  // the most that is allowed; the least where more is better
  bool kept(const Metrics& m) const { return metric->more_is_better ? m.*metric->value >= value : m.*metric->value <= value; }
};

// "max|p99.9|...|flip"
std::string metric_choices();
// The metric of that name, whatever its case; nullptr if there is none.
const MetricWord* metric_from_text(const std::string& name);
// Throws CLI::ValidationError for what is no metric, or no number.
MetricLimit parse_metric_limit(const std::string& text);

}  // namespace spanray::demo
