// What `why` and questions outside of frames say of spheres.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "render/trace_pixel.h"
#include "spanray/query.h"
#include "support/seen_pixels.h"

namespace spanray {
namespace {

TEST(RenderSpheres, WhySaysWhatThePictureShows) {
  const Scene scene = crowd();
  for (const Shading shading : {Shading::kPhong, Shading::kGouraud})
    for (const int samples : {1, 4})
      for (const Visibility visibility : {Visibility::kRaster, Visibility::kRay})
        for (const ShadingRate rate : {ShadingRate::k1x1, ShadingRate::k2x2}) {
          Settings s = test_settings(100, 65);
          s.shading = shading, s.samples = samples, s.visibility = visibility, s.shading_rate = rate;
          int seen = 0;
          expect_why_agrees(scene, kCrowdView, s, [&](uint32_t primitive) { return scene.data().is_sphere(primitive); }, seen);
          EXPECT_GT(seen, 20);
        }
}

TEST(RenderSpheres, QuestionsAgreeWithFrames) {
  const Scene scene = crowd();
  Settings s = test_settings(200, 130);
  s.transparency = Transparency::kNone;
  int seen = 0;
  expect_questions_agree(scene, kCrowdView, s, [](double) { return 1e-5; },
                         [&](uint32_t primitive) { return scene.data().is_sphere(primitive); }, seen);
  EXPECT_GT(seen, 200);
}

TEST(RenderSpheres, QuestionsAboutOneSphere) {
  SceneData data = make_test_scene({});
  add_sphere(ball({1, 2, 3}, 2), data);
  const SceneQuery query(finish(std::move(data)));
  Ray ray{{1, 2, 10}, {0, 0, -2}};
  const auto hit = query.closest(ray);
  ASSERT_TRUE(hit && hit.value());
  EXPECT_EQ(hit.value()->t, 2.5);
  EXPECT_EQ(hit.value()->distance, 5);
  EXPECT_TRUE(hit.value()->front);
  EXPECT_EQ(hit.value()->position[2], 5);
  EXPECT_EQ(hit.value()->normal[2], 1);
  EXPECT_EQ(hit.value()->name.material, "material");
  EXPECT_TRUE(hit.value()->name.sphere);
  EXPECT_EQ(hit.value()->name.object, "");
  ray.t_min = 2.5f;  // counts
  EXPECT_EQ(query.closest(ray).value()->t, 2.5);
  ray.t_min = 2.6f;
  const auto far = query.closest(ray);
  ASSERT_TRUE(far && far.value());
  EXPECT_EQ(far.value()->t, 4.5);
  EXPECT_FALSE(far.value()->front);
  EXPECT_EQ(far.value()->normal[2], -1);
  EXPECT_TRUE(query.any(ray).value());
  ray.t_min = 4.5f;
  ASSERT_TRUE(query.closest(ray).value());
  EXPECT_EQ(query.closest(ray).value()->t, 4.5);
  EXPECT_TRUE(query.any(ray).value());
  ray.t_min = 4.6f;
  EXPECT_FALSE(query.any(ray).value());
  EXPECT_FALSE(query.closest(ray).value().has_value());
}

// A moving ball against a resting one: from outside, from within, grazing, already touching.
TEST(RenderSpheres, SweptAndTouchingSpheres) {
  SceneData data = make_test_scene({});
  add_sphere(ball({0, 0, 0}, 2), data);
  const SceneQuery query(finish(std::move(data)));
  const auto sweep = [&](const glm::dvec3& a, const glm::dvec3& b, double r) {
    SphereSweep s;
    for (int k = 0; k < 3; ++k) s.start[k] = a[k], s.end[k] = b[k];
    s.radius = r;
    const auto hit = query.sweep(s);
    EXPECT_TRUE(hit);
    return hit.value();
  };
  const auto front = sweep({0, 0, 10}, {0, 0, 0}, 1);
  ASSERT_TRUE(front);
  EXPECT_LE(front->distance, 7);
  EXPECT_NEAR(front->distance, 7, 1e-12);
  EXPECT_NEAR(front->position[2], 2, 1e-12);
  EXPECT_EQ(front->normal[2], 1);
  const auto within = sweep({0, 0, 0}, {0, 0, 10}, 0.5);
  ASSERT_TRUE(within);
  EXPECT_LE(within->distance, 1.5);
  EXPECT_NEAR(within->distance, 1.5, 1e-12);
  EXPECT_EQ(within->normal[2], -1);
  EXPECT_FALSE(sweep({0, 3.0001, 10}, {0, 3.0001, -10}, 1));
  EXPECT_TRUE(sweep({0, 2.9999, 10}, {0, 2.9999, -10}, 1));
  EXPECT_FALSE(sweep({0, 0, 10}, {0, 0, 3.0001}, 1));
  EXPECT_EQ(sweep({0, 0, 2.5}, {0, 0, 0}, 1)->time, 0) << "touches, and moves in";
  EXPECT_FALSE(sweep({0, 0, 2.5}, {0, 0, 9}, 1)) << "touches, and moves out";
  EXPECT_EQ(sweep({0, 0, 1.5}, {0, 0, 9}, 1)->time, 0) << "touches from within, and moves out";
  EXPECT_NEAR(sweep({0, 0, 1.5}, {0, 0, -8.5}, 1)->distance, 2.5, 1e-12) << "touches from within, and moves across";
  TestRandom random(11);
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 a = random_point(random, 6), b = random_point(random, 6);
    const double r = random.uniform(0.01, 1.5);
    const auto hit = sweep(a, b, r);
    const double end = hit ? hit->time : 1;
    const auto gap = [&](double t) { return std::fabs(length3(a + (b - a) * t) - 2) - r; };
    if (gap(0) < 0) continue;
    for (double t = 0; t < 1; t += 1.0 / 256) ASSERT_GE(gap(t * end), -1e-9) << i;
    if (hit) {
      ASSERT_NEAR(gap(end), 0, 1e-9) << i;
    }
  }
  const double place[3] = {0, 3, 0};
  const auto touches = query.touching(place, 1.5);
  ASSERT_TRUE(touches);
  ASSERT_EQ(touches.value().size(), 1u);
  EXPECT_EQ(touches.value()[0].distance, 1);
  EXPECT_EQ(touches.value()[0].position[1], 2);
  EXPECT_EQ(touches.value()[0].normal[1], 1);
  EXPECT_TRUE(query.touching(place, 0.9).value().empty());
}

}  // namespace
}  // namespace spanray
