#include "embree_frame.h"

#include <algorithm>
#include <limits>

#include "measure.h"
#include "ray_agreement.h"
#include "render/frame_stats.h"
#include "render/make_frame.h"
#include "render/tile_hits.h"
#include "render/tile_light.h"
#include "render/tile_output.h"

namespace spanray::peers {
namespace {

// The clock of tiles, read our way: Embree has no rasterizer and composites nothing.
constexpr TileStage kPrimary = TileStage::kRaster, kMaking = TileStage::kComposite;

}  // namespace

struct EmbreeFrame::Worker {
  TileWorker tile;
  AlignedBuffer<float> t;          // of Embree's hits
  AlignedBuffer<uint32_t> judged;  // our answers
  EmbreeFrameErrors errors;
  double making_primary = 0;  // seconds

  Worker() {
    for (int k = 0; k < 2; ++k) tile.levels.push_back(std::make_unique<Level>());
  }
  void reset() {
    tile.counts = {}, tile.clock.reset();
    errors = {}, making_primary = 0;
  }
  uint32_t* room_to_judge(size_t n) {
    judged.resize(n);
    return judged.data();
  }
};

EmbreeFrame::EmbreeFrame(const Scene& scene, const Camera& camera, const Settings& settings, Parallel& parallel)
    : plan_(make_plan(scene.data(), find_scene_use(scene.data()), settings)), parallel_(parallel) {
  frame_ = make_frame(scene.data(), camera, settings, plan_, parallel);
  bvh_ = build_bvh(scene.data(), plan_.material_flags.data(), 0, 0, parallel, settings.tree);
  for (int i = 0; i < parallel.threads(); ++i) workers_.push_back(std::make_unique<Worker>());
}

EmbreeFrame::~EmbreeFrame() = default;

// As render/tile_light.cpp has it.
void EmbreeFrame::find_lit(const Asked& asked, const SurfaceBatch& surfaces, int light, Worker& w, uint32_t* lit) const {
  TileWorker& tile = w.tile;
  tile.clock.enter(kMaking);
  RayBatch& rays = tile.shadow_rays;
  rays.count = 0;
  tile.surface_of_ray.clear();
  make_shadow_rays(frame_, surfaces, light, rays, tile.surface_of_ray);
  const size_t words = static_cast<size_t>(rays.count) / 32 + 2;
  tile.occluded.resize(words);
  tile.clock.enter(TileStage::kShadowRays);
  asked.tracer.any(asked.modes.shadow, rays, tile.occluded.data());
  tile.clock.enter(kMaking);
  tile.counts.rays_shadow += static_cast<uint64_t>(rays.count);
  if (asked.judged) {
    uint32_t* const ours = w.room_to_judge(words);
    trace_any(frame_, bvh_, rays, ours);
    w.errors.shadow += different_bits(rays.count, ours, tile.occluded.data());
  }
  mark_lit(tile.surface_of_ray.data(), tile.occluded.data(), rays.count, lit);
  tile.clock.enter(TileStage::kShade);
}

// What a level's hits send to the eye goes to their slots, the background to all others.
void EmbreeFrame::shade_level(const Asked& asked, const FrameJob& job, Worker& w, Level& level, bool primary) const {
  TileWorker& tile = w.tile;
  tile.clock.enter(TileStage::kShade);
  compact_hits(frame_, level, primary);
  resolve_surfaces(frame_, level.hits, level.surfaces);
  light_surfaces_by(frame_, tile, level.surfaces, level.hits, [&](int light, uint32_t* lit) { find_lit(asked, level.surfaces, light, w, lit); });
  if (!job.keeps_radiance_of_hits()) scatter_hits(frame_, tile, level);
}

// Mirror rays and what they hit. Returns false if there is none.
bool EmbreeFrame::start_bounce(const Asked& asked, const Level& level, Level& next, Worker& w) const {
  TileWorker& tile = w.tile;
  tile.clock.enter(kMaking);
  next.rays.count = 0;
  tile.surface_of_ray.clear();
  make_bounce_rays(frame_, level.surfaces, level.hits, next.rays, tile.surface_of_ray);
  const int n = next.rays.count;
  if (n == 0) return false;
  next.resize(n, false);
  for (int i = 0; i < n; ++i) {
    const uint32_t surface = tile.surface_of_ray[i];
    next.pixel[i] = next.rays.pixel[i], next.parent[i] = level.slot_of_hit[surface];
    for (int c = 0; c < 3; ++c) next.weight[c][i] = level.surfaces.mirror[c][surface];
  }
  w.t.resize(static_cast<size_t>(n));
  tile.clock.enter(TileStage::kBounceRays);
  asked.tracer.closest(asked.modes.bounce, next.rays, next.primitive.data(), w.t.data());
  tile.clock.enter(kMaking);
  tile.counts.rays_bounce += static_cast<uint64_t>(n);
  if (asked.judged) {
    uint32_t* const ours = w.room_to_judge(static_cast<size_t>(n));
    trace_closest(frame_, bvh_, next.rays, ours);
    w.errors.bounce += different_hits(*frame_.scene, next.rays, ours, next.primitive.data(), w.t.data());
  }
  return true;
}

void EmbreeFrame::trace_primary(const Asked& asked, Worker& w) const {
  TileWorker& tile = w.tile;
  Level& level = *tile.levels[0];
  tile.clock.enter(kMaking);
  const double before = wall_ms();
  make_primary_batch(frame_, level.pixel.data(), level.slots, 0, level.rays);
  w.making_primary += (wall_ms() - before) * 1e-3;
  w.t.resize(static_cast<size_t>(level.slots));
  tile.clock.enter(kPrimary);
  asked.tracer.closest(asked.modes.primary, level.rays, level.primitive.data(), w.t.data());
  tile.clock.enter(kMaking);
  tile.counts.rays_primary += static_cast<uint64_t>(level.slots);
  if (!asked.judged) return;
  uint32_t* const ours = w.room_to_judge(static_cast<size_t>(level.slots));
  trace_closest(frame_, bvh_, level.rays, ours);
  w.errors.primary += different_hits(*frame_.scene, level.rays, ours, level.primitive.data(), w.t.data());
}

void EmbreeFrame::render_chunk(const Asked& asked, const FrameJob& job, const Chunk& chunk, Worker& w) const {
  TileWorker& tile = w.tile;
  Level &level = *tile.levels[0], &mirrored = *tile.levels[1];
  tile.clock.enter(kMaking);
  level.resize(chunk.pixels(), false);
  tile.pixel_order.make(chunk.columns, chunk.y1 - chunk.y0);
  tile.pixel_order.name_pixels(pack_pixel(static_cast<uint32_t>(chunk.x0), static_cast<uint32_t>(chunk.y0)), level.pixel.data());
  trace_primary(asked, w);
  shade_level(asked, job, w, level, true);
  if (frame_.plan.bounces && start_bounce(asked, level, mirrored, w)) {
    shade_level(asked, job, w, mirrored, false);
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i < mirrored.slots; ++i) level.radiance[c][mirrored.parent[i]] += mirrored.weight[c][i] * mirrored.radiance[c][i];
  }
  write_chunk(job, tile, level, chunk);
}

