#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>

#include "support/test_surfaces.h"

namespace spanray {
namespace {

using LVec = glm::vec<3, long double>;
LVec wide(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

// Positions on random triangles far from and near the origin, each off its true point by all of the stated error: as hard as allowed.
struct PlaneCase {
  LVec normal;  // exact up to long double, to the side of the viewer
  LVec corner;
};
std::unique_ptr<TestSurfaces> hard_positions(uint32_t seed, double scale, int count, std::vector<PlaneCase>& planes) {
  TestRandom random(seed);
  auto t = make_test_surfaces(seed, count, Shading::kPhong, false);
  SurfaceBatch& s = t->surfaces;
  clear_surfaces(s, count);
  planes.clear();
  for (int i = 0; i < count; ++i) {
    // Sizes from the scale down to a thousandth, at up to 100 scales from the origin, often with axis-parallel edges.
    const double size = scale * std::pow(10.0, -random.uniform(0, 3));
    const glm::dvec3 offset = random.below(2) ? random_vector(random, 0, 100) * scale : glm::dvec3(0);
    LVec v[3];
    for (LVec& p : v) {
      glm::dvec3 q = offset + size * random_unit(random);
      if (i % 3 == 0) q[i / 3 % 3] = offset[i / 3 % 3];
      for (int k = 0; k < 3; ++k) p[k] = static_cast<float>(q[k]);
    }
    LVec n = cross3(v[1] - v[0], v[2] - v[0]);
    n = n / std::sqrt(dot3(n, n));
    if (!(dot3(n, n) > 0.5L)) { n = LVec(0, 0, 1); }
    if (random.below(2)) n = -n;
    long double w[3] = {random.uniform(), random.uniform(), random.uniform()};
    if (i % 5 == 0) w[1] = w[2] = 0;
    const long double sum = w[0] + w[1] + w[2];
    const LVec exact = (w[0] / sum) * v[0] + (w[1] / sum) * v[1] + (w[2] / sum) * v[2];
    long double reach = 0, error = 0;
    for (int k = 0; k < 3; ++k) reach = std::max(reach, std::fabs(exact[k]) * 0x1p-22L);
    for (int k = 0; k < 3; ++k) {
      s.position[k][i] = static_cast<float>(exact[k] - (i % 2 ? std::copysign(reach, n[k]) : 0));  // into the surface
      error = std::max(error, std::fabs(s.position[k][i] - exact[k]));
    }
    s.position_error[i] = std::nextafterf(static_cast<float>(error), INFINITY);
    s.valid[i] = 1;
    s.pixel[i] = static_cast<uint32_t>(i * 7);
    const glm::dvec3 g(n.x, n.y, n.z);
    put3(s.geometric_normal, i, g), put3(s.normal, i, g), put3(s.view, i, g), put3(s.mirror, i, glm::dvec3(0.5));
    planes.push_back({n, v[0]});
  }
  return t;
}

TEST(ShadowRays, O1_OriginsLieStrictlyOffThePlaneOnTheSideOfTheLight) {
  std::vector<PlaneCase> planes;
  for (const double scale : {1e-3, 1e-1, 1.0, 1e2, 1e4, 1e6}) {
    auto t = hard_positions(100, scale, 3000, planes);
    TestRandom random(101);
    int seen = 0;
    for (int kind = 0; kind < 2; ++kind) {
      Light light;
      light.kind = kind;
      const glm::dvec3 p = 50 * scale * random_unit(random), d = random_unit(random);
      for (int k = 0; k < 3; ++k) light.position[k] = static_cast<float>(p[k]), light.direction[k] = static_cast<float>(d[k]);
      t->scene().lights = {light};
      for (const Isa isa : supported_isas()) {
        t->frame().isa = isa;
        RayBatch rays;
        AlignedBuffer<uint32_t> of;
        make_shadow_rays(t->frame(), t->surfaces, 0, rays, of);
        for (size_t r = 0; r < of.size(); ++r, ++seen) {
          const int i = static_cast<int>(of[r]);
          const PlaneCase& plane = planes[static_cast<size_t>(i)];
          const LVec origin(rays.origin[0][r], rays.origin[1][r], rays.origin[2][r]);
          ASSERT_GT(dot3(plane.normal, origin - plane.corner), 0) << "scale " << scale << " surface " << i;
          // ... and no farther off than the error asks for.
          const LVec moved = origin - wide(get3(t->surfaces.position, i));
          const long double ulp = 0x1p-23L * std::max({std::fabs(origin.x), std::fabs(origin.y), std::fabs(origin.z)});
          ASSERT_LE(std::sqrt(dot3(moved, moved)), 2 * t->surfaces.position_error[i] + 4 * ulp);
          for (int k = 0; k < 3; ++k) {
            const float want = kind == 0 ? light.position[k] - rays.origin[k][r] : -light.direction[k];
            ASSERT_EQ(rays.direction[k][r], want);
          }
          ASSERT_EQ(rays.t_max[r], kind == 0 ? 1.0f - 0x1p-16f : INFINITY);
          ASSERT_EQ(rays.pixel[r], static_cast<uint32_t>(i * 7));
        }
      }
    }
    EXPECT_GT(seen, 3000);
  }
}

// A lamp's own surface, which contains the light, must not shadow it; a wall at 2^-14 of the distance before it must.
TEST(ShadowRays, LampAroundALightDoesNotShadowIt) {
  TestRandom random(111);
  for (int n = 0; n < 2000; ++n) {
    const double scale = std::pow(10.0, random.uniform(-3, 6));
    LVec origin, light, direction;
    for (int k = 0; k < 3; ++k) {
      const float o = static_cast<float>(random.uniform(-scale, scale)), l = static_cast<float>(random.uniform(-scale, scale));
      const float d = l - o;
      origin[k] = o, light[k] = l, direction[k] = d;
    }
    LVec plane = wide(random_unit(random));
    const long double slope = dot3(plane, direction) / std::sqrt(dot3(direction, direction));
    if (std::fabs(slope) < 0.02L) continue;  // nearly in the plane of the lamp
    const long double t = dot3(plane, light - origin) / dot3(plane, direction);
    EXPECT_GT(t, 1.0L - 0x1p-16L + 0x1p-18L) << "room for the error of a triangle test";
  }
}

TEST(ShadowRays, AppendAndAgreeOnEveryInstructionSet) {
  for (const Shading shading : {Shading::kFlat, Shading::kGouraud, Shading::kPhong}) {
    auto t = make_test_surfaces(121, 1003, shading, false);
    RayBatch want;
    AlignedBuffer<uint32_t> want_of;
    t->frame().isa = Isa::kScalar;
    for (int l = 0; l < 6; ++l) make_shadow_rays(t->frame(), t->surfaces, l, want, want_of);
    EXPECT_GT(want.count, 1000);
    for (const Isa isa : supported_isas()) {
      t->frame().isa = isa;
      RayBatch rays;
      AlignedBuffer<uint32_t> of;
      for (int l = 0; l < 6; ++l) make_shadow_rays(t->frame(), t->surfaces, l, rays, of);
      ASSERT_EQ(rays.count, want.count);
      ASSERT_EQ(of.size(), want_of.size());
      EXPECT_EQ(std::memcmp(of.data(), want_of.data(), of.size() * 4), 0);
      for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(std::memcmp(rays.origin[k].data(), want.origin[k].data(), of.size() * 4), 0);
        EXPECT_EQ(std::memcmp(rays.direction[k].data(), want.direction[k].data(), of.size() * 4), 0);
      }
    }
  }
}

TEST(BounceRays, MirrorsAboutTheNormalAndNeverBelowTheHorizon) {
  TestRandom random(131);
  constexpr int kCount = 3001;
  auto t = make_test_surfaces(132, kCount, Shading::kPhong, false);
  SurfaceBatch& s = t->surfaces;
  for (int i = 0; i < kCount; ++i) {
    const glm::dvec3 g = random_unit(random);
    // Shading normals and views anywhere in the hemisphere, often grazing.
    const auto above = [&](double lift) {
      glm::dvec3 v = random_unit(random);
      v = v - dot3(v, g) * g + std::fabs(dot3(v, g)) * lift * g;
      return normalize3(v, g);
    };
    put3(s.geometric_normal, i, g), put3(s.normal, i, above(i % 3 ? 1 : 1e-6)), put3(s.view, i, above(i % 4 ? 1 : 1e-6));
    put3(s.mirror, i, i % 7 == 0 ? glm::dvec3(0) : i % 7 == 1 ? glm::dvec3(0, 0, 1e-6) : glm::dvec3(0.5));
  }
  for (const Isa isa : supported_isas()) {
    t->frame().isa = isa;
    RayBatch rays;
    AlignedBuffer<uint32_t> of;
    make_bounce_rays(t->frame(), s, t->hits, rays, of);
    size_t next = 0;
    int lifted = 0;
    for (int i = 0; i < kCount; ++i) {
      if (!s.valid[i] || s.mirror[2][i] == 0) continue;
      ASSERT_LT(next, of.size());
      ASSERT_EQ(of[next], static_cast<uint32_t>(i));
      const glm::dvec3 r(rays.direction[0][next], rays.direction[1][next], rays.direction[2][next]);
      const glm::dvec3 d = -get3(s.view, i), n = get3(s.normal, i), g = get3(s.geometric_normal, i);
      ASSERT_GT(dot3(wide(g), wide(r)), 0);
      const glm::dvec3 want = d - 2 * dot3(d, n) * n;
      if (dot3(want, g) > 0x1p-9) {
        ASSERT_LT(length3(r - want), 1e-6);
      } else {
        ASSERT_LT(length3((r - dot3(r, g) * g) - (want - dot3(want, g) * g)), 1e-6) << "moved along the normal only";
        ++lifted;
      }
      ASSERT_EQ(rays.t_max[next], INFINITY);
      ASSERT_EQ(rays.pixel[next], s.pixel[i]);
      ++next;
    }
    EXPECT_EQ(next, of.size());
    EXPECT_EQ(rays.count, static_cast<int>(of.size()));
    EXPECT_GT(lifted, 100);
  }
}

TEST(BounceRays, O1_OriginsLieStrictlyOffThePlane) {
  std::vector<PlaneCase> planes;
  for (const double scale : {1e-3, 1.0, 1e6}) {
    auto t = hard_positions(141, scale, 3000, planes);
    t->frame().isa = resolve_isa(Isa::kAuto);
    RayBatch rays;
    AlignedBuffer<uint32_t> of;
    make_bounce_rays(t->frame(), t->surfaces, t->hits, rays, of);
    ASSERT_EQ(of.size(), 3000u);
    for (size_t i = 0; i < of.size(); ++i) {
      const LVec origin(rays.origin[0][i], rays.origin[1][i], rays.origin[2][i]);
      ASSERT_GT(dot3(planes[i].normal, origin - planes[i].corner), 0);
    }
  }
}

// Mirror ray of the plane through 0 with normal n, from the ray (o, d): where it starts and goes, in double.
struct Reflection { glm::dvec3 p, r; };
Reflection reflect_at_plane(const glm::dvec3& o, const glm::dvec3& d, const glm::dvec3& n) {
  const glm::dvec3 u = d / length3(d);
  return {o - dot3(o, n) / dot3(u, n) * u, u - 2 * dot3(u, n) * n};
}

TEST(BounceRays, DifferentialsOfPlaneMirrorsMatchFiniteDifferences) {
  TestRandom random(151);
  for (const bool bounce : {false, true})
    for (int trial = 0; trial < 200; ++trial) {
      auto t = make_test_surfaces(152, 1, Shading::kPhong, bounce);
      clear_surfaces(t->surfaces, 1);
      SurfaceBatch& s = t->surfaces;
      const PrimaryRays& p = t->frame().primary;
      const int x = random.below(64), y = random.below(64);
      glm::dvec3 o = p.eye, d = p.corner + (x + 0.5) * p.step_x + (y + 0.5) * p.step_y;
      glm::dvec3 ox(0), oy(0), dx = p.step_x, dy = p.step_y;
      if (bounce) {
        t->rays.resize(1, true);
        d = random_vector(random, 0.5, 2);
        o = -3.0 * d + 0.1 * random_unit(random);
        ox = 0.01 * random_unit(random), oy = 0.01 * random_unit(random);
        dx = 0.01 * random_unit(random), dy = 0.01 * random_unit(random);
        float* const direction[3] = {t->rays.direction[0].data(), t->rays.direction[1].data(), t->rays.direction[2].data()};
        float* const direction_dx[3] = {t->rays.direction_dx[0].data(), t->rays.direction_dx[1].data(), t->rays.direction_dx[2].data()};
        float* const direction_dy[3] = {t->rays.direction_dy[0].data(), t->rays.direction_dy[1].data(), t->rays.direction_dy[2].data()};
        put3(direction, 0, d), put3(direction_dx, 0, dx), put3(direction_dy, 0, dy);
      }
      glm::dvec3 n = normalize3(random_unit(random) - 1.2 * d / length3(d), -d);
      const Reflection at = reflect_at_plane(o, d, n);
      const double h = 1e-4;
      const auto difference = [&](const glm::dvec3& by_o, const glm::dvec3& by_d) {
        const Reflection a = reflect_at_plane(o - h * by_o, d - h * by_d, n), b = reflect_at_plane(o + h * by_o, d + h * by_d, n);
        return Reflection{(b.p - a.p) / (2 * h), (b.r - a.r) / (2 * h)};
      };
      const Reflection by_x = difference(ox, dx), by_y = difference(oy, dy);
      s.valid[0] = 1;
      s.pixel[0] = pack_pixel(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
      put3(s.position, 0, at.p), put3(s.normal, 0, n), put3(s.geometric_normal, 0, n), put3(s.view, 0, -d / length3(d));
      put3(s.mirror, 0, glm::dvec3(1)), put3(s.dpdx, 0, by_x.p), put3(s.dpdy, 0, by_y.p);
      RayBatch rays;
      AlignedBuffer<uint32_t> of;
      make_bounce_rays(t->frame(), s, t->hits, rays, of);
      ASSERT_EQ(rays.count, 1);
      const double near = 1e-5 * (length3(by_x.r) + length3(by_y.r)) + 1e-8;
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(rays.direction_dx[k][0], by_x.r[k], near);
        EXPECT_NEAR(rays.direction_dy[k][0], by_y.r[k], near);
        EXPECT_EQ(rays.origin_dx[k][0], static_cast<float>(by_x.p[k]));
        EXPECT_EQ(rays.origin_dy[k][0], static_cast<float>(by_y.p[k]));
      }
    }
}

}  // namespace
}  // namespace spanray
