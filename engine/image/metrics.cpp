#include "image/metrics.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "math/elementary.h"

namespace spanray {
namespace {

bool consistent(const Image& image) {
  return image.width >= 0 && image.height >= 0 &&
         image.rgba.size() == 4 * static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
}

const uint8_t* pixel(const Image& image, int x, int y) {
  return image.rgba.data() + 4 * (static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x));
}

void paint_difference(const uint8_t* a, const uint8_t* b, uint8_t* out) {
  if (std::equal(a, a + 4, b)) {
    out[0] = out[1] = out[2] = static_cast<uint8_t>((a[0] + 2 * a[1] + a[2]) / 24);
    return;
  }
  const int alpha = std::abs(a[3] - b[3]);
  for (int k = 0; k < 3; ++k) {
    const int d = std::max(std::abs(a[k] - b[k]), alpha);
    out[k] = static_cast<uint8_t>(d == 0 ? 0 : std::min(255, 56 + 8 * d));
  }
}

}  // namespace

Result<ImageDifference> compare_images(const Image& a, const Image& b) {
  if (!consistent(a) || !consistent(b)) return Error{"cannot compare: the size and the bytes of a picture disagree"};
  if (a.width != b.width || a.height != b.height)
    return Error{"cannot compare: " + std::to_string(a.width) + " x " + std::to_string(a.height) + " pixels against " +
                 std::to_string(b.width) + " x " + std::to_string(b.height)};
  ImageDifference difference;
  uint64_t squares = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const uint8_t *p = pixel(a, x, y), *q = pixel(b, x, y);
      int largest = 0;
      for (int k = 0; k < 4; ++k) {
        const int d = std::abs(p[k] - q[k]);
        largest = std::max(largest, d);
        if (k < 3) squares += static_cast<uint64_t>(d * d);
      }
      difference.wrong_pixels += largest > 0;
      difference.pixels_over_1 += largest > 1;
      if (largest > difference.max) difference.max = largest, difference.x = x, difference.y = y;
    }
  const double samples = 3.0 * a.width * a.height;
  difference.rmse = samples > 0 ? std::sqrt(static_cast<double>(squares) / samples) : 0;
  constexpr double kDecibelsPerOctave = 6.020599913279624;  // 20 log10(2)
  difference.psnr_db = squares == 0 ? std::numeric_limits<double>::infinity() : kDecibelsPerOctave * log2_(255 / difference.rmse);
  return difference;
}

Image difference_picture(const Image& a, const Image& b) {
  Image out;
  out.width = std::max(a.width, b.width);
  out.height = std::max(a.height, b.height);
  out.rgba.resize(4 * static_cast<size_t>(out.width) * static_cast<size_t>(out.height));
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      uint8_t* o = out.rgba.data() + 4 * (static_cast<size_t>(y) * static_cast<size_t>(out.width) + static_cast<size_t>(x));
      o[3] = 255;
      if (x < std::min(a.width, b.width) && y < std::min(a.height, b.height))
        paint_difference(pixel(a, x, y), pixel(b, x, y), o);
      else
        o[0] = 255, o[1] = 0, o[2] = 255;
    }
  return out;
}

}  // namespace spanray
