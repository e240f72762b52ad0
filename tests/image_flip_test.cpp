// FLIP: its steps against published values, the whole against the paper's formulas as sums over the plane.
#include <gtest/gtest.h>

#include <cmath>

#include "image/flip.h"
#include "support/random.h"

namespace spanray {
namespace {

Image plain(int width, int height, uint8_t r, uint8_t g, uint8_t b) {
  Image image{width, height, {}};
  for (int i = 0; i < width * height; ++i) image.rgba.insert(image.rgba.end(), {r, g, b, 255});
  return image;
}

Image noise(int width, int height, uint32_t seed) {
  TestRandom random(seed);
  Image image = plain(width, height, 0, 0, 0);
  for (size_t i = 0; i < image.rgba.size(); ++i)
    if (i % 4 != 3) image.rgba[i] = static_cast<uint8_t>(random.uniform(0, 256));
  return image;
}

double mean(const std::vector<float>& map) {
  double sum = 0;
  for (const float v : map) sum += v;
  return sum / static_cast<double>(map.size());
}

TEST(ImageFlip, LabOfThePrimariesIsThePublishedOne) {
  struct Known { Color3 rgb, lab; };
  // Bruce Lindbloom's and the CIE's values for sRGB and D65.
  for (const Known& k : {Known{{1, 1, 1}, {100, 0, 0}}, Known{{0, 0, 0}, {0, 0, 0}}, Known{{1, 0, 0}, {53.24, 80.09, 67.20}},
                         Known{{0, 1, 0}, {87.73, -86.18, 83.18}}, Known{{0, 0, 1}, {32.30, 79.19, -107.86}},
                         Known{{0.2140411, 0.2140411, 0.2140411}, {53.39, 0, 0}}}) {
    const Color3 lab = lab_from_xyz(xyz_from_rgb(k.rgb));
    EXPECT_NEAR(lab.x, k.lab.x, 0.02);
    EXPECT_NEAR(lab.y, k.lab.y, 0.02);
    EXPECT_NEAR(lab.z, k.lab.z, 0.02);
  }
}

TEST(ImageFlip, ColorSpacesGoThereAndBack) {
  TestRandom random(3);
  for (int i = 0; i < 1000; ++i) {
    const Color3 rgb{random.uniform(), random.uniform(), random.uniform()};
    const Color3 back = rgb_from_xyz(xyz_from_ycxcz(ycxcz_from_xyz(xyz_from_rgb(rgb))));
    EXPECT_NEAR(back.x, rgb.x, 1e-13);
    EXPECT_NEAR(back.y, rgb.y, 1e-13);
    EXPECT_NEAR(back.z, rgb.z, 1e-13);
    EXPECT_NEAR(linear_from_srgb_exact(srgb_from_linear(rgb.x)), rgb.x, 1e-7) << "the two parts of the curve meet within 1e-7";
  }
  const Color3 gray = ycxcz_from_xyz(xyz_from_rgb({0.5, 0.5, 0.5}));
  EXPECT_NEAR(gray.x, 42, 1e-12);
  EXPECT_NEAR(gray.y, 0, 1e-12);
  EXPECT_NEAR(gray.z, 0, 1e-12);
}

TEST(ImageFlip, KernelsHaveTheSumsOfThePaper) {
  const double ppd = kFlipPixelsPerDegree;
  EXPECT_NEAR(ppd, 67, 0.03);
  for (const flip::Channel channel : {flip::Channel::kAchromatic, flip::Channel::kRedGreen, flip::Channel::kBlueYellow}) {
    const flip::Sensitivity s = flip::contrast_sensitivity(channel, ppd);
    EXPECT_EQ(s.kernel[0].radius, 10);
    EXPECT_NEAR(s.share[0] + s.share[1], 1, 1e-14);
    for (int i = 0; i < s.terms; ++i) {
      double sum = 0;
      for (int j = -10; j <= 10; ++j) {
        sum += s.kernel[i].at(j);
        EXPECT_EQ(s.kernel[i].at(j), s.kernel[i].at(-j));
      }
      EXPECT_NEAR(sum, 1, 1e-14);
    }
  }
  // Variance of the achromatic Gaussian: b / (2 pi^2) square degrees.
  const flip::Sensitivity s = flip::contrast_sensitivity(flip::Channel::kAchromatic, ppd);
  double variance = 0;
  for (int j = -10; j <= 10; ++j) variance += j * j * s.kernel[0].at(j);
  EXPECT_NEAR(variance, 0.0047 / (2 * 9.8696044) * ppd * ppd, 0.002);

  const flip::Features f = flip::feature_kernels(ppd);
  EXPECT_EQ(f.smooth.radius, 9);
  double smooth = 0;
  for (int j = -9; j <= 9; ++j) smooth += f.smooth.at(j);
  EXPECT_NEAR(smooth, 1, 1e-14);
  for (const flip::Kernel* k : {&f.edge, &f.point}) {
    double positive = 0, negative = 0;
    for (int j = -9; j <= 9; ++j) (k->at(j) > 0 ? positive : negative) += k->at(j);
    EXPECT_NEAR(positive, 1, 1e-14);
    EXPECT_NEAR(negative, -1, 1e-14);
  }
  for (int j = 1; j <= 9; ++j) {
    EXPECT_NEAR(f.edge.at(j), -f.edge.at(-j), 1e-15);
    EXPECT_NEAR(f.point.at(j), f.point.at(-j), 1e-15);
  }
  EXPECT_LT(f.point.at(0), 0);
  EXPECT_GT(f.edge.at(-1), 0);
}

TEST(ImageFlip, ColorErrorIsMonotoneAndEndsAtOne) {
  const double most = flip::hyab(flip::hunt_lab({0, 1, 0}), flip::hunt_lab({0, 0, 1}));
  EXPECT_NEAR(std::pow(most, 0.7), 41.27, 0.02);
  EXPECT_EQ(flip::color_error(0), 0);
  EXPECT_NEAR(flip::color_error(most), 1, 1e-12);
  EXPECT_NEAR(flip::color_error(std::pow(0.4, 1 / 0.7) * most), 0.95, 1e-12);
  EXPECT_EQ(flip::color_error(2 * most), 1);
  for (double d = 0; d < most; d += 1) EXPECT_LT(flip::color_error(d), flip::color_error(d + 1));
}

TEST(ImageFlip, ExtremesOfPlainPictures) {
  Parallel parallel(2);
  const auto value = [&](const Image& a, const Image& b) { return mean(flip_map(a, b, parallel)); };
  const Image black = plain(40, 30, 0, 0, 0), white = plain(40, 30, 255, 255, 255);
  EXPECT_EQ(value(black, black), 0);
  EXPECT_EQ(value(noise(40, 30, 1), noise(40, 30, 1)), 0);
  EXPECT_NEAR(value(plain(40, 30, 0, 255, 0), plain(40, 30, 0, 0, 255)), 1, 1e-6);
  // Black to white: HyAB is 100, to the power 0.7 25.12, of 41.27 at most.
  EXPECT_NEAR(value(black, white), 0.95 + (std::pow(100, 0.7) - 0.4 * 41.27) / (0.6 * 41.27) * 0.05, 1e-4);
  EXPECT_EQ(value(black, white), value(white, black));
  EXPECT_GT(value(plain(9, 9, 100, 100, 100), plain(9, 9, 101, 101, 101)), 0);
  EXPECT_LT(value(plain(9, 9, 100, 100, 100), plain(9, 9, 101, 101, 101)), 0.05);
}

// What a feature adds, what distance takes away.
TEST(ImageFlip, ALineIsWorseThanItsColorAndFarAwayItVanishes) {
  Parallel parallel(1);
  const Image gray = plain(64, 64, 120, 120, 120);
  Image line = gray;
  for (size_t y = 0; y < 64; ++y)
    for (size_t c = 0; c < 3; ++c) line.rgba[4 * (64 * y + 32) + c] = 140;
  const std::vector<float> near = flip_map(gray, line, parallel, 30), far = flip_map(gray, line, parallel, 200);
  EXPECT_GT(near[64 * 32 + 32], 1.3 * far[64 * 32 + 32]);
  EXPECT_LT(near[64 * 32 + 5], 1e-3) << "far from the line nothing is seen";
  const double color_alone = flip::color_error(flip::hyab(flip::hunt_lab({0.1878, 0.1878, 0.1878}), flip::hunt_lab({0.1946, 0.1946, 0.1946})));
  EXPECT_GT(near[64 * 32 + 32], color_alone);
}

TEST(ImageFlip, ThreadsAndOrderChangeNothing) {
  Parallel one(1), three(3);
  const Image a = noise(70, 101, 5), b = noise(70, 101, 6);
  const std::vector<float> map = flip_map(a, b, one);
  EXPECT_EQ(map, flip_map(a, b, three));
  EXPECT_EQ(map, flip_map(b, a, one));
}

// The paper's equations, as sums over the plane: nothing is separated, shared or cut into bands.
class FlipOracle {
 public:
  FlipOracle(const Image& a, const Image& b) : a_(a), b_(b) {}
  double at(int x, int y) const {
    const double color = color_error(x, y);
    double e[2], p[2];
    features(a_, x, y, e[0], p[0]), features(b_, x, y, e[1], p[1]);
    const double feature = std::pow(std::max(std::fabs(e[0] - e[1]), std::fabs(p[0] - p[1])) / std::sqrt(2.0), 0.5);
    return std::pow(color, 1 - std::min(1.0, feature));
  }

