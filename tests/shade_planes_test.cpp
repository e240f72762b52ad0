// Surfaces of planes: within their bound of the plane, and the rays that leave them start on the side that was hit.
#include <gtest/gtest.h>

#include <cmath>

#include "frame/exact_hit.h"
#include "shade/light.h"
#include "support/plane_scenes.h"

namespace spanray {
namespace {

__extension__ typedef __float128 Quad;

// Of a place of floats over the plane, in units of length.
double height(const Plane& p, const float (&at)[3]) {
  Quad sum = 0;
  for (int k = 0; k < 3; ++k) sum += Quad(p.normal[k]) * (Quad(at[k]) - Quad(p.point[k]));
  return static_cast<double>(sum) / length3(normal_of(p));
}

struct Case {
  double scale, away;
  bool below, tilted;
};

void check(const Case& c) {
  TestRandom random(12);
  Material mirror;
  mirror.mirror[0] = mirror.mirror[1] = mirror.mirror[2] = 1;
  SceneData scene = make_test_scene({}, {mirror});
  const glm::dvec3 normal = c.tilted ? glm::dvec3(0.37, 0.8, -0.55) : glm::dvec3(0, 1, 0);
  const Plane plane = plane_at(glm::dvec3(0.6, -0.3, 0.7) * (c.away * c.scale), normal);
  add_plane(plane, scene);
  const auto t = make_test_frame(std::move(scene), Camera(), test_settings(16, 16));
  t->frame.plan.bounces = true;

  constexpr int kRays = 3000;
  RayBatch rays;
  HitBatch hits;
  rays.resize(kRays, false), hits.resize(kRays, true);
  hits.rays = &rays;
  const glm::dvec3 up = normalize3(normal_of(plane), normal) * (c.below ? -1.0 : 1.0), foot = point_of(plane);
  int made = 0;
  while (made < kRays) {
    const glm::dvec3 from = foot + (random_point(random) + up * random.uniform(1, 5)) * c.scale;
    const glm::dvec3 side = random_point(random), d = side - up * (dot3(side, up) + std::pow(10, random.uniform(-4, 0)));
    for (int k = 0; k < 3; ++k)
      rays.origin[k][made] = static_cast<float>(from[k]), rays.direction[k][made] = static_cast<float>(d[k]);
    const float at[3] = {rays.origin[0][made], rays.origin[1][made], rays.origin[2][made]};
    if ((height(plane, at) < 0) != c.below || height(plane, at) == 0) continue;  // rounding moved it across
    rays.t_max[made] = INFINITY, rays.pixel[made] = 0;
    hits.pixel[made] = 0, hits.ray[made] = static_cast<uint32_t>(made), hits.primitive[made] = 0;
    ++made;
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
    double reach = 0;  // what an error of the bound in each coordinate makes
    for (int k = 0; k < 3; ++k) reach += std::fabs(up[k]) * static_cast<double>(surfaces.position_error[i]);
    ASSERT_LE(std::fabs(height(plane, at)), reach) << i;
    closest_to_bound = std::max(closest_to_bound, std::fabs(height(plane, at)) / reach);
    ASSERT_EQ(height(plane, start) < 0, c.below) << i;
    ASSERT_NE(height(plane, start), 0) << i;
    float out[3] = {leaving.direction[0][i], leaving.direction[1][i], leaving.direction[2][i]};
    ASSERT_GT(dot3(glm::dvec3(out[0], out[1], out[2]), up), 0) << i;
  }
  if (c.tilted) {
    EXPECT_GT(closest_to_bound, 0.1) << "the bound is not a wild guess";
  }
}

TEST(ShadePlanes, PositionsKeepTheirBoundAndRaysStartOnTheirSide) {
  for (const double scale : {0x1p-20, 1.0, 0x1p20})
    for (const double away : {0.0, 3.0, 1e3, 0x1p17, 0x1p20})
      for (const bool below : {false, true})
        for (const bool tilted : {false, true}) {
          SCOPED_TRACE(testing::Message() << scale << ", " << away << ", " << below << tilted);
          check({scale, away, below, tilted});
        }
}

}  // namespace
}  // namespace spanray
