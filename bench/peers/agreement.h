// Do two pictures show the same? Only then is their time worth comparing.
#pragma once
#include <cstdint>
#include <vector>

#include "spanray/image.h"

namespace spanray::peers {

struct Agreement {
  static constexpr int kTolerance = 2;       // of 255, every channel
  static constexpr double kEnough = 0.999;   // of the pixels that both cover
  uint64_t both = 0, only_ours = 0, only_theirs = 0;  // pixels covered
  uint64_t agreeing = 0;                     // of both
  uint64_t by_difference[256] = {};          // of both, by largest channel difference

  double share() const { return both == 0 ? 0 : static_cast<double>(agreeing) / static_cast<double>(both); }
  bool counts() const { return share() >= kEnough; }
};

// Depths: 0 where nothing covers the pixel. All four have the same size.
Agreement compare_pictures(const Image& ours, const std::vector<float>& our_depth, const Image& theirs,
                           const std::vector<float>& their_depth);

// Gray where the two agree, red by difference where they do not, blue where only one covers.
Image difference_picture(const Image& ours, const std::vector<float>& our_depth, const Image& theirs,
                         const std::vector<float>& their_depth);

}  // namespace spanray::peers
