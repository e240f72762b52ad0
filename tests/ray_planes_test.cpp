// Rays against planes beside triangles and spheres: as asking every one of them; rays that leave planes; rays that no frame
// has.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "frame/exact_hit.h"
#include "ray/bvh_data.h"
#include "support/plane_scenes.h"
#include "support/ray_answers.h"

namespace spanray {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

std::unique_ptr<TestFrame> frame_with(const std::vector<SoupTriangle>& soup, const std::vector<Sphere>& spheres,
                                      const std::vector<Plane>& planes) {
  SceneData scene = make_test_scene(soup);
  for (const Sphere& s : spheres) add_sphere(s, scene);
  for (const Plane& p : planes) add_plane(p, scene);
  return make_test_frame(std::move(scene), Camera(), test_settings(16, 16));
}

// The hit of an exact primitive, by its own function and nothing else.
struct Nearest {
  uint32_t primitive = kNoPrimitive;
  double t = kInf;
};
Nearest ask_all(const TestFrame& t, const ExactRay& ray, bool front_only) {
  Nearest best;
  ExactRay asked = ray;
  asked.front_only = front_only;
  const SceneData& scene = t.scene;
  for (size_t i = scene.triangles.size(); i < scene.triangles.size() + scene.spheres.size() + scene.planes.size(); ++i) {
    const double at = first_hit(asked, scene, static_cast<uint32_t>(i)).t;
    if (at <= ray.t_max && at < best.t) best = {static_cast<uint32_t>(i), at};
  }
  return best;
}

TEST(RayPlanes, AsAskingEveryPrimitiveAtAllScalesAndOffsets) {
  for (const double scale : {0x1p-20, 1.0, 0x1p20})
    for (const double away : {0.0, 100.0}) {
      TestRandom random(7);
      const glm::dvec3 offset = glm::dvec3(1, -2, 0.5) * (away * scale);
      std::vector<Sphere> spheres;
      std::vector<Plane> planes;
      for (int i = 0; i < 30; ++i)
        spheres.push_back(ball(offset + random_point(random, scale), scale * random.uniform(0.01, 0.2)));
      for (int i = 0; i < 9; ++i) planes.push_back(plane_at(offset + random_point(random, scale), random_point(random)));
      planes.push_back(plane_at(offset, {0, 1, 0})), planes.push_back(planes[3]);  // coincident: the lowest id
      const auto t = frame_with({}, spheres, planes);
      const Bvh bvh = build_all(*t);
      EXPECT_EQ(bvh.primitive_count(), 41u);
      const RayBatch rays = crossing_rays(random, 3000, scale, offset, 41);
      for (const Culling culling : {Culling::kNone, Culling::kBack})
        for (const Isa isa : supported_isas()) {
          t->frame.settings.culling = culling;
          const Answers got = trace(*t, bvh, rays, isa);
          for (int i = 0; i < rays.count; ++i) {
            ExactRay ray;
            ray.origin = ray_origin(rays, i), ray.direction = ray_direction(rays, i);
            ray.t_max = rays.t_max[i], ray.from = rays.from[i];
            const size_t at = static_cast<size_t>(i);
            ASSERT_EQ(got.closest[at], ask_all(*t, ray, culling == Culling::kBack).primitive) << i;
            ASSERT_EQ(got.any[at], ask_all(*t, ray, false).primitive != kNoPrimitive) << i;
            ASSERT_TRUE(got.all[at].empty()) << "layers are triangles";
          }
        }
    }
}

TEST(RayPlanes, WhereHitsCount) {
  const auto t = frame_with({}, {}, {plane_at({0, 1, 0}, {0, 3, 0})});
  const Bvh bvh = build_all(*t);
  RayBatch rays;
  add_ray(rays, {5, 3, 0}, {0, -1, 0}, 2);
  add_ray(rays, {5, 3, 0}, {0, -1, 0}, std::nextafterf(2, 0));
  add_ray(rays, {5, 1, 0}, {0, -1, 0});  // starts on it
  add_ray(rays, {5, 1, 0}, {1, 0, 0});   // runs in it
  add_ray(rays, {5, 2, 0}, {1, 0, 0});   // runs along it
  add_ray(rays, {5, 2, 0}, {1, -0.0, 0});
  add_ray(rays, {5, 2, 0}, {1, 1e-20, 0});        // away
  add_ray(rays, {5, 2, 0}, {1, -1e-20, 0});       // 1e20 away
  add_ray(rays, {5, 2, 0}, {1, -1e-35, 0});       // beyond 1e30: planes end there
  add_ray(rays, {5, 0, 0}, {0, 1, 0}, 1);         // from behind
  add_ray(rays, {5, 3, 0}, {0, -1, 0}, kInf, 0);  // leaves it
  add_ray(rays, {5, 0, 0}, {0, 1, 0}, kInf, 0);
  const bool want[] = {true, false, false, false, false, false, false, true, false, true, false, false};
  for (const Isa isa : supported_isas()) {
    const Answers got = trace(*t, bvh, rays, isa);
    for (size_t i = 0; i < std::size(want); ++i) {
      EXPECT_EQ(got.closest[i], want[i] ? 0u : kNoPrimitive) << i;
      EXPECT_EQ(got.any[i], want[i]) << i;
    }
  }
  t->frame.settings.culling = Culling::kBack;
  const Answers culled = trace(*t, bvh, rays, supported_isas().back());
  EXPECT_EQ(culled.closest[0], 0u);
  EXPECT_EQ(culled.closest[9], kNoPrimitive) << "seen from behind";
  EXPECT_TRUE(culled.any[9]) << "both faces occlude";
}

TEST(RayPlanes, RaysThatNoFrameHasMiss) {
  const auto t = frame_with({}, {}, {plane_at({0, 0, 0}, {1, 2, 3})});
  const Bvh bvh = build_all(*t);
  RayBatch rays;
  for (const double bad : {double{kNan}, double{kInf}, -double{kInf}}) {
    add_ray(rays, {bad, 1, 0}, {-1, -1, -1}), add_ray(rays, {1, 1, 1}, {-1, bad, -1});
  }
  add_ray(rays, {1, 1, 1}, {0, 0, 0});
  add_ray(rays, {1, 1, 1}, {-1, -1, -1}, -1), add_ray(rays, {1, 1, 1}, {-1, -1, -1}, kNan),
      add_ray(rays, {1, 1, 1}, {-1, -1, -1}, 0);
  const Answers got = trace(*t, bvh, rays, supported_isas().back());
  for (size_t i = 0; i < static_cast<size_t>(rays.count); ++i) EXPECT_TRUE(got.closest[i] == kNoPrimitive && !got.any[i]) << i;
}

// Triangles come first, then spheres, then planes.
TEST(RayPlanes, TiesGoToTheLowestId) {
  const auto t = frame_with({soup_triangle({-5, -5, 1}, {5, -5, 1}, {0, 5, 1})}, {ball({0, 0, 0}, 1), ball({0, 0, -3}, 1)},
                            {plane_at({0, 0, 1}, {0, 0, 1}), plane_at({9, 0, 1}, {0, 0, -7}), plane_at({0, 0, -2}, {0, 0, 1})});
  const Bvh bvh = build_all(*t);
  RayBatch rays;
  add_ray(rays, {0, 0, 3}, {0, 0, -1});     // triangle, sphere and plane at 2
  add_ray(rays, {0, 40, 3}, {0, 0, -1});    // both planes
  add_ray(rays, {0, 0, -1.5}, {0, 0, -1});  // sphere and plane at 0.5
  const Answers got = trace(*t, bvh, rays, supported_isas().back());
  EXPECT_EQ(got.closest[0], 0u);
  EXPECT_EQ(got.closest[1], 3u);
  EXPECT_EQ(got.closest[2], 2u);
}

// A triangle whose corners lie in a plane hides it, although the two t are rounded apart; one that is tilted by an ulp meets it
// in a line.
TEST(RayPlanes, TrianglesThatLieInAPlaneHideIt) {
  TestRandom random(5);
  int apart = 0;
  for (int i = 0; i < 300; ++i) {
    const glm::dvec3 n(random.between(1, 9), random.between(-9, 9), random.between(-9, 9)), point = {0.5, 0.25, -3};
    const glm::dvec3 u(n.y, -n.x, 0), v(n.z, 0, -n.x);
    const auto t =
        frame_with({soup_triangle(point + u * 64.0 + v * 32.0, point - u * 32.0 + v * 64.0, point - v * 96.0 - u * 8.0)}, {},
                   {plane_at(point, n)});
    ASSERT_TRUE(lies_in(t->scene, t->scene.triangles[0], t->scene.planes[0]));
    const Bvh bvh = build_all(*t);
    RayBatch rays;
    for (int k = 0; k < 64; ++k) {
      const glm::dvec3 o = point + random_point(random, 30);
      add_ray(rays, o, point + u * random.uniform(-1, 1) + v * random.uniform(-1, 1) - o);
    }
    const Answers got = trace(*t, bvh, rays, supported_isas().back());
    for (int k = 0; k < 64; ++k) ASSERT_EQ(got.closest[static_cast<size_t>(k)], 0u) << i << ", " << k;
    for (int k = 0; k < 64; ++k) {
      ExactRay ray;
      ray.origin = ray_origin(rays, k), ray.direction = ray_direction(rays, k);
      double triangle_t = 0;
      const double plane_t = first_hit(ray, t->scene, 1).t;
      float o[3], d[3], corner[9];
      for (int c = 0; c < 3; ++c) o[c] = rays.origin[c][k], d[c] = rays.direction[c][k];
      for (int c = 0; c < 3; ++c) std::copy_n(t->scene.vertices[t->scene.triangles[0].vertex[c]].position, 3, corner + 3 * c);
      TraceRay trace_ray;
      ASSERT_TRUE(prepare_ray(o, d, kInf, trace_ray) && hit_triangle(trace_ray, TriangleView{corner, 3, 1}, triangle_t));
      apart += triangle_t * (trace_ray.direction_z / static_cast<double>(d[trace_ray.kz])) > plane_t;
    }
  }
  EXPECT_GT(apart, 100) << "nothing was decided by the rule";
}

}  // namespace
}  // namespace spanray
