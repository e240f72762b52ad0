// Hits -> surfaces: weights, position and its error bound, normals, against an oracle in long double.
// Footprints: shade_footprint_test.cpp. Batches: shade_surface_batch_test.cpp.
#include <gtest/gtest.h>

#include "support/surface_scenes.h"

namespace spanray {
namespace {

TEST(ShadeSurface, WeightsPositionAndTFollowTheOracle) {
  TestRandom random(1);
  for (const double distance : {0.5, 3.0, 1000.0}) {
    auto t = full_frame(random_surface_scene(2, 300), random_camera(random, distance), 4096, 4096);
    if (distance > 100) t->frame.primary = make_primary_rays([&] { Camera c = random_camera(random, distance); c.fov_y_degrees = 0.2; return c; }(), 4096, 4096);
    for (const Isa isa : supported_isas()) {
      t->frame.isa = isa;
      TestRandom pick(3);
      HitBatch hits;
      random_primary_hits(t->frame, pick, 2000, hits);
      SurfaceBatch s;
      resolve_surfaces(t->frame, hits, s);
      int checked = 0;
      for (int i = 0; i < hits.count; ++i) {
        const size_t at = static_cast<size_t>(i);
        const OracleHit want = oracle_hit(t->scene, hits.primitive[at], oracle_primary(t->frame, hits.pixel[at]));
        const Real3 v0 = oracle_vertex(t->scene, hits.primitive[at], 0), p = real3(s.position, i);
        const Real bound = s.position_error[i];
        // Never off the triangle's plane by more than the bound, whatever the view.
        ASSERT_LE(std::fabs(dot_real(p - v0, want.normal)), bound * std::sqrt(Real(3))) << distance << " " << i;
        if (!want.inside || want.cosine < Real(1) / 16) continue;
        ++checked;
        for (int k = 0; k < 3; ++k) {
          ASSERT_LE(std::fabs(p[k] - want.position[k]), bound) << distance << " " << i;
          ASSERT_NEAR(s.weight[k][i], static_cast<double>(want.b[k]), 0x1p-20) << distance << " " << i;
        }
        ASSERT_LE(bound, 0x1p-22f * (2 + static_cast<float>(length_real(p)))) << "the bound must stay useful";
        ASSERT_NEAR(s.t[i] / static_cast<double>(want.t), 1, 0x1.1p-24);
      }
      EXPECT_GT(checked, 1000);
    }
  }
}

TEST(ShadeSurface, NormalsFaceTheViewerWhateverTheWindingSays) {
  TestRandom random(5);
  auto t = full_frame(random_surface_scene(6, 200), random_camera(random, 3), 1024, 1024);
  t->frame.plan.bump = false;
  HitBatch hits;
  random_primary_hits(t->frame, random, 3000, hits);
  SurfaceBatch s;
  resolve_surfaces(t->frame, hits, s);
  int fronts = 0, backs = 0;
  for (int i = 0; i < hits.count; ++i) {
    const Triangle& tri = t->scene.triangles[hits.primitive[static_cast<size_t>(i)]];
    const OracleHit want = oracle_hit(t->scene, hits.primitive[static_cast<size_t>(i)], oracle_primary(t->frame, hits.pixel[static_cast<size_t>(i)]));
    const bool front = facing(t->scene, tri, t->frame.primary.eye) >= 0;
    (front ? fronts : backs)++;
    const Real3 g = real3(s.geometric_normal, i), n = real3(s.normal, i);
    const Real3 toward = want.normal * (((tri.bits & kTriangleFlipped) != 0) == front ? -1 : 1);
    ASSERT_LE(length_real(g - toward), 1e-6L);
    ASSERT_GE(dot_real(g, real3(s.view, i)), -1e-6L);
    ASSERT_GT(dot_real(g, n), 0x1p-11L) << "horizon";
    ASSERT_NEAR(static_cast<double>(length_real(n)), 1, 1e-6);
    Real3 blend, sum;
    for (int c = 0; c < 3; ++c) {
      const Real3 corner = real3(t->scene.vertices[tri.vertex[c]].normal);
      blend = blend + corner * s.weight[c][i];
      sum = sum + corner;
    }
    const Real agree = dot_real(sum, g);  // the three corner normals turn as one
    const Real3 smooth = blend * ((agree < 0 ? -1 : 1) / length_real(blend));
    if (dot_real(smooth, g) > 0.01L && fabsl(agree) > 1e-4L) {
      ASSERT_LE(length_real(smooth - n), 1e-5L) << i;
    }
  }
  EXPECT_GT(fronts, 500);
  EXPECT_GT(backs, 500);
  t->frame.settings.shading = Shading::kFlat;
  resolve_surfaces(t->frame, hits, s);
  for (int i = 0; i < hits.count; ++i)
    for (int k = 0; k < 3; ++k) ASSERT_EQ(bits_of(s.normal[k][i]), bits_of(s.geometric_normal[k][i]));
}

TEST(ShadeSurface, EdgeOnAndDegenerateTrianglesStayFiniteAndOnTheTriangle) {
  const std::vector<SoupTriangle> soup = {
      soup_triangle({0, -1, -1}, {0, 1, 0}, {0, -1, 1}),      // seen exactly edge-on from +z
      soup_triangle({0, 0, 0}, {0.5, 0, 0}, {0.25, 0, 0}),    // a line
      soup_triangle({0.1, 0, 0}, {0.1, 0, 0}, {0.1, 0, 0}),   // a point
      soup_triangle({0, 0, 1e-30}, {1e-30, 0, 0}, {0, 1e-30, 0}),
      soup_triangle({-1e30, -1e30, -1e30}, {1e30, -1e30, -1e29}, {0, 1e30, -1e28}),
      soup_triangle({0, 0, 5}, {1, 0, 5}, {0, 1, 5}),         // its vertices at the origin of the ray
  };
  auto t = full_frame(make_test_scene(soup), Camera{}, 64, 64);
  RayBatch rays;
  HitBatch hits;
  hits.rays = &rays;
  for (uint32_t p = 0; p < soup.size(); ++p)
    for (const glm::dvec3& d : {glm::dvec3(0, 0, -1), glm::dvec3(0.02, 0, -1), glm::dvec3(0, 0.01, -1), glm::dvec3(1e-20, 1e-20, -1), glm::dvec3(0)})
      add_hit(hits, 0, static_cast<uint32_t>(add_ray(rays, {0, 0, 5}, d)), p);
  for (const Isa isa : supported_isas()) {
    t->frame.isa = isa;
    SurfaceBatch s;
    resolve_surfaces(t->frame, hits, s);
    for (int i = 0; i < hits.count; ++i) {
      for (const BatchField& f : batch_fields(s)) ASSERT_TRUE(std::isfinite(f.data[i])) << f.name << " " << i;
      float sum = 0;
      for (int k = 0; k < 3; ++k) {
        ASSERT_TRUE(s.weight[k][i] >= 0 && s.weight[k][i] <= 1);
        sum += s.weight[k][i];
      }
      ASSERT_NEAR(sum, 1, 1e-6) << i;
    }
  }
}

TEST(ShadeSurface, PixelsOutsideAreClampedToTheTriangle) {
  auto t = full_frame(make_test_scene({soup_triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0})}), Camera{}, 256, 256);
  HitBatch hits;
  for (uint32_t y = 0; y < 256; y += 3)
    for (uint32_t x = 0; x < 256; x += 3) add_hit(hits, pack_pixel(x, y), 0, 0);
  SurfaceBatch s;
  resolve_surfaces(t->frame, hits, s);
  int outside = 0;
  for (int i = 0; i < hits.count; ++i) {
    outside += !oracle_hit(t->scene, 0, oracle_primary(t->frame, hits.pixel[static_cast<size_t>(i)])).inside;
    ASSERT_NEAR(s.weight[0][i] + s.weight[1][i] + s.weight[2][i], 1, 2e-7);
    for (int k = 0; k < 3; ++k) ASSERT_TRUE(s.weight[k][i] >= 0 && s.weight[k][i] <= 1);
    ASSERT_TRUE(std::fabs(s.position[0][i]) <= 1 && std::fabs(s.position[1][i]) <= 1);
  }
  EXPECT_GT(outside, 1000);
}

