#include "stage_times.h"

#include <algorithm>
#include <cmath>

namespace spanray::demo {

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

double percentile_95(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[(values.size() * 95 + 99) / 100 - 1];
}

MedianInterval median_interval(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const double n = static_cast<double>(values.size());
  size_t rank = 0;  // the greatest with P(fewer values than rank are below the median) <= 2.5 %, binomial with p = 1/2
  double log_term = -n * std::log(2.0), sum = std::exp(log_term);
  while (sum <= 0.025) {
    ++rank;
    log_term += std::log((n - static_cast<double>(rank) + 1) / static_cast<double>(rank));
    sum += std::exp(log_term);
  }
  rank = std::max<size_t>(rank, 1);
  return {values[rank - 1], values[values.size() - rank]};
}

}  // namespace spanray::demo
