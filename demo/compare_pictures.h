// The part of `compare` that is about pictures.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "metric_limit.h"

namespace spanray::demo {

struct CompareOptions {
  std::string a, b, diff, error_map, flip_map, mask, mask_map;
  int max = 0;               // a channel may differ by this much
  long long max_wrong = 0;   // so many pixels may differ by more
  bool count_wrong = false;  // the two were given
  long long max_outside = 0;  // so many pixels may be outside of the mask
  std::vector<MetricLimit> limits;

  // The files to write, with the options that named them.
  std::vector<std::pair<std::string, std::string>> written() const {
    std::vector<std::pair<std::string, std::string>> list;
    for (const auto& [option, file] :
         {std::pair{"--diff", &diff}, {"--error-map", &error_map}, {"--flip-map", &flip_map}, {"--mask-map", &mask_map}})
      if (!file->empty()) list.emplace_back(option, *file);
    return list;
  }
};

// Exit code. Throws UsageError.
int compare_pictures(const CompareOptions& options);

}  // namespace spanray::demo
