// Ambiguity masks as files, and pictures judged by them.
#pragma once
#include <string>

#include "frame/ambiguity_mask.h"
#include "image/picture_view.h"
#include "spanray/result.h"

namespace spanray {

// A PFM picture of twice the height: the upper half is `least`, the lower one `greatest`. Errors: as of files; a mask whose
// size and values disagree; a height over 8192, since PFM pictures of 16384 rows are the highest that are read.
Result<void> write_mask(const std::string& path, const AmbiguityMask& mask);
// Errors: those of read_pfm; an odd height; a value outside of [0, 255] or not a number; a least color above the greatest, with
// the pixel.
Result<AmbiguityMask> read_mask(const std::string& path);

struct MaskDifference {
  struct Pixel {
    int x = 0, y = 0, channel = 0;
    double code = 0, least = 0, greatest = 0;  // of the channel that is farthest outside
  };
  uint64_t outside = 0;       // pixels of which a channel is
  double worst[3] = {};       // codes outside, by channel
  std::vector<Pixel> first;   // row by row, at most kMostListed
  std::vector<float> excess;  // a value a pixel: codes outside, of the worst channel; 0: inside
  static constexpr size_t kMostListed = 5;
};
// Errors: sizes differ.
Result<MaskDifference> compare_with_mask(const PictureView& picture, const AmbiguityMask& mask);

// How much the mask leaves open: of the widest channel of each pixel, codes.
std::vector<float> mask_widths(const AmbiguityMask& mask);
// Share of the pixels whose widest channel is wider than this, 0 to 1.
double share_wider(const AmbiguityMask& mask, double codes);

}  // namespace spanray
