// Surfaces of spheres: within their bound of the sphere, and the rays that leave them start on the side that was hit.
#include <gtest/gtest.h>

#include <cmath>

#include "frame/exact_hit.h"
#include "shade/light.h"
#include "support/random.h"
#include "support/test_frame.h"

namespace spanray {
namespace {

// Of a place of floats, against the sphere, in units of the radius: > 0 outside.
long double outside(const Sphere& s, const float (&p)[3]) {
  long double square = 0;
  for (int k = 0; k < 3; ++k)
    square += (static_cast<long double>(p[k]) - s.center[k]) * (static_cast<long double>(p[k]) - s.center[k]);
  return std::sqrt(square) / s.radius - 1;
}

glm::dvec3 unit(TestRandom& random) {
  for (;;)
    if (const glm::dvec3 p = random_point(random); length3(p) > 0.1 && length3(p) <= 1) return p / length3(p);
}

struct Case {
  double scale, away;
  bool inside;
};

void check(const Case& c) {
  TestRandom random(12);
  Material mirror;
  mirror.mirror[0] = mirror.mirror[1] = mirror.mirror[2] = 1;
  SceneData scene = make_test_scene({}, {mirror});
  Sphere sphere{};
  const glm::dvec3 place = unit(random) * (c.away * c.scale);
  for (int k = 0; k < 3; ++k) sphere.center[k] = static_cast<float>(place[k]);
  sphere.radius = static_cast<float>(c.scale);
  add_sphere(sphere, scene);
  const auto t = make_test_frame(std::move(scene), Camera(), test_settings(16, 16));
  t->frame.plan.bounces = true;

  constexpr int kRays = 3000;
  RayBatch rays;
  HitBatch hits;
  rays.resize(kRays, false), hits.resize(kRays, true);
  hits.rays = &rays;
  const glm::dvec3 center = center_of(sphere);
  for (int i = 0; i < kRays; ++i) {
    const glm::dvec3 from = center + unit(random) * (c.inside ? 0.3 : 5) * c.scale;
    const glm::dvec3 to = center + unit(random) * random.uniform(0, 0.9) * c.scale - from;
    for (int k = 0; k < 3; ++k)
      rays.origin[k][i] = static_cast<float>(from[k]), rays.direction[k][i] = static_cast<float>(to[k]);
    rays.t_max[i] = INFINITY, rays.pixel[i] = 0;
    hits.pixel[i] = 0, hits.ray[i] = static_cast<uint32_t>(i), hits.primitive[i] = 0;
  }
  SurfaceBatch surfaces;
  resolve_surfaces(t->frame, hits, surfaces);
  RayBatch leaving;
  AlignedBuffer<uint32_t> surface_of_ray;
  make_bounce_rays(t->frame, surfaces, hits, leaving, surface_of_ray);
  ASSERT_EQ(leaving.count, kRays);
  double closest_to_bound = 0;
  for (int i = 0; i < kRays; ++i) {
    const float at[3] = {surfaces.position[0][i], surfaces.position[1][i], surfaces.position[2][i]};
    const float start[3] = {leaving.origin[0][i], leaving.origin[1][i], leaving.origin[2][i]};
    const double off = std::fabs(static_cast<double>(outside(sphere, at))) * c.scale,
                 bound = std::sqrt(3.0) * surfaces.position_error[i];
    ASSERT_LE(off, bound) << i;
    closest_to_bound = std::max(closest_to_bound, off / bound);
    ASSERT_EQ(outside(sphere, start) > 0, !c.inside) << i << ": " << static_cast<double>(outside(sphere, start));
  }
  EXPECT_GT(closest_to_bound, 0.1) << "the bound is not a wild guess";
}

TEST(ShadeSpheres, PositionsKeepTheirBoundAndRaysStartOnTheirSide) {
  for (const double scale : {0x1p-20, 1.0, 0x1p20})
    for (const double away : {0.0, 3.0, 1e3, 0x1p17, 0x1p20})
      for (const bool inside : {false, true}) {
        SCOPED_TRACE(testing::Message() << scale << ", " << away << ", " << inside);
        check({scale, away, inside});
      }
}

}  // namespace
}  // namespace spanray
