// The ten-minute walk: everything that happens to a frame, in order. The loop inside a tile is in render/tile.cpp.
#include <chrono>
#include <cmath>
#include <exception>
#include <new>

#include "core/fp_env.h"
#include "frame/ladder.h"
#include "raster/raster.h"
#include "render/check_request.h"
#include "render/frame_stats.h"
#include "render/make_frame.h"
#include "render/plan.h"
#include "render/tile.h"

namespace spanray {
namespace {

double seconds_now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// Milliseconds that a call takes.
template <class F> double timed_ms(F&& call) {
  const double start = seconds_now();
  call();
  return (seconds_now() - start) * 1e3;
}

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

// What lives from frame to frame: threads, buffers, trees, lit vertices. Trees are rebuilt when the scene or the meaning of its
// materials changes.
struct Renderer::Impl {
  std::unique_ptr<Parallel> parallel;
  Scene scene;  // keeps alive what the trees and `use` were made from
  SceneUse use;
  std::vector<uint32_t> tree_flags;
  std::unique_ptr<Bvh> opaque, translucent;
  std::unique_ptr<LitVertexCache> lit_vertices;
  double bvh_build_ms = 0;
  ScreenVertices vertices;
  TileBins bins;
  std::vector<std::unique_ptr<TileWorker>> workers;

  void adopt(const Scene& new_scene, int threads) {
    if (!parallel || (threads > 0 ? parallel->threads() != threads : parallel->threads() != Parallel::available()))
      parallel = std::make_unique<Parallel>(threads);
    while (workers.size() < static_cast<size_t>(parallel->threads())) workers.push_back(std::make_unique<TileWorker>());
    if (scene.valid() && &scene.data() == &new_scene.data()) return;
    opaque.reset(), translucent.reset(), lit_vertices.reset();
    bvh_build_ms = 0;
    use = find_scene_use(new_scene.data());
    scene = new_scene;
  }

  // Builds the trees that the plan asks for and that are not there yet.
  void build_trees(const Plan& plan) {
    if (tree_flags != plan.material_flags) {
      opaque.reset(), translucent.reset();
      bvh_build_ms = 0;
      tree_flags = plan.material_flags;
    }
    const auto build = [&](bool needed, uint32_t value, std::unique_ptr<Bvh>& tree) {
      if (!needed || tree) return;
      bvh_build_ms += timed_ms([&] {
        tree = std::make_unique<Bvh>(build_bvh(scene.data(), tree_flags.data(), kMaterialTranslucent, value, *parallel));
      });
    };
    build(plan.flags.bvh, 0, opaque);
    build(plan.flags.translucent_bvh, kMaterialTranslucent, translucent);
  }

  size_t memory_bytes() const {
    size_t bytes = vertices.memory_bytes() + bins.memory_bytes();
    if (opaque) bytes += opaque->memory_bytes();
    if (translucent) bytes += translucent->memory_bytes();
    if (lit_vertices) bytes += lit_vertices->memory_bytes();
    for (const auto& w : workers) bytes += w->memory_bytes();
    return bytes;
  }

  FrameStats render(const Camera& camera, const Settings& settings, Framebuffer& out, const FrameRequest& request);
};

FrameStats Renderer::Impl::render(const Camera& camera, const Settings& settings, Framebuffer& out, const FrameRequest& request) {
  FrameStats stats;
  const double start = seconds_now();
  const Plan plan = make_plan(scene.data(), use, settings);
  const double build_ms = timed_ms([&] { build_trees(plan); });

  const Frame frame = make_frame(scene.data(), camera, settings, plan, *parallel);
  resize_output(settings, request, out);
  if (request.ladder != nullptr) {
    request.ladder->begin(settings.width, settings.height);
    request.ladder->set(Rung::kScene, scene.hash());
  }

  FrameCounts counts;
  if (plan.flags.raster) {
    stats.ms.transform = timed_ms([&] { transform_vertices(frame, vertices); });
    if (request.ladder != nullptr) hash_vertices(vertices, *request.ladder);
    stats.ms.clip = timed_ms([&] { clip_triangles(frame, vertices, bins, counts); });
    stats.ms.bin = timed_ms([&] { bin_triangles(frame, bins); });
  } else {
    counts.triangles_in = scene.data().triangles.size();
  }
  if (!plan.flags.lit_vertices) lit_vertices.reset();
  else if (!lit_vertices) lit_vertices = std::make_unique<LitVertexCache>(scene.data().vertices.size(), scene.data().lights.size());
  else lit_vertices->reset();

  for (const auto& w : workers) w->counts = {}, w->clock.reset();
  const FrameJob job{frame, plan.flags.raster ? &bins : nullptr, opaque.get(), translucent.get(), lit_vertices.get(), out, request};
  parallel->for_each(static_cast<size_t>(frame.grid.count()), [&](size_t tile, int worker) {
    render_tile(job, static_cast<int>(tile), *workers[static_cast<size_t>(worker)]);
  });

  stats.ms.bvh_build = bvh_build_ms;
  stats.ms.frame = (seconds_now() - start) * 1e3 - build_ms;  // a tree is built once a scene, and stands in bvh_build
  add_worker_stats(workers, parallel->threads(), counts, stats);
  if (lit_vertices) counts.vertices_lit = lit_vertices->lit_count();
  add_counts(counts, stats);
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
