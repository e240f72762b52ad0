// From hits to radiance, one thread: surfaces, light, ray requests. Items are surfaces.
#include "frozen_frame.h"

namespace spanray::bench {
namespace {

void resolve(benchmark::State& state, const char* scene) {
  FrozenFrame& f = frozen(scene, isa_of(state));
  SurfaceBatch surfaces;
  for (auto _ : state) {
    for (const HitBatch& hits : f.hits) resolve_surfaces(f.frame, hits, surfaces);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(f.hit_count()));
}
BENCHMARK_CAPTURE(resolve, plain, "cornell")->Apply(each_isa);
BENCHMARK_CAPTURE(resolve, textured_and_bumped, "columns")->Apply(each_isa);

void light(benchmark::State& state, Shading shading) {
  FrozenFrame& f = frozen("columns", isa_of(state));
  Frame frame = f.frame;
  frame.settings.shading = shading;
  // Surfaces of one tile in eight: all of them would not fit a cache, as those of a real tile do.
  std::vector<std::pair<const HitBatch*, std::unique_ptr<SurfaceBatch>>> tiles;
  int64_t count = 0;
  for (size_t i = 0; i < f.hits.size(); i += 8) {
    tiles.emplace_back(&f.hits[i], std::make_unique<SurfaceBatch>());
    resolve_surfaces(frame, f.hits[i], *tiles.back().second);
    count += f.hits[i].count;
  }
  AlignedBuffer<float> radiance[3];
  for (auto& channel : radiance) channel.resize(kTilePixels + 16);
  float* const out[3] = {radiance[0].data(), radiance[1].data(), radiance[2].data()};
  for (auto _ : state) {
    for (const auto& [hits, surfaces] : tiles) {
      shade_ambient(frame, *surfaces, out);
      for (int k = 0; k < static_cast<int>(f.scene.light_count()); ++k) shade_light(frame, *surfaces, *hits, k, nullptr, out);
    }
  }
  state.SetItemsProcessed(state.iterations() * count * static_cast<int64_t>(f.scene.light_count()));  // surface-light pairs
}
BENCHMARK_CAPTURE(light, phong, Shading::kPhong)->Apply(each_isa);
BENCHMARK_CAPTURE(light, gouraud_lit, Shading::kGouraud)->Apply(each_isa);

void make_rays(benchmark::State& state) {
  FrozenFrame& f = frozen("spheres", isa_of(state));
  SurfaceBatch surfaces;
  RayBatch rays;
  AlignedBuffer<uint32_t> surface_of_ray;
  const HitBatch& hits = f.hits[f.hits.size() / 2];
  resolve_surfaces(f.frame, hits, surfaces);
  for (auto _ : state) {
    rays.resize(0, false), surface_of_ray.clear();
    make_shadow_rays(f.frame, surfaces, 0, rays, surface_of_ray);
  }
  state.SetItemsProcessed(state.iterations() * hits.count);
}
BENCHMARK(make_rays)->Apply(each_isa);

}  // namespace
}  // namespace spanray::bench
