// The ambiguity mask on the shipped scenes: the renderer's own pictures and those of moved vertices lie within, others do not,
// and it is narrow.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>

#include "image/mask.h"
#include "math/vec.h"
#include "reference/ambiguity.h"
#include "reference/view.h"
#include "spanray/render.h"
#include "support/scene_files.h"

namespace spanray {
namespace {

struct Case {
  const char* name;
  const char* scene;
  void (*change)(Settings&);
  double most_wide;  // share of the pixels left open by more than 8 of 255
  size_t camera = 0;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

Scene load(const std::string& file) { return must_load(file).loaded.scene; }
Scene shipped(const std::string& name) { return load(std::string(SPANRAY_SOURCE_DIR) + "/assets/" + name + ".toml"); }

Image picture(const Scene& scene, const Camera& camera, const Settings& settings) {
  Framebuffer frame;
  EXPECT_TRUE(Renderer().render(scene, camera, settings, frame));
  return frame.color;
}
AmbiguityMask mask_of(const Scene& scene, const Camera& camera, const Settings& settings, const AmbiguityBounds& bounds = {}) {
  AmbiguityMask mask;
  EXPECT_TRUE(make_ambiguity_mask(scene, camera, settings, {}, bounds, mask));
  return mask;
}
uint64_t outside(const Image& image, const AmbiguityMask& mask) {
  const Result<MaskDifference> difference = compare_with_mask(image, mask);
  EXPECT_TRUE(difference);
  for (const MaskDifference::Pixel& p : difference.value().first)
    if (difference.value().outside < 20)
      std::printf("outside: %d,%d channel %d is %g, %g to %g\n", p.x, p.y, p.channel, p.code, p.least, p.greatest);
  return difference.value().outside;
}
Settings small(const Scene& scene) {
  Settings settings = scene.settings();
  settings.width = 160, settings.height = 90;
  return settings;
}

class AmbiguityOfScenes : public ::testing::TestWithParam<Case> {};

TEST_P(AmbiguityOfScenes, HoldsBothRenderersPicturesAndIsNarrow) {
  const Case& c = GetParam();
  const Scene scene = shipped(c.scene);
  Settings settings = small(scene);
  c.change(settings);
  const Camera& camera = scene.cameras()[c.camera];
  const AmbiguityMask mask = mask_of(scene, camera, settings);
  Framebuffer truth;
  ASSERT_TRUE(render_reference(scene, camera, settings, {}, truth));
  EXPECT_EQ(outside(truth.color, mask), 0u);
  EXPECT_EQ(outside(picture(scene, camera, settings), mask), 0u);
  const std::vector<float> widths = mask_widths(mask);
  std::vector<float> sorted = widths;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<long>(sorted.size() / 2), sorted.end());
  std::printf("%s: %.4f %% wider than 8, median width %.3f\n", c.name, 100 * share_wider(mask, 8),
              static_cast<double>(sorted[sorted.size() / 2]));
  EXPECT_LE(share_wider(mask, 8), c.most_wide);
  EXPECT_GT(share_wider(mask, 8), 0.0005) << "there are edges in every picture";
  EXPECT_LE(sorted[sorted.size() / 2], 3.0f);
}

void as_it_is(Settings&) {}

INSTANTIATE_TEST_SUITE_P(
    Shipped, AmbiguityOfScenes,
    ::testing::Values(
        Case{"cornell", "cornell", as_it_is, 0.01}, Case{"spheres", "spheres", as_it_is, 0.05},
        Case{"columns", "columns", as_it_is, 0.02}, Case{"gauze", "gauze", as_it_is, 0.02},
        Case{"glass", "glass", as_it_is, 0.02}, Case{"hall", "hall", as_it_is, 0.04},
        Case{"orrery", "orrery", [](Settings& s) { s.time = 3; }, 0.02}, Case{"hall, camera 1", "hall", as_it_is, 0.04, 1},
        Case{"spheres, Gouraud", "spheres", [](Settings& s) { s.shading = Shading::kGouraud; }, 0.05},
        Case{"columns, flat", "columns", [](Settings& s) { s.shading = Shading::kFlat; }, 0.02},
        Case{"columns, bilinear", "columns", [](Settings& s) { s.filter = Filter::kBilinear; }, 0.03},
        Case{"columns, nearest", "columns", [](Settings& s) { s.filter = Filter::kNearest; }, 0.06},
        Case{"glass, screen-door", "glass", [](Settings& s) { s.transparency = Transparency::kScreenDoor; }, 0.02},
        Case{"gauze, blended", "gauze", [](Settings& s) { s.transparency = Transparency::kAlpha; }, 0.02},
        Case{"gauze, culled", "gauze", [](Settings& s) { s.culling = Culling::kBack; }, 0.02},
        Case{"columns, 4 samples", "columns", [](Settings& s) { s.samples = 4, s.antialiasing = Antialiasing::kSupersample; },
             0.04},
        Case{"hall, plain", "hall", [](Settings& s) { s.textures = s.bump = false, s.shadows = Shadows::kNone; }, 0.04}));

// The camera turned so that the picture moves by a part of a pixel.
Camera turned(const Camera& camera, const Settings& settings, double pixels) {
  const reference::View view(camera, settings.width, settings.height);
  const double distance =
      length3(glm::dvec3(camera.target[0] - camera.eye[0], camera.target[1] - camera.eye[1], camera.target[2] - camera.eye[2]));
  const glm::dvec3 move = (view.right + view.down) * (pixels * distance);
  Camera result = camera;
  for (int k = 0; k < 3; ++k) result.target[k] += move[k];
  return result;
}

TEST(AmbiguityOfScenes, APictureThatMovedByLessIsWithinAndOneThatMovedByHalfAPixelIsNot) {
  for (const char* name : {"columns", "hall", "glass"}) {
    const Scene scene = shipped(name);
    const Settings settings = small(scene);
    const Camera& camera = scene.cameras()[0];
    const AmbiguityMask mask = mask_of(scene, camera, settings);
    // A third: toward the corners, turning moves the picture by more. Our own rasterizer then adds up to 1/512.
    for (const double part : {-0.33, 0.33})
      EXPECT_EQ(outside(picture(scene, turned(camera, settings, part / 256), settings), mask), 0u) << name;
    const size_t pixels = 160 * 90;
    EXPECT_GT(outside(picture(scene, turned(camera, settings, 0.5), settings), mask), pixels / 5) << name;
    EXPECT_GT(outside(picture(scene, turned(camera, settings, 0.03), settings), mask), pixels / 1000)
        << name << ", eight times the bound";
  }
}

// The scene with every vertex moved in the plane of the picture, by up to so many pixels, each place on its own.
Scene jittered(const TempFolder& folder, const char* name, const Camera& camera, const Settings& settings, double pixels) {
  const reference::View view(camera, settings.width, settings.height);
  std::filesystem::copy(SPANRAY_SOURCE_DIR "/assets", folder.path(),
                        std::filesystem::copy_options::recursive | std::filesystem::copy_options::overwrite_existing);
  std::ifstream in(std::string(SPANRAY_SOURCE_DIR) + "/assets/" + name + ".obj");
  std::ofstream out(folder.file(std::string(name) + ".obj"));
  std::map<std::string, glm::dvec2> moves;  // vertices at one place move together
  uint64_t random = 1;
  const auto next = [&] {
    return random = random * 6364136223846793005u + 1442695040888963407u, 2 * static_cast<double>(random >> 11) * 0x1p-53 - 1;
  };
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("v ", 0) == 0) {
      if (moves.count(line) == 0) moves[line] = glm::dvec2(next(), next()) * pixels;
      glm::dvec3 p;
      EXPECT_EQ(std::sscanf(line.c_str(), "v %lf %lf %lf", &p.x, &p.y, &p.z), 3);
      const double depth = dot3(p - view.eye, view.forward);
      if (depth > view.near) p += (view.right * moves[line].x + view.down * moves[line].y) * depth;
      char text[128];
      std::snprintf(text, sizeof text, "v %.9g %.9g %.9g", p.x, p.y, p.z), line = text;
    }
    out << line << "\n";
  }
  out.close();
  return load(folder.file(std::string(name) + ".toml"));
}

