// Rays that leave a surface (HARD-CASES Y7): the origin is moved off by the error of its position and by nothing else.
#include <gtest/gtest.h>

#include "ray/bvh.h"
#include "support/bvh_oracle.h"

namespace spanray {
namespace {

// A point of a triangle in float, with the bound on the error of its coordinates.
struct SurfacePoint {
  glm::dvec3 position, normal;
  double error;
};
SurfacePoint point_on(const SceneData& scene, uint32_t primitive, TestRandom& random) {
  const glm::dvec3 a = scene_vertex(scene, primitive, 0), b = scene_vertex(scene, primitive, 1), c = scene_vertex(scene, primitive, 2);
  double u = random.uniform(), v = random.uniform();
  if (u + v > 1) u = 1 - u, v = 1 - v;
  const glm::dvec3 exact = a + (b - a) * u + (c - a) * v;
  SurfacePoint p;
  p.position = glm::dvec3(glm::vec3(exact));
  p.normal = normalize3(cross3(b - a, c - a), glm::dvec3(0));
  if (scene.triangles[primitive].bits & kTriangleFlipped) p.normal = -p.normal;
  p.error = std::max({std::fabs(exact.x), std::fabs(exact.y), std::fabs(exact.z)}) * 0x1p-24;
  return p;
}

// Pharr, Jakob, Humphreys, 6.8.6: along the normal by the error's extent, then each coordinate outward to the next float.
glm::dvec3 leave(const SurfacePoint& p) {
  const double offset = p.error * (std::fabs(p.normal.x) + std::fabs(p.normal.y) + std::fabs(p.normal.z));
  glm::dvec3 origin;
  for (int k = 0; k < 3; ++k) {
    const double exact = p.position[k] + offset * p.normal[k];
    float f = static_cast<float>(exact);
    if (p.normal[k] > 0 && static_cast<double>(f) < exact) f = std::nextafter(f, kInfinity);
    if (p.normal[k] < 0 && static_cast<double>(f) > exact) f = std::nextafter(f, -kInfinity);
    origin[k] = static_cast<double>(f);
  }
  return origin;
}

// A float direction in the open hemisphere of n, with cos(n, d) about `cosine`; false if rounding took it out.
bool direction_above(const glm::dvec3& n, double cosine, TestRandom& random, glm::dvec3& d) {
  glm::dvec3 side = cross3(n, random_point(random, 1));
  side = normalize3(side, glm::dvec3(1, 0, 0));
  d = glm::dvec3(glm::vec3(n * cosine + side * std::sqrt(1 - cosine * cosine)));
  return dot3(n, d) > 1e-9;
}

TEST(RayOrigin, Y7_NoSelfHitAtAnyScaleAndAngle) {
  const IndexedMesh mesh = make_sphere(3);
  for (double scale = 1e-3; scale < 2e6; scale *= 10) {
    std::vector<SoupTriangle> soup;
    add_mesh(soup, mesh, scale, glm::dvec3(0));
    auto t = make_test_frame(make_test_scene(soup), Camera(), test_settings(16, 16));
    const Bvh bvh = build_bvh(t->scene, t->material_flags.data(), 0, 0, *t->parallel);
    TestRandom random(31);
    constexpr int kRays = 10000;
    RayBatch rays = make_rays(kRays);
    std::vector<uint32_t> from(kRays);
    for (int i = 0; i < kRays;) {
      const uint32_t p = static_cast<uint32_t>(random.below(static_cast<int>(soup.size())));
      const SurfacePoint point = point_on(t->scene, p, random);
      glm::dvec3 d;
      if (!direction_above(point.normal, std::pow(10.0, -random.uniform(0, 7)), random, d)) continue;
      const glm::dvec3 origin = leave(point);
      ASSERT_GT(facing(t->scene, t->scene.triangles[p], origin), 0);
      from[static_cast<size_t>(i)] = p;
      set_ray(rays, i++, origin, d);
    }
    for (const Isa isa : supported_isas()) {
      t->frame.isa = isa;
      std::vector<uint32_t> closest(kRays), any(kRays / 32 + 1);
      trace_closest(t->frame, bvh, rays, closest.data());
      trace_any(t->frame, bvh, rays, any.data());
      int self_hits = 0, other_hits = 0;
      for (size_t i = 0; i < kRays; ++i) {
        self_hits += closest[i] == from[i];
        other_hits += closest[i] != kNoPrimitive && closest[i] != from[i];
        ASSERT_EQ(any[i / 32] >> (i % 32) & 1, closest[i] != kNoPrimitive);
      }
      EXPECT_EQ(self_hits, 0) << isa_name(isa) << " scale " << scale;
      // A sphere is convex: whatever leaves a face upward is gone. (Vertices are rounded, so faces may be concave by an ulp.)
      EXPECT_LE(other_hits, 2) << isa_name(isa) << " scale " << scale;
    }
  }
}

TEST(RayOrigin, Y7_BlockersAtATenThousandthAreFound) {
  for (double scale = 1e-3; scale < 2e6; scale *= 10) {
    const double s = scale, h = 1e-4 * scale;
    // A floor, and over it a small and a very large blocker.
    auto t = make_test_frame(make_test_scene({soup_triangle({-s, 0, -s}, {-s, 0, 3 * s}, {3 * s, 0, -s}),
                                              soup_triangle({-0.1 * s, h, -0.1 * s}, {0.3 * s, h, -0.1 * s}, {-0.1 * s, h, 0.3 * s}),
                                              soup_triangle({-1e3 * s, 2 * h, -1e3 * s}, {3e3 * s, 2 * h, -1e3 * s}, {-1e3 * s, 2 * h, 3e3 * s})}),
                             Camera(), test_settings(16, 16));
    const Bvh bvh = build_bvh(t->scene, t->material_flags.data(), 0, 0, *t->parallel);
    TestRandom random(32);
    constexpr int kRays = 2000;
    RayBatch rays = make_rays(kRays);
    std::vector<uint32_t> want(kRays);
    for (int i = 0; i < kRays; ++i) {
      const bool small = i % 2 == 0;
      const double extent = small ? 0.05 : 0.5, tilt = small ? 10 : 1000;  // by height: stays under the small, goes past it under the large
      SurfacePoint p;
      p.position = glm::dvec3(glm::vec3(static_cast<float>(random.uniform(-extent, extent) * s), 0, static_cast<float>(random.uniform(-extent, extent) * s)));
      if (!small) p.position.x = static_cast<double>(static_cast<float>(0.6 * s));
      p.normal = {0, 1, 0}, p.error = s * 0x1p-24;
      set_ray(rays, i, leave(p), {random.uniform(0, tilt), 1, small ? random.uniform(-tilt, tilt) : 0});
      want[static_cast<size_t>(i)] = small ? 1 : 2;
    }
    for (const Isa isa : supported_isas()) {
      t->frame.isa = isa;
      std::vector<uint32_t> closest(kRays);
      trace_closest(t->frame, bvh, rays, closest.data());
      EXPECT_EQ(closest, want) << isa_name(isa) << " scale " << scale;
    }
  }
}

}  // namespace
}  // namespace spanray
