// The ten-minute walk: everything that happens to a frame, in order. The loop inside a tile is in render/tile.cpp.
#include <cmath>
#include <exception>
#include <new>

#include "core/fp_env.h"
#include "core/timed.h"
#include "frame/ladder.h"
#include "raster/raster.h"
#include "render/check_request.h"
#include "render/frame_stats.h"
#include "render/make_frame.h"
#include "render/plan.h"
#include "render/ray_trees.h"
#include "render/tile.h"
#include "scene/pose.h"

namespace spanray {
namespace {

void hash_vertices(const ScreenVertices& v, Ladder& ladder) {
  Hash hash;
  for (size_t i = 0; i < v.outcode.size(); ++i) {
    hash.add_word(v.outcode[i]);
    // Snapped positions exist only where nothing needs to be clipped.
    if ((v.outcode[i] & kOutClipMask) == 0)
      hash.add_word(static_cast<uint32_t>(v.x_24_8[i]) | static_cast<uint64_t>(static_cast<uint32_t>(v.y_24_8[i])) << 32);
  }
  ladder.set(Rung::kVertices, hash.value());
}

}  // namespace

// What lives from frame to frame: threads, buffers, trees, the scene as it stands now. Trees are rebuilt when the scene or
// the meaning of its materials changes.
struct Renderer::Impl {
  std::unique_ptr<Parallel> parallel;
  Scene scene;  // keeps alive what the trees and `use` were made from
  SceneUse use;
  std::unique_ptr<PosedScene> posed;  // only where something moves
  uint64_t poses = 0;
  RayTrees trees;
  std::unique_ptr<Clusters> clusters;  // of the scene at rest; none of a small one
  ClusterFates fates;
  ScreenVertices vertices;
  TileBins bins;
  ExactBins exact;
  std::vector<std::unique_ptr<TileWorker>> workers;

  void adopt(const Scene& new_scene, int threads) {
    if (!parallel || (threads > 0 ? parallel->threads() != threads : parallel->threads() != Parallel::available()))
      parallel = std::make_unique<Parallel>(threads);
    while (workers.size() < static_cast<size_t>(parallel->threads())) workers.push_back(std::make_unique<TileWorker>());
    if (scene.valid() && &scene.data() == &new_scene.data()) return;
    scene = Scene();  // nothing of it is left, should memory run out below
    trees.clear(), clusters.reset(), posed.reset();
    use = find_scene_use(new_scene.data());
    if (!new_scene.data().motions.empty()) posed = std::make_unique<PosedScene>(new_scene.data());
    scene = new_scene;
  }

  // The scene as this frame sees it.
  const SceneData& standing() const { return posed ? posed->data() : scene.data(); }

  size_t memory_bytes() const {
    size_t bytes = vertices.memory_bytes() + bins.memory_bytes() + exact.memory_bytes() + trees.memory_bytes();
    if (posed) bytes += posed->memory_bytes();
    if (clusters) bytes += clusters->memory_bytes() + fates.memory_bytes();
    for (const auto& w : workers) bytes += w->memory_bytes();
    return bytes;
  }

  // Which clusters this frame drops, or nullptr. They are made in the first frame that rasterizes a scene.
  const ClusterFates* find_fates(const Frame& frame) {
    if (!clusters && scene.data().triangles.size() > kFewTriangles)
      clusters = std::make_unique<Clusters>(make_clusters(scene.data(), scene.data().moving_triangles, frame.isa, *parallel));
    if (!clusters) return nullptr;
    find_cluster_fates(frame, *clusters, fates);
    return &fates;
  }