 private:
  static constexpr double kPi = 3.14159265358979323846, kPpd = kFlipPixelsPerDegree;
  static Color3 opponent(const PictureView& p, int x, int y) {
    return ycxcz_from_xyz(xyz_from_rgb(p.shown(std::min(std::max(x, 0), p.width - 1), std::min(std::max(y, 0), p.height - 1))));
  }
  static double csf(int channel, double square) {
    const double a[3][2] = {{1, 0}, {1, 0}, {34.1, 13.5}}, b[3][2] = {{0.0047, 1e-5}, {0.0053, 1e-5}, {0.04, 0.025}};
    double sum = 0;
    for (int i = 0; i < 2; ++i) sum += a[channel][i] * std::sqrt(kPi / b[channel][i]) * std::exp(-kPi * kPi * square / b[channel][i]);
    return sum;
  }
  static Color3 filtered(const PictureView& p, int x, int y) {
    double sum[3] = {}, whole[3] = {};
    for (int j = -10; j <= 10; ++j)
      for (int i = -10; i <= 10; ++i) {
        const Color3 c = opponent(p, x + i, y + j);
        const double value[3] = {c.x, c.y, c.z};
        for (int k = 0; k < 3; ++k) {
          const double w = csf(k, (i * i + j * j) / (kPpd * kPpd));
          sum[k] += w * value[k], whole[k] += w;
        }
      }
    Color3 rgb = rgb_from_xyz(xyz_from_ycxcz({sum[0] / whole[0], sum[1] / whole[1], sum[2] / whole[2]}));
    for (double* v : {&rgb.x, &rgb.y, &rgb.z}) *v = std::min(std::max(*v, 0.0), 1.0);
    return rgb;
  }
  static Color3 hunt(const Color3& rgb) {
    const Color3 lab = lab_from_xyz(xyz_from_rgb(rgb));
    return {lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z};
  }
  static double distance(const Color3& p, const Color3& q) {
    return std::pow(std::fabs(p.x - q.x) + std::sqrt((p.y - q.y) * (p.y - q.y) + (p.z - q.z) * (p.z - q.z)), 0.7);
  }
  double color_error(int x, int y) const {
    const double d = distance(hunt(filtered(a_, x, y)), hunt(filtered(b_, x, y))), most = distance(hunt({0, 1, 0}), hunt({0, 0, 1}));
    return d < 0.4 * most ? d * 0.95 / (0.4 * most) : 0.95 + 0.05 * (d - 0.4 * most) / (0.6 * most);
  }
  static void features(const PictureView& p, int x, int y, double& edge, double& point) {
    const double s = 0.5 * 0.082 * kPpd;
    double value[4] = {};
    for (int k = 0; k < 4; ++k) {
      double positive = 0, negative = 0, above = 0, below = 0;
      for (int j = -9; j <= 9; ++j)
        for (int i = -9; i <= 9; ++i) {
          const int along = k % 2 == 0 ? i : j;
          const double g = std::exp(-(i * i + j * j) / (2 * s * s)), w = (k < 2 ? -along : along * along / (s * s) - 1) * g;
          const double v = (opponent(p, x + i, y + j).x + 16) / 116;
          (w > 0 ? positive : negative) += std::fabs(w), (w > 0 ? above : below) += w * v;
        }
      value[k] = above / positive + below / negative;
    }
    edge = std::hypot(value[0], value[1]), point = std::hypot(value[2], value[3]);
  }
  PictureView a_, b_;
};

TEST(ImageFlip, IsThatOfThePaper) {
  Parallel parallel(2);
  const Image a = noise(23, 41, 8);
  Image b = a;
  for (size_t i = 0; i < b.rgba.size(); i += 28) b.rgba[i] = static_cast<uint8_t>(b.rgba[i] ^ 0x5f);  // every seventh pixel
  const std::vector<float> map = flip_map(a, b, parallel);
  const FlipOracle oracle(a, b);
  double most = 0;
  for (int y = 0; y < 41; y += 3)  // both sides of the seam between two bands
    for (int x = 0; x < 23; x += 2) {
      most = std::max(most, oracle.at(x, y));
      EXPECT_NEAR(map[static_cast<size_t>(23 * y + x)], oracle.at(x, y), 1e-6) << x << "," << y;
    }
  EXPECT_GT(most, 0.1);
}

}  // namespace
}  // namespace spanray
