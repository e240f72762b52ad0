// What motion costs a frame: posing the vertices, and making the tree follow by a refit or by a build. Argument: threads.
#include "frozen_frame.h"
#include "ray/bvh_refit.h"
#include "scene/pose.h"

namespace spanray::bench {
namespace {

constexpr double kStep = 1.0 / 30;

struct Moving {
  explicit Moving(const char* name, int threads) : rest(load_shipped(name)), parallel(threads), posed(rest.data()), flags(rest.data().materials.size(), 0) {}
  const SceneData& next() {
    posed.pose(time += kStep, parallel);
    return posed.data();
  }
  Bvh build(const SceneData& scene) { return build_bvh(scene, flags.data(), 0, 0, parallel); }
  int64_t moving_triangles() const {
    int64_t count = 0;
    for (const MovingRun& run : rest.data().moving_triangles) count += run.count;
    return count;
  }

  Scene rest;
  Parallel parallel;
  PosedScene posed;
  std::vector<uint32_t> flags;
  double time = 0;
};

void pose(benchmark::State& state, const char* name) {
  Moving m(name, static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(m.next().bounds_min[0]);
  state.counters["moving"] = static_cast<double>(m.moving_triangles());
}

void refit(benchmark::State& state, const char* name) {
  Moving m(name, static_cast<int>(state.range(0)));
  Bvh bvh = m.build(m.rest.data());
  BvhRefit refit(bvh, m.rest.data().moving_triangles);
  for (auto _ : state) {
    state.PauseTiming();
    const SceneData& scene = m.next();
    state.ResumeTiming();
    refit.refit(scene, bvh, m.parallel);
  }
}

void rebuild(benchmark::State& state, const char* name) {
  Moving m(name, static_cast<int>(state.range(0)));
  for (auto _ : state) {
    state.PauseTiming();
    const SceneData& scene = m.next();
    state.ResumeTiming();
    const Bvh bvh = m.build(scene);
    benchmark::DoNotOptimize(BvhRefit(bvh, m.rest.data().moving_triangles).cost());
  }
}

BENCHMARK_CAPTURE(pose, orrery, "orrery")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(refit, orrery, "orrery")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(rebuild, orrery, "orrery")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace spanray::bench
