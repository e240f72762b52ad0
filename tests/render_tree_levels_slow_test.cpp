// Enough copies that trees for rays have two levels: what a frame says before and after it built them.
#include <gtest/gtest.h>

#include "render/ray_trees.h"
#include "support/frame_count.h"
#include "support/instance_scene.h"
#include "support/plane_scenes.h"

namespace spanray {
namespace {

TEST(RenderTreeLevels, AreTwoWhereCopiesAreMany) {
  constexpr int kSide = 160, kPlaces = 84;  // 83 copies spare 4.25 million triangles
  std::vector<SoupTriangle> part;
  for (int x = 0; x < kSide; ++x)
    for (int z = 0; z < kSide; ++z) {
      const glm::dvec3 a(x / 160.0, 0, z / 160.0), u(1 / 160.0, 0, 0), v(0, 0, 1 / 160.0);
      part.push_back(soup_triangle(a, a + v, a + u)), part.push_back(soup_triangle(a + u, a + v, a + u + v));
    }
  for (const int places : {kPlaces - 3, kPlaces}) {
    InstanceScene maker;
    maker.add_part({});
    maker.add_part(part);
    for (int i = 0; i < places; ++i) {
      AffineMap map;
      map.offset[0] = i % 10 * 1.1, map.offset[2] = -1.1 * (i / 10);
      maker.place(1, map);
    }
    SceneData data = maker.build();
    add_plane(plane_at({0, -0.5, 0}, {0, 1, 0}), data);
    add_lamp(data, {5, 4, 0}, 60);
    const Scene scene = finish(std::move(data));
    Settings s = test_settings(64, 36, Isa::kAuto, 2);
    const int want = places == kPlaces ? 2 : 1;
    EXPECT_EQ(tree_levels(scene.data(), s), want);
    Renderer renderer;
    Framebuffer out;
    const Result<FrameStats> stats = renderer.render(scene, from_to({5, 3, 4}, {5, 0, -3}), s, out, {});
    ASSERT_TRUE(stats);
    EXPECT_EQ(count(stats.value(), "bvh_levels"), static_cast<uint64_t>(want));
  }
}

}  // namespace
}  // namespace spanray
