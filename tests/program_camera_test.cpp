// The camera that flies and the camera on a path, without a window.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "../demo/camera_path.h"
#include "../demo/fly_camera.h"
#include "math/vec.h"

namespace spanray::demo {
namespace {

glm::dvec3 vec(const double (&v)[3]) { return {v[0], v[1], v[2]}; }
glm::dvec3 view(const Camera& c) { return vec(c.target) - vec(c.eye); }
bool same_bits(const Camera& a, const Camera& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

Camera start() {
  Camera camera;
  const double eye[3] = {1, 2, 7}, target[3] = {0.3, 1.5, -2};
  std::copy_n(eye, 3, camera.eye), std::copy_n(target, 3, camera.target);
  return camera;
}

TEST(FlyCamera, NothingMovesItByItself) {
  FlyCamera fly(start());
  fly.turn(0, 0);
  fly.move(0, 0, 0);
  EXPECT_TRUE(same_bits(start(), fly.camera()));
}

TEST(FlyCamera, MovesAlongItsOwnAxes) {
  FlyCamera fly(start());
  fly.move(0, 0, 2);
  const glm::dvec3 forward = normalize3(view(start()), glm::dvec3(0));
  EXPECT_NEAR(0, length3(vec(fly.camera().eye) - vec(start().eye) - forward * 2.0), 1e-12);
  EXPECT_NEAR(0, length3(view(fly.camera()) - view(start())), 1e-12) << "the view stays";
  fly.move(3, 0, -2);
  const glm::dvec3 step = vec(fly.camera().eye) - vec(start().eye);
  EXPECT_NEAR(3, length3(step), 1e-12);
  EXPECT_NEAR(0, dot3(step, forward), 1e-12);
  EXPECT_GT(dot3(step, cross3(forward, vec(start().up))), 0) << "to the right";
  fly.move(-3, 1.5, 0);
  EXPECT_NEAR(start().eye[1] + 1.5, fly.camera().eye[1], 1e-12) << "up along Camera::up";
}

TEST(FlyCamera, MouseToTheRightAndDownTurnsRightAndDown) {
  FlyCamera fly(start());
  fly.turn(100, 0);
  const glm::dvec3 right = cross3(view(start()), vec(start().up));
  EXPECT_GT(dot3(view(fly.camera()), right), 0);
  EXPECT_NEAR(view(start()).y, view(fly.camera()).y, 1e-12) << "no pitch";
  fly.turn(0, 100);
  EXPECT_LT(view(fly.camera()).y, view(start()).y);
  EXPECT_NEAR(length3(view(start())), length3(view(fly.camera())), 1e-12);
  EXPECT_EQ(0, std::memcmp(start().eye, fly.camera().eye, sizeof start().eye)) << "the eye stays";
  fly.turn(0, -100);
  fly.turn(-100, 0);
  EXPECT_NEAR(0, length3(view(fly.camera()) - view(start())), 1e-9) << "and back";
}

TEST(FlyCamera, NeverTipsOver) {
  for (const double dy : {-1.0, 1.0, -500.0, 500.0, -1e6, 1e6}) {
    FlyCamera fly(start());
    for (int i = 0; i < 3000; ++i) {
      fly.turn(i % 7, dy);
      const glm::dvec3 direction = normalize3(view(fly.camera()), glm::dvec3(0));
      ASSERT_LE(std::fabs(direction.y), 0.9981) << dy;
      ASSERT_NEAR(length3(view(start())), length3(view(fly.camera())), 1e-9);
    }
  }
}

TEST(FlyCamera, SurvivesACameraWithoutDirection) {
  Camera camera = start();
  std::copy_n(camera.eye, 3, camera.target);
  FlyCamera fly(camera);
  fly.turn(10, 10);
  fly.move(1, 1, 1);
  for (int k = 0; k < 3; ++k) EXPECT_TRUE(std::isfinite(fly.camera().eye[k]) && std::isfinite(fly.camera().target[k]));
}

TEST(CameraPath, PassesThroughItsKeysAndHoldsItsEnds) {
  std::vector<CameraKey> keys;
  for (int i = 0; i < 4; ++i) {
    CameraKey key{1.0 + i * i, start()};
    key.camera.eye[0] = i * 10.0, key.camera.fov_y_degrees = 40 + i;
    keys.push_back(key);
  }
  for (const CameraKey& key : keys) EXPECT_TRUE(same_bits(key.camera, camera_at(keys, key.time)));
  EXPECT_TRUE(same_bits(keys.front().camera, camera_at(keys, -5)));
  EXPECT_TRUE(same_bits(keys.back().camera, camera_at(keys, 99)));
  EXPECT_TRUE(same_bits(keys.front().camera, camera_at(keys, std::nan(""))));
  EXPECT_EQ(15, camera_at(keys, 3.5).eye[0]);  // half way from key 1 (time 2) to key 2 (time 5)
  EXPECT_EQ(41.5, camera_at(keys, 3.5).fov_y_degrees);
  EXPECT_TRUE(same_bits(keys.front().camera, camera_at(keys, time_of_frame(keys, 0, 7))));
  EXPECT_TRUE(same_bits(keys.back().camera, camera_at(keys, time_of_frame(keys, 6, 7))));
  EXPECT_TRUE(same_bits(keys.front().camera, camera_at(keys, time_of_frame(keys, 0, 1))));
  const std::vector<CameraKey> one = {keys[2]};
  EXPECT_TRUE(same_bits(keys[2].camera, camera_at(one, time_of_frame(one, 3, 5))));
}

}  // namespace
}  // namespace spanray::demo