void EmbreeFrame::render_all(const Asked& asked, Framebuffer& out, const FrameRequest& request) {
  frame_.plan = plan_.flags;
  leave_out_unread(request, *frame_.scene, frame_.settings.shading, frame_.plan);  // as for our frame
  resize_output(frame_.settings, request, out);
  for (const auto& w : workers_) w->reset();
  const FrameJob job{frame_, nullptr, nullptr, nullptr, out, request};
  const TileGrid& grid = frame_.grid;
  parallel_.for_each(static_cast<size_t>(grid.count()), [&](size_t index, int worker) {
    const int tile = static_cast<int>(index);
    Worker& w = *workers_[static_cast<size_t>(worker)];
    for (int y0 = grid.y0(tile); y0 < grid.y1(tile); y0 += kChunkRows)
      render_chunk(asked, job, {tile, grid.x0(tile), grid.x1(tile) - grid.x0(tile), y0, std::min(y0 + kChunkRows, grid.y1(tile))}, w);
    w.tile.clock.stop();
  });
}

EmbreeFrameTimes EmbreeFrame::render(const EmbreeTracer& tracer, const EmbreeModes& modes, Framebuffer& out, const FrameRequest& request) {
  const Stopwatch watch;
  render_all({tracer, modes, false}, out, request);
  EmbreeFrameTimes times;
  times.frame = watch.wall();
  for (const auto& w : workers_) {
    const auto ms = [&](TileStage stage) { return w->tile.clock.seconds(static_cast<size_t>(stage)) * 1e3 / parallel_.threads(); };
    const double making_primary = w->making_primary * 1e3 / parallel_.threads();
    times.primary += ms(kPrimary), times.shadow += ms(TileStage::kShadowRays), times.bounce += ms(TileStage::kBounceRays);
    times.making_primary += making_primary, times.making_secondary += ms(kMaking) - making_primary;
    times.shade += ms(TileStage::kShade), times.encode += ms(TileStage::kEncode);
    times.rays_primary += w->tile.counts.rays_primary, times.rays_shadow += w->tile.counts.rays_shadow;
    times.rays_bounce += w->tile.counts.rays_bounce;
  }
  return times;
}

EmbreeFrameErrors EmbreeFrame::judge(const EmbreeTracer& tracer, const EmbreeModes& modes, Framebuffer& out, const FrameRequest& request) {
  render_all({tracer, modes, true}, out, request);
  EmbreeFrameErrors errors;
  for (const auto& w : workers_)
    errors.primary += w->errors.primary, errors.shadow += w->errors.shadow, errors.bounce += w->errors.bounce;
  return errors;
}

}  // namespace spanray::peers
