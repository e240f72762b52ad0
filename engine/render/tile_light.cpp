#include "render/tile_light.h"

#include "render/lifted_rays.h"
#include "render/tile_ladder.h"

namespace spanray {
namespace {

// The word that begins at bit `at`; reads the one after it, too.
uint32_t word_at(const uint32_t* words, int at) {
  const uint32_t* const w = words + at / 32;
  return static_cast<uint32_t>((w[0] | uint64_t{w[1]} << 32) >> (at % 32));
}

// One bit a surface: set where the light is seen. Surfaces that the light cannot reach get no ray and no bit. lit: zeros.
void find_lit(const FrameJob& job, TileWorker& w, const SurfaceBatch& surfaces, int light, uint32_t* lit) {
  const TileStage stage = w.clock.enter(TileStage::kShadowRays);
  w.shadow_rays.count = 0;
  w.surface_of_ray.clear();
  make_shadow_rays(job.frame, surfaces, light, w.shadow_rays, w.surface_of_ray);
  const int rays = w.shadow_rays.count;
  w.occluded.assign((static_cast<size_t>(rays) + 31) / 32 + 1, 0);  // mark_lit reads one word past the last, too
  const LightGrid* const grid = job.grids != nullptr ? job.grids->of(static_cast<size_t>(light)) : nullptr;
  if (rays > 0 && grid != nullptr) trace_to_light(job.frame, *job.opaque, *grid, w.shadow_rays, w.occluded.data());
  else if (rays > 0) trace_any(job.frame, *job.opaque, w.shadow_rays, w.occluded.data());
  w.counts.rays_shadow += static_cast<uint64_t>(rays);
  mark_lit(w.surface_of_ray.data(), w.occluded.data(), rays, lit);
  w.clock.enter(stage);
}

}  // namespace

// Most rays belong to neighbours: runs of bits.
void mark_lit(const uint32_t* surface_of_ray, const uint32_t* occluded, int rays, uint32_t* lit) {
  for (int i = 0, run; i < rays; i += run) {
    const uint32_t first = surface_of_ray[i];
    const auto is_run = [&](int n) { return i + n <= rays && surface_of_ray[i + n - 1] - first == static_cast<uint32_t>(n) - 1; };
    run = is_run(32) ? 32 : is_run(8) ? 8 : 1;
    const uint64_t seen = ~word_at(occluded, i) & ~uint32_t{0} >> (32 - run), at = seen << (first % 32);
    lit[first / 32] |= static_cast<uint32_t>(at), lit[first / 32 + 1] |= static_cast<uint32_t>(at >> 32);
  }
}

void light_surfaces_by(const Frame& frame, TileWorker& w, const SurfaceBatch& surfaces, const HitBatch& hits, const FindLitFn& find_lit) {
  float* radiance[3];
  for (int c = 0; c < 3; ++c) {
    w.radiance[c].resize(static_cast<size_t>(surfaces.count) + 64);  // whole vectors are written
    radiance[c] = w.radiance[c].data();
  }
  if (surfaces.count == 0) return;
  LightRange lights{0, static_cast<int>(frame.scene->lights.size())};
  if (frame.plan.shadow_rays) {
    lights.words = (static_cast<size_t>(surfaces.count) + 31) / 32 + 1;  // kernels may read one word past the last
    w.lit.assign(lights.words * static_cast<size_t>(lights.count), 0);
    lights.lit = w.lit.data();
    for (int k = 0; k < lights.count; ++k) find_lit(k, w.lit.data() + static_cast<size_t>(k) * lights.words);
  }
  shade_lights(frame, surfaces, hits, lights, radiance);
}

void light_surfaces(const FrameJob& job, TileWorker& w, SurfaceBatch& surfaces, const HitBatch& hits) {
  const TileStage stage = w.clock.enter(TileStage::kShade);
  if (job.frame.plan.lifted_rays && job.frame.plan.shadow_rays) {
    const TileStage shade = w.clock.enter(TileStage::kShadowRays);
    w.counts.rays_shadow += keep_free_lifts(job.frame, *job.opaque, surfaces, w.shadow_rays, w.surface_of_ray, w.occluded);
    w.clock.enter(shade);
  }
  light_surfaces_by(job.frame, w, surfaces, hits, [&](int light, uint32_t* lit) {
    find_lit(job, w, surfaces, light, lit);
    if (job.request.ladder != nullptr) mix_shadow_bits(job, surfaces, hits, lit, light);
  });
  w.clock.enter(stage);
}

}  // namespace spanray
