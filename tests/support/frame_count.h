// A count of a frame, by its name.
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "spanray/stats.h"

namespace spanray {

// Fails the test if there is none of that name.
inline uint64_t count(const FrameStats& stats, const std::string& name) {
  for (const auto& [key, value] : stats.counts)
    if (key == name) return value;
  ADD_FAILURE() << name;
  return 0;
}

}  // namespace spanray
