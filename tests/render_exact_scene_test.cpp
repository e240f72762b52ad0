// Spheres, planes and instances in one scene file: frames of both engines, the reference, questions, and trees of one and of
// two levels say the same.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "ray/bvh_data.h"
#include "reference/reference.h"
#include "render/ray_trees.h"
#include "scene/coplanar.h"
#include "spanray/query.h"
#include "support/frame_count.h"
#include "support/plane_scenes.h"
#include "support/ray_answers.h"

namespace spanray {
namespace {

class RenderExactScene : public testing::Test {
 protected:
  RenderExactScene() {
    const Result<LoadedScene> loaded = load_scene(SPANRAY_SOURCE_DIR "/assets/henge.toml");
    EXPECT_TRUE(loaded);
    scene_ = loaded.value().scene;
    settings_ = scene_.settings();
    settings_.width = 240, settings_.height = 135, settings_.threads = 2;
  }
  Scene scene_;
  Settings settings_;
};

TEST_F(RenderExactScene, HasAllKinds) {
  const SceneData& data = scene_.data();
  EXPECT_EQ(scene_.sphere_count(), 3u);
  EXPECT_EQ(scene_.plane_count(), 2u);
  EXPECT_EQ(data.instances.size(), 14u);
  size_t paved = 0;
  for (const Triangle& t : data.triangles) paved += lies_in(data, t, data.planes[0]);
  EXPECT_EQ(paved, 40u) << "the pavement lies in the ground's plane exactly";
  EXPECT_LT(data.bounds_max[0], 5) << "planes have no bounds";
  EXPECT_EQ(tree_makeup(data, settings_).levels, 1);
  Settings no_rays = settings_;
  no_rays.shadows = Shadows::kNone, no_rays.reflections = Reflections::kNone;
  EXPECT_EQ(tree_makeup(data, no_rays).levels, 0);
  Renderer renderer;
  Framebuffer out;
  const Result<FrameStats> stats = renderer.render(scene_, scene_.cameras()[0], settings_, out, {});
  ASSERT_TRUE(stats);
  EXPECT_EQ(count(stats.value(), "bvh_levels"), 1u);
  const Result<FrameStats> none = renderer.render(scene_, scene_.cameras()[0], no_rays, out, {});
  ASSERT_TRUE(none);
  EXPECT_EQ(count(none.value(), "bvh_levels"), 0u) << "there is a tree, but this frame asks none";
}

TEST_F(RenderExactScene, RasterRaysReferenceAndQuestionsAgree) {
  const SceneQuery query(scene_);
  for (const Camera& camera : scene_.cameras()) {
    const Framebuffer raster = render(scene_, camera, settings_);
    Settings by_rays = settings_;
    by_rays.visibility = Visibility::kRay;
    const Framebuffer rays = render(scene_, camera, by_rays);
    Framebuffer truth;
    ASSERT_TRUE(render_reference(scene_, camera, settings_, {}, truth));
    const size_t pixels = raster.primitive.size();
    size_t other_ids = 0, other_bits = 0, wrong = 0, not_asked = 0, kinds[3] = {};
    for (size_t i = 0; i < pixels; ++i) {
      const uint32_t p = raster.primitive[i];
      if (p != kNoPrimitive) ++kinds[scene_.data().is_triangle(p) ? 0 : scene_.data().is_sphere(p) ? 1 : 2];
      other_ids += p != rays.primitive[i] || p != truth.primitive[i];
      if (p != rays.primitive[i]) continue;
      other_bits += std::memcmp(&raster.radiance[3 * i], &rays.radiance[3 * i], 12) != 0;
      int most = 0;
      for (size_t k = 4 * i; k < 4 * i + 4; ++k) most = std::max(most, std::abs(truth.color.rgba[k] - raster.color.rgba[k]));
      wrong += p == truth.primitive[i] && most > 1;
      const int x = static_cast<int>(i) % settings_.width, y = static_cast<int>(i) / settings_.width;
      if ((x + y) % 5 != 0) continue;
      const auto hit = query.pixel(camera, by_rays, x, y);
      ASSERT_TRUE(hit);
      not_asked += p == kNoPrimitive ? hit.value().has_value() : !hit.value() || hit.value()->name.triangle != p;
    }
    EXPECT_EQ(other_bits, 0u);
    EXPECT_EQ(not_asked, 0u);
    EXPECT_LE(other_ids, pixels / 500);
    EXPECT_LE(wrong, pixels / 2000);
    for (const size_t seen : kinds) EXPECT_GT(seen, 200u);
  }
}

TEST_F(RenderExactScene, TreesOfTwoLevelsSayTheSame) {
  SceneData copy;
  static_cast<SceneTables&>(copy) = scene_.data();
  copy.vertices = AlignedBuffer<Vertex>::copy(scene_.data().vertices);
  copy.triangles = AlignedBuffer<Triangle>::copy(scene_.data().triangles);
  const auto t = make_test_frame(std::move(copy), Camera(), test_settings(16, 16));
  const auto build = [&](InstanceUse use) {
    return build_bvh(t->scene, t->material_flags.data(), 0, 0, *t->parallel, TreeQuality::kFast, false, use);
  };
  const Bvh one = build(InstanceUse::kNever), two = build(InstanceUse::kAlways);
  ASSERT_FALSE(one.data().instances);
  ASSERT_TRUE(two.data().instances);
  EXPECT_EQ(one.primitive_count(), two.primitive_count());
  TestRandom random(6);
  RayBatch rays;
  rays.resize(4000, false);
  for (int i = 0; i < rays.count; ++i) {
    const glm::dvec3 o = random_point(random, 4), d = random_point(random, 3) + glm::dvec3(0, 0.5, 0) - o;
    for (int k = 0; k < 3; ++k) rays.origin[k][i] = static_cast<float>(o[k]), rays.direction[k][i] = static_cast<float>(d[k]);
    rays.t_max[i] = i % 3 == 0 ? 1.0f : INFINITY, rays.pixel[i] = 0;
  }
  for (const Isa isa : supported_isas()) {
    const Answers a = trace(*t, one, rays, isa), b = trace(*t, two, rays, isa);
    EXPECT_TRUE(a == b) << isa_name(isa);
    size_t kinds[3] = {};
    for (const uint32_t p : a.closest)
      if (p != kNoPrimitive) ++kinds[t->scene.is_triangle(p) ? 0 : t->scene.is_sphere(p) ? 1 : 2];
    for (const size_t met : kinds) EXPECT_GT(met, 100u);
  }
}

}  // namespace
}  // namespace spanray
