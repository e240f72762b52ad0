// Anti-aliasing of made scenes: exact weights, no leaks. Shipped scenes: render_samples_scenes_test.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "frame/samples.h"
#include "scene/scene_builder.h"
#include "support/random.h"
#include "support/sample_pictures.h"
#include "support/test_frame.h"

namespace spanray {
namespace {

// Emits `gray` and nothing else.
Material glowing(float gray, float opacity = 1) {
  Material m;
  for (int c = 0; c < 3; ++c) m.ambient[c] = m.diffuse[c] = m.specular[c] = m.mirror[c] = 0, m.emission[c] = gray;
  m.opacity = opacity;
  if (opacity < 1) m.transparency = static_cast<int32_t>(MaterialTransparency::kAlpha);
  return m;
}

Scene scene_of(const std::vector<SoupTriangle>& soup, const std::vector<Material>& materials, float background) {
  auto data = std::make_shared<SceneData>(make_test_scene(soup, materials));
  for (float& c : data->background) c = background;
  hash_scene(*data);
  return Scene(data);
}

void add_quad(std::vector<SoupTriangle>& soup, double x0, double y0, double x1, double y1, double z, uint32_t material) {
  soup.push_back(soup_triangle({x0, y0, z}, {x1, y0, z}, {x1, y1, z}, material));
  soup.push_back(soup_triangle({x0, y0, z}, {x1, y1, z}, {x0, y1, z}, material));
}

// Looks at the plane z = 0 so that a pixel of a 32 x 32 picture is a unit square: pixel (i, j) is [i - 16, i - 15] x [15 - j, 16 - j].
Camera unit_pixels() {
  Camera c;
  c.eye[2] = 16;
  c.fov_y_degrees = 90;
  return c;
}

Settings settings_with(int samples, Antialiasing mode, Visibility engine = Visibility::kRaster) {
  Settings s;
  s.width = s.height = 32, s.threads = 1;
  s.samples = samples, s.antialiasing = mode, s.visibility = engine;
  return s;
}

template <class F> void for_all_ways(const F& visit) {
  for (const int samples : kPatterns)
    for (const Antialiasing mode : kModes)
      for (const Visibility engine : kEngines) visit(samples, mode, engine);
}

int samples_right_of(int samples, int sixteenths) {
  const SamplePlaces p = make_sample_places(samples);
  int n = 0;
  for (int place = p.first(); place < p.end(); ++place) n += p.offset_x_24_8[place] + 128 >= 16 * sixteenths;
  return n;
}

// A vertical edge that sweeps through a pixel in steps of 1/16.
TEST(Antialiasing, AnEdgeGivesTheExactWeightedMean) {
  std::set<float> steps;
  for_all_ways([&](int samples, Antialiasing mode, Visibility engine) {
    for (int k = 0; k < 16; ++k) {
      std::vector<SoupTriangle> soup;
      add_quad(soup, 0 + k / 16.0, -20, 20, 20, 0, 0);
      const Framebuffer out = render(scene_of(soup, {glowing(1)}, 0.25f), unit_pixels(), settings_with(samples, mode, engine));
      // Samples on the edge itself: inside by the top-left rule; rays may see them either way.
      const int covered = samples_right_of(samples, k), on_edge = covered - samples_right_of(samples, k + 1) > 0 && engine == Visibility::kRay;
      const float want = (static_cast<float>(covered) + 0.25f * static_cast<float>(samples - covered)) / static_cast<float>(samples);
      for (int y = 0; y < 32; ++y) {
        const float* pixel = &out.radiance[3 * static_cast<size_t>(y * 32 + 16)];
        if (!on_edge) {
          ASSERT_EQ(pixel[0], want) << samples << " samples, edge at " << k << "/16, row " << y;
        }
        ASSERT_EQ(pixel[-3], 0.25f) << "left of it";
        ASSERT_EQ(pixel[3], 1.0f) << "right of it";
      }
      if (samples == 16 && engine == Visibility::kRaster) steps.insert(want);
    }
  });
  EXPECT_EQ(steps.size(), 16u) << "16 samples show every sixteenth of a pixel";
}

TEST(Antialiasing, NoBackgroundShowsThroughAMesh) {
  constexpr int kSide = 20;
  TestRandom random(7);
  glm::dvec3 p[kSide + 1][kSide + 1];
  for (int j = 0; j <= kSide; ++j)
    for (int i = 0; i <= kSide; ++i)
      p[j][i] = {-25 + 2.5 * i + random.uniform(-0.5, 0.5), -25 + 2.5 * j + random.uniform(-0.5, 0.5), random.uniform(-2, 2)};
  std::vector<SoupTriangle> soup;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      soup.push_back(soup_triangle(p[j][i], p[j][i + 1], p[j + 1][i + 1]));
      soup.push_back(soup_triangle(p[j][i], p[j + 1][i + 1], p[j + 1][i]));
    }
  const Scene scene = scene_of(soup, {glowing(0.25f)}, 1);
  for_all_ways([&](int samples, Antialiasing mode, Visibility engine) {
    Settings s = settings_with(samples, mode, engine);
    s.width = s.height = 100;
    const Framebuffer out = render(scene, unit_pixels(), s);
    for (const float r : out.radiance) ASSERT_EQ(r, 0.25f) << samples;
  });
}

// A pane before a glowing wall, over part of the pixel: the samples that it covers are blended, the others are not.
TEST(Antialiasing, T3_APaneCoversSomeSamples) {
  for_all_ways([&](int samples, Antialiasing mode, Visibility engine) {
    std::vector<SoupTriangle> soup;
    add_quad(soup, -30, -30, 30, 30, -4, 0);
    add_quad(soup, 0.46875, -20, 20, 20, 0, 1);  // between two columns of samples
    const Framebuffer out = render(scene_of(soup, {glowing(1), glowing(0.5f, 0.5f)}, 0), unit_pixels(), settings_with(samples, mode, engine));
    const int covered = samples_right_of(samples, 8);
    const float want = (0.75f * static_cast<float>(covered) + static_cast<float>(samples - covered)) / static_cast<float>(samples);
    ASSERT_TRUE(covered > 0 && covered < samples);
    for (int y = 0; y < 32; ++y) {
      const float* pixel = &out.radiance[3 * static_cast<size_t>(y * 32 + 16)];
      ASSERT_FLOAT_EQ(pixel[0], want) << samples << " samples, row " << y;
      ASSERT_EQ(pixel[-3], 1.0f);
      ASSERT_EQ(pixel[3], 0.75f);
    }
  });
}

// T4 with several samples: every sample has its exact count a mask tile, and every pixel nearly its share.
TEST(Antialiasing, T4_AScreenDoorTurnsSmooth) {
  for_all_ways([&](int samples, Antialiasing mode, Visibility engine) {
    for (const int rank : {7, 16, 29, 50}) {
      std::vector<SoupTriangle> soup;
      add_quad(soup, -30, -30, 30, 30, 0, 0);
      Material gauze = glowing(1, static_cast<float>(rank) / 64);
      gauze.transparency = static_cast<int32_t>(MaterialTransparency::kScreenDoor);
      const Framebuffer out = render(scene_of(soup, {gauze}, 0), unit_pixels(), settings_with(samples, mode, engine));
      float sum = 0;
      for (size_t y = 8; y < 16; ++y)
        for (size_t x = 16; x < 24; ++x) {
          const float r = out.radiance[3 * (y * 32 + x)];
          ASSERT_LE(std::fabs(r - gauze.opacity), 1.0f / static_cast<float>(samples));
          sum += r;
        }
      ASSERT_EQ(sum, static_cast<float>(rank)) << samples;
    }
  });
}

// One color a face: shading every sample gives what shading every face once gives.
TEST(Antialiasing, SupersamplingOfFlatFacesIsMultisampling) {
  TestRandom random(11);
  std::vector<SoupTriangle> soup;
  std::vector<Material> materials;
  for (int i = 0; i < 300; ++i) {
    const glm::dvec3 c(random.uniform(-18, 18), random.uniform(-18, 18), random.uniform(-6, 2));
    const auto near = [&] { return c + glm::dvec3(random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-1, 1)); };
    const glm::dvec3 a = near(), b = near(), d = near();
    soup.push_back(soup_triangle(a, b, d, static_cast<uint32_t>(i % 7)));
  }
  for (int i = 0; i < 7; ++i) {
    Material m;
    for (float& d : m.diffuse) d = static_cast<float>(random.uniform(0.1, 0.9));
    materials.push_back(m);
  }
  auto data = std::make_shared<SceneData>(make_test_scene(soup, materials));
  Light sun;
  sun.kind = static_cast<int32_t>(LightKind::kDirectional);
  sun.direction[2] = 1;
  for (float& c : sun.intensity) c = 2;
  data->lights.push_back(sun);
  hash_scene(*data);
  const Scene scene{data};
  for (const int samples : kPatterns) {
    Settings s = settings_with(samples, Antialiasing::kMultisample);
    s.width = s.height = 128, s.shading = Shading::kFlat, s.shadows = Shadows::kNone;
    const Framebuffer multi = render(scene, unit_pixels(), s);
    s.antialiasing = Antialiasing::kSupersample;
    const Framebuffer super = render(scene, unit_pixels(), s);
    int lit = 0, differ = 0;
    for (size_t i = 0; i < multi.radiance.size(); ++i) {
      lit += multi.radiance[i] > 0;
      ASSERT_NEAR(multi.radiance[i], super.radiance[i], 1e-6f * multi.radiance[i]) << "only sums round differently";
    }
    for (size_t i = 0; i < multi.color.rgba.size(); ++i) differ += multi.color.rgba[i] != super.color.rgba[i];
    EXPECT_GT(lit, 10000);
    EXPECT_LE(differ, 3) << "a sum that rounds across the border of two bytes";
  }
}

TEST(Antialiasing, OtherCountsAreRefused) {
  const Scene scene = scene_of({soup_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}, {Material{}}, 0);
  Renderer renderer;
  Framebuffer out;
  for (const int samples : {-4, 0, 2, 3, 5, 15, 17, 32}) {
    const auto stats = renderer.render(scene, unit_pixels(), settings_with(samples, Antialiasing::kMultisample), out);
    ASSERT_FALSE(stats) << samples;
    EXPECT_NE(stats.error().to_string().find("1, 4, 8 or 16"), std::string::npos);
  }
}

}  // namespace
}  // namespace spanray
