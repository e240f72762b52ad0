#include "render/trace_pixel.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "core/fp_env.h"
#include "image/encode.h"
#include "raster/raster.h"
#include "ray/bvh.h"
#include "render/check_request.h"
#include "render/make_frame.h"
#include "render/tile.h"
#include "render/tile_exact.h"
#include "render/trace_surface.h"
#include "scene/pose.h"
#include "shade/light.h"
#include "shade/surface.h"

namespace spanray {
namespace {

// Everything that the frame of one pixel needs: the beginning of Renderer::render, for one picture.
class Tracer {
 public:
  Tracer(const Scene& scene, const Camera& camera, const Settings& settings, int x, int y);
  PixelTrace run();

 private:
  // What one surface of the pixel starts from. layers: translucent, if they are known already.
  struct Slot {
    uint32_t pixel = 0;  // that is shaded: of a quad the upper left one
    int place = 0;
    float weight = 1;
    uint32_t primitive = kNoPrimitive;
    FragmentList layers;
    bool layers_known = false;
  };
  std::vector<Slot> find_slots();
  std::optional<Slot> find_quad(uint32_t& seen);
  SlotTrace trace_slot(const Slot& slot);
  uint32_t raster_hit(int place, FragmentList& fragments, float& depth);
  uint32_t ray_hit(int place) const;
  uint32_t pixel() const { return pack_pixel(static_cast<uint32_t>(x_), static_cast<uint32_t>(y_)); }
  int tile() const { return y_ / kTileSize * frame_.grid.columns + x_ / kTileSize; }
  void make_primary_ray(uint32_t pixel, int place, RayBatch& rays) const;
  void make_hits(HitBatch& hits, const RayBatch* rays, uint32_t primitive, const Slot& slot) const;
  SurfaceTrace shade(const HitBatch& hits, SurfaceBatch& surfaces) const {
    return trace_surface(frame_, opaque_, hits, surfaces);
  }
  void add_layers(LevelTrace& level, RayBatch& rays, const Slot& start, bool primary);
  bool bounce(const HitBatch& hits, const SurfaceBatch& surfaces, RayBatch& next, LevelTrace& level) const;

