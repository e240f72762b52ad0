// Y13: the rasterizer and primary rays see the same picture. Equal ids: bit-equal depth, and bit-equal color unless a translucent
// edge passes. Ids differ only within 1/256 pixel of an edge, or where the two depths differ by less than kDepthTie.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "frame/primary_rays.h"
#include "frame/transparency.h"
#include "math/vec.h"
#include "reference/reference.h"
#include "scene/scene_builder.h"
#include "spanray/render.h"
#include "support/edge_distance.h"
#include "support/test_frame.h"

namespace spanray {
namespace {

constexpr double kDepthTie = 2e-6;  // relative: float depth of the z-buffer against float t of the tracer

double plane_depth(const SceneData& scene, const PrimaryRays& rays, uint32_t primitive, double x, double y) {
  const Triangle& t = scene.triangles[primitive];
  const glm::dvec3 v0 = vertex_position(scene, t, 0);
  const glm::dvec3 n = cross3(vertex_position(scene, t, 1) - v0, vertex_position(scene, t, 2) - v0);
  return dot3(v0 - rays.eye, n) / dot3(rays.corner + rays.step_x * x + rays.step_y * y, n);
}

struct Case {
  const char* scene;
  int width, height;
};

class RasterAgainstRays : public testing::TestWithParam<Case> {};

TEST_P(RasterAgainstRays, Y13_SamePicture) {
  const Result<LoadedScene> loaded = load_scene(std::string(SPANRAY_SOURCE_DIR) + "/assets/" + GetParam().scene);
  ASSERT_TRUE(loaded) << loaded.error().to_string();
  const Scene& scene = loaded.value().scene;
  const SceneData& data = scene.data();
  Settings settings = scene.settings();
  settings.width = GetParam().width, settings.height = GetParam().height;
  FrameRequest request;
  request.depth = request.primitive = request.radiance = true;
  Framebuffer frames[2];
  Renderer renderer;
  for (int i = 0; i < 2; ++i) {
    settings.visibility = i == 0 ? Visibility::kRaster : Visibility::kRay;
    const auto stats = renderer.render(scene, scene.cameras()[0], settings, frames[i], request);
    ASSERT_TRUE(stats) << stats.error().to_string();
  }
  const PrimaryRays rays = make_primary_rays(scene.cameras()[0], settings.width, settings.height);
  std::vector<uint32_t> translucent;
  for (uint32_t i = 0; i < data.triangles.size(); ++i)
    if (material_flags(data.materials[material_of(data.triangles[i])], settings) & kMaterialTranslucent) translucent.push_back(i);

  size_t covered = 0, ids_differ = 0, colors_differ = 0;
  for (size_t p = 0; p < frames[0].primitive.size(); ++p) {
    const double x = static_cast<double>(p % settings.width) + 0.5, y = static_cast<double>(p / settings.width) + 0.5;
    const uint32_t a = frames[0].primitive[p], b = frames[1].primitive[p];
    covered += a != kNoPrimitive;
    if (a == b) {
      ASSERT_EQ(0, std::memcmp(&frames[0].depth[p], &frames[1].depth[p], 4)) << x << "," << y;
      if (std::memcmp(&frames[0].radiance[3 * p], &frames[1].radiance[3 * p], 12) == 0) continue;
      ++colors_differ;
      double nearest = std::numeric_limits<double>::infinity();
      for (const uint32_t t : translucent) nearest = std::min(nearest, edge_distance(data, rays, t, x, y));
      EXPECT_LE(nearest, kEdgePixels) << "color differs at " << x << "," << y << ", primitive " << a;
      continue;
    }
    ++ids_differ;
    double nearest = std::numeric_limits<double>::infinity();
    for (const uint32_t t : {a, b})
      if (t != kNoPrimitive) nearest = std::min(nearest, edge_distance(data, rays, t, x, y));
    if (nearest <= kEdgePixels) continue;
    ASSERT_TRUE(a != kNoPrimitive && b != kNoPrimitive) << x << "," << y << ": " << a << " and " << b << ", nearest edge " << nearest;
    const double za = plane_depth(data, rays, a, x, y), zb = plane_depth(data, rays, b, x, y);
    EXPECT_LE(std::fabs(za - zb), kDepthTie * std::fabs(za)) << x << "," << y << ": " << a << " and " << b << ", nearest edge " << nearest;
  }
  RecordProperty("ids_differ", static_cast<int>(ids_differ));
  std::printf("%s: %zu of %zu covered pixels differ in id, %zu more in color\n", GetParam().scene, ids_differ, covered, colors_differ);
  EXPECT_GT(covered, frames[0].primitive.size() / 4) << "an empty picture proves nothing";
  EXPECT_LE(ids_differ, covered / 500);
}

// A pane of two triangles, seen head-on so that their common edge runs through pixel centers, before a wall: one layer for the rasterizer, for
// rays and for the reference.
TEST(RenderVisibility, APaneIsOneLayerOnItsDiagonal) {
  std::vector<Material> materials(2);
  materials[0].transparency = static_cast<int32_t>(MaterialTransparency::kAlpha), materials[0].opacity = 0.5f;
  materials[0].emission[0] = 0.5f;
  materials[1].emission[1] = 0.75f;
  std::vector<SoupTriangle> soup;
  const auto add_square = [&](double half, double z, uint32_t material) {
    const glm::dvec3 a(-half, -half, z), b(half, -half, z), c(half, half, z), d(-half, half, z);
    soup.push_back(soup_triangle(a, b, c, material)), soup.push_back(soup_triangle(a, c, d, material));
  };
  add_square(1, 0, 0), add_square(4, -2, 1);
  const Scene scene(std::make_shared<SceneData>(make_test_scene(soup, materials)));
  Camera camera;
  camera.eye[2] = 3;
  Settings settings;
  settings.width = settings.height = 64;
  Framebuffer raster, rays, truth;
  Renderer renderer;
  ASSERT_TRUE(renderer.render(scene, camera, settings, raster));
  settings.visibility = Visibility::kRay;
  ASSERT_TRUE(renderer.render(scene, camera, settings, rays));
  ASSERT_TRUE(render_reference(scene, camera, settings, {}, truth));
  int panes = 0;
  for (size_t i = 0; i < raster.color.rgba.size(); i += 4) {
    panes += raster.color.rgba[i] > 100;
    for (size_t c = 0; c < 3; ++c) {
      ASSERT_EQ(raster.color.rgba[i + c], rays.color.rgba[i + c]) << "pixel " << i / 4;
      ASSERT_NEAR(raster.color.rgba[i + c], truth.color.rgba[i + c], 1) << "pixel " << i / 4;
    }
  }
  EXPECT_GT(panes, 400);
}

INSTANTIATE_TEST_SUITE_P(Scenes, RasterAgainstRays,
                         testing::Values(Case{"cornell.toml", 640, 360}, Case{"spheres.toml", 640, 360}, Case{"columns.toml", 640, 360},
                                         Case{"gauze.toml", 640, 360}, Case{"glass.toml", 640, 360}, Case{"columns.toml", 2048, 256}),
                         [](const auto& c) {
                           const std::string name = c.param.scene;
                           return name.substr(0, name.find('.')) + "_" + std::to_string(c.param.width);
                         });

}  // namespace
}  // namespace spanray
