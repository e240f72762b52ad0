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

// One bit a surface: set where the light is seen. Surfaces that the light cannot reach get no ray and no bit.
const uint32_t* find_lit(const FrameJob& job, TileWorker& w, const SurfaceBatch& surfaces, int light) {
  const TileStage stage = w.clock.enter(TileStage::kShadowRays);
  w.shadow_rays.count = 0;
  w.surface_of_ray.clear();
  make_shadow_rays(job.frame, surfaces, light, w.shadow_rays, w.surface_of_ray);
  const int rays = w.shadow_rays.count;
  w.occluded.assign((static_cast<size_t>(rays) + 31) / 32 + 1, 0);  // mark_lit reads one word past the last, too
  w.lit.assign((static_cast<size_t>(surfaces.count) + 31) / 32 + 1, 0);  // kernels may read one word past the last
  if (rays > 0) trace_any(job.frame, *job.opaque, w.shadow_rays, w.occluded.data());
  w.counts.rays_shadow += static_cast<uint64_t>(rays);
  mark_lit(w.surface_of_ray.data(), w.occluded.data(), rays, w.lit.data());
  w.clock.enter(stage);
  return w.lit.data();
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

void light_surfaces(const FrameJob& job, TileWorker& w, SurfaceBatch& surfaces, const HitBatch& hits) {
  const TileStage stage = w.clock.enter(TileStage::kShade);
  if (job.frame.plan.lifted_rays && job.frame.plan.shadow_rays) {
    const TileStage shade = w.clock.enter(TileStage::kShadowRays);
    w.counts.rays_shadow += keep_free_lifts(job.frame, *job.opaque, surfaces, w.shadow_rays, w.surface_of_ray, w.occluded);
    w.clock.enter(shade);
  }
  float* radiance[3];
  for (int c = 0; c < 3; ++c) {
    w.radiance[c].resize(static_cast<size_t>(surfaces.count) + 64);  // whole vectors are written
    radiance[c] = w.radiance[c].data();
  }
  shade_ambient(job.frame, surfaces, radiance);
  for (int light = 0; surfaces.count > 0 && light < static_cast<int>(job.frame.scene->lights.size()); ++light) {
    const uint32_t* lit = job.frame.plan.shadow_rays ? find_lit(job, w, surfaces, light) : nullptr;
    if (job.request.ladder != nullptr && lit != nullptr) mix_shadow_bits(job, surfaces, hits, lit, light);
    shade_light(job.frame, surfaces, hits, light, lit, radiance);
  }
  w.clock.enter(stage);
}

}  // namespace spanray
