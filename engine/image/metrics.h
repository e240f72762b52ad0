// How far two pictures are apart: numbers, and a picture of it.
#pragma once
#include <cstdint>

#include "spanray/image.h"

namespace spanray {

struct ImageDifference {
  int max = 0;                 // largest difference of a channel, alpha included, 0 to 255
  double rmse = 0;             // root mean square over R, G, B of all pixels, 0 to 255
  double psnr_db = 0;          // 20 log10(255 / rmse); infinity where rmse is 0
  uint64_t wrong_pixels = 0;   // pixels with any channel different, alpha included
  uint64_t pixels_over_1 = 0;  // pixels with a channel more than 1 apart
  int x = -1, y = -1;          // the first pixel, row by row, that has the largest difference; -1 where there is none
};

// Errors: sizes differ; bytes and size of a picture disagree.
Result<ImageDifference> compare_images(const Image& a, const Image& b);

// Equal pixels: the picture `a` in dark gray, for orientation. Others: each channel min(255, 56 + 8 d) for a difference d > 0, so
// that one step is seen; opaque. Where only one picture has a pixel (sizes differ): magenta. Pictures must be consistent.
Image difference_picture(const Image& a, const Image& b);

}  // namespace spanray
