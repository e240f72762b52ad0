// Whole frames of the shipped scenes, 1280x720, all processors, as the scene files ask for them. The stage times of FrameStats
// (mean milliseconds a frame) and the triangles stand beside as counters.
#include <benchmark/benchmark.h>

#include <map>
#include <memory>

#include "frozen_frame.h"
#include "spanray/render.h"

namespace spanray::bench {
namespace {

void frame(benchmark::State& state, const char* name) {
  static std::map<std::string, Scene> scenes;
  if (scenes.count(name) == 0) scenes[name] = load_shipped(name);
  const Scene& scene = scenes[name];
  Settings settings = scene.settings();
  settings.width = 1280, settings.height = 720;
  Renderer renderer;
  Framebuffer picture;
  const auto render = [&] { return renderer.render(scene, scene.cameras()[0], settings, picture); };
  const auto first = render();  // builds the trees and grows the buffers
  if (!first) {
    state.SkipWithError(first.error().to_string().c_str());
    return;
  }
  StageTimes sum;
  for (auto _ : state) {
    const auto stats = render();
    const StageTimes& t = stats.value().ms;
    sum.transform += t.transform, sum.clip += t.clip, sum.bin += t.bin, sum.raster += t.raster, sum.shade += t.shade;
    sum.shadow_rays += t.shadow_rays, sum.bounce_rays += t.bounce_rays, sum.composite += t.composite, sum.encode += t.encode;
  }
  const auto mean = [](double total) { return benchmark::Counter(total, benchmark::Counter::kAvgIterations); };
  state.counters["transform_ms"] = mean(sum.transform);
  state.counters["clip_ms"] = mean(sum.clip);
  state.counters["bin_ms"] = mean(sum.bin);
  state.counters["raster_ms"] = mean(sum.raster);
  state.counters["shade_ms"] = mean(sum.shade);
  state.counters["shadow_rays_ms"] = mean(sum.shadow_rays);
  state.counters["bounce_rays_ms"] = mean(sum.bounce_rays);
  state.counters["composite_ms"] = mean(sum.composite);
  state.counters["encode_ms"] = mean(sum.encode);
  state.counters["bvh_build_ms"] = first.value().ms.bvh_build;
  state.counters["triangles"] = static_cast<double>(scene.triangle_count());
}
BENCHMARK_CAPTURE(frame, cornell, "cornell")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(frame, spheres, "spheres")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(frame, columns, "columns")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(frame, gauze, "gauze")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(frame, glass, "glass")->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace spanray::bench