  FrameStats render(const Camera& camera, const Settings& settings, Framebuffer& out, const FrameRequest& request);
};

FrameStats Renderer::Impl::render(const Camera& camera, const Settings& settings, Framebuffer& out, const FrameRequest& request) {
  FrameStats stats;
  const double start = seconds_now();
  Plan plan = make_plan(scene.data(), use, settings);
  leave_out_unread(request, scene.data(), settings.shading, plan.flags);
  if (plan.flags.motion) stats.ms.pose = timed_ms([&] { poses += posed->pose(settings.time, *parallel); });
  const RayTrees::Work followed = trees.update(standing(), plan, settings, scene.data().moving_triangles, poses, *parallel);

  const Frame frame = make_frame(standing(), camera, settings, plan, *parallel);
  resize_output(settings, request, out);
  if (request.ladder != nullptr) {
    request.ladder->begin(settings.width, settings.height);
    request.ladder->set(Rung::kScene, scene.hash());
  }

  FrameCounts counts;
  if (plan.flags.raster) {
    const ClusterFates* dropped = nullptr;
    stats.ms.transform = timed_ms([&] {
      dropped = find_fates(frame);
      transform_vertices(frame, vertices, request.ladder == nullptr ? dropped : nullptr);  // the ladder hashes all of them
    });
    if (request.ladder != nullptr) hash_vertices(vertices, *request.ladder);
    stats.ms.clip = timed_ms([&] { clip_triangles(frame, vertices, bins, counts, dropped); });
    stats.ms.bin = timed_ms([&] { bin_triangles(frame, bins); });
  } else {
    counts.triangles_in = scene.data().triangles.size();
  }
  if (scene.data().has_exact()) stats.ms.bin += timed_ms([&] { bin_exact(frame, exact); });
  for (const auto& w : workers) w->counts = {}, w->clock.reset();
  const FrameJob job{frame, plan.flags.raster ? &bins : nullptr, trees.opaque(), trees.translucent(), out, request,
                     scene.data().has_exact() ? &exact : nullptr, trees.grids()};
  parallel->for_each(static_cast<size_t>(frame.grid.count()), [&](size_t tile, int worker) {
    render_tile(job, static_cast<int>(tile), *workers[static_cast<size_t>(worker)]);
  });

  stats.ms.bvh_refit = followed.refit_ms;
  stats.ms.bvh_build = trees.build_ms();
  stats.ms.light_grid_build = trees.grids_build_ms();
  stats.ms.frame = (seconds_now() - start) * 1e3 - followed.first_build_ms;  // of a scene once; it stands in bvh_build
  counts.bvh_refits = followed.refits, counts.bvh_rebuilds = followed.rebuilds;
  add_worker_stats(workers, parallel->threads(), counts, stats);
  add_counts(counts, stats);
  // Trees of frames before may be there, though this one asks none.
  const RayTrees::Makeup traced = plan.flags.bvh || plan.flags.translucent_bvh ? trees.makeup() : RayTrees::Makeup();
  stats.counts.emplace_back("bvh_levels", static_cast<uint64_t>(traced.levels));
  stats.counts.emplace_back("bvh_instances", traced.instances);
  stats.counts.emplace_back("bvh_bytes", traced.bytes);
  const LightGrids* const grids = plan.flags.light_grids ? trees.grids() : nullptr;
  stats.counts.emplace_back("light_grids", grids != nullptr ? grids->count() : 0);
  stats.counts.emplace_back("light_grid_bytes", grids != nullptr ? grids->memory_bytes() : 0);
  stats.memory_bytes = memory_bytes();
  stats.isa = isa_name(frame.isa);
  stats.threads = parallel->threads();
  return stats;
}

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}
Renderer::~Renderer() = default;

Result<FrameStats> Renderer::render(const Scene& scene, const Camera& camera, const Settings& settings, Framebuffer& out,
                                    const FrameRequest& request) {
  if (Result<void> checked = check_request(scene, camera, settings); !checked) return checked.error();
  const FpEnvGuard guard;
  try {
    impl_->adopt(scene, settings.threads);
    return impl_->render(camera, settings, out, request);
  } catch (const std::bad_alloc&) {
    return Error{"out of memory for a frame of " + std::to_string(settings.width) + "x" + std::to_string(settings.height) + " pixels"};
  } catch (const std::exception& e) {  // of the threads, above all: none to be had
    return Error{std::string("cannot render: ") + e.what()};
  }
}

std::vector<PlanLine> plan_frame(const Scene& scene, const Settings& settings) {
  return make_plan(scene.data(), find_scene_use(scene.data()), settings).lines;
}

}  // namespace spanray
