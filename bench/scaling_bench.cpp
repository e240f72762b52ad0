// Cost against the number of triangles: a gallery of balls, some of which are seen, 1280x720, no rays. The others are in view
// too, behind a wall, or behind the eye. From a million triangles on, as many are seen: 100 thousand.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "math/elementary.h"
#include "scene/scene_builder.h"
#include "spanray/render.h"

namespace spanray::bench {
namespace {

enum class Others { kInView, kHidden, kBehindEye };
constexpr const char* kOthers[] = {"in_view", "hidden", "behind_eye"};

constexpr int kBands = 50, kBallTriangles = 2 * (kBands - 1) * 2 * kBands;  // about 10 thousand

void add_ball(SceneData& scene, double x, double y, double z, double radius) {
  const uint32_t first = static_cast<uint32_t>(scene.vertices.size());
  for (int i = 0; i <= kBands; ++i)
    for (int j = 0; j <= 2 * kBands; ++j) {
      double st, ct, sp, cp;
      sin_cos(kPi * i / kBands, &st, &ct), sin_cos(kPi * (j % (2 * kBands)) / kBands, &sp, &cp);
      const double n[3] = {st * cp, ct, -st * sp}, at[3] = {x, y, z};
      Vertex v{};
      for (int k = 0; k < 3; ++k)
        v.position[k] = static_cast<float>(at[k] + radius * n[k]) + 0.0f, v.normal[k] = static_cast<float>(n[k]);
      scene.vertices.push_back(v);
    }
  const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
    Triangle t{{first + a, first + b, first + c}, 0};
    order_vertices(scene.vertices, t);
    scene.triangles.push_back(t);
  };
  constexpr uint32_t kRow = 2 * kBands + 1;
  for (uint32_t i = 0; i < kBands; ++i)
    for (uint32_t j = 0; j + 1 < kRow; ++j) {
      const uint32_t a = i * kRow + j, b = a + kRow;
      if (i + 1 < kBands) add(a, b, b + 1);
      if (i > 0) add(a, b + 1, a + 1);
    }
}

// Balls in a square that fills the picture at z.
void add_balls(SceneData& scene, int count, double z, double half_width) {
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  const double step = 2 * half_width / side;
  for (int i = 0; i < count; ++i)
    add_ball(scene, (i % side + 0.5) * step - half_width, (i / side + 0.5) * step - half_width, z, 0.45 * step);
}

Scene gallery(int triangles, Others others) {
  const int balls = std::max(1, triangles / kBallTriangles), seen = std::min(balls, 10);
  auto scene = std::make_shared<SceneData>(make_test_scene({}));
  if (others == Others::kInView) {
    add_balls(*scene, balls, -10, 4);
  } else {
    add_balls(*scene, seen, -10, 4);
    if (others == Others::kBehindEye) {
      add_balls(*scene, balls - seen, 30, 12);
    } else {
      const uint32_t first = static_cast<uint32_t>(scene->vertices.size());
      for (const float x : {-20.0f, 20.0f})
        for (const float y : {-20.0f, 20.0f}) scene->vertices.push_back(Vertex{{x, y, -15}, {0, 0, 1}, {0, 0}});
      for (const uint32_t a : {0u, 1u}) {
        Triangle t{{first + a, first + 2, first + (a == 0 ? 1 : 3)}, 0};
        if (a == 1) std::swap(t.vertex[1], t.vertex[2]);
        order_vertices(scene->vertices, t);
        scene->triangles.push_back(t);
      }
      add_balls(*scene, balls - seen, -30, 12);
    }
  }
  Light light;
  light.position[1] = 5, light.intensity[0] = light.intensity[1] = light.intensity[2] = 150;
  scene->lights.push_back(light);
  hash_scene(*scene);
  return Scene(scene);
}

// Arguments: triangles, Others, whether back faces are culled, threads.
void scaling(benchmark::State& state) {
  static Scene scene;  // of the last arguments: one at a time, the largest takes a gigabyte
  static std::pair<int64_t, int64_t> made;
  const std::pair<int64_t, int64_t> wanted{state.range(0), state.range(1)};
  const auto others = static_cast<Others>(state.range(1));
  if (made != wanted) scene = Scene(), scene = gallery(static_cast<int>(state.range(0)), others), made = wanted;
  Settings s;
  s.width = 1280, s.height = 720, s.threads = static_cast<int>(state.range(3));
  s.shadows = Shadows::kNone, s.reflections = Reflections::kNone;
  s.culling = state.range(2) != 0 ? Culling::kBack : Culling::kNone;
  Camera camera = scene.cameras()[0];
  for (int k = 0; k < 3; ++k) camera.eye[k] = 0, camera.target[k] = k == 2 ? -1 : 0;
  camera.fov_y_degrees = 45;
  Renderer renderer;
  Framebuffer out;
  const auto render = [&] { return renderer.render(scene, camera, s, out).value(); };
  const double first_ms = render().ms.frame;
  std::vector<double> frame, transform, clip, bin, raster;
  uint64_t drawn = 0;
  for (auto _ : state) {
    const FrameStats stats = render();
    frame.push_back(stats.ms.frame), transform.push_back(stats.ms.transform), clip.push_back(stats.ms.clip),
        bin.push_back(stats.ms.bin);
    raster.push_back(stats.ms.raster);
    for (const auto& [name, value] : stats.counts)
      if (name == "triangles_drawn") drawn = value;
  }
  const auto median = [](std::vector<double>& v) {
    std::nth_element(v.begin(), v.begin() + static_cast<ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
  };
  state.counters["frame_ms"] = median(frame), state.counters["first_frame_ms"] = first_ms;
  state.counters["transform_ms"] = median(transform), state.counters["clip_ms"] = median(clip),
  state.counters["bin_ms"] = median(bin);
  state.counters["raster_ms"] = median(raster), state.counters["drawn"] = static_cast<double>(drawn);
  state.SetLabel(kOthers[state.range(1)] + std::string(state.range(2) != 0 ? ", back faces culled" : ""));
}
BENCHMARK(scaling)
    ->ArgsProduct({{10'000, 100'000, 1'000'000, 10'000'000}, {0, 1, 2}, {0, 1}, {1, 2}})
    ->ArgNames({"triangles", "others", "culling", "threads"})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(9);

}  // namespace
}  // namespace spanray::bench
