// Visibility engine 1, stage by stage, one thread.
#include "frozen_frame.h"

namespace spanray::bench {
namespace {

void transform(benchmark::State& state) {
  FrozenFrame& f = frozen("columns", isa_of(state));
  ScreenVertices out;
  for (auto _ : state) transform_vertices(f.frame, out);
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(f.scene.data().vertices.size()));
}
BENCHMARK(transform)->Apply(each_isa);

void clip_and_bin(benchmark::State& state) {
  FrozenFrame& f = frozen("columns", isa_of(state));
  TileBins bins;
  for (auto _ : state) {
    FrameCounts counts;
    clip_triangles(f.frame, f.vertices, bins, counts);
    bin_triangles(f.frame, bins);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(f.scene.triangle_count()));
}
BENCHMARK(clip_and_bin)->Apply(each_isa);

void rasterize(benchmark::State& state, const char* scene) {
  FrozenFrame& f = frozen(scene, isa_of(state));
  const auto hits = std::make_unique<TileHits>();
  for (auto _ : state) {
    for (int tile = 0; tile < f.frame.grid.count(); ++tile) rasterize_tile(f.frame, f.bins, tile, *hits);
  }
  state.SetItemsProcessed(state.iterations() * 1280 * 720);  // pixels
}
BENCHMARK_CAPTURE(rasterize, opaque, "columns")->Apply(each_isa);
BENCHMARK_CAPTURE(rasterize, masked, "gauze")->Apply(each_isa);

void rasterize_layers(benchmark::State& state) {
  FrozenFrame& f = frozen("glass", isa_of(state));
  const auto hits = std::make_unique<TileHits>();
  FragmentList fragments;
  for (auto _ : state) {
    for (int tile = 0; tile < f.frame.grid.count(); ++tile) {
      fragments.clear();
      rasterize_tile(f.frame, f.bins, tile, *hits);
      rasterize_translucent(f.frame, f.bins, tile, *hits, fragments);
    }
  }
  state.SetItemsProcessed(state.iterations() * 1280 * 720);
}
BENCHMARK(rasterize_layers)->Apply(each_isa);

}  // namespace
}  // namespace spanray::bench
