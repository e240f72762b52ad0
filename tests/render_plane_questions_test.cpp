// What questions outside of frames say of planes.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/coplanar.h"
#include "spanray/query.h"
#include "support/plane_scenes.h"
#include "support/seen_pixels.h"

namespace spanray {
namespace {

TEST(RenderPlanes, QuestionsAgreeWithFrames) {
  const Scene scene = landscape();
  int seen = 0;
  expect_questions_agree(scene, kLandscapeView, test_settings(200, 130), [](double z) { return 1e-6 * z; },
                         [&](uint32_t primitive) { return scene.data().is_plane(primitive); }, seen);
  EXPECT_GT(seen, 1000);
}

TEST(RenderPlanes, QuestionsAboutOnePlane) {
  SceneData data = make_test_scene({});
  add_plane(plane_at({7, 2, 3}, {0, 4, 0}), data);
  const SceneQuery query(finish(std::move(data)));
  Ray ray{{1, 7, 10}, {0, -2, 0}};
  const auto hit = query.closest(ray);
  ASSERT_TRUE(hit && hit.value());
  EXPECT_EQ(hit.value()->t, 2.5);
  EXPECT_EQ(hit.value()->distance, 5);
  EXPECT_TRUE(hit.value()->front);
  EXPECT_EQ(hit.value()->position[0], 1);
  EXPECT_EQ(hit.value()->position[1], 2);
  EXPECT_EQ(hit.value()->normal[1], 1);
  EXPECT_EQ(hit.value()->name.material, "material");
  EXPECT_TRUE(hit.value()->name.plane);
  EXPECT_FALSE(hit.value()->name.sphere);
  EXPECT_EQ(hit.value()->name.object, "");
  ray.t_min = 2.5f;  // counts
  EXPECT_EQ(query.closest(ray).value()->t, 2.5);
  EXPECT_TRUE(query.any(ray).value());
  ray.t_min = 2.6f;
  EXPECT_FALSE(query.closest(ray).value().has_value());
  EXPECT_FALSE(query.any(ray).value());
  const auto behind = query.closest(Ray{{1, -7, 10}, {3, 1, 0}});
  ASSERT_TRUE(behind && behind.value());
  EXPECT_FALSE(behind.value()->front);
  EXPECT_EQ(behind.value()->position[0], 28);
  EXPECT_EQ(behind.value()->normal[1], 1);
  EXPECT_FALSE(query.any(Ray{{1, 7, 10}, {1, 0, 0}}).value());
}

// A triangle in the plane and one just above it: t_min asks for what lies beyond.
TEST(RenderPlanes, QuestionsAboutATriangleInAPlane) {
  SceneData data =
      make_test_scene({soup_triangle({-5, 1, -5}, {5, 1, -5}, {0, 1, 5}), soup_triangle({-5, 2, -5}, {5, 2, -5}, {0, 2, 5})});
  add_plane(plane_at({0, 1, 0}, {0, 1, 0}), data);
  add_plane(plane_at({0, 0.5, 0}, {0, 1, 0}), data);
  const SceneQuery query(finish(std::move(data)));
  Ray ray{{0, 3, 0}, {0, -1, 0}};
  EXPECT_EQ(query.closest(ray).value()->name.triangle, 1u);
  ray.t_min = 1.5f;
  EXPECT_EQ(query.closest(ray).value()->name.triangle, 0u) << "before the plane in which it lies";
  ray.t_min = 2.25f;
  EXPECT_EQ(query.closest(ray).value()->name.triangle, 3u);
}

TEST(RenderPlanes, SweptAndTouchingSpheres) {
  for (const glm::dvec3& normal : {glm::dvec3(0, 1, 0), glm::dvec3(0.3, -0.8, 0.2)}) {
    SceneData data = make_test_scene({});
    add_plane(plane_at({1, 2, 3}, normal), data);
    const glm::dvec3 n = normalize3(normal_of(data.planes[0]), normal), point = point_of(data.planes[0]);
    const SceneQuery query(finish(std::move(data)));
    const auto height = [&](const glm::dvec3& p) { return dot3(n, p - point); };
    const auto sweep = [&](const glm::dvec3& a, const glm::dvec3& b, double r) {
      SphereSweep s;
      for (int k = 0; k < 3; ++k) s.start[k] = a[k], s.end[k] = b[k];
      s.radius = r;
      const auto hit = query.sweep(s);
      EXPECT_TRUE(hit);
      return hit.value();
    };
    const glm::dvec3 flat = normalize3(cross3(n, glm::dvec3(1, 0, 1)), n);
    const auto front = sweep(point + n * 10.0, point - n * 10.0, 1);
    ASSERT_TRUE(front);
    EXPECT_LE(front->distance, 9 + 1e-14);
    EXPECT_NEAR(front->distance, 9, 1e-12);
    EXPECT_TRUE(front->name.plane);
    EXPECT_NEAR(length3(glm::dvec3(front->position[0], front->position[1], front->position[2]) - point), 0, 1e-12);
    EXPECT_NEAR(front->normal[1], n.y, 1e-15);
    const auto behind = sweep(point - n * 10.0, point + n * 10.0, 1);
    ASSERT_TRUE(behind);
    EXPECT_NEAR(behind->normal[1], -n.y, 1e-15);
    EXPECT_FALSE(sweep(point + n * 3.0, point + n * 3.0 + flat * 1e6, 2.999)) << "along it";
    EXPECT_FALSE(sweep(point + n * 3.0, point + n * 9.0, 2)) << "away";
    EXPECT_FALSE(sweep(point + n * 3.0, point + n * 2.001, 2)) << "too short";
    EXPECT_TRUE(sweep(point + n * 3.0, point + n * 1.999, 2));
    EXPECT_EQ(sweep(point + n, point - n, 2)->time, 0) << "touches, and moves in";
    EXPECT_FALSE(sweep(point + n, point + n * 9.0, 2)) << "touches, and moves out";
    EXPECT_FALSE(sweep(point + n, point + n + flat, 2)) << "touches, and moves along";
    EXPECT_TRUE(sweep(point + n, point - n, 0)) << "a ray";
    TestRandom random(11);
    int hits = 0;
    for (int i = 0; i < 3000; ++i) {
      const glm::dvec3 a = point + random_point(random, 6), b = point + random_point(random, 6);
      const double r = random.uniform(0.01, 1.5);
      if (std::fabs(height(a)) < r) continue;
      const auto hit = sweep(a, b, r);
      const bool meets = height(b) * height(a) < 0 || std::fabs(height(b)) < r;
      ASSERT_EQ(hit.has_value(), meets) << i;
      if (!hit) continue;
      ++hits;
      const double gap = std::fabs(height(a + (b - a) * hit->time)) - r;
      ASSERT_GE(gap, -1e-14) << "never later than the true contact";
      ASSERT_LE(gap, 1e-11) << i;
      ASSERT_NEAR(height({hit->position[0], hit->position[1], hit->position[2]}), 0, 1e-12);
    }
    EXPECT_GT(hits, 500);
    const glm::dvec3 p = point - n * 3.0 + flat;
    const double place[3] = {p.x, p.y, p.z};
    const auto touches = query.touching(place, 3.5);
    ASSERT_TRUE(touches);
    ASSERT_EQ(touches.value().size(), 1u);
    EXPECT_NEAR(touches.value()[0].distance, 3, 1e-12);
    EXPECT_NEAR(touches.value()[0].normal[1], -n.y, 1e-12);
    EXPECT_NEAR(touches.value()[0].position[0], (point + flat).x, 1e-12);
    EXPECT_TRUE(query.touching(place, 2.9).value().empty());
    const double on[3] = {1, 2, 3};
    ASSERT_EQ(query.touching(on, 0).value().size(), 1u);
    EXPECT_EQ(query.touching(on, 0).value()[0].normal[1], 0);
  }
}

}  // namespace
}  // namespace spanray
