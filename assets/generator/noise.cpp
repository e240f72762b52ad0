#include "noise.h"

#include <cmath>

#include "core/hash.h"

namespace spanray::assets {
namespace {

int64_t wrap(int64_t i, int period) {
  const int64_t r = i % period;
  return r < 0 ? r + period : r;
}

}  // namespace

double random_unit(int64_t x, int64_t y, uint32_t seed) {
  const uint64_t key = static_cast<uint64_t>(x) * 0x9e3779b97f4a7c15ull + static_cast<uint64_t>(y) * 0xc2b2ae3d27d4eb4full + seed;
  return static_cast<double>(mix64(mix64(key)) >> 11) / 9007199254740992.0;  // 53 bits
}

double smooth_step(double low, double high, double x) {
  double t = (x - low) / (high - low);
  t = t < 0 ? 0 : t > 1 ? 1 : t;
  return t * t * (3 - 2 * t);
}

double mix(double a, double b, double t) { return a + (b - a) * t; }

double gradient_noise(double x, double y, int period_x, int period_y, uint32_t seed) {
  // Sixteen directions: multiples of 22.5 degrees, to four digits.
  static constexpr double kX[16] = {1, 0.9239, 0.7071, 0.3827, 0, -0.3827, -0.7071, -0.9239, -1, -0.9239, -0.7071, -0.3827, 0, 0.3827, 0.7071, 0.9239};
  const double fx = std::floor(x), fy = std::floor(y);
  const double dx = x - fx, dy = y - fy;
  double corner[2][2];
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const int64_t cx = wrap(static_cast<int64_t>(fx) + i, period_x), cy = wrap(static_cast<int64_t>(fy) + j, period_y);
      const int k = static_cast<int>(random_unit(cx, cy, seed) * 16);
      corner[j][i] = kX[k] * (dx - i) + kX[(k + 12) & 15] * (dy - j);
    }
  }
  const double u = dx * dx * dx * (dx * (dx * 6 - 15) + 10), v = dy * dy * dy * (dy * (dy * 6 - 15) + 10);
  return 1.5 * mix(mix(corner[0][0], corner[0][1], u), mix(corner[1][0], corner[1][1], u), v);
}

double fractal_noise(double x, double y, int period_x, int period_y, int octaves, uint32_t seed) {
  double sum = 0, weight = 0.5;
  for (int k = 0; k < octaves; ++k) {
    sum += weight * gradient_noise(x, y, period_x, period_y, seed + static_cast<uint32_t>(k) * 101);
    x *= 2, y *= 2, period_x *= 2, period_y *= 2, weight *= 0.5;
  }
  return sum;
}

Cell cell_noise(double x, double y, int period, uint32_t seed) {
  const int64_t fx = static_cast<int64_t>(std::floor(x)), fy = static_cast<int64_t>(std::floor(y));
  Cell best{1e9, 1e9, 0};
  for (int64_t j = fy - 1; j <= fy + 1; ++j) {
    for (int64_t i = fx - 1; i <= fx + 1; ++i) {
      const int64_t cx = wrap(i, period), cy = wrap(j, period);
      const double px = static_cast<double>(i) + random_unit(cx, cy, seed) - x;
      const double py = static_cast<double>(j) + random_unit(cx, cy, seed + 7) - y;
      const double d = std::sqrt(px * px + py * py);
      if (d < best.nearest) {
        best.second = best.nearest, best.nearest = d, best.id = random_unit(cx, cy, seed + 13);
      } else if (d < best.second) {
        best.second = d;
      }
    }
  }
  return best;
}

}  // namespace spanray::assets
