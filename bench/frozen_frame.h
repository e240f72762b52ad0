// Frozen inputs: one shipped scene from its first camera at 1280x720 on one thread, and what the stages before the one that
// is measured made of it. The same in every run, so that numbers can be compared between commits.
#pragma once
#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "raster/raster.h"
#include "ray/bvh.h"
#include "render/make_frame.h"
#include "shade/light.h"
#include "shade/surface.h"
#include "spanray/scene.h"

namespace spanray::bench {

inline Scene load_shipped(const std::string& name) {
  auto loaded = load_scene(std::string(SPANRAY_SOURCE_DIR) + "/assets/" + name + ".toml");
  if (!loaded) {
    std::fprintf(stderr, "%s\n", loaded.error().to_string().c_str());
    std::exit(1);
  }
  return loaded.value().scene;
}

struct FrozenFrame {
  Scene scene;
  Plan plan;
  Parallel parallel{1};
  Frame frame;
  ScreenVertices vertices;
  TileBins bins;
  std::unique_ptr<Bvh> bvh;       // opaque triangles
  std::vector<HitBatch> hits;     // one a tile: the pixels that see something
  FrameCounts counts;

  FrozenFrame(const std::string& name, Isa isa) : scene(load_shipped(name)) {
    Settings settings = scene.settings();
    settings.width = 1280, settings.height = 720, settings.isa = isa, settings.threads = 1;
    plan = make_plan(scene.data(), find_scene_use(scene.data()), settings);
    frame = make_frame(scene.data(), scene.cameras()[0], settings, plan, parallel);
    transform_vertices(frame, vertices);
    clip_triangles(frame, vertices, bins, counts);
    bin_triangles(frame, bins);
    bvh = std::make_unique<Bvh>(build_bvh(scene.data(), frame.material_flags, kMaterialTranslucent, 0, parallel));
    find_hits();
  }
  FrozenFrame(const FrozenFrame&) = delete;
  FrozenFrame& operator=(const FrozenFrame&) = delete;

  size_t hit_count() const {
    size_t n = 0;
    for (const HitBatch& h : hits) n += static_cast<size_t>(h.count);
    return n;
  }

 private:
  void find_hits() {
    const auto visible = std::make_unique<TileHits>();
    for (int tile = 0; tile < frame.grid.count(); ++tile) {
      rasterize_tile(frame, bins, tile, *visible);
      HitBatch batch;
      batch.resize(kTilePixels, false);
      int n = 0;
      for (int y = frame.grid.y0(tile); y < frame.grid.y1(tile); ++y) {
        for (int x = frame.grid.x0(tile); x < frame.grid.x1(tile); ++x) {
          const uint32_t primitive = visible->primitive[(y - frame.grid.y0(tile)) * kTileSize + x - frame.grid.x0(tile)];
          if (primitive == kNoPrimitive) continue;
          batch.pixel[n] = pack_pixel(static_cast<uint32_t>(x), static_cast<uint32_t>(y)), batch.primitive[n++] = primitive;
        }
      }
      batch.resize(n, false);
      if (n > 0) hits.push_back(std::move(batch));
    }
  }
};

// Made once a scene and instruction set, however many benchmarks ask for it.
inline FrozenFrame& frozen(const std::string& name, Isa isa) {
  static std::map<std::pair<std::string, int>, std::unique_ptr<FrozenFrame>> made;
  auto& slot = made[{name, static_cast<int>(isa)}];
  if (!slot) slot = std::make_unique<FrozenFrame>(name, isa);
  return *slot;
}

// Every stage benchmark takes the instruction set as its argument: 1 scalar, 2 SSE4, 3 AVX2, 4 AVX-512 (simd/isa.h).
inline void each_isa(benchmark::internal::Benchmark* b) {
  b->ArgName("isa");
  for (int isa = 1; isa <= kIsaCount; ++isa) {
    if (isa_supported(static_cast<Isa>(isa))) b->Arg(isa);
  }
  b->Unit(benchmark::kMillisecond);
}
inline Isa isa_of(const benchmark::State& state) { return static_cast<Isa>(state.range(0)); }

}  // namespace spanray::bench
