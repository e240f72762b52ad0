// Trees of two levels against one tree over all triangles: what they cost to build and to keep, and what rays cost. Copies of a wavy ball on a jittered grid.
#include <benchmark/benchmark.h>

#include <cmath>

#include "frame/primary_rays.h"
#include "ray/bvh.h"
#include "scene/instance_list.h"
#include "support/bvh_oracle.h"
#include "support/random_map.h"

namespace spanray {
namespace {

// range(0): levels of the ball (20 * 4^levels triangles); range(1): copies; range(2): 1 for two levels.
struct Scattered {
  SceneData scene;
  std::unique_ptr<TestFrame> t;
  Bvh bvh;

  explicit Scattered(const benchmark::State& state) {
    TestRandom random(5);
    std::vector<SoupTriangle> ball;
    IndexedMesh mesh = make_sphere(static_cast<int>(state.range(0)));
    for (glm::dvec3& v : mesh.vertices) v = v * (1 + 0.1 * std::fabs(v.x) * v.y);
    add_mesh(ball, mesh, 1, glm::dvec3(0));
    for (SoupTriangle& triangle : ball) triangle.object = 1;
    InstanceList list;
    list.templates.push_back({"ball", 0});
    const int side = static_cast<int>(std::ceil(std::cbrt(static_cast<double>(state.range(1)))));
    for (int i = 0; i < state.range(1); ++i) {
      const glm::dvec3 place = glm::dvec3(i % side, i / side % side, i / side / side) * 3.0 + random_point(random, 0.8);
      list.instances.push_back({"ball", 0, random_map(random, glm::dvec3(random.uniform(0.8, 1.4)), place), false});
    }
    SceneData built = make_test_scene({});
    (void)build_instanced_geometry(ball, list, {"", "ball"}, built);
    Camera camera;
    const double s = side * 3.0;
    camera.eye[0] = -0.6 * s, camera.eye[1] = 0.9 * s, camera.eye[2] = 1.5 * s;
    camera.target[0] = camera.target[1] = camera.target[2] = 0.45 * s;
    t = make_test_frame(std::move(built), camera, test_settings(512, 512));
    make();
    use = state.range(2) != 0 ? InstanceUse::kAlways : InstanceUse::kNever;
  }
  InstanceUse use = InstanceUse::kNever;
  void make() { bvh = build_bvh(t->scene, t->material_flags.data(), 0, 0, *t->parallel, TreeQuality::kFast, false, use); }

  RayBatch primary() const {
    RayBatch rays = make_rays(512 * 512);
    for (int i = 0; i < rays.count; ++i) {
      // Blocks of 4 x 4 pixels, as frames have them.
      const int block = i / 16, x = block % 128 * 4 + i % 4, y = block / 128 * 4 + i / 4 % 4;
      float origin[3], direction[3];
      round_primary_ray(t->frame.primary, x + 0.5, y + 0.5, origin, direction);
      set_ray(rays, i, {origin[0], origin[1], origin[2]}, {direction[0], direction[1], direction[2]});
    }
    return rays;
  }
};

RayBatch bounced(const Scattered& s, bool parallel) {
  const RayBatch first = s.primary();
  std::vector<uint32_t> hit(static_cast<size_t>(first.count));
  trace_closest(s.t->frame, s.bvh, first, hit.data());
  RayBatch rays = make_rays(first.count);
  TestRandom random(6);
  for (int i = 0; i < first.count; ++i) {
    const uint32_t p = hit[static_cast<size_t>(i)];
    if (p == kNoPrimitive) {
      set_ray(rays, i, {0, 0, 0}, {0, 0, 0});
      continue;
    }
    const glm::dvec3 a = scene_vertex(s.t->scene, p, 0), b = scene_vertex(s.t->scene, p, 1), c = scene_vertex(s.t->scene, p, 2);
    glm::dvec3 n = normalize3(cross3(b - a, c - a), glm::dvec3(0, 1, 0));
    if (dot3(n, ray_direction(first, i)) > 0) n = -n;
    set_ray(rays, i, (a + b + c) / 3.0 + n * 1e-4, parallel ? glm::dvec3(0.5, 1, 0.7) : n + normalize3(random_point(random, 1), n));
  }
  return rays;
}

void report(benchmark::State& state, const Scattered& s) {
  state.counters["MB"] = static_cast<double>(s.bvh.memory_bytes()) / 1e6;
  state.counters["triangles"] = static_cast<double>(s.t->scene.triangles.size());
}

void build(benchmark::State& state) {
  Scattered s(state);
  for ([[maybe_unused]] auto _ : state) s.make();
  report(state, s);
}

enum Kind { kPrimary, kShadow, kDiffuse, kOcclusion };
void trace(benchmark::State& state, Kind kind) {
  Scattered s(state);
  s.make();
  const RayBatch rays = kind == kPrimary ? s.primary() : bounced(s, kind == kShadow);
  std::vector<uint32_t> out(static_cast<size_t>(rays.count));
  for ([[maybe_unused]] auto _ : state) {
    if (kind == kPrimary || kind == kDiffuse) trace_closest(s.t->frame, s.bvh, rays, out.data());
    else trace_any(s.t->frame, s.bvh, rays, out.data());
    benchmark::DoNotOptimize(out.data());
  }
  state.counters["Mrays/s"] = benchmark::Counter(static_cast<double>(rays.count) * 1e-6, benchmark::Counter::kIsIterationInvariantRate);
}

void sizes(benchmark::internal::Benchmark* b) {
  for (const auto& [levels, copies] : {std::pair<int64_t, int64_t>{2, 64}, {2, 4096}, {4, 64}, {4, 1000}, {6, 27}})
    for (const int64_t two : {0, 1}) b->Args({levels, copies, two});
  b->Unit(benchmark::kMillisecond);
}

BENCHMARK(build)->Apply(sizes);
BENCHMARK_CAPTURE(trace, primary, kPrimary)->Apply(sizes);
BENCHMARK_CAPTURE(trace, shadow, kShadow)->Apply(sizes);
BENCHMARK_CAPTURE(trace, diffuse, kDiffuse)->Apply(sizes);
BENCHMARK_CAPTURE(trace, occlusion, kOcclusion)->Apply(sizes);

}  // namespace
}  // namespace spanray
