// Settings::shadow_terminator: the renderer and the reference, which has the model a second time, in double, say the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "reference/reference.h"
#include "support/camera_at.h"
#include "support/sample_pictures.h"
#include "support/terminator_scenes.h"

namespace spanray {
namespace {

// A mirror shows the treated sphere, and both engines and the reference say the same of it.
TEST(ReferenceShadowTerminator, MirrorsAndTheReferenceAgree) {
  std::vector<SoupTriangle> soup = sphere(1, 1, {-0.9, 0, 0});
  const uint32_t count = static_cast<uint32_t>(soup.size());
  for (const auto& [a, b, c] : {std::array{glm::dvec3(0.6, -2, -2), glm::dvec3(1.6, -2, 2), glm::dvec3(1.6, 2, 2)},
                                {glm::dvec3(0.6, -2, -2), glm::dvec3(1.6, 2, 2), glm::dvec3(0.6, 2, -2)}})
    soup.push_back(soup_triangle(a, b, c, 1));
  Material mirror = matte();
  for (int k = 0; k < 3; ++k) mirror.mirror[k] = 0.9f, mirror.diffuse[k] = 0;
  const Scene scene = scene_of(soup, {directional_light({0, 0.8, 0.6})}, {matte(), mirror});
  const Camera camera = camera_at({0, 0, 4}, {0, 0, 0});
  for (const Visibility engine : kEngines) {
    Settings off = small(ShadowTerminator::kOff), on = small(ShadowTerminator::kLifted);
    off.visibility = on.visibility = engine, off.width = on.width = off.height = on.height = 2 * kSide;
    const Framebuffer before = render(scene, camera, off), after = render(scene, camera, on);
    Framebuffer truth;
    ASSERT_TRUE(render_reference(scene, camera, on, {}, truth));
    size_t changed = 0, wrong = 0, same = 0;
    for (size_t i = 0; i < after.primitive.size(); ++i) {
      changed += after.primitive[i] >= count && after.primitive[i] != kNoPrimitive && before.radiance[3 * i] != after.radiance[3 * i];
      if (after.primitive[i] != truth.primitive[i]) continue;
      ++same, wrong += std::fabs(after.radiance[3 * i] - truth.radiance[3 * i]) > 1e-4f;
    }
    EXPECT_GT(changed, 30u);
    EXPECT_GT(same, after.primitive.size() * 99 / 100);
    EXPECT_LE(wrong, 4u) << "edges of shadows";
  }
}

// Triangles that pierce and shadow each other at all distances, normals bent at random: the renderer and the reference agree on which
// ways are free.
TEST(ReferenceShadowTerminator, RandomTrianglesAgreeWithTheReference) {
  size_t wrong = 0, changed = 0, pixels = 0;
  for (uint32_t seed = 1; seed <= 6; ++seed) {
    TestRandom random(seed);
    SceneData data = make_lit_scene(random, 150);
    for (Material& m : data.materials) m.transparency = 0, m.opacity = 1;
    hash_scene(data);
    const Scene scene(std::make_shared<SceneData>(std::move(data)));
    const Camera camera = camera_at({0, 0, 5}, {0, 0, 0});
    Settings on = small(ShadowTerminator::kLifted);
    on.visibility = Visibility::kRay;
    const Framebuffer after = render(scene, camera, on), before = render(scene, camera, [&] {
      Settings off = on;
      off.shadow_terminator = ShadowTerminator::kOff;
      return off;
    }());
    Framebuffer truth;
    ASSERT_TRUE(render_reference(scene, camera, on, {}, truth));
    for (size_t i = 0; i < after.primitive.size(); ++i) {
      if (after.primitive[i] == kNoPrimitive || after.primitive[i] != truth.primitive[i]) continue;
      float most = 0;
      for (size_t c = 3 * i; c < 3 * i + 3; ++c) most = std::max(most, std::fabs(after.radiance[c] - truth.radiance[c]) / (1 + truth.radiance[c]));
      ++pixels, wrong += most > 1e-3f, changed += before.radiance[3 * i] != after.radiance[3 * i];
    }
  }
  std::printf("%zu pixels, %zu changed, %zu otherwise than the reference\n", pixels, changed, wrong);
  EXPECT_GT(pixels, 20000u);
  EXPECT_GT(changed, pixels / 10);
  EXPECT_LT(wrong, pixels / 2000);
}

}  // namespace
}  // namespace spanray
