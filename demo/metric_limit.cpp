#include "metric_limit.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include <CLI/CLI.hpp>

#include "core/number_text.h"
#include "spanray/settings_text.h"

namespace spanray::demo {

std::string metric_choices() {
  std::string text;
  for (const MetricWord& word : kMetricWords) text += (text.empty() ? "" : "|") + std::string(word.name);
  return text;
}

const MetricWord* metric_from_text(const std::string& name) {
  std::string lower = name;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const MetricWord& word : kMetricWords)
    if (lower == word.name) return &word;
  return nullptr;
}

MetricLimit parse_metric_limit(const std::string& text) {
  const size_t equals = std::min(text.find('='), text.size());
  const std::string name = text.substr(0, equals);
  MetricLimit limit;
  limit.metric = metric_from_text(name);
  if (limit.metric == nullptr) {
    std::vector<std::string> known;
    for (const MetricWord& word : kMetricWords) known.emplace_back(word.name);
    throw CLI::ValidationError("--max-error", "'" + name + "' is not one of " + metric_choices() + did_you_mean(name, known));
  }
  const char *begin = text.data() + std::min(equals + 1, text.size()), *end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(begin, end, limit.value);
  if (begin == end || error != std::errc() || stop != end || !std::isfinite(limit.value))
    throw CLI::ValidationError("--max-error", "'" + text + "' is not METRIC=VALUE with a number, such as flip=0.02");
  if (limit.value < limit.metric->low || limit.value > limit.metric->high)
    throw CLI::ValidationError("--max-error", "'" + text + "': " + name + " is " + number_text(limit.metric->low) +
                               (limit.metric->high == kUnbounded ? " or more" : " to " + number_text(limit.metric->high)));
  return limit;
}

}  // namespace spanray::demo
