#include "image/metrics.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "image/flip.h"
#include "image/ssim.h"
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

double psnr_of(double rmse) {
  constexpr double kDecibelsPerOctave = 6.020599913279624;  // 20 log10(2)
  return rmse == 0 ? std::numeric_limits<double>::infinity() : kDecibelsPerOctave * log2_(255 / rmse);
}

std::string size_text(int width, int height) { return std::to_string(width) + " x " + std::to_string(height); }

Result<void> check_comparable(const PictureView& a, const PictureView& b) {
  if (!a.consistent() || !b.consistent()) return Error{"cannot compare: the size and the values of a picture disagree"};
  if (a.width != b.width || a.height != b.height)
    return Error{"cannot compare: " + size_text(a.width, a.height) + " pixels against " + size_text(b.width, b.height)};
  if (a.width == 0 || a.height == 0) return Error{"cannot compare: the pictures have no pixel"};
  for (const PictureView* picture : {&a, &b})
    for (int y = 0; y < a.height; ++y)
      for (int x = 0; x < a.width; ++x) {
        const Color3 c = picture->linear(x, y);
        if (!std::isfinite(c.x + c.y + c.z))
          return Error{"cannot compare: pixel " + std::to_string(x) + "," + std::to_string(y) + " of the " +
                       (picture == &a ? "first" : "second") + " picture is not finite"};
      }
  return {};
}

// Sums of one row: rows are added in order, so that threads change nothing.
struct RowSums { double code_squares = 0, linear_squares = 0, relative_squares = 0; };

RowSums sum_row(const PictureView& reference, const PictureView& picture, int y, float* largest) {
  constexpr double kFloor = 0.01;  // keeps black from counting without bound (Rousselle, Knaus, Zwicker 2011)
  RowSums sums;
  for (int x = 0; x < reference.width; ++x) {
    const Color3 code1 = reference.code(x, y), code2 = picture.code(x, y), linear1 = reference.linear(x, y), linear2 = picture.linear(x, y);
    double most = 0;
    for (double Color3::*c : {&Color3::x, &Color3::y, &Color3::z}) {
      const double d = code1.*c - code2.*c, e = linear1.*c - linear2.*c, r = linear1.*c;
      most = std::max(most, std::fabs(d));
      sums.code_squares += d * d, sums.linear_squares += e * e, sums.relative_squares += e * e / (r * r + kFloor);
    }
    largest[x] = static_cast<float>(most);
  }
  return sums;
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
  difference.psnr_db = psnr_of(difference.rmse);
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

Result<Metrics> measure_pictures(const PictureView& reference, const PictureView& picture, Parallel& parallel, MetricMaps* maps) {
  if (Result<void> comparable = check_comparable(reference, picture); !comparable) return comparable.error();
  const size_t width = static_cast<size_t>(reference.width), height = static_cast<size_t>(reference.height), pixels = width * height;
  std::vector<float> difference(pixels);
  std::vector<RowSums> rows(height);
  parallel.for_each(height, [&](size_t y, int) { rows[y] = sum_row(reference, picture, static_cast<int>(y), difference.data() + y * width); });
  RowSums sums;
  for (const RowSums& row : rows)
    sums.code_squares += row.code_squares, sums.linear_squares += row.linear_squares, sums.relative_squares += row.relative_squares;

  Metrics m;
  const double samples = 3.0 * static_cast<double>(pixels);
  m.max = *std::max_element(difference.begin(), difference.end());
  m.over_1 = static_cast<double>(std::count_if(difference.begin(), difference.end(), [](float d) { return d > 1; })) / static_cast<double>(pixels);
  m.rmse_linear = std::sqrt(sums.linear_squares / samples);
  m.relmse = sums.relative_squares / samples;
  m.psnr_db = psnr_of(std::sqrt(sums.code_squares / samples));
  m.ssim = mean_ssim(reference, picture, parallel);
  std::vector<float> flip = flip_map(reference, picture, parallel);
  double flip_sum = 0;
  for (const float f : flip) flip_sum += f;
  m.flip = flip_sum / static_cast<double>(pixels);
  if (maps != nullptr) maps->difference = difference, maps->flip = std::move(flip);
  // Nearest rank: the least value that 99.9 % of the pixels do not exceed.
  const auto rank = difference.begin() + static_cast<std::ptrdiff_t>((pixels * 999 + 999) / 1000 - 1);
  std::nth_element(difference.begin(), rank, difference.end());
  m.p99_9 = *rank;
  return m;
}

}  // namespace spanray
