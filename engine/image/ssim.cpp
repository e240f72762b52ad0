#include "image/ssim.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace spanray {
namespace {

constexpr int kWindow = 11, kBandRows = 32, kMoments = 5;

std::vector<double> window_weights(int size) {
  std::vector<double> weights;
  double sum = 0;
  for (int i = 0; i < size; ++i) {
    const double x = (i - 0.5 * (size - 1)) / 1.5;
    weights.push_back(std::exp(-0.5 * x * x));
    sum += weights.back();
  }
  for (double& w : weights) w /= sum;
  return weights;
}

double luma(const Color3& c) { return 0.299 * c.x + 0.587 * c.y + 0.114 * c.z; }

double similarity(const double (&m)[kMoments]) {
  constexpr double kC1 = (0.01 * 255) * (0.01 * 255), kC2 = (0.03 * 255) * (0.03 * 255);
  const double variance_a = m[2] - m[0] * m[0], variance_b = m[3] - m[1] * m[1], covariance = m[4] - m[0] * m[1];
  return (2 * m[0] * m[1] + kC1) * (2 * covariance + kC2) /
         ((m[0] * m[0] + m[1] * m[1] + kC1) * (variance_a + variance_b + kC2));
}

}  // namespace

double mean_ssim(const PictureView& a, const PictureView& b, Parallel& parallel) {
  const std::vector<double> across = window_weights(std::min(kWindow, a.width)),
                            down = window_weights(std::min(kWindow, a.height));
  const int columns = a.width - static_cast<int>(across.size()) + 1, rows = a.height - static_cast<int>(down.size()) + 1;
  const size_t width = static_cast<size_t>(columns);
  std::vector<double> sum_of_row(static_cast<size_t>(rows));
  parallel.for_each(static_cast<size_t>((rows + kBandRows - 1) / kBandRows), [&](size_t band, int) {
    const int y0 = static_cast<int>(band) * kBandRows, y1 = std::min(y0 + kBandRows, rows),
              source_rows = y1 - y0 + static_cast<int>(down.size()) - 1;
    // Means of a, b, a a, b b and a b along each row, then down.
    std::vector<double> moment(static_cast<size_t>(source_rows) * width * kMoments);
    std::vector<double> value_a(static_cast<size_t>(a.width)), value_b(value_a.size());
    for (int y = 0; y < source_rows; ++y) {
      for (int x = 0; x < a.width; ++x)
        value_a[static_cast<size_t>(x)] = luma(a.code(x, y0 + y)), value_b[static_cast<size_t>(x)] = luma(b.code(x, y0 + y));
      for (size_t x = 0; x < width; ++x) {
        double* const m = moment.data() + (static_cast<size_t>(y) * width + x) * kMoments;
        for (size_t i = 0; i < across.size(); ++i) {
          const double w = across[i], p = value_a[x + i], q = value_b[x + i];
          m[0] += w * p, m[1] += w * q, m[2] += w * (p * p), m[3] += w * (q * q), m[4] += w * (p * q);
        }
      }
    }
    for (int y = y0; y < y1; ++y)
      for (size_t x = 0; x < width; ++x) {
        double m[kMoments] = {};
        for (size_t j = 0; j < down.size(); ++j)
          for (size_t k = 0; k < kMoments; ++k)
            m[k] += down[j] * moment[((static_cast<size_t>(y - y0) + j) * width + x) * kMoments + k];
        sum_of_row[static_cast<size_t>(y)] += similarity(m);
      }
  });
  double sum = 0;
  for (const double row : sum_of_row) sum += row;
  return sum / (static_cast<double>(columns) * static_cast<double>(rows));
}

}  // namespace spanray