TEST(AmbiguityOfScenes, AMeshWhoseVerticesMovedWithinTheBoundIsWithin) {
  const TempFolder folder;
  for (const char* name : {"columns", "glass", "gauze"}) {
    const Scene scene = shipped(name);
    Settings settings = small(scene);  // vertices move in the picture only, not for rays; normals of moved triangles are others
    settings.shadows = Shadows::kNone, settings.reflections = Reflections::kNone, settings.bump = false;
    const Camera& camera = scene.cameras()[0];
    const AmbiguityMask mask = mask_of(scene, camera, settings);
    // In space a tiny triangle turns when its corners move, and one may turn away from a light; on the screen it does not.
    EXPECT_LE(outside(picture(jittered(folder, name, camera, settings, 0.5 / 256), camera, settings), mask), 1u) << name;
    EXPECT_GT(outside(picture(jittered(folder, name, camera, settings, 0.1), camera, settings), mask), 50u) << name;
  }
}

TEST(AmbiguityOfScenes, WhatIsRenderedWronglyIsNotWithin) {
  struct Wrong {
    const char* name;
    const char* scene;
    void (*change)(Settings&);
    uint64_t least;
  };
  for (const Wrong& wrong : {Wrong{"no shadows", "columns", [](Settings& s) { s.shadows = Shadows::kNone; }, 1000},
                             Wrong{"no bump", "columns", [](Settings& s) { s.bump = false; }, 500},
                             Wrong{"nearest", "columns", [](Settings& s) { s.filter = Filter::kNearest; }, 1000},
                             Wrong{"bilinear", "columns", [](Settings& s) { s.filter = Filter::kBilinear; }, 1000},
                             Wrong{"no mirrors", "spheres", [](Settings& s) { s.reflections = Reflections::kNone; }, 1000},
                             Wrong{"one bounce", "spheres", [](Settings& s) { s.max_bounces = 1; }, 20},
                             Wrong{"Gouraud", "spheres", [](Settings& s) { s.shading = Shading::kGouraud; }, 100},
                             Wrong{"flat normals", "spheres", [](Settings& s) { s.shading = Shading::kFlat; }, 1000},
                             Wrong{"no transparency", "glass", [](Settings& s) { s.transparency = Transparency::kNone; }, 1000},
                             Wrong{"four samples", "hall", [](Settings& s) { s.samples = 4; }, 500}}) {
    const Scene scene = shipped(wrong.scene);
    Settings settings = small(scene);
    const AmbiguityMask mask = mask_of(scene, scene.cameras()[0], settings);
    wrong.change(settings);
    const uint64_t found = outside(picture(scene, scene.cameras()[0], settings), mask);
    std::printf("%s: %llu outside\n", wrong.name, static_cast<unsigned long long>(found));
    EXPECT_GE(found, wrong.least) << wrong.name;
  }
}

