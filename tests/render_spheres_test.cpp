// Frames with spheres: one picture for both visibility engines, all instruction sets and numbers of threads; exact outlines; no
// shadow of a sphere on its own lit side; what the reference says of them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "frame/exact_hit.h"
#include "frame/primary_rays.h"
#include "math/elementary.h"
#include "reference/reference.h"
#include "support/frame_count.h"
#include "support/sphere_scenes.h"

namespace spanray {
namespace {

// Where spheres are seen, both engines give the same bits; triangles may differ at edges and ties, as ever.
void expect_same_spheres(const Scene& scene, const Framebuffer& a, const Framebuffer& b, const std::string& where) {
  size_t differ = 0, other = 0;
  for (size_t i = 0; i < a.primitive.size(); ++i) {
    const bool sphere = (a.primitive[i] != kNoPrimitive && scene.data().is_sphere(a.primitive[i])) ||
                        (b.primitive[i] != kNoPrimitive && scene.data().is_sphere(b.primitive[i]));
    const bool same = a.primitive[i] == b.primitive[i] && a.depth[i] == b.depth[i] &&
                      std::memcmp(&a.radiance[3 * i], &b.radiance[3 * i], 12) == 0 &&
                      std::memcmp(&a.normal[3 * i], &b.normal[3 * i], 12) == 0;
    (sphere ? differ : other) += !same;
  }
  EXPECT_EQ(differ, 0u) << where;
  EXPECT_LE(other, a.primitive.size() / 200) << where;
}

TEST(RenderSpheres, Y13_BothEnginesShowTheSame) {
  const Scene scene = crowd();
  for (const Shading shading : {Shading::kPhong, Shading::kGouraud, Shading::kFlat})
    for (const int samples : {1, 8})
      for (const Culling culling : {Culling::kNone, Culling::kBack}) {
        Settings s = test_settings(200, 130);
        s.shading = shading, s.samples = samples, s.culling = culling;
        const Framebuffer raster = render(scene, kCrowdView, s);
        s.visibility = Visibility::kRay;
        expect_same_spheres(scene, raster, render(scene, kCrowdView, s),
                            std::to_string(static_cast<int>(shading)) + ", " + std::to_string(samples));
        EXPECT_GT(sphere_pixels(scene, raster), 2500u);
      }
}

TEST(RenderSpheres, OnePictureForAllInstructionSetsAndThreads) {
  const Scene scene = crowd();
  for (const Visibility visibility : {Visibility::kRaster, Visibility::kRay}) {
    Settings s = test_settings(200, 130, Isa::kScalar);
    s.visibility = visibility, s.shading = Shading::kGouraud, s.samples = 4, s.shadow_terminator = ShadowTerminator::kLifted;
    const Framebuffer want = render(scene, kCrowdView, s);
    for (const Isa isa : supported_isas())
      for (const int threads : {1, 3}) {
        s.isa = isa, s.threads = threads;
        const Framebuffer got = render(scene, kCrowdView, s);
        EXPECT_EQ(got.radiance, want.radiance) << isa_name(isa) << threads;
        EXPECT_EQ(got.primitive, want.primitive) << isa_name(isa) << threads;
        EXPECT_EQ(got.depth, want.depth) << isa_name(isa) << threads;
      }
  }
}

struct View {
  Camera camera;
  double radius;
  glm::dvec3 center;
};

// How many pixels of a lone sphere are not those of their exact rays. There are two of it: of equal ones the first is seen.
int wrong_pixels(const View& v, int width, int height, Culling culling, Visibility visibility) {
  SceneData data = make_test_scene({});
  for (int i = 0; i < 2; ++i) add_sphere(ball(v.center, v.radius), data);
  const Scene scene = finish(std::move(data));
  Settings s = test_settings(width, height);
  s.culling = culling, s.visibility = visibility, s.shadows = Shadows::kNone;
  const Framebuffer got = render(scene, v.camera, s);
  const PrimaryRays rays = make_primary_rays(v.camera, s.width, s.height);
  const Sphere& sphere = scene.data().spheres[0];
  int wrong = 0;
  for (int y = 0; y < s.height; ++y)
    for (int x = 0; x < s.width; ++x) {
      SphereCrossing cross;
      const glm::dvec3 d = rays.corner + rays.step_x * (x + 0.5) + rays.step_y * (y + 0.5);
      double t = INFINITY;
      if (cross_sphere(rays.eye - center_of(sphere), d, double{sphere.radius}, cross)) {
        if (cross.enter > rays.near_plane)
          t = cross.enter;
        else if (cross.leave > rays.near_plane && culling == Culling::kNone)
          t = cross.leave;
      }
      const size_t i = static_cast<size_t>(y * s.width + x);
      wrong += (got.primitive[i] == 0) != std::isfinite(t);
      if (std::isfinite(t)) wrong += got.depth[i] != static_cast<float>(rays.near_plane) / static_cast<float>(t);
    }
  return wrong;
}

// From afar, from very near, from within, cut by the near plane, behind the eye, to the side.
TEST(RenderSpheres, OutlinesAreExactFromEverywhere) {
  const View views[] = {{from_to({0, 0, 5}, {0, 0, 0}), 1, {0, 0, 0}},
                        {from_to({0, 0, 5}, {2.5, 1, 0}), 1, {0, 0, 0}},
                        {from_to({0, 0, 1.001}, {0, 0, 0}, 1e-4), 1, {0, 0, 0}},
                        {from_to({0, 1.02, 0}, {5, 1, 0}, 1e-3), 1, {0, 0, 0}},
                        {from_to({0.3, 0, 0.2}, {1, 0, 0}), 1, {0, 0, 0}},
                        {from_to({0, 0, 1.2}, {1, 0, 0.2}), 1, {0, 0, 0}},
                        {from_to({0, 0, 1.5}, {0, 0, 0}, 0.8), 1, {0, 0, 0}},
                        {from_to({0, 0, 1.5}, {0, 0, 0}, 3.0), 1, {0, 0, 0}},
                        {from_to({0, 0, 1.5}, {0, 0, 5}), 1, {0, 0, 0}},
                        {from_to({1e5, 0, 0}, {0, 0, 0}, 1), 2e4, {0, 0, 0}},
                        {from_to({0, 2.0, 0}, {300, 0, 0}), 6.4e6, {0, -6.4e6, 0}},
                        {from_to({-3, 0, 0.4}, {0, 0, 0.4}), 1e-3, {0, 0, 0.4}}};
  for (const View& v : views)
    for (const Culling culling : {Culling::kNone, Culling::kBack})
      for (const Visibility visibility : {Visibility::kRaster, Visibility::kRay})
        EXPECT_EQ(wrong_pixels(v, 150, 100, culling, visibility), 0)
            << "view " << &v - views << ", culling " << static_cast<int>(culling) << ", by ray "
            << (visibility == Visibility::kRay);
}

TEST(RenderSpheres, OutlinesAreExactFromAnywhere) {
  TestRandom random(9);
  for (int i = 0; i < 150; ++i) {
    const glm::dvec3 eye = random_point(random, 4);
    const View v = {from_to(eye, random_point(random), random.uniform(0.001, 0.5)), random.uniform(0.1, 2), {0, 0, 0}};
    EXPECT_EQ(wrong_pixels(v, 90, 70, Culling::kNone, i % 2 == 0 ? Visibility::kRaster : Visibility::kRay), 0) << i;
  }
}

// Lit from the eye's side, all of a lone sphere that the eye sees and the light reaches is lit: no shadow of itself, at any
// scale and offset; and from within, the light at its center reaches all of it.
TEST(RenderSpheres, Y7_NoShadowOnTheirOwnLitSideAndNoLeakThrough) {
  for (const double scale : {0x1p-20, 1e-3, 1.0, 1e3, 0x1p20})
    for (const double away : {0.0, 10.0, 1e3, 1e5, 1e6}) {
      const glm::dvec3 at = glm::dvec3(1, -0.7, 0.3) * (away * scale);
      SceneData data = make_test_scene({});
      add_sphere(ball(at, scale), data);
      data.ambient_radiance[0] = data.ambient_radiance[1] = data.ambient_radiance[2] = 0;
      add_sun(data, {0.4, -0.3, -1});
      const Scene outside = finish(std::move(data));
      const glm::dvec3 center = center_of(outside.data().spheres[0]);
      Settings s = test_settings(160, 160);
      const Camera camera = from_to(center + glm::dvec3(0, 0, 4 * scale), center, 0.01 * scale);
      const Framebuffer shadowed = render(outside, camera, s);
      s.shadows = Shadows::kNone;
      const Framebuffer plain = render(outside, camera, s);
      EXPECT_EQ(shadowed.radiance, plain.radiance) << scale << ", " << away;
      EXPECT_GT(sphere_pixels(outside, plain), 4000u);

      // Within a shell, a lamp outside lights nothing.
      SceneData shell = make_test_scene({});
      shell.ambient_radiance[0] = shell.ambient_radiance[1] = shell.ambient_radiance[2] = 0;
      add_sphere(ball(at, scale), shell);
      add_lamp(shell, center + glm::dvec3(0, 3 * scale, 0), 100);
      const Scene inside = finish(std::move(shell));
      s.shadows = Shadows::kRay;
      const Framebuffer dark = render(inside, from_to(center, center + glm::dvec3(0, scale, 0.3 * scale), 0.01 * scale), s);
      EXPECT_EQ(sphere_pixels(inside, dark), dark.primitive.size());
      if (away < 1e9) {
        float most = 0;
        for (const float r : dark.radiance) most = std::max(most, r);
        EXPECT_EQ(most, 0) << scale << ", " << away;
      }
    }
}

TEST(RenderSpheres, ALampWithinLightsAllOfAShell) {
  for (const double away : {0.0, 10.0, 1e3}) {
    SceneData data = make_test_scene({});
    add_sphere(ball(glm::dvec3(1, 1, 1) * away, 1), data);
    const glm::dvec3 center = center_of(data.spheres[0]);
    add_lamp(data, center + glm::dvec3(0.2, 0.1, 0), 1);
    const Scene scene = finish(std::move(data));
    Settings s = test_settings(120, 120);
    const Camera camera = from_to(center, center + glm::dvec3(0, 0, 1));
    const Framebuffer shadowed = render(scene, camera, s);
    s.shadows = Shadows::kNone;
    EXPECT_EQ(shadowed.radiance, render(scene, camera, s).radiance) << away;
  }
}

TEST(RenderSpheres, FlatGouraudAndPhongAreOneOnSpheres) {
  const Scene scene = crowd();
  Settings s = test_settings(200, 130);
  s.reflections = Reflections::kNone, s.transparency = Transparency::kNone;
  const Framebuffer phong = render(scene, kCrowdView, s);
  ASSERT_GT(sphere_pixels(scene, phong), 1000u);
  for (const Shading shading : {Shading::kFlat, Shading::kGouraud}) {
    s.shading = shading;
    const Framebuffer other = render(scene, kCrowdView, s);
    for (size_t i = 0; i < phong.primitive.size(); ++i)
      if (phong.primitive[i] != kNoPrimitive && scene.data().is_sphere(phong.primitive[i])) {
        ASSERT_EQ(0, std::memcmp(&phong.radiance[3 * i], &other.radiance[3 * i], 12)) << i;
      }
  }
}

// What is seen of them takes no corners of triangles, though batches have both.
TEST(RenderSpheres, NoTriangleIsLitForThem) {
  for (const bool with_triangle : {false, true}) {
    std::vector<SoupTriangle> soup;
    if (with_triangle) soup.push_back(soup_triangle({-9, 0, -20}, {9, 0, -20}, {0, 9, -20}));
    SceneData data = make_test_scene(soup);
    add_sphere(ball({0, 0, 0}, 1), data);
    add_lamp(data, {3, 5, 3}, 60);
    const Scene scene = finish(std::move(data));
    Settings s = test_settings(96, 64);
    s.shading = Shading::kGouraud;
    Framebuffer out;
    FrameRequest request;
    request.primitive = true;
    Renderer renderer;
    const auto lit_of = [&](const glm::dvec3& eye) {
      const Result<FrameStats> done = renderer.render(scene, from_to(eye, {0, 0, 0}), s, out, request);
      EXPECT_TRUE(done);
      EXPECT_GT(sphere_pixels(scene, out), 500u);
      return count(done.value(), "vertices_lit");
    };
    EXPECT_EQ(lit_of({0, 0, -4}), 0u);  // away from the triangle
    if (with_triangle) {
      EXPECT_GT(lit_of({0, 0, 4}), 0u);
    }
  }
}

// The normal is the exact one, to rounding; spheres have no texture coordinates.
TEST(RenderSpheres, NormalsAreThoseOfTheSphere) {
  const Scene scene = crowd();
  const Settings s = test_settings(200, 130);
  const Framebuffer f = render(scene, kCrowdView, s);
  ASSERT_GT(sphere_pixels(scene, f), 1000u);
  const PrimaryRays rays = make_primary_rays(kCrowdView, s.width, s.height);
  for (int y = 0; y < s.height; ++y)
    for (int x = 0; x < s.width; ++x) {
      const size_t i = static_cast<size_t>(y * s.width + x);
      if (f.primitive[i] == kNoPrimitive || !scene.data().is_sphere(f.primitive[i])) continue;
      const Sphere& sphere = scene.data().sphere(f.primitive[i]);
      const glm::dvec3 d = rays.corner + rays.step_x * (x + 0.5) + rays.step_y * (y + 0.5), from = rays.eye - center_of(sphere);
      SphereCrossing cross;
      ASSERT_TRUE(cross_sphere(from, d, sphere.radius, cross));
      for (int k = 0; k < 3; ++k)
        ASSERT_NEAR(f.normal[3 * i + static_cast<size_t>(k)], (from + d * cross.enter)[k] / sphere.radius, 1e-6)
            << x << "," << y;
      ASSERT_TRUE(f.uv[2 * i] == 0 && f.uv[2 * i + 1] == 0);
    }
}

TEST(RenderSpheres, TheReferenceAgrees) {
  const Scene scene = crowd();
  for (const Shading shading : {Shading::kPhong, Shading::kGouraud, Shading::kFlat})
    for (const Culling culling : {Culling::kNone, Culling::kBack})
      for (const glm::dvec3& eye :
           {glm::dvec3(0.5, 2, 5.5), glm::dvec3(0, 0.75, 0.1)}) {  // the second within a mirroring sphere
        Settings s = test_settings(120, 80);
        s.shading = shading, s.culling = culling;
        const Camera camera = from_to(eye, {0, 0.6, -1});
        expect_reference(scene, camera, s);
      }
}

}  // namespace
}  // namespace spanray
