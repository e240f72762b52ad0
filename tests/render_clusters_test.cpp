// Frames of a renderer, which drops clusters, against the rasterizer without any: whatever was rendered before, with parts that
// move.
#include <gtest/gtest.h>

#include <fstream>

#include "core/hash.h"
#include "frame/ladder.h"
#include "math/elementary.h"
#include "raster/clusters.h"
#include "scene/pose.h"
#include "spanray/render.h"
#include "support/camera_at.h"
#include "support/frame_count.h"
#include "support/moving_scene.h"
#include "support/random.h"
#include "support/raster_front_end.h"
#include "support/scene_files.h"

namespace spanray {
namespace {

// The moving room, with thousands of spikes, and a ball of many triangles that stands.
std::string write_room_with_ball(const TempFolder& folder) {
  const std::string toml = write_moving_scene(folder, 1500);
  std::ofstream obj(folder.file("moving.obj"), std::ios::app);
  constexpr int kBands = 60;
  obj << "o ball\nusemtl red\n";
  for (int i = 0; i <= kBands; ++i)
    for (int j = 0; j <= 2 * kBands; ++j) {
      double st, ct, sp, cp;
      sin_cos(kPi * i / kBands, &st, &ct), sin_cos(kPi * j / kBands, &sp, &cp);
      obj << vertex_line(st * cp + 1.5, ct + 1, -st * sp - 1);
    }
  constexpr int kRow = 2 * kBands + 1;
  const int first = -(kBands + 1) * kRow;
  for (int i = 0; i < kBands; ++i)
    for (int j = 0; j < 2 * kBands; ++j) {
      const int a = first + i * kRow + j, b = a + kRow;
      obj << "f " << a << ' ' << b << ' ' << b + 1 << "\nf " << a << ' ' << b + 1 << ' ' << a + 1 << '\n';
    }
  return toml;
}

// The ladder's rung of all vertices.
uint64_t hash_of(const ScreenVertices& v) {
  Hash hash;
  for (size_t i = 0; i < v.outcode.size(); ++i) {
    hash.add_word(v.outcode[i]);
    if ((v.outcode[i] & kOutClipMask) == 0)
      hash.add_word(static_cast<uint32_t>(v.x_24_8[i]) | static_cast<uint64_t>(static_cast<uint32_t>(v.y_24_8[i])) << 32);
  }
  return hash.value();
}

TEST(RenderClusters, ChangeNoFrameWhateverWasRenderedBefore) {
  const TempFolder folder;
  const Scene moving = must_load(write_room_with_ball(folder)).loaded.scene;
  const auto shipped = load_scene(std::string(SPANRAY_SOURCE_DIR) + "/assets/columns.toml");
  ASSERT_TRUE(shipped);
  const Scene columns = shipped.value().scene;
  ASSERT_GT(moving.data().triangles.size(), 4 * kFewTriangles);
  TestRandom random(1);
  Renderer renderer;
  uint64_t outside = 0, back_face = 0;
  for (int n = 0; n < 60; ++n) {
    const bool is_moving = random.below(3) != 0;
    const Scene& scene = is_moving ? moving : columns;
    Settings s = scene.settings();
    s.width = random.between(30, 300), s.height = random.between(30, 200), s.threads = random.between(1, 2);
    s.shadows = Shadows::kNone, s.reflections = Reflections::kNone, s.transparency = Transparency::kNone, s.textures = false;
    s.culling = random.below(2) ? Culling::kBack : Culling::kNone, s.time = random.uniform(0, 9);
    Camera camera = scene.cameras()[0];
    const glm::dvec3 eye = random_point(random, 3), target = random_point(random, 2);
    if (n % 4 != 0)
      for (int k = 0; k < 3; ++k) camera.eye[k] = eye[k] + (k == 1 ? 3 : 0), camera.target[k] = target[k];
    FrameRequest request;
    request.primitive = true;
    Ladder ladder;
    if (n % 5 == 0) request.ladder = &ladder;  // which looks at all vertices
    Framebuffer out;
    const auto stats = renderer.render(scene, camera, s, out, request);
    ASSERT_TRUE(stats) << stats.error().to_string();
    PosedScene posed(scene.data());
    Parallel parallel(1);
    posed.pose(s.time, parallel);
    const auto t = make_test_frame(SceneData(), camera, s);
    t->material_flags.assign(scene.data().materials.size(), 0);
    t->frame.scene = is_moving ? &posed.data() : &scene.data(), t->frame.material_flags = t->material_flags.data();
    const FrontEnd all = run_front_end(t->frame);
    const Picture want = rasterize(t->frame, all.bins);
    ASSERT_EQ(out.primitive, want.primitive) << n;
    if (request.ladder != nullptr) {
      EXPECT_EQ(ladder.hash(Rung::kVertices), hash_of(all.vertices)) << n;
    }
    EXPECT_EQ(count(stats.value(), "triangles_drawn"), all.counts.triangles_drawn);
    EXPECT_EQ(count(stats.value(), "triangles_empty"), all.counts.triangles_empty);
    EXPECT_EQ(count(stats.value(), "triangles_culled"), all.counts.triangles_culled());
    outside += count(stats.value(), "triangles_outside"), back_face += count(stats.value(), "triangles_back_face");
  }
  EXPECT_GT(outside, 0u);
  EXPECT_GT(back_face, 0u);
}

}  // namespace
}  // namespace spanray
