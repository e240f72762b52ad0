// The footprint of a pixel on a surface: the derivative of the position, against differences of an oracle in long double.
#include <gtest/gtest.h>

#include "support/surface_scenes.h"

namespace spanray {
namespace {

TEST(ShadeFootprint, IsTheDerivativeOfThePosition) {
  TestRandom random(7);
  auto t = full_frame(random_surface_scene(8, 200), random_camera(random, 3), 2048, 2048);
  HitBatch hits;
  random_primary_hits(t->frame, random, 2000, hits);
  SurfaceBatch s;
  resolve_surfaces(t->frame, hits, s);
  int checked = 0;
  for (int i = 0; i < hits.count; ++i) {
    const uint32_t pixel = hits.pixel[static_cast<size_t>(i)], primitive = hits.primitive[static_cast<size_t>(i)];
    const auto hit = [&](Real dx, Real dy) { return oracle_hit(t->scene, primitive, oracle_primary(t->frame, pixel, dx, dy)); };
    if (!hit(0, 0).inside || hit(0, 0).cosine < 0.05L) continue;
    const Real h = 1e-3L;
    const Real3 x = (hit(h, 0).position - hit(-h, 0).position) * (1 / (2 * h)), y = (hit(0, h).position - hit(0, -h).position) * (1 / (2 * h));
    ASSERT_LE(length_real(real3(s.dpdx, i) - x), 1e-5L * length_real(x));
    ASSERT_LE(length_real(real3(s.dpdy, i) - y), 1e-5L * length_real(y));
    ++checked;
  }
  EXPECT_GT(checked, 1000);
}

// Igehy's transfer for rays that are not primary: o + x * do/dx, d + x * dd/dx.
TEST(ShadeFootprint, OfRaysWithDifferentials) {
  TestRandom random(9);
  auto t = full_frame(random_surface_scene(10, 100), Camera{}, 64, 64);
  RayBatch rays;
  HitBatch hits;
  for (int i = 0; i < 500; ++i) {
    const uint32_t primitive = random.bits() % 100;
    const glm::dvec3 o = random_point(random, 3), p = point_on(t->scene, primitive, random);
    add_hit(hits, 0, static_cast<uint32_t>(add_ray(rays, o, p - o)), primitive);
    for (int k = 0; k < 3; ++k)
      for (auto* a : {&rays.origin_dx[k], &rays.origin_dy[k], &rays.direction_dx[k], &rays.direction_dy[k]})
        a->push_back(static_cast<float>(random.uniform(-0.01, 0.01)));
  }
  hits.rays = &rays;
  SurfaceBatch s;
  resolve_surfaces(t->frame, hits, s);
  int checked = 0;
  for (int i = 0; i < hits.count; ++i) {
    const size_t at = static_cast<size_t>(i);
    const auto hit = [&](Real dx) {
      OracleRay r = oracle_ray(rays, i);
      const Real3 o{rays.origin_dx[0][at], rays.origin_dx[1][at], rays.origin_dx[2][at]};
      const Real3 d{rays.direction_dx[0][at], rays.direction_dx[1][at], rays.direction_dx[2][at]};
      return oracle_hit(t->scene, hits.primitive[at], {r.origin + o * dx, r.direction + d * dx});
    };
    if (hit(0).cosine < 0.05L) continue;
    const Real3 x = (hit(1e-3L).position - hit(-1e-3L).position) * 500;
    ASSERT_LE(length_real(real3(s.dpdx, i) - x), 1e-4L * length_real(x)) << i;
    ++checked;
  }
  EXPECT_GT(checked, 300);
}

}  // namespace
}  // namespace spanray
