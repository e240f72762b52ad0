// A picture is a function of the time: of how the renderer came there it is not.
#include <gtest/gtest.h>

#include <cstring>

#include "core/hash.h"
#include "image/metrics.h"
#include "reference/reference.h"
#include "render/trace_pixel.h"
#include "scene/pose.h"
#include "spanray/render.h"
#include "support/frame_count.h"
#include "support/moving_scene.h"
#include "support/scene_files.h"
#include "support/test_frame.h"

namespace spanray {
namespace {

Settings small(Visibility visibility = Visibility::kRaster, Shading shading = Shading::kPhong) {
  Settings s;
  s.width = 120, s.height = 90, s.threads = 2, s.visibility = visibility, s.shading = shading;
  return s;
}

FrameStats render(Renderer& renderer, const Scene& scene, const Settings& settings, Framebuffer& out) {
  FrameRequest request;
  request.depth = request.primitive = request.radiance = request.normal = true;
  const auto stats = renderer.render(scene, scene.cameras()[0], settings, out, request);
  EXPECT_TRUE(stats) << stats.error().to_string();
  return stats ? stats.value() : FrameStats();
}

uint64_t hash_of(const Framebuffer& f) {
  Hash hash;
  hash.add(f.color.rgba.data(), f.color.rgba.size()).add(f.radiance.data(), f.radiance.size() * 4);
  hash.add(f.depth.data(), f.depth.size() * 4).add(f.primitive.data(), f.primitive.size() * 4).add(f.normal.data(), f.normal.size() * 4);
  return hash.value();
}

uint64_t render_hash(Renderer& renderer, const Scene& scene, const Settings& settings) {
  Framebuffer out;
  render(renderer, scene, settings, out);
  return hash_of(out);
}

class Motions : public testing::Test {
 protected:
  Motions() : loaded_(must_load(write_moving_scene(folder_))), scene_(loaded_.loaded.scene) {}
  TempFolder folder_;
  Loaded loaded_;
  Scene scene_;
};

TEST_F(Motions, OnePictureByRefitsByBuildAndInAStaticScene) {
  for (const Visibility visibility : {Visibility::kRaster, Visibility::kRay})
    for (const Shading shading : {Shading::kPhong, Shading::kGouraud, Shading::kFlat}) {
      Settings s = small(visibility, shading);
      s.time = 1.7;
      Renderer fresh;
      const uint64_t want = render_hash(fresh, scene_, s);
      Renderer still;
      EXPECT_EQ(render_hash(still, scene_at(scene_, s.time), s), want);
      uint64_t other = want;
      for (const Isa isa : supported_isas())
        for (const int threads : {1, 2, 7}) {
          s.isa = isa, s.threads = threads;
          Renderer walked;
          for (const double t : {0.0, 0.5, 1.1, 60.0, 1.6}) {
            s.time = t;
            Framebuffer out;
            const FrameStats stats = render(walked, scene_, s, out);
            EXPECT_EQ(count(stats, "bvh_refits") + count(stats, "bvh_rebuilds"), t == 0 ? 0u : 2u);
            other = hash_of(out);
          }
          s.time = 1.7;
          EXPECT_EQ(render_hash(walked, scene_, s), want) << isa_name(isa) << ", " << threads << " threads";
        }
      EXPECT_NE(other, want);
    }
}

// The same vertices written into an OBJ. Flat shading sees positions alone, which decimals of 9 digits keep; normals are
// normalized once more by the loader.
TEST_F(Motions, TheSamePictureAsVerticesBakedIntoAFile) {
  for (const double time : {0.3, 2.5}) {
    const Scene still = scene_at(scene_, time);
    std::string obj = "mtllib moving.mtl\n";
    for (size_t i = 0; i < still.triangle_count(); ++i) {
      obj += "usemtl " + still.data().material_names[material_of(still.data().triangles[i])] + "\n";
      for (int c = 0; c < 3; ++c) {
        const float* p = corner(still.data(), i, c).position;
        obj += vertex_line(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]));
      }
      for (int c = 0; c < 3; ++c) {
        char line[96];
        const float* n = corner(still.data(), i, c).normal;
        std::snprintf(line, sizeof line, "vn %.9g %.9g %.9g\n", static_cast<double>(n[0]), static_cast<double>(n[1]), static_cast<double>(n[2]));
        obj += line;
      }
      obj += "f -3//-3 -2//-2 -1//-1\n";
    }
    folder_.write("baked.obj", obj);
    std::string toml = kMovingToml;
    toml = toml.substr(0, toml.find("[[moving]]"));
    toml.replace(toml.find("moving.obj"), 10, "baked.obj");
    const Loaded baked = must_load(folder_.write("baked.toml", toml));
    ASSERT_EQ(baked.scene().triangles.size(), still.triangle_count());
    for (const Shading shading : {Shading::kFlat, Shading::kPhong}) {
      Settings s = small(Visibility::kRaster, shading);
      s.time = time;
      Renderer a, b;
      Framebuffer moved, fixed;
      render(a, scene_, s, moved), render(b, baked.loaded.scene, s, fixed);
      EXPECT_EQ(moved.primitive, fixed.primitive);
      EXPECT_EQ(moved.depth, fixed.depth);
      int most = 0;
      for (size_t i = 0; i < moved.color.rgba.size(); ++i) most = std::max(most, std::abs(moved.color.rgba[i] - fixed.color.rgba[i]));
      EXPECT_LE(most, shading == Shading::kFlat ? 0 : 1);
    }
  }
}

