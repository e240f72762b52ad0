// Settings::shadow_terminator: what lifted shadow rays light, what they must not, and where they change nothing. How far they take a
// coarse mesh toward a fine one is measured by hard case S8.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/plan.h"
#include "render/trace_pixel.h"
#include "support/camera_at.h"
#include "support/frame_count.h"
#include "support/sample_pictures.h"
#include "support/terminator_scenes.h"

namespace spanray {
namespace {

const Light kSun = directional_light({0.96, 0.28, 0}), kLamp = lamp({3, 1, 0.4});
const Camera kFront = [] {
  Camera camera = camera_at({0, 0, 4}, {0, 0, 0});
  camera.fov_y_degrees = 36;
  return camera;
}();

struct Lit { size_t lit = 0, surfaces = 0; };
Lit count_lit(const Framebuffer& f, uint32_t below = kNoPrimitive) {
  Lit n;
  for (size_t i = 0; i < f.primitive.size(); ++i) {
    if (f.primitive[i] >= below) continue;
    ++n.surfaces, n.lit += f.radiance[3 * i] != 0;
  }
  return n;
}

uint64_t shadow_rays(const Scene& scene, const Settings& settings) {
  Framebuffer frame;
  return count(Renderer().render(scene, kFront, settings, frame).value(), "rays_shadow");
}

const Shading kSmooth[] = {Shading::kGouraud, Shading::kPhong};

// Where the blocks were: more of a coarse sphere is lit, nearly as much as of the true one, and what was lit stays as it was.
TEST(ShadowTerminator, LightEndsWhereTheNormalsSay) {
  for (const Light& light : {kSun, kLamp})
    for (const Visibility engine : kEngines)
      for (const Shading shading : kSmooth) {
        const Scene scene = scene_of(sphere(1, 1), {light});
        Settings off = small(ShadowTerminator::kOff), on = small(ShadowTerminator::kLifted);
        off.visibility = on.visibility = engine, off.shading = on.shading = shading;
        const Framebuffer before = render(scene, kFront, off), after = render(scene, kFront, on);
        size_t wrong = 0, more = 0, lost = 0;
        for (size_t i = 0; i < before.primitive.size(); ++i) {
          if (before.primitive[i] == kNoPrimitive) continue;
          lost += before.radiance[3 * i] != 0 && before.radiance[3 * i] != after.radiance[3 * i];
          more += before.radiance[3 * i] == 0 && after.radiance[3 * i] != 0;
          if (shading != Shading::kPhong) continue;
          const auto trace = trace_pixel(scene, kFront, on, static_cast<int>(i % kSide), static_cast<int>(i / kSide));
          ASSERT_TRUE(trace);
          const SurfaceTrace& s = trace.value().slots[0].levels[0].surface;
          const LightTrace& l = s.lights[0];
          float n_l = 0;
          for (int k = 0; k < 3; ++k) n_l += s.normal[k] * l.to_light[k];
          wrong += (n_l > 1e-4f) != l.lit && std::fabs(n_l) > 1e-4f;
        }
        EXPECT_GT(more, 60u);
        EXPECT_EQ(lost, 0u);
        EXPECT_EQ(wrong, 0u) << "a sphere shadows none of what its normals turn to the light";
      }
}

// The formula, from the corners' tangent planes in extended precision.
TEST(ShadowTerminator, LiftGoesTowardTheTangentPlanesOfTheCorners) {
  const Scene scene = scene_of(sphere(1, 1), {kSun});
  const SceneData& data = scene.data();
  Settings settings = small(ShadowTerminator::kLifted);
  double most = 0;
  int lifted = 0;
  for (int y = 4; y < kSide; y += 3)
    for (int x = 4; x < kSide; x += 3) {
      const auto traced = trace_pixel(scene, kFront, settings, x, y);
      ASSERT_TRUE(traced);
      const SurfaceTrace& s = traced.value().slots[0].levels[0].surface;
      if (!s.valid) continue;
      const Real3 p = real3(s.position);
      Real3 blend{0, 0, 0};
      for (int j = 0; j < 3; ++j) {
        const Vertex& v = data.vertices[data.triangles[s.primitive].vertex[j]];
        const Real3 n = real3(v.normal);
        const Real below = std::max<Real>(0, -dot_real(p - real3(v.position), n));  // outward, as the camera sees them
        blend = blend + (p + n * below) * s.weight[j];
      }
      const Real3 want = (blend - p * (Real{s.weight[0]} + s.weight[1] + s.weight[2])) * Real{0.75};
      const Real3 off = real3(s.lift) - want;
      if (length_real(want) < 1e-5) continue;
      EXPECT_LT(length_real(off), 1e-5 * length_real(want) + 2 * s.position_error) << x << "," << y;
      EXPECT_GT(dot_real(real3(s.lift), real3(s.geometric_normal)), 0);
      most = std::max(most, static_cast<double>(length_real(want))), ++lifted;
    }
  EXPECT_GT(lifted, 200);
  EXPECT_GT(most, 0.05);
}

// Corners that agree, that agree but for rounding, or that agree and are not the face's normal, as rounding in files makes them. A sphere
// out of sight keeps the lifted rays in the plan.
TEST(ShadowTerminator, FlatTrianglesKeepEveryBit) {
  TestRandom random(5);
  for (const double tilt : {0.0, 1e-3, 2e-6}) {
    std::vector<SoupTriangle> soup = sphere(0, 0.1, {100, 0, 0});
    for (int i = 0; i < 60; ++i) {
      const glm::dvec3 a = random_point(random);
      const glm::dvec3 b = a + random_point(random);
      SoupTriangle t = soup_triangle(a, b, a + random_point(random));
      const glm::dvec3 face = normalize3(cross3(b - a, glm::dvec3(t.corner[2].position[0], t.corner[2].position[1], t.corner[2].position[2]) - a), {0, 1, 0});
      const glm::dvec3 one = normalize3(face + tilt * random_unit(random), face);
      for (Vertex& v : t.corner) {
        const glm::dvec3 n = tilt < 1e-5 ? normalize3(face + tilt * random_unit(random), face) : one;
        for (int k = 0; k < 3; ++k) v.normal[k] = static_cast<float>(n[k]);
      }
      soup.push_back(t);
    }
    const Scene scene = scene_of(soup, {kSun, kLamp});
    for (const Visibility engine : kEngines) {
      Settings off = small(ShadowTerminator::kOff), on = small(ShadowTerminator::kLifted);
      off.visibility = on.visibility = engine;
      const Framebuffer before = render(scene, kFront, off), after = render(scene, kFront, on);
      EXPECT_GT(count_lit(before).lit, 500u);
      EXPECT_EQ(before.radiance, after.radiance) << "tilt " << tilt;
      EXPECT_GT(shadow_rays(scene, off), 500u);
      EXPECT_EQ(shadow_rays(scene, off), shadow_rays(scene, on)) << "tilt " << tilt << ": nothing was lifted";
    }
  }
}

// From within, a sphere is concave: nothing is lifted, whichever side of it the light is on.
TEST(ShadowTerminator, ConcaveSurfacesKeepEveryBit) {
  const Camera inside = camera_at({0, 0, 0.1}, {0.3, 0.1, -1});
  for (const Light& light : {kSun, kLamp, lamp({0.4, 0.5, -0.3})}) {
    const Scene scene = scene_of(sphere(1, 1), {light});
    const Framebuffer before = render(scene, inside, small(ShadowTerminator::kOff));
    const Framebuffer after = render(scene, inside, small(ShadowTerminator::kLifted));
    EXPECT_EQ(count_lit(before).surfaces, size_t{kSide} * kSide);
    EXPECT_EQ(before.radiance, after.radiance);
    EXPECT_EQ(count_lit(after).lit > 0, light.position[2] < 0) << "only its own lamp lights the inside";
  }
}

// Lifted rays of a coarse sphere begin beyond a shell that all but touches it. The shell, which the camera culls, keeps all light out.
TEST(ShadowTerminator, NoLightThroughAShellBelowTheLiftedOrigins) {
  const std::vector<SoupTriangle> coarse = sphere(1, 1);
  std::vector<SoupTriangle> shell = sphere(4, 1.004, glm::dvec3(0));
  for (SoupTriangle& t : shell) std::swap(t.corner[1], t.corner[2]);
  std::vector<SoupTriangle> both = coarse;
  both.insert(both.end(), shell.begin(), shell.end());
  const uint32_t count = static_cast<uint32_t>(coarse.size());
  for (const Visibility engine : kEngines)
    for (const Shading shading : kSmooth) {
      Settings s = small(ShadowTerminator::kLifted);
      s.visibility = engine, s.shading = shading, s.culling = Culling::kBack;
      const std::vector<Light> lights = {kSun, kLamp};
      EXPECT_GT(count_lit(render(scene_of(coarse, lights), kFront, s)).lit, 800u);
      const Lit within = count_lit(render(scene_of(both, lights), kFront, s), count);
      EXPECT_GT(within.surfaces, 2000u);
      EXPECT_EQ(within.lit, 0u);
    }
}

// Closed boxes whose corners' normals are those of a ball: dark within while the lights are outside, dark outside while one is within.
TEST(ShadowTerminator, ClosedBoxesWithSmoothNormalsKeepLightOnItsSide) {
  std::vector<SoupTriangle> soup;
  for (const double r : {1.0, 1.001}) {  // walls a thousandth thick
    const auto corner = [&](int i) { return glm::dvec3(i & 1 ? r : -r, i & 2 ? r : -r, i & 4 ? r : -r); };
    for (const auto& [a, b, c, d] : {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
      for (const auto& [p, q, s] : {std::array{a, b, c}, {a, c, d}}) {
        SoupTriangle t = soup_triangle(corner(p), corner(q), corner(s));
        for (Vertex& v : t.corner)
          for (int k = 0; k < 3; ++k) v.normal[k] = v.position[k];
        soup.push_back(t);
      }
  }
  const auto lit = [&](const Light& light, const glm::dvec3& eye, const glm::dvec3& target, Visibility engine) {
    Settings s = small(ShadowTerminator::kLifted);
    s.visibility = engine;
    const Lit n = count_lit(render(scene_of(soup, {light}), camera_at(eye, target), s));
    EXPECT_GT(n.surfaces, 1000u);
    return n.lit;
  };
  for (const Visibility engine : kEngines) {
    for (const Light& light : {kSun, kLamp, lamp({1.01, 0.9, 0.9})}) {
      EXPECT_EQ(lit(light, {0.1, 0.2, 0.7}, {0.2, 0, -1}, engine), 0u);
      EXPECT_EQ(lit(light, {0.1, 0.2, 0.7}, {1, 0.9, 0.8}, engine), 0u);
    }
    for (const glm::dvec3& at : {glm::dvec3(0.99, 0.9, 0.9), glm::dvec3(0.2, 0.1, 0)})
      EXPECT_EQ(lit(lamp(at), {2.5, 2, 2.2}, {0, 0, 0}, engine), 0u);
    EXPECT_GT(lit(kLamp, {2.5, 2, 2.2}, {0, 0, 0}, engine), 100u);
  }
}

// One sheet alone, its normals all bent to one side, the light behind it on that side: from most of it lifted rays come down upon the
// sheet itself, near its tip they pass it.
TEST(ShadowTerminator, ASheetHidesLightFromBehindIt) {
  std::vector<SoupTriangle> soup = {soup_triangle({-1, -1, 0}, {1, 0, 0}, {-1, 1, 0})};
  for (Vertex& v : soup[0].corner) {
    const glm::dvec3 n = normalize3(glm::dvec3(1, 0.01 * v.position[1], 1), {0, 0, 1});
    for (int k = 0; k < 3; ++k) v.normal[k] = static_cast<float>(n[k]);
  }
  const Scene scene = scene_of(soup, {directional_light(normalize3(glm::dvec3(1, 0, -0.4), {1, 0, 0}))});
  EXPECT_EQ(count_lit(render(scene, kFront, small(ShadowTerminator::kOff))).lit, 0u);
  Settings s = small(ShadowTerminator::kLifted);
  const Lit n = count_lit(render(scene, kFront, s));
  s.shadows = Shadows::kNone;
  const Lit facing = count_lit(render(scene, kFront, s));
  EXPECT_GT(facing.lit, facing.surfaces * 9 / 10) << "that all of it would be lit by its normals";
  EXPECT_GT(n.lit, 50u);
  EXPECT_LT(n.lit, n.surfaces / 2);
}

// Powers of two change no bit of the picture; other scales and places far away change no pixel but by rounding.
TEST(ShadowTerminator, ScaleChangesNothing) {
  const auto picture = [](double scale, const glm::dvec3& at) {
    const Camera camera = camera_at(at + scale * glm::dvec3(0, 0, 4), at, 0.01 * scale);
    return render(scene_of(sphere(2, scale, at), {kSun}), camera, small(ShadowTerminator::kLifted));
  };
  const Framebuffer one = picture(1, glm::dvec3(0));
  for (const int e : {-20, 20}) EXPECT_EQ(picture(std::ldexp(1, e), glm::dvec3(0)).radiance, one.radiance) << e;
  const double wanted = static_cast<double>(count_lit(one).lit);
  for (const double scale : {1e-3, 1e6})
    for (const double away : {0.0, 300.0}) {
      const Framebuffer f = picture(scale, away * scale * glm::dvec3(1, -0.5, 0.25));
      EXPECT_NEAR(static_cast<double>(count_lit(f).lit), wanted, 4) << scale << " " << away;
    }
}

TEST(ShadowTerminator, ThePlanNeedsLightOnSmoothTriangles) {
  const auto needed = [](const Scene& scene, const Settings& settings) {
    for (const PlanLine& line : plan_frame(scene, settings))
      if (line.stage == "lifted shadow rays") return line.needed ? std::string("needed") : line.reason;
    return std::string("no line");
  };
  Settings s = small(ShadowTerminator::kLifted);
  const Scene ball = scene_of(sphere(1, 1), {kSun}), flat = scene_of({soup_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}, {kSun});
  EXPECT_EQ(needed(ball, s), "needed");
  EXPECT_EQ(needed(flat, s), "each triangle has one normal");
  EXPECT_EQ(needed(scene_of(sphere(1, 1), {}), s), "nothing is lit");
  EXPECT_EQ(needed(ball, small(ShadowTerminator::kOff)), "switched off");
  s.shading = Shading::kFlat;
  EXPECT_EQ(needed(ball, s), "flat shading interpolates no normals");
  const Framebuffer lifted = render(ball, kFront, s);
  s.shadow_terminator = ShadowTerminator::kOff;
  EXPECT_EQ(lifted.radiance, render(ball, kFront, s).radiance);
}

}  // namespace
}  // namespace spanray