TEST(AmbiguityOfScenes, WiderBoundsGiveWiderMasksAndThreadsChangeNothing) {
  const Scene scene = shipped("columns");
  Settings settings = small(scene);
  const Camera& camera = scene.cameras()[0];
  const AmbiguityMask mask = mask_of(scene, camera, settings);
  const auto share = [&](void (*change)(AmbiguityBounds&), double codes) {
    AmbiguityBounds bounds;
    change(bounds);
    const AmbiguityMask wider = mask_of(scene, camera, settings, bounds);
    return share_wider(wider, codes) / share_wider(mask, codes);
  };
  EXPECT_GT(share([](AmbiguityBounds& b) { b.pixels *= 4; }, 8), 2);
  EXPECT_GT(share([](AmbiguityBounds& b) { b.texels *= 16; }, 3), 1.5);
  EXPECT_GT(share([](AmbiguityBounds& b) { b.levels *= 32; }, 3), 1.2);
  EXPECT_GT(share([](AmbiguityBounds& b) { b.any_opengl_footprint = true; }, 8), 2);
  EXPECT_GT(share([](AmbiguityBounds& b) { b.codes = 2; }, 3.9), 5) << "4 is the least then";
  ReferenceOptions three;
  three.threads = 3;
  AmbiguityMask again;
  ASSERT_TRUE(make_ambiguity_mask(scene, camera, settings, three, {}, again));
  EXPECT_TRUE(again.least == mask.least && again.greatest == mask.greatest && again.open == mask.open);
  settings.width = 0;
  EXPECT_FALSE(make_ambiguity_mask(scene, camera, settings, {}, {}, again));
}

}  // namespace
}  // namespace spanray