TEST_F(Motions, AnEyeLightFollowsTheBoundsOfTheMoment) {
  std::string toml = kMovingToml;
  const size_t light = toml.find("[[light]]");
  toml.erase(light, toml.find("[[moving]]") - light);
  const Scene scene = must_load(folder_.write("eye.toml", toml)).loaded.scene;
  ASSERT_TRUE(scene.data().light_follows_eye);
  Settings s = small();
  Renderer walked, still;
  render_hash(walked, scene, s);
  s.time = 2.25;
  EXPECT_EQ(render_hash(walked, scene, s), render_hash(still, scene_at(scene, s.time), s));
}

TEST_F(Motions, ATreeThatWasNotNeededFollowsLater) {
  Settings s = small(), bare = small();
  bare.shadows = Shadows::kNone, bare.reflections = Reflections::kNone;
  Renderer walked, fresh;
  render_hash(walked, scene_, s);
  bare.time = 0.8;
  render_hash(walked, scene_, bare);
  s.time = 0.8;
  EXPECT_EQ(render_hash(walked, scene_, s), render_hash(fresh, scene_, s));
  // Another scene, another meaning of its materials, and back.
  s.time = 1.4, s.transparency = Transparency::kNone;
  Renderer other;
  EXPECT_EQ(render_hash(walked, scene_, s), render_hash(other, scene_, s));
  const TempFolder folder;
  const Scene second = must_load(write_moving_scene(folder, 20)).loaded.scene;
  Renderer third;
  EXPECT_EQ(render_hash(walked, second, s), render_hash(third, second, s));
  EXPECT_EQ(render_hash(walked, scene_, s), render_hash(other, scene_, s));
}

TEST_F(Motions, OnePixelExplainedAndTheReferenceStandAtTheSameTime) {
  Settings s = small();
  s.time = 1.9;
  Renderer renderer;
  Framebuffer out, reference;
  render(renderer, scene_, s, out);
  for (int y = 5; y < s.height; y += 16)
    for (int x = 3; x < s.width; x += 16) {
      const auto why = trace_pixel(scene_, scene_.cameras()[0], s, x, y);
      ASSERT_TRUE(why) << why.error().to_string();
      EXPECT_EQ(std::memcmp(why.value().rgba, &out.color.rgba[4 * static_cast<size_t>(y * s.width + x)], 4), 0) << x << " " << y;
    }
  ASSERT_TRUE(render_reference(scene_, scene_.cameras()[0], s, {}, reference));
  size_t differ = 0;
  for (size_t i = 0; i < out.primitive.size(); ++i) differ += out.primitive[i] != reference.primitive[i];
  EXPECT_LT(differ, out.primitive.size() / 200);  // edges
}