  int x_, y_;
  Parallel parallel_;
  Plan plan_;
  Frame frame_;
  Bvh opaque_, translucent_;
  TileBins bins_;
  ExactBins exact_;
};

Tracer::Tracer(const Scene& scene, const Camera& camera, const Settings& settings, int x, int y)
    : x_(x), y_(y), parallel_(settings.threads), plan_(make_plan(scene.data(), find_scene_use(scene.data()), settings)),
      frame_(make_frame(scene.data(), camera, settings, plan_, parallel_)) {
  // Both engines are asked, whatever the plan says; where the plan has no use for a tree, its answer is only shown.
  opaque_ = build_bvh(scene.data(), frame_.material_flags, kMaterialTranslucent, 0, parallel_);
  translucent_ = build_bvh(scene.data(), frame_.material_flags, kMaterialTranslucent, kMaterialTranslucent, parallel_);
  ScreenVertices vertices;
  FrameCounts counts;
  transform_vertices(frame_, vertices);
  clip_triangles(frame_, vertices, bins_, counts);
  bin_triangles(frame_, bins_);
  bin_exact(frame_, exact_);
}

uint32_t Tracer::raster_hit(int place, FragmentList& fragments, float& depth) {
  const auto visible = std::make_unique<TileHits>();
  parallel_.for_each(1, [&](size_t, int) {
    rasterize_tile(frame_, bins_, tile(), *visible, place);
    rasterize_exact(frame_, exact_, tile(), place, *visible);
    FragmentList all;
    if (frame_.plan.translucents) rasterize_translucent(frame_, bins_, tile(), *visible, all, place);
    for (size_t i = 0; i < all.pixel.size(); ++i) {
      if (all.pixel[i] != pixel()) continue;
      fragments.pixel.push_back(all.pixel[i]), fragments.ray.push_back(0), fragments.primitive.push_back(all.primitive[i]);
    }
  });
  const int i = y_ % kTileSize * kTileSize + x_ % kTileSize;
  depth = visible->depth[i];
  return visible->primitive[i];
}

void Tracer::make_primary_ray(uint32_t pixel, int place, RayBatch& rays) const {
  make_primary_batch(frame_, &pixel, 1, place, rays);
}

uint32_t Tracer::ray_hit(int place) const {
  RayBatch rays;
  make_primary_ray(pixel(), place, rays);
  AlignedBuffer<uint32_t> primitive;
  primitive.assign(kLanePadding, kNoPrimitive);
  trace_closest(frame_, opaque_, rays, primitive.data());
  float depth = kUnknownDepth;
  draw_exact(frame_, exact_, tile(), place, {{x_, y_, x_ + 1, y_ + 1}, 1, primitive.data(), &depth});
  return primitive[0];
}

void Tracer::make_hits(HitBatch& hits, const RayBatch* rays, uint32_t primitive, const Slot& slot) const {
  hits.resize(primitive == kNoPrimitive ? 0 : 1, true);
  hits.rays = rays;
  if (hits.count == 0) return;
  hits.pixel[0] = slot.pixel;
  hits.ray[0] = 0;
  hits.primitive[0] = primitive;
  if (rays == nullptr && slot.place != 0) hits.place.assign(1, static_cast<uint32_t>(slot.place));
}

void Tracer::add_layers(LevelTrace& level, RayBatch& rays, const Slot& start, bool primary) {
  const float opaque_t = level.surface.valid ? level.surface.t : std::numeric_limits<float>::infinity();
  FragmentList traced;
  const bool known = primary && start.layers_known;
  if (!known) {
    const float near_t = primary ? static_cast<float>(frame_.primary.near_plane) : 0.0f;
    rays.t_max[0] = (opaque_t - near_t) * 1.00001f;  // as in render/tile.cpp
    trace_all(frame_, translucent_, rays, HitsOnEdges::kOfOne, traced);
  }
  const FragmentList& list = known ? start.layers : traced;
  for (size_t i = 0; i < list.primitive.size(); ++i) {
    HitBatch hits;
    SurfaceBatch surfaces;
    make_hits(hits, primary ? nullptr : &rays, list.primitive[i], start);
    level.layers.push_back(shade(hits, surfaces));
  }
  // Shown in the order of blending; blended by the renderer's own function.
  std::sort(level.layers.begin(), level.layers.end(), [](const SurfaceTrace& a, const SurfaceTrace& b) {
    return a.t != b.t ? a.t > b.t : a.primitive > b.primitive;
  });
  const int n = static_cast<int>(level.layers.size());
  SurfaceBatch batch;
  batch.resize(n);
  AlignedBuffer<int32_t> slot;
  slot.assign(static_cast<size_t>(n) + kLanePadding, 0);
  AlignedBuffer<float> layer_radiance[3];
  for (auto& channel : layer_radiance) channel.assign(static_cast<size_t>(n) + kLanePadding, 0.0f);
  for (int i = 0; i < n; ++i) {
    const SurfaceTrace& layer = level.layers[static_cast<size_t>(i)];
    batch.t[i] = layer.t, batch.opacity[i] = layer.opacity, batch.primitive[i] = layer.primitive, batch.valid[i] = layer.valid;
    for (int c = 0; c < 3; ++c) layer_radiance[c][static_cast<size_t>(i)] = layer.radiance[c];
  }
  Radiance out;
  for (int c = 0; c < 3; ++c) out.channel[c][0] = level.radiance[c];
  const float* from[3] = {layer_radiance[0].data(), layer_radiance[1].data(), layer_radiance[2].data()};
  if (n > 0) composite(batch, slot.data(), from, &opaque_t, 1, out.pointer, &level.transmittance);
  out.get(level.radiance);
}

// The mirror ray of a surface, if it has one.
bool Tracer::bounce(const HitBatch& hits, const SurfaceBatch& surfaces, RayBatch& next, LevelTrace& level) const {
  if (hits.count == 0) return false;
  AlignedBuffer<uint32_t> surface_of_ray;
  make_bounce_rays(frame_, surfaces, hits, next, surface_of_ray);
  if (next.count == 0) return false;
  for (int k = 0; k < 3; ++k) level.origin[k] = next.origin[k][0], level.direction[k] = next.direction[k][0];
  return true;
}

// The pixel's quad, if it is shaded in one. seen: the pixel's own primitive.
std::optional<Tracer::Slot> Tracer::find_quad(uint32_t& seen) {
  const int x0 = x_ & ~1, y0 = y_ & ~1;
  if (!frame_.plan.coarse_quads || x0 + 1 >= frame_.grid.width || y0 + 1 >= frame_.grid.height) return std::nullopt;
  Framebuffer out;
  const FrameRequest request;
  const FrameJob job{frame_, frame_.plan.raster ? &bins_ : nullptr, &opaque_, &translucent_, out, request, &exact_};
  const auto worker = std::make_unique<TileWorker>();
  Level level;
  parallel_.for_each(1, [&](size_t, int) {
    see_tile(job, tile(), *worker);
    start_chunk(job, Chunk{tile(), x0, 2, y0, y0 + 2}, *worker, level);
  });
  if (level.quads.empty()) return std::nullopt;
  const Quad& quad = level.quads[0];
  seen = quad.primitive[2 * (y_ - y0) + x_ - x0];
  Slot slot;
  slot.pixel = level.pixel[quad.slot[0]], slot.place = kQuadPlace, slot.primitive = level.primitive[quad.slot[0]];
  slot.layers_known = true;
  return slot;
}

std::vector<Tracer::Slot> Tracer::find_slots() {
  const bool by_ray = frame_.settings.visibility == Visibility::kRay;
  std::vector<Slot> slots;
  if (frame_.places.count == 1) {
    Slot& slot = slots.emplace_back();
    slot.pixel = pixel();
    float depth;
    const uint32_t rasterized = raster_hit(0, slot.layers, depth);
    slot.primitive = by_ray ? ray_hit(0) : rasterized;
    slot.layers_known = !by_ray;
    return slots;
  }
  Framebuffer out;
  const FrameRequest request;
  const FrameJob job{frame_, by_ray ? nullptr : &bins_, &opaque_, &translucent_, out, request, &exact_};
  TileWorker worker;
  Level level;
  parallel_.for_each(1, [&](size_t, int) {
    rasterize_samples(job, tile(), worker);
    level.pixel.assign(1, pixel());
    find_sample_slots(job, Chunk{tile(), x_, 1, y_, y_ + 1}, worker, level);
  });
  for (size_t i = 0; i < static_cast<size_t>(level.slots); ++i) {
    Slot& slot = slots.emplace_back();
    slot.pixel = pixel();
    slot.place = static_cast<int>(level.place[i]);
    slot.weight = level.weight[0][i];
    slot.primitive = level.primitive[i];
    slot.layers_known = true;
    for (size_t k = 0; k < worker.fragment_slot.size(); ++k)
      if (worker.fragment_slot[k] == static_cast<int32_t>(i)) slot.layers.primitive.push_back(worker.chunk_fragments.primitive[k]);
  }
  return slots;
}

SlotTrace Tracer::trace_slot(const Slot& slot) {
  SlotTrace trace;
  const PrimaryRays& p = frame_.primary;
  trace.weight = slot.weight;
  trace.quad = slot.place == kQuadPlace;
  trace.position = {(slot.pixel & 0xffff) + frame_.places.x[slot.place], (slot.pixel >> 16) + frame_.places.y[slot.place]};
  trace.direction = p.corner + p.step_x * trace.position.x + p.step_y * trace.position.y;
  FragmentList unused;
  const int place = trace.quad ? 0 : slot.place;
  trace.raster_primitive = raster_hit(place, unused, trace.raster_depth);
  trace.ray_primitive = ray_hit(place);
  trace.primitive = slot.primitive;

  std::vector<std::unique_ptr<RayBatch>> rays;
  rays.push_back(std::make_unique<RayBatch>());
  make_primary_ray(slot.pixel, slot.place, *rays[0]);
  uint32_t primitive = slot.primitive;
  for (size_t k = 0;; ++k) {
    const bool primary = k == 0;
    if (primary) trace.levels.emplace_back();
    HitBatch hits;
    SurfaceBatch surfaces;
    make_hits(hits, primary ? nullptr : rays[k].get(), primitive, slot);
    LevelTrace& level = trace.levels[k];
    level.surface = shade(hits, surfaces);
    for (int c = 0; c < 3; ++c)
      level.radiance[c] = hits.count > 0 ? level.surface.radiance[c] : frame_.scene->background[c];
    if (frame_.plan.translucents) add_layers(level, *rays[k], slot, primary);
    std::copy_n(level.radiance, 3, level.layers_over);
    if (!frame_.plan.bounces || k == static_cast<size_t>(frame_.settings.max_bounces)) break;
    rays.push_back(std::make_unique<RayBatch>());
    LevelTrace next;
    if (!bounce(hits, surfaces, *rays[k + 1], next)) break;
    for (int c = 0; c < 3; ++c) next.weight[c] = surfaces.mirror[c][0] * (frame_.plan.translucents ? level.transmittance : 1.0f);
    AlignedBuffer<uint32_t> found;
    found.assign(kLanePadding, kNoPrimitive);
    trace_closest(frame_, opaque_, *rays[k + 1], found.data());
    primitive = found[0];
    trace.levels.push_back(next);
  }
  for (size_t k = trace.levels.size() - 1; k > 0; --k)
    for (int c = 0; c < 3; ++c) trace.levels[k - 1].radiance[c] += trace.levels[k].weight[c] * trace.levels[k].radiance[c];
  return trace;
}

PixelTrace Tracer::run() {
  PixelTrace trace;
  trace.eye = frame_.primary.eye;
  trace.by_ray = frame_.settings.visibility == Visibility::kRay;
  trace.samples = frame_.places.count;
  if (const std::optional<Slot> quad = find_quad(trace.primitive)) {
    trace.slots.push_back(trace_slot(*quad));
  } else {
    for (const Slot& slot : find_slots()) trace.slots.push_back(trace_slot(slot));
    trace.primitive = trace.slots[0].primitive;
  }
  Radiance out;
  for (int c = 0; c < 3; ++c) {
    float sum = trace.samples == 1 ? trace.slots[0].levels[0].radiance[c] : 0.0f;
    if (trace.samples > 1)
      for (const SlotTrace& slot : trace.slots) sum += slot.weight * slot.levels[0].radiance[c];
    trace.radiance[c] = out.channel[c][0] = sum;
  }
  const float* radiance[3] = {out.pointer[0], out.pointer[1], out.pointer[2]};
  encode_row(frame_.isa, radiance, 1, trace.rgba);
  return trace;
}

}  // namespace

Result<PixelTrace> trace_pixel(const Scene& scene, const Camera& camera, const Settings& settings, int x, int y) {
  if (Result<void> checked = check_request(scene, camera, settings); !checked) return checked.error();
  if (x < 0 || y < 0 || x >= settings.width || y >= settings.height)
    return Error{"pixel " + std::to_string(x) + "," + std::to_string(y) + " lies outside the picture of " +
                 std::to_string(settings.width) + "x" + std::to_string(settings.height)};
  const FpEnvGuard guard;
  const Scene standing = scene_at(scene, settings.time);
  return Tracer(standing, camera, settings, x, y).run();
}

}  // namespace spanray
