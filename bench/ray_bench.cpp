// Visibility engine 2: building the tree, and batches of rays as the tiles of a frame send them, one thread.
#include "frozen_frame.h"

namespace spanray::bench {
namespace {

void build(benchmark::State& state, const char* scene) {
  FrozenFrame& f = frozen(scene, Isa::kAuto);
  for (auto _ : state) {
    const Bvh bvh = build_bvh(f.scene.data(), f.frame.material_flags, kMaterialTranslucent, 0, f.parallel);
    benchmark::DoNotOptimize(bvh.primitive_count());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(f.scene.triangle_count()));
}
BENCHMARK_CAPTURE(build, columns, "columns")->Unit(benchmark::kMillisecond);

// The rays of each tile, made once.
enum class Rays { kShadow, kBounce };
std::vector<RayBatch> rays_of(FrozenFrame& f, Rays kind) {
  std::vector<RayBatch> batches;
  SurfaceBatch surfaces;
  AlignedBuffer<uint32_t> surface_of_ray;
  for (const HitBatch& hits : f.hits) {
    resolve_surfaces(f.frame, hits, surfaces);
    RayBatch rays;
    surface_of_ray.clear();
    if (kind == Rays::kShadow) make_shadow_rays(f.frame, surfaces, 0, rays, surface_of_ray);
    else make_bounce_rays(f.frame, surfaces, hits, rays, surface_of_ray);
    if (rays.count > 0) batches.push_back(std::move(rays));
  }
  return batches;
}

void shadow_rays(benchmark::State& state, const char* scene) {
  FrozenFrame& f = frozen(scene, isa_of(state));
  const auto batches = rays_of(f, Rays::kShadow);
  AlignedBuffer<uint32_t> occluded(kTilePixels);
  int64_t rays = 0;
  for (auto _ : state) {
    for (const RayBatch& b : batches) trace_any(f.frame, *f.bvh, b, occluded.data()), rays += b.count;
  }
  state.SetItemsProcessed(rays);
}
BENCHMARK_CAPTURE(shadow_rays, sun, "columns")->Apply(each_isa);
BENCHMARK_CAPTURE(shadow_rays, masked, "gauze")->Apply(each_isa);

void bounce_rays(benchmark::State& state) {
  FrozenFrame& f = frozen("spheres", isa_of(state));
  const auto batches = rays_of(f, Rays::kBounce);
  AlignedBuffer<uint32_t> primitive(kTilePixels);
  int64_t rays = 0;
  for (auto _ : state) {
    for (const RayBatch& b : batches) trace_closest(f.frame, *f.bvh, b, primitive.data()), rays += b.count;
  }
  state.SetItemsProcessed(rays);
}
BENCHMARK(bounce_rays)->Apply(each_isa);

}  // namespace
}  // namespace spanray::bench
