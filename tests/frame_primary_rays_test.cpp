// Primary rays and the homogeneous pixel rows are inverses of each other.
#include <gtest/gtest.h>

#include <cmath>

#include "math/elementary.h"
#include "support/random.h"
#include "support/test_frame.h"

namespace spanray {
namespace {

void expect_inverse(const Camera& camera, int width, int height) {
  const PrimaryRays r = make_primary_rays(camera, width, height);
  for (const double x : {0.0, 0.5, width - 0.5})
    for (const double y : {0.0, 0.5, height - 0.5}) {
      const glm::dvec3 d = r.corner + x * r.step_x + y * r.step_y;
      EXPECT_NEAR(dot3(d, r.forward), 1, 1e-15 * length3(d) + 1e-15);
      EXPECT_NEAR(dot3(r.pixel_row_x, d) / dot3(r.forward, d), x, 1e-12 * width * length3(d));
      EXPECT_NEAR(dot3(r.pixel_row_y, d) / dot3(r.forward, d), y, 1e-12 * width * length3(d));
    }
  EXPECT_NEAR(length3(r.step_x), length3(r.step_y), 1e-15 * length3(r.step_x) + 1e-18);
  EXPECT_GT(dot3(cross3(r.step_x, r.step_y), r.forward), 0);  // x right, y down, forward: right-handed
}

TEST(PrimaryRays, DirectionsAndRowsAreInverse) {
  TestRandom random(1);
  for (int n = 0; n < 200; ++n) {
    Camera c;
    for (int k = 0; k < 3; ++k) {
      c.eye[k] = random.uniform(-100, 100);
      c.target[k] = random.uniform(-100, 100);
      c.up[k] = random.uniform(-1, 1);
    }
    c.fov_y_degrees = random.uniform(1, 179);
    expect_inverse(c, 1 + random.below(4000), 1 + random.below(4000));
  }
}

TEST(PrimaryRays, DefaultCameraSeesUpAtTheTopAndTheRightAtTheRight) {
  const PrimaryRays r = make_primary_rays(Camera{}, 101, 51);
  const glm::dvec3 top_right = r.corner + 101.0 * r.step_x;
  EXPECT_NEAR(top_right.y, std::tan(22.5 * kPi / 180), 1e-15);
  EXPECT_NEAR(top_right.x, top_right.y * 101 / 51, 1e-14);
  EXPECT_EQ(top_right.z, -1);
}

TEST(PrimaryRays, ParallelUpAndZeroViewStillGiveACamera) {
  Camera c;
  for (const double y : {-3.0, 3.0})
    for (const double tilt : {0.0, 1e-12, 1e-6}) {
      c.eye[0] = 0, c.eye[1] = y, c.eye[2] = 0, c.target[0] = tilt, c.target[1] = 0, c.target[2] = 0;
      expect_inverse(c, 64, 64);
    }
  for (int k = 0; k < 3; ++k) c.eye[k] = c.target[k];
  expect_inverse(c, 64, 64);
}

TEST(Trigonometry, SinCosTanAgainstLongDouble) {
  TestRandom random(2);
  for (int n = 0; n < 200000; ++n) {
    const double range = n % 2 ? 4.0 : 1e6;
    const double x = n < 16 ? n * (kPi / 4) : random.uniform(-range, range);
    double s, c;
    sin_cos(x, &s, &c);
    ASSERT_NEAR(s, static_cast<double>(std::sin(static_cast<long double>(x))), 0x1p-52) << x;
    ASSERT_NEAR(c, static_cast<double>(std::cos(static_cast<long double>(x))), 0x1p-52) << x;
    const long double t = std::tan(static_cast<long double>(x));
    if (std::fabs(c) > 1e-8) {
      ASSERT_LE(std::fabs(static_cast<double>(tan_(x) - t)), 4 * 0x1p-52 * std::fabs(static_cast<double>(t))) << x;
    }
  }
}

}  // namespace
}  // namespace spanray
