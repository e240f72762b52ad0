// Anti-aliasing of shipped scenes: one picture from both engines, interiors as with one sample.
#include <cmath>
#include <cstring>
#include <limits>

#include "ray/bvh.h"
#include "render/make_frame.h"
#include "render/tile_samples.h"
#include "spanray/scene.h"
#include "support/edge_distance.h"
#include "support/raster_front_end.h"
#include "support/sample_pictures.h"

namespace spanray {
namespace {

// What every sample of a picture sees, by either engine: sample by sample.
std::vector<std::vector<uint32_t>> ids_of_samples(const Scene& scene, const Camera& camera, const Settings& settings, Visibility engine) {
  const SceneData& data = scene.data();
  Parallel parallel(1);
  Settings s = settings;
  s.visibility = engine;
  const Plan plan = make_plan(data, find_scene_use(data), s);
  const Frame frame = make_frame(data, camera, s, plan, parallel);
  const FrontEnd front = run_front_end(frame);
  const Bvh bvh = build_bvh(data, frame.material_flags, kMaterialTranslucent, 0, parallel);
  std::vector<std::vector<uint32_t>> ids;
  const size_t pixels = static_cast<size_t>(s.width) * static_cast<size_t>(s.height);
  for (int place = frame.places.first(); place < frame.places.end(); ++place) {
    if (engine == Visibility::kRaster) {
      ids.push_back(rasterize(frame, front.bins, place).primitive);
      continue;
    }
    std::vector<uint32_t>& id = ids.emplace_back(pixels);
    std::vector<uint32_t> pixel;
    for (size_t i = 0; i < pixels; ++i)
      pixel.push_back(pack_pixel(static_cast<uint32_t>(i) % static_cast<uint32_t>(s.width), static_cast<uint32_t>(i) / static_cast<uint32_t>(s.width)));
    RayBatch rays;
    make_primary_batch(frame, pixel.data(), static_cast<int>(pixels), place, rays);
    trace_closest(frame, bvh, rays, id.data());
  }
  return ids;
}

struct ShippedPicture {
  Scene scene;
  Camera camera;
  Settings settings;
};

ShippedPicture picture_of(const char* name, int width, int height, int samples, Antialiasing mode) {
  Result<LoadedScene> loaded = load_scene(std::string(SPANRAY_SOURCE_DIR) + "/assets/" + name);
  EXPECT_TRUE(loaded) << loaded.error().to_string();
  ShippedPicture p{loaded.value().scene, loaded.value().scene.cameras()[0], loaded.value().scene.settings()};
  p.settings.width = width, p.settings.height = height, p.settings.samples = samples, p.settings.antialiasing = mode;
  p.settings.threads = 1;
  return p;
}

// Y13 with several samples: where all samples of a pixel see the same by both engines, and no translucent edge passes one, the
// radiance is bit-equal.
TEST(Antialiasing, Y13_RasterAndRaysGiveOnePicture) {
  struct Case { const char* scene; int samples; Antialiasing mode; };
  for (const Case& c : {Case{"spheres.toml", 4, Antialiasing::kMultisample}, Case{"gauze.toml", 8, Antialiasing::kMultisample},
                        Case{"glass.toml", 4, Antialiasing::kMultisample}, Case{"glass.toml", 4, Antialiasing::kSupersample}}) {
    ShippedPicture p = picture_of(c.scene, 160, 90, c.samples, c.mode);
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
    const ShippedPicture p = picture_of("spheres.toml", 160, 90, samples, Antialiasing::kMultisample);
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

}  // namespace
}  // namespace spanray
