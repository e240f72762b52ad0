// How far two pictures are apart: numbers, and a picture of it.
#pragma once
#include <cstdint>
#include <vector>

#include "core/parallel.h"
#include "image/picture_view.h"
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

// How far a picture is from a reference. Codes are sRGB-encoded, 0 to 255, not rounded where the picture is not.
struct Metrics {
  double max = 0;          // largest difference of a channel, codes
  double p99_9 = 0;        // of 99.9 % of the pixels, the largest difference of a channel is at most this, codes
  double over_1 = 0;       // share of the pixels with a channel off by more than 1 code, 0 to 1
  double rmse_linear = 0;  // root mean square over R, G, B in linear light, 1 = white
  double relmse = 0;       // mean over R, G, B of (difference / reference)^2 in linear light, with 0.01 added to the divisor's square
  double psnr_db = 0;      // 20 log10(255 / root mean square of codes); infinity for equal pictures
  double ssim = 1;         // image/ssim.h
  double flip = 0;         // mean of image/flip.h
};

// The metrics by name: for messages, options and tables.
struct MetricWord {
  const char* name;
  double Metrics::*value;
  bool more_is_better;
  const char* unit;
  double low, high;  // what it can be
};
inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();
inline constexpr MetricWord kMetricWords[] = {{"max", &Metrics::max, false, "of 255", 0, 255},
                                              {"p99.9", &Metrics::p99_9, false, "of 255", 0, 255},
                                              {"over_1", &Metrics::over_1, false, "share of pixels", 0, 1},
                                              {"rmse_linear", &Metrics::rmse_linear, false, "1 = white", 0, kUnbounded},
                                              {"relmse", &Metrics::relmse, false, "", 0, kUnbounded},
                                              {"psnr_db", &Metrics::psnr_db, true, "dB", 0, kUnbounded},
                                              {"ssim", &Metrics::ssim, true, "", -1, 1},
                                              {"flip", &Metrics::flip, false, "", 0, 1}};

// What the metrics are means of, a value a pixel: the largest difference of a channel in codes, and FLIP.
struct MetricMaps { std::vector<float> difference, flip; };

// Errors: sizes differ; no pixel; storage and size disagree; a value that is not finite, with its pixel.
Result<Metrics> measure_pictures(const PictureView& reference, const PictureView& picture, Parallel& parallel, MetricMaps* maps = nullptr);

}  // namespace spanray
