// Rays against spheres beside triangles: as asking every sphere, whatever the tree; rays that leave spheres; rays that no frame
// has.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "frame/exact_hit.h"
#include "ray/bvh_data.h"
#include "support/ray_answers.h"

namespace spanray {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

Sphere sphere_at(const glm::dvec3& c, double r) {
  Sphere s{};
  for (int k = 0; k < 3; ++k) s.center[k] = static_cast<float>(c[k]);
  s.radius = static_cast<float>(r);
  return s;
}

std::unique_ptr<TestFrame> frame_with(const std::vector<SoupTriangle>& soup, const std::vector<Sphere>& spheres) {
  SceneData scene = make_test_scene(soup);
  for (const Sphere& s : spheres) add_sphere(s, scene);
  return make_test_frame(std::move(scene), Camera(), test_settings(16, 16));
}

std::unique_ptr<TestFrame> clutter(TestRandom& random, int triangles, int spheres, double scale, const glm::dvec3& offset) {
  std::vector<SoupTriangle> soup;
  for (int i = 0; i < triangles; ++i) {
    const glm::dvec3 p = offset + random_point(random, scale);
    soup.push_back(soup_triangle(p, p + random_point(random, 0.3 * scale), p + random_point(random, 0.3 * scale)));
  }
  std::vector<Sphere> list;
  for (int i = 0; i < spheres; ++i)
    list.push_back(sphere_at(offset + random_point(random, scale), scale * random.uniform(0.01, 0.2)));
  for (int i = 0; i < spheres / 10; ++i) list.push_back(list[static_cast<size_t>(i)]);  // coincident: the lowest id
  return frame_with(soup, list);
}

// What every sphere says; triangles by the tree, which has tests of its own.
struct Nearest {
  uint32_t closest = kNoPrimitive;
  bool any = false;
};
Nearest ask_all(const TestFrame& t, const RayBatch& rays, int i, uint32_t triangle) {
  Nearest best;
  double best_t = kInf;
  ExactRay ray;
  ray.origin = ray_origin(rays, i), ray.direction = ray_direction(rays, i), ray.from = rays.from[i];
  ray.front_only = t.frame.settings.culling == Culling::kBack;
  if (triangle != kNoPrimitive) {
    long double t_triangle = oracle_hit(t.scene, triangle, ray.origin, ray.direction).t;
    best = {triangle, true}, best_t = static_cast<double>(t_triangle);
  }
  for (size_t s = 0; s < t.scene.spheres.size(); ++s) {
    const uint32_t id = static_cast<uint32_t>(t.scene.triangles.size() + s);
    const double at = first_hit(ray, t.scene.spheres[s], id).t;
    if (at <= static_cast<double>(rays.t_max[i]) && at < best_t) best = {id, true}, best_t = at;
    ExactRay both = ray;
    both.front_only = false;
    best.any |= first_hit(both, t.scene.spheres[s], id).t <=
                static_cast<double>(std::min(rays.t_max[i], std::numeric_limits<float>::max()));
  }
  return best;
}

void expect_as_all(TestFrame& t, const RayBatch& rays) {
  const Bvh bvh = build_all(t);
  SceneData bare = make_test_scene({});
  bare.vertices = AlignedBuffer<Vertex>::copy(t.scene.vertices),
  bare.triangles = AlignedBuffer<Triangle>::copy(t.scene.triangles);
  const auto plain = make_test_frame(std::move(bare), Camera(), t.frame.settings);
  const Bvh triangles = build_all(*plain);
  for (const Isa isa : supported_isas()) {
    const Answers got = trace(t, bvh, rays, isa), alone = trace(*plain, triangles, rays, isa);
    for (int i = 0; i < rays.count; ++i) {
      const size_t at = static_cast<size_t>(i);
      const Nearest want = ask_all(t, rays, i, alone.closest[at]);
      ASSERT_EQ(got.closest[at], want.closest) << isa_name(isa) << " ray " << i;
      ASSERT_EQ(got.any[at], want.any || alone.any[at]) << isa_name(isa) << " ray " << i;
      ASSERT_EQ(got.all[at], alone.all[at]) << "layers are triangles";
    }
  }
}

TEST(RaySpheres, AsAskingEverySphereAtAllScalesAndOffsets) {
  for (const double scale : {0x1p-20, 1.0, 0x1p20}) {
    for (const double away : {0.0, 100.0}) {
      TestRandom random(7);
      const glm::dvec3 offset = glm::dvec3(1, -2, 0.5) * (away * scale);
      const auto t = clutter(random, 30, 300, scale, offset);
      const RayBatch rays = crossing_rays(random, 3000, scale, offset, 330);
      for (const Culling culling : {Culling::kNone, Culling::kBack}) {
        t->frame.settings.culling = culling;
        expect_as_all(*t, rays);
      }
    }
  }
}

TEST(RaySpheres, HitsAtExactlyTheEndOfARayCountAndNoneAtItsStart) {
  const auto t = frame_with({}, {sphere_at({0, 0, 0}, 1)});
  const Bvh bvh = build_all(*t);
  RayBatch rays;
  add_ray(rays, {-3, 0, 0}, {1, 0, 0}, 2);
  add_ray(rays, {-3, 0, 0}, {1, 0, 0}, std::nextafterf(2, 0));
  add_ray(rays, {-1, 0, 0}, {-1, 0, 0});       // starts on it, outwards
  add_ray(rays, {-1, 0, 0}, {1, 0, 0}, 1.5f);  // and inwards: the far side, too far away
  add_ray(rays, {-1, 0, 0}, {1, 0, 0}, 2);
  add_ray(rays, {-2, 1, 0}, {1, 0, 0});  // touches
  add_ray(rays, {-2, 1, 0}, {1, 0, 0}, 2);
  add_ray(rays, {0, 0, 0}, {0, -1, 0}, 1);
  add_ray(rays, {-3, 0, 0}, {-1, 0, 0});  // behind
  const bool want[] = {true, false, false, false, true, true, true, true, false};
  for (const Isa isa : supported_isas()) {
    const Answers got = trace(*t, bvh, rays, isa);
    for (size_t i = 0; i < std::size(want); ++i) {
      EXPECT_EQ(got.closest[i], want[i] ? 0u : kNoPrimitive) << i;
      EXPECT_EQ(got.any[i], want[i]) << i;
    }
  }
}

TEST(RaySpheres, RaysThatNoFrameHasMiss) {
  const auto t = frame_with({}, {sphere_at({0, 0, 0}, 1)});
  const Bvh bvh = build_all(*t);
  RayBatch rays;
  for (const double bad : {double{kNan}, double{kInf}, -double{kInf}}) {
    add_ray(rays, {bad, 0, 0}, {1, 0, 0}), add_ray(rays, {0, 0, 0}, {1, bad, 0});
  }
  add_ray(rays, {-3, 0, 0}, {0, 0, 0}), add_ray(rays, {0, 0, 0}, {0, 0, 0});
  add_ray(rays, {-3, 0, 0}, {1, 0, 0}, -1), add_ray(rays, {-3, 0, 0}, {1, 0, 0}, kNan), add_ray(rays, {0, 0, 0}, {1, 0, 0}, 0);
  const Answers got = trace(*t, bvh, rays, supported_isas().back());
  for (size_t i = 0; i < static_cast<size_t>(rays.count); ++i) EXPECT_TRUE(got.closest[i] == kNoPrimitive && !got.any[i]) << i;
}

// Of two surfaces at one distance the lowest id; triangles come first.
TEST(RaySpheres, TiesGoToTheLowestId) {
  const auto t =
      frame_with({soup_triangle({-5, -5, 1}, {5, -5, 1}, {0, 5, 1})}, {sphere_at({0, 0, 0}, 1), sphere_at({0, 0, 0}, 1)});
  const Bvh bvh = build_all(*t);
  RayBatch rays;
  add_ray(rays, {0, 0, 3}, {0, 0, -1});
  add_ray(rays, {0, 0, -3}, {0, 0, 1});
  const Answers got = trace(*t, bvh, rays, supported_isas().back());
  EXPECT_EQ(got.closest[0], 0u);
  EXPECT_EQ(got.closest[1], 1u);
}

// A ray that starts on a sphere meets it again only from within, and there on the other side, however its origin was rounded.
TEST(RaySpheres, RaysThatLeaveASphere) {
  TestRandom random(8);
  for (const double away : {0.0, 1e3, 1e6}) {
    const Sphere sphere = sphere_at(glm::dvec3(1, -1, 0.5) * away, 1);
    const auto t = frame_with({}, {sphere});
    const Bvh bvh = build_all(*t);
    RayBatch outwards, inwards, down;
    for (int i = 0; i < 4000; ++i) {
      const glm::dvec3 n = normalize3(random_point(random), glm::dvec3(1, 0, 0)), side = random_point(random);
      const glm::dvec3 flat = normalize3(side - n * dot3(side, n), glm::dvec3(0));
      const double slope = std::pow(10.0, random.uniform(-3, 1)),
                   rounding = 1e-6 * away;  // the point of the frame is off by so much
      add_ray(outwards, center_of(sphere) + n * (1 + 2 * rounding + 1e-6), flat + n * slope, kInf, 0);
      add_ray(down, center_of(sphere) + n * (1 + 2 * rounding + 1e-6), flat - n * slope, kInf,
              0);  // as no surface asks for, but shading normals may
      add_ray(inwards, center_of(sphere) + n * (1 - 2 * rounding - 1e-6), flat - n * slope, kInf, 0);
    }
    const Answers out = trace(*t, bvh, outwards, supported_isas().back()),
                  in = trace(*t, bvh, inwards, supported_isas().back()), never = trace(*t, bvh, down, supported_isas().back());
    for (size_t i = 0; i < 4000; ++i) {
      ASSERT_FALSE(out.any[i] || out.closest[i] != kNoPrimitive) << i;
      ASSERT_FALSE(never.any[i] || never.closest[i] != kNoPrimitive) << i;
      if (away < 1e6) {
        ASSERT_TRUE(in.any[i] && in.closest[i] == 0) << i;
      }
    }
  }
}

TEST(RaySpheres, ThousandsInOnePlaceAndOnALine) {
  std::vector<Sphere> list(5000, sphere_at({0, 0, 0}, 1));
  for (int i = 0; i < 5000; ++i) list.push_back(sphere_at({i * 3.0, 5, 0}, 1));
  const auto t = frame_with({}, list);
  const Bvh bvh = build_all(*t);
  EXPECT_EQ(bvh.primitive_count(), 10000u);
  RayBatch rays;
  add_ray(rays, {0, 0, 4}, {0, 0, -1});
  add_ray(rays, {-10, 5, 0}, {1, 0, 0});
  add_ray(rays, {1e6, 5, 0}, {-1, 0, 0});
  add_ray(rays, {30, 5, 0.5}, {0, 1, 0});
  const Answers got = trace(*t, bvh, rays, supported_isas().back());
  EXPECT_EQ(got.closest[0], 0u);
  EXPECT_EQ(got.closest[1], 5000u);
  EXPECT_EQ(got.closest[2], 9999u);
  EXPECT_EQ(got.closest[3], 5010u);
}

}  // namespace
}  // namespace spanray
