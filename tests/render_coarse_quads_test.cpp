// Shading rate 2x2: what is shaded once, and that edges, layers, ids, depth, normals and uv keep every pixel.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>

#include "render/coarse_quads.h"
#include "render/make_frame.h"
#include "render/trace_pixel.h"
#include "spanray/settings_text.h"
#include "support/raster_front_end.h"
#include "support/sample_pictures.h"

namespace spanray {
namespace {

struct Rendered {
  Framebuffer frame;
  std::map<std::string, uint64_t> counts;
};

struct Shipped {
  Scene scene;
  Camera camera;
  Settings settings;

  Shipped(const std::string& name, int width, int height) {
    Result<LoadedScene> loaded = load_scene(std::string(SPANRAY_SOURCE_DIR) + "/assets/" + name);
    EXPECT_TRUE(loaded) << loaded.error().to_string();
    scene = loaded.value().scene;
    camera = scene.cameras()[0], settings = scene.settings();
    settings.width = width, settings.height = height, settings.threads = 1;
  }
  Rendered render(ShadingRate rate) const {
    Settings s = settings;
    s.shading_rate = rate;
    Renderer renderer;
    Rendered out;
    FrameRequest request;
    request.radiance = request.primitive = request.depth = request.normal = request.uv = true;
    const auto stats = renderer.render(scene, camera, s, out.frame, request);
    EXPECT_TRUE(stats) << stats.error().to_string();
    out.counts = {stats.value().counts.begin(), stats.value().counts.end()};
    return out;
  }
  // Of each pixel: how many translucent fragments lie over it.
  std::vector<int> layers(const Frame& frame) const {
    return frame.plan.translucents ? count_fragments(frame, run_front_end(frame).bins)
                                   : std::vector<int>(static_cast<size_t>(settings.width * settings.height), 0);
  }
};

bool same_radiance(const Framebuffer& a, size_t i, const Framebuffer& b, size_t j) {
  return std::memcmp(&a.radiance[3 * i], &b.radiance[3 * j], 12) == 0;
}

// Every aligned square of an odd-sized picture: one color where it is one surface without layers, and elsewhere, as in the last
// column and row, the bytes of the picture at 1x1.
TEST(CoarseQuads, EdgesAndLayersKeepEveryPixel) {
  for (const char* name : {"spheres.toml", "columns.toml", "glass.toml", "gauze.toml", "hall.toml"})
    for (const Visibility engine : kEngines)
      for (const Shading shading : {Shading::kPhong, Shading::kFlat, Shading::kGouraud}) {
        if (shading != Shading::kPhong && std::string(name) != "glass.toml") continue;
        SCOPED_TRACE(std::string(name) + " " + enum_text(engine) + " " + enum_text(shading));
        Shipped p(name, 131, 75);
        p.settings.visibility = engine, p.settings.shading = shading;
        const Rendered fine = p.render(ShadingRate::k1x1), coarse = p.render(ShadingRate::k2x2);
        Parallel parallel(1);
        const Plan plan = make_plan(p.scene.data(), find_scene_use(p.scene.data()), p.settings);
        const Frame frame = make_frame(p.scene.data(), p.camera, p.settings, plan, parallel);
        const std::vector<int> layers = p.layers(frame);
        size_t squares = 0, edges = 0, behind_layers = 0;
        std::vector<bool> in_square(layers.size(), false);
        for (int y = 0; y + 1 < 75; y += 2)
          for (int x = 0; x + 1 < 131; x += 2) {
            const size_t at = static_cast<size_t>(y * 131 + x), pixel[4] = {at, at + 1, at + 131, at + 132};
            uint32_t primitive[4];
            int over = 0;
            for (int k = 0; k < 4; ++k) primitive[k] = fine.frame.primitive[pixel[k]], over += layers[pixel[k]];
            const bool one = is_one_surface(frame, primitive);
            behind_layers += one && over > 0;
            edges += !one;
            if (!one || over > 0) continue;
            ++squares;
            for (const size_t i : pixel) {
              in_square[i] = true;
              ASSERT_TRUE(same_radiance(coarse.frame, i, coarse.frame, at)) << x << "," << y;
              ASSERT_EQ(0, std::memcmp(&coarse.frame.color.rgba[4 * i], &coarse.frame.color.rgba[4 * at], 4));
            }
          }
        for (size_t i = 0; i < layers.size(); ++i)
          ASSERT_TRUE(in_square[i] || same_radiance(fine.frame, i, coarse.frame, i)) << i % 131 << "," << i / 131;
        EXPECT_EQ(fine.frame.primitive, coarse.frame.primitive);
        EXPECT_EQ(fine.frame.depth, coarse.frame.depth);
        EXPECT_EQ(fine.frame.normal, coarse.frame.normal);
        EXPECT_EQ(fine.frame.uv, coarse.frame.uv);
        EXPECT_GT(squares, 200u);
        EXPECT_GT(edges, 100u);
        EXPECT_TRUE(!plan.flags.translucents || behind_layers > 30) << behind_layers;
        if (engine == Visibility::kRay) continue;  // its layers may differ from the rasterizer's at their edges
        EXPECT_EQ(coarse.counts.at("quads_shaded"), squares);
        EXPECT_EQ(coarse.counts.at("pixels_covered"), fine.counts.at("pixels_covered"));
        EXPECT_EQ(coarse.counts.at("surfaces_shaded"), fine.counts.at("surfaces_shaded") - 3 * squares);
      }
}

// Without textures, a square is shaded as the pixel of a picture of half the size, whose center its middle is.
TEST(CoarseQuads, TheMiddleIsShaded) {
  for (const char* name : {"spheres.toml", "columns.toml"}) {
    Shipped p(name, 160, 90), half(name, 80, 45);
    for (Shipped* s : {&p, &half}) s->settings.textures = s->settings.bump = false;
    const Rendered coarse = p.render(ShadingRate::k2x2), small = half.render(ShadingRate::k1x1);
    size_t squares = 0, off = 0;
    for (size_t y = 0; y < 45; ++y)
      for (size_t x = 0; x < 80; ++x) {
        const size_t at = 2 * y * 160 + 2 * x, i = y * 80 + x;
        const auto& id = coarse.frame.primitive;
        if (id[at] != id[at + 1] || id[at] != id[at + 160] || id[at] != id[at + 161]) continue;
        if (id[at] != small.frame.primitive[i] || id[at] == kNoPrimitive) continue;
        ++squares;
        int most = 0;
        const uint8_t *const a = &coarse.frame.color.rgba[4 * at], *const b = &small.frame.color.rgba[4 * i];
        for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(a[c] - b[c]));
        off += most > 1;
      }
    std::printf("%s: %zu squares, %zu more than 1 of 255 off\n", name, squares, off);
    EXPECT_GT(squares, 500u);
    EXPECT_LE(off, squares / 200) << "at the borders of shadows and mirrored edges, where rounding decides";
  }
}

// With several samples the pixels of a square must be whole: all samples of one surface. Supersampling shades every sample.
TEST(CoarseQuads, SeveralSamplesAPixel) {
  for (const char* name : {"spheres.toml", "glass.toml"})
    for (const Visibility engine : kEngines) {
      Shipped p(name, 321, 181);
      p.settings.visibility = engine, p.settings.samples = 4;
      const Rendered fine = p.render(ShadingRate::k1x1), coarse = p.render(ShadingRate::k2x2);
      EXPECT_EQ(fine.frame.primitive, coarse.frame.primitive);
      EXPECT_EQ(fine.frame.depth, coarse.frame.depth);
      EXPECT_EQ(fine.frame.normal, coarse.frame.normal);
      EXPECT_EQ(fine.counts.at("pixels_covered"), coarse.counts.at("pixels_covered"));
      EXPECT_EQ(coarse.counts.at("surfaces_shaded"), fine.counts.at("surfaces_shaded") - 3 * coarse.counts.at("quads_shaded"));
      EXPECT_GT(coarse.counts.at("quads_shaded"), 2000u);
      size_t changed = 0;
      for (int y = 0; y < 181; ++y)
        for (int x = 0; x < 321; ++x) {
          const size_t i = static_cast<size_t>(y * 321 + x), first = static_cast<size_t>((y & ~1) * 321 + (x & ~1));
          if (same_radiance(fine.frame, i, coarse.frame, i)) continue;
          ++changed;
          ASSERT_TRUE(same_radiance(coarse.frame, i, coarse.frame, first)) << x << "," << y;
        }
      EXPECT_LE(changed, 4 * coarse.counts.at("quads_shaded"));
      EXPECT_GT(changed, coarse.counts.at("quads_shaded"));
      p.settings.antialiasing = Antialiasing::kSupersample;
      p.settings.width = 97, p.settings.height = 55;
      EXPECT_EQ(p.render(ShadingRate::k1x1).frame.color.rgba, p.render(ShadingRate::k2x2).frame.color.rgba);
    }
}

TEST(CoarseQuads, OneSurfaceIsATriangleOrNeighboursOfOneMaterial) {
  // A fan about vertex 0; the last triangle stands apart, with corners of its own.
  auto data = std::make_shared<SceneData>();
  data->vertices.resize(8);
  data->triangles.resize(5);
  const uint32_t corner[5][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {5, 6, 7}};
  for (size_t t = 0; t < 5; ++t) std::copy_n(corner[t], 3, data->triangles[t].vertex), data->triangles[t].bits = 0;
  Frame frame;
  frame.scene = data.get();
  const auto one = [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    const uint32_t p[4] = {a, b, c, d};
    return is_one_surface(frame, p);
  };
  EXPECT_TRUE(one(4, 4, 4, 4));
  EXPECT_TRUE(one(0, 1, 2, 3));
  for (const uint32_t other : {4u, kNoPrimitive}) {
    EXPECT_FALSE(one(other, 0, 0, 0));
    EXPECT_FALSE(one(0, other, 0, 0));
    EXPECT_FALSE(one(0, 0, other, 0));
    EXPECT_FALSE(one(0, 0, 0, other));
  }
  EXPECT_FALSE(one(kNoPrimitive, kNoPrimitive, kNoPrimitive, kNoPrimitive));
  data->triangles[2].bits = kTriangleFlipped;
  EXPECT_TRUE(one(0, 1, 2, 3)) << "the file's order of corners does not matter";
  data->triangles[2].bits = 1;
  EXPECT_FALSE(one(0, 1, 2, 3)) << "another material";
  EXPECT_TRUE(one(0, 1, 0, 3));
  frame.settings.shading = Shading::kFlat;
  EXPECT_FALSE(one(0, 1, 0, 3)) << "each face has a color";
  EXPECT_TRUE(one(1, 1, 1, 1));
}

// The derivation of a pixel finds its square, and ends in the bytes of the picture.
TEST(CoarseQuads, WhyFindsTheSquare) {
  for (const char* name : {"spheres.toml", "glass.toml"})
    for (const Visibility engine : kEngines)
      for (const int samples : {1, 4}) {
        Shipped p(name, 97, 55);
        p.settings.visibility = engine, p.settings.samples = samples, p.settings.shading_rate = ShadingRate::k2x2;
        const Framebuffer picture = render(p.scene, p.camera, p.settings);
        int squares = 0;
        for (int k = 0; k < 12; ++k) {
          const int x = (k * 37 + 20) % 97, y = (k * 23 + 11) % 55;
          const auto trace = trace_pixel(p.scene, p.camera, p.settings, x, y);
          ASSERT_TRUE(trace);
          const size_t i = static_cast<size_t>(y * 97 + x);
          EXPECT_EQ(0, std::memcmp(trace.value().radiance, &picture.radiance[3 * i], 12)) << x << "," << y;
          EXPECT_EQ(trace.value().primitive, picture.primitive[i]);
          squares += trace.value().slots[0].quad;
        }
        EXPECT_GT(squares, samples == 1 ? 3 : -1) << name;
      }
}

}  // namespace
}  // namespace spanray
