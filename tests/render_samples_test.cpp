// Anti-aliasing of whole pictures: exact weights, no leaks, one picture from both engines, interiors as with one sample.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include "image/metrics.h"
#include "raster/raster.h"
#include "ray/bvh.h"
#include "render/make_frame.h"
#include "render/tile_samples.h"
#include "scene/scene_builder.h"
#include "spanray/render.h"
#include "support/random.h"
#include "support/test_frame.h"

namespace spanray {
namespace {

constexpr int kPatterns[] = {4, 8, 16};
constexpr Antialiasing kModes[] = {Antialiasing::kMultisample, Antialiasing::kSupersample};
constexpr Visibility kEngines[] = {Visibility::kRaster, Visibility::kRay};
constexpr double kEdgePixels = 1.0 / 256;  // as in render_visibility_test

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

Framebuffer render(const Scene& scene, const Camera& camera, const Settings& settings) {
  Renderer renderer;
  Framebuffer out;
  FrameRequest request;
  request.radiance = request.primitive = request.depth = true;
  const auto stats = renderer.render(scene, camera, settings, out, request);
  EXPECT_TRUE(stats) << stats.error().to_string();
  return out;
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

// What every sample of a picture sees, by either engine: sample by sample.
std::vector<std::vector<uint32_t>> ids_of_samples(const Scene& scene, const Camera& camera, const Settings& settings, Visibility engine) {
  const SceneData& data = scene.data();
  Parallel parallel(1);
  Settings s = settings;
  s.visibility = engine;
  const Plan plan = make_plan(data, find_scene_use(data), s);
  const Frame frame = make_frame(data, camera, s, plan, parallel);
  ScreenVertices vertices;
  TileBins bins;
  FrameCounts counts;
  transform_vertices(frame, vertices);
  clip_triangles(frame, vertices, bins, counts);
  bin_triangles(frame, bins);
  const Bvh bvh = build_bvh(data, frame.material_flags, kMaterialTranslucent, 0, parallel);
  std::vector<std::vector<uint32_t>> ids;
  const size_t pixels = static_cast<size_t>(s.width) * static_cast<size_t>(s.height);
  for (int place = frame.places.first(); place < frame.places.end(); ++place) {
    std::vector<uint32_t>& id = ids.emplace_back(pixels);
    if (engine == Visibility::kRay) {
      std::vector<uint32_t> pixel;
      for (size_t i = 0; i < pixels; ++i)
        pixel.push_back(pack_pixel(static_cast<uint32_t>(i) % static_cast<uint32_t>(s.width), static_cast<uint32_t>(i) / static_cast<uint32_t>(s.width)));
      RayBatch rays;
      make_primary_batch(frame, pixel.data(), static_cast<int>(pixels), place, rays);
      trace_closest(frame, bvh, rays, id.data());
      continue;
    }
    const auto hits = std::make_unique<TileHits>();
    for (int tile = 0; tile < frame.grid.count(); ++tile) {
      rasterize_tile(frame, bins, tile, *hits, place);
      for (int y = frame.grid.y0(tile); y < frame.grid.y1(tile); ++y)
        for (int x = frame.grid.x0(tile); x < frame.grid.x1(tile); ++x)
          id[static_cast<size_t>(y * s.width + x)] = hits->primitive[(y - frame.grid.y0(tile)) * kTileSize + x - frame.grid.x0(tile)];
    }
  }
  return ids;
}

struct Picture {
  Scene scene;
  Camera camera;
  Settings settings;
};

Picture picture_of(const char* name, int width, int height, int samples, Antialiasing mode) {
  Result<LoadedScene> loaded = load_scene(std::string(SPANRAY_SOURCE_DIR) + "/assets/" + name);
  EXPECT_TRUE(loaded) << loaded.error().to_string();
  Picture p{loaded.value().scene, loaded.value().scene.cameras()[0], loaded.value().scene.settings()};
  p.settings.width = width, p.settings.height = height, p.settings.samples = samples, p.settings.antialiasing = mode;
  p.settings.threads = 1;
  return p;
}

double edge_distance(const SceneData& scene, const PrimaryRays& rays, uint32_t primitive, double x, double y) {
  const auto vertex = [&](int i) {
    const float* p = scene.vertices[scene.triangles[primitive].vertex[i]].position;
    return glm::dvec3(p[0], p[1], p[2]);
  };
  const glm::dvec3 d = rays.corner + rays.step_x * x + rays.step_y * y;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 n = cross3(vertex(i) - rays.eye, vertex((i + 1) % 3) - rays.eye);
    const double gradient = std::hypot(dot3(rays.step_x, n), dot3(rays.step_y, n));
    if (gradient > 0) least = std::min(least, std::fabs(dot3(d, n)) / gradient);
  }
  return least;
}

// Y13 with several samples: where all samples of a pixel see the same by both engines, and no translucent edge passes one, the
// radiance is bit-equal.
TEST(Antialiasing, Y13_RasterAndRaysGiveOnePicture) {
  struct Case { const char* scene; int samples; Antialiasing mode; };
  for (const Case& c : {Case{"spheres.toml", 4, Antialiasing::kMultisample}, Case{"gauze.toml", 8, Antialiasing::kMultisample},
                        Case{"glass.toml", 4, Antialiasing::kMultisample}, Case{"glass.toml", 4, Antialiasing::kSupersample}}) {
    Picture p = picture_of(c.scene, 160, 90, c.samples, c.mode);
    Framebuffer frames[2];
    std::vector<std::vector<uint32_t>> ids[2];
    for (int i = 0; i < 2; ++i) {
      p.settings.visibility = kEngines[i];
      frames[i] = render(p.scene, p.camera, p.settings);
      ids[i] = ids_of_samples(p.scene, p.camera, p.settings, kEngines[i]);
    }
    const PrimaryRays rays = make_primary_rays(p.camera, 160, 90);
    const SamplePlaces places = make_sample_places(c.samples);
    const SceneData& data = p.scene.data();
    std::vector<uint32_t> translucent;
    for (uint32_t i = 0; i < data.triangles.size(); ++i)
      if (material_flags(data.materials[material_of(data.triangles[i])], p.settings) & kMaterialTranslucent) translucent.push_back(i);
    size_t mixed = 0, differ = 0, colors = 0;
    for (size_t i = 0; i < frames[0].primitive.size(); ++i) {
      ASSERT_EQ(frames[0].primitive[i], ids[0][0][i]) << "the picture's ids are those of sample 0";
      bool same_ids = true;
      double nearest = std::numeric_limits<double>::infinity();
      for (int s = 0; s < c.samples; ++s) {
        const bool same = ids[0][static_cast<size_t>(s)][i] == ids[1][static_cast<size_t>(s)][i];
        same_ids = same_ids && same;
        differ += !same;
        mixed += ids[0][static_cast<size_t>(s)][i] != ids[0][0][i];
      }
      if (!same_ids || std::memcmp(&frames[0].radiance[3 * i], &frames[1].radiance[3 * i], 12) == 0) continue;
      ++colors;
      for (int place = places.first(); place < places.end(); ++place)
        for (const uint32_t t : translucent)
          nearest = std::min(nearest, edge_distance(data, rays, t, static_cast<double>(i % 160) + places.x[place], static_cast<double>(i / 160) + places.y[place]));
      EXPECT_LE(nearest, kEdgePixels) << c.scene << ": color differs at " << i % 160 << "," << i / 160;
    }
    std::printf("%s, %d samples: %zu samples differ in id, %zu more pixels in color\n", c.scene, c.samples, differ, colors);
    EXPECT_GT(mixed, 300u) << "no edges, no test";
    EXPECT_LT(differ, frames[0].primitive.size() * static_cast<size_t>(c.samples) / 500);
  }
}

// Multisampling changes edges only: where all samples see what the center sees, the picture is that of one sample, bit for bit.
TEST(Antialiasing, InteriorsAreThoseOfOneSample) {
  for (const int samples : kPatterns) {
    const Picture p = picture_of("spheres.toml", 160, 90, samples, Antialiasing::kMultisample);
    Settings one = p.settings;
    one.samples = 1;
    const Framebuffer many = render(p.scene, p.camera, p.settings), single = render(p.scene, p.camera, one);
    const auto ids = ids_of_samples(p.scene, p.camera, p.settings, Visibility::kRaster);
    size_t inside = 0;
    for (size_t i = 0; i < single.primitive.size(); ++i) {
      bool same = single.primitive[i] != kNoPrimitive;
      for (const auto& id : ids) same = same && id[i] == single.primitive[i];
      if (!same) continue;
      ++inside;
      ASSERT_EQ(0, std::memcmp(&many.radiance[3 * i], &single.radiance[3 * i], 12)) << i % 160 << "," << i / 160;
      ASSERT_EQ(many.depth[i], single.depth[i]);
    }
    EXPECT_GT(inside, 1000u);
  }
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
