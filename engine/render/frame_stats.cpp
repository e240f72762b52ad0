#include "render/frame_stats.h"

#include "core/counted.h"

namespace spanray {

void resize_output(const Settings& s, const FrameRequest& request, Framebuffer& out) {
  const size_t pixels = static_cast<size_t>(s.width) * static_cast<size_t>(s.height);
  out.color.width = s.width;
  out.color.height = s.height;
  out.color.rgba.resize(4 * pixels);
  out.radiance.resize(request.radiance ? 3 * pixels : 0);
  out.depth.resize(request.depth ? pixels : 0);
  out.primitive.resize(request.primitive ? pixels : 0);
  out.normal.resize(request.normal ? 3 * pixels : 0);
  out.uv.resize(request.uv ? 2 * pixels : 0);
}

void add_worker_stats(const std::vector<std::unique_ptr<TileWorker>>& workers, int threads, FrameCounts& counts, FrameStats& stats) {
  double* const ms[kTileStageCount] = {&stats.ms.raster,      &stats.ms.shade,     &stats.ms.shadow_rays,
                                       &stats.ms.bounce_rays, &stats.ms.composite, &stats.ms.encode};
  for (const auto& w : workers) {
    for (size_t i = 0; i < kTileStageCount; ++i) *ms[i] += w->clock.seconds(i) * 1e3 / threads;
    counts.add(w->counts);
  }
}

void add_counts(const FrameCounts& c, FrameStats& stats) {
  stats.counts = {{"triangles_in", c.triangles_in},
                  {"triangles_invalid", c.triangles_invalid},
                  {"triangles_clipped", c.triangles_clipped},
                  {"triangles_culled", c.triangles_culled()},
                  {"triangles_outside", c.triangles_outside},
                  {"triangles_back_face", c.triangles_back_face},
                  {"triangles_hidden", c.triangles_hidden},
                  {"triangles_empty", c.triangles_empty},
                  {"triangles_drawn", c.triangles_drawn},
                  {"tile_triangles", c.tile_triangles},
                  {"tile_triangles_hidden", c.tile_triangles_hidden},
                  {"samples_passed", c.samples_passed},
                  {"pixels_covered", c.pixels_covered},
                  {"surfaces_shaded", c.surfaces_shaded},
                  {"quads_shaded", c.quads_shaded},
                  {"fragments_translucent", c.fragments_translucent},
                  {"rays_primary", c.rays_primary},
                  {"rays_shadow", c.rays_shadow},
                  {"rays_bounce", c.rays_bounce},
                  {"rays_translucent", c.rays_translucent},
                  {"vertices_lit", c.vertices_lit},
                  {"bvh_refits", c.bvh_refits},
                  {"bvh_rebuilds", c.bvh_rebuilds}};
  stats.lanes = {{"raster_walkers", c.walker_lanes.computed, c.walker_lanes.used},
                 {"raster_packets", c.packet_lanes.computed, c.packet_lanes.used},
                 {"planes", c.plane_lanes.computed, c.plane_lanes.used},
                 {"surfaces", c.surface_lanes.computed, c.surface_lanes.used}};
  if (c.triangles_invalid > 0)
    stats.warnings.push_back(counted(c.triangles_invalid, "triangle was", "triangles were") + " dropped: the projection is not finite");
}

}  // namespace spanray