TEST_F(Motions, ACostlyTreeIsBuiltAnew) {
  // The wheel flies apart from its glass, then away.
  std::string toml = kMovingToml;
  const size_t first = toml.find("[[moving]]");
  toml = toml.substr(0, first) + "[[moving]]\npart = \"wheel\"\nkey = [{time = 0}, {time = 10, translation = [40, 0, 0]}]\n";
  const Scene scene = must_load(folder_.write("away.toml", toml)).loaded.scene;
  Settings s = small();
  Renderer walked;
  uint64_t refits = 0, rebuilds = 0;
  for (int i = 0; i <= 40; ++i) {
    s.time = i * 0.25;
    Framebuffer out;
    const FrameStats stats = render(walked, scene, s, out);
    refits += count(stats, "bvh_refits"), rebuilds += count(stats, "bvh_rebuilds");
    EXPECT_GT(stats.ms.bvh_build, 0);
    EXPECT_EQ(stats.ms.bvh_refit > 0, i > 0);
    if (i % 10 != 0) continue;
    Renderer fresh;
    EXPECT_EQ(hash_of(out), render_hash(fresh, scene, s)) << s.time;
  }
  EXPECT_GT(refits, 10u);
  EXPECT_GT(rebuilds, 0u);
  // At rest nothing is done.
  Framebuffer out;
  const FrameStats again = render(walked, scene, s, out);
  EXPECT_EQ(count(again, "bvh_refits") + count(again, "bvh_rebuilds"), 0u);
  EXPECT_EQ(again.ms.bvh_refit, 0);
}

TEST_F(Motions, WhatDoesNotMoveCostsNothing) {
  std::string toml = kMovingToml;
  const Scene still = must_load(folder_.write("still.toml", toml.substr(0, toml.find("[[moving]]")))).loaded.scene;
  Settings s = small();
  s.threads = 1;
  Renderer a, b;
  Framebuffer out;
  const FrameStats moving = render(a, scene_, s, out), resting = render(b, still, s, out);  // one picture: buffers of one size
  EXPECT_EQ(resting.ms.pose, 0);
  EXPECT_EQ(resting.ms.bvh_refit, 0);
  EXPECT_EQ(count(resting, "bvh_refits") + count(resting, "bvh_rebuilds"), 0u);
  const size_t geometry = scene_.data().vertices.size() * sizeof(Vertex) + scene_.data().triangles.size() * sizeof(Triangle);
  EXPECT_GE(moving.memory_bytes, resting.memory_bytes + geometry);
  EXPECT_LE(moving.memory_bytes, resting.memory_bytes + 2 * geometry);
  const auto line = [](const Scene& scene, const std::string& stage) {
    for (const PlanLine& l : plan_frame(scene, small()))
      if (l.stage == stage) return l;
    return PlanLine();
  };
  for (const char* stage : {"pose", "BVH refit"}) {
    EXPECT_TRUE(line(scene_, stage).needed);
    EXPECT_FALSE(line(still, stage).needed);
    EXPECT_EQ(line(still, stage).reason, "nothing moves");
  }
}

TEST_F(Motions, TimesOutOfRangeAreRefused) {
  Settings s = small();
  Renderer renderer;
  Framebuffer out;
  for (const double time : {2e6, -2e6, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    s.time = time;
    const auto stats = renderer.render(scene_, scene_.cameras()[0], s, out);
    ASSERT_FALSE(stats);
    EXPECT_NE(stats.error().message.find("time"), std::string::npos);
    EXPECT_FALSE(render_reference(scene_, scene_.cameras()[0], s, {}, out));
  }
}

}  // namespace
}  // namespace spanray