// The walls of a room meet at its edges: a position past the edge of its wall would lie behind the next one, in its shadow.
TEST(ShadeSurface, PositionsInARoomAreNotBehindItsOtherWalls) {
  constexpr float kHalf = 1.3f;
  std::vector<SoupTriangle> room;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-double{kHalf}, double{kHalf}}) {
      const auto corner = [&](double a, double b) {
        glm::dvec3 p;
        p[axis] = side, p[(axis + 1) % 3] = a, p[(axis + 2) % 3] = b;
        return p;
      };
      room.push_back(soup_triangle(corner(-kHalf, -kHalf), corner(kHalf, -kHalf), corner(kHalf, kHalf)));
      room.push_back(soup_triangle(corner(-kHalf, -kHalf), corner(kHalf, kHalf), corner(-kHalf, kHalf)));
    }
  TestRandom random(21);
  for (int view = 0; view < 6; ++view) {
    Camera camera;  // along an axis: the room's edges run exactly through centers of pixels
    for (int k = 0; k < 3; ++k) camera.eye[k] = 0, camera.target[k] = 0;
    camera.eye[view % 3] = random.uniform(-0.9, 0.9), camera.target[view % 3] = view < 3 ? -2 : 2;
    if (view % 3 == 1) camera.up[0] = 1, camera.up[1] = 0;
    camera.fov_y_degrees = 90;
    auto t = full_frame(make_test_scene(room), camera, 200, 200);
    HitBatch hits;
    for (uint32_t i = 0; i < 200 * 200; ++i) {
      const uint32_t pixel = pack_pixel(i % 200, i / 200);
      for (uint32_t p = 0; p < room.size(); ++p) {
        // A little to each side, as snapping moves edges.
        const auto seen = [&](double dx) {
          const OracleHit hit = oracle_hit(t->scene, p, oracle_primary(t->frame, pixel, dx));
          return hit.inside && hit.t > 0;
        };
        if (seen(0) || seen(1.0 / 256) || seen(-1.0 / 256)) add_hit(hits, pixel, 0, p);
      }
    }
    for (const Isa isa : supported_isas()) {
      t->frame.isa = isa;
      SurfaceBatch s;
      resolve_surfaces(t->frame, hits, s);
      for (int i = 0; i < hits.count; ++i) {
        const uint32_t axis = hits.primitive[static_cast<size_t>(i)] / 4;
        for (uint32_t k = 0; k < 3; ++k) {
          if (k == axis) EXPECT_LE(std::fabs(std::fabs(s.position[k][i]) - kHalf), s.position_error[i]);
          else ASSERT_LE(std::fabs(s.position[k][i]), kHalf) << isa_name(isa) << " axis " << axis << ", " << k << ", view " << view;
        }
      }
    }
  }
}

}  // namespace
}  // namespace spanray
