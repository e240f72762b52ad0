// spanray walk: fly through a scene, in a window; or play its camera path and measure it.
#include <algorithm>
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>

#include "camera_path.h"
#include "command.h"
#include "frame_options.h"
#include "spanray/render.h"
#include "walk_session.h"
#include "walk_window.h"

namespace spanray::demo {
namespace {

constexpr int kMaxFrames = 1000000;
constexpr double kPathFramesPerSecond = 30;

struct WalkOptions {
  FrameOptions frame;
  std::string path_file;
  bool path = false, headless = false;
  int frames = 0;  // 0: until the window is closed
  double radius = -1;  // as WindowOptions::radius
};

// The keys of --path: of the scene itself, or of the file that the option names.
Result<std::vector<CameraKey>> load_path(const WalkOptions& options, const Scene& scene) {
  if (options.path_file.empty()) {
    if (scene.data().camera_path.empty()) return Error{"--path: the scene has no camera path", options.frame.scene_path()};
    return scene.data().camera_path;
  }
  Result<LoadedScene> other = load_scene(options.path_file);
  if (!other) return other.error();
  if (other.value().scene.data().camera_path.empty()) return Error{"--path: it has no camera path", options.path_file};
  return other.value().scene.data().camera_path;
}

int frames_of(const WalkOptions& options, const WalkJob& job) {
  if (options.frames > 0 || !options.path) return options.frames;
  const double wanted = (job.path.back().time - job.path.front().time) * kPathFramesPerSecond;
  return wanted > kMaxFrames ? kMaxFrames : wanted < 1 ? 1 : static_cast<int>(wanted);
}

Result<WalkJob> load_walk(const WalkOptions& options, const LoadProgress& progress) {
  Result<Job> job = options.frame.load_to_see(progress);
  if (!job) return job.error();
  WalkJob walk{std::move(job.value()), {}};
  walk.path = walk.job.scene.data().camera_path;
  if (!options.path) return walk;
  Result<std::vector<CameraKey>> path = load_path(options, walk.job.scene);
  if (!path) return path.error();
  walk.path = std::move(path.value());
  return walk;
}

// All frames of a path without a window.
int play(const WalkOptions& options) {
  const Result<WalkJob> loaded = load_walk(options, {});
  if (!loaded) return fail(loaded.error());
  const WalkJob& walk = loaded.value();
  for (const std::string& text : walk.job.messages) message(text);
  const int frames = frames_of(options, walk);
  Renderer renderer;
  Framebuffer picture;
  std::vector<double> frame_ms;
  for (int i = 0; i < frames; ++i) {
    Settings settings = walk.job.settings;
    const double time = time_of_frame(walk.path, i, frames);
    settings.time = std::clamp(time, -kMostSeconds, kMostSeconds);
    const Result<FrameStats> stats = renderer.render(walk.job.scene, camera_at(walk.path, time), settings, picture);
    if (!stats) return fail(stats.error());
    frame_ms.push_back(stats.value().ms.frame);
  }
  report_frames(frame_ms);
  return kDone;
}

int walk(const WalkOptions& options) {
  if (options.headless && !options.path) throw UsageError("walk: --headless plays a camera path, so it needs --path");
  if (options.headless) return play(options);
  WindowOptions window;
  const Settings first = options.frame.settings_over(Settings());
  window.name = std::filesystem::path(options.frame.scene_path()).filename().string();
  window.width = first.width, window.height = first.height;
  window.play = options.path;
  window.radius = options.radius;
  window.frames = [&options](const WalkJob& job) { return frames_of(options, job); };
  return walk_in_window(window, [&options](const LoadProgress& progress) { return load_walk(options, progress); });
}

}  // namespace

void add_walk(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("walk", "Walk through a scene in a window");
  auto options = std::make_shared<WalkOptions>();
  options->frame.add_to(*command);
  command->footer(WalkSession::help());
  CLI::Option* path = command->add_option("--path", options->path_file, "Play the scene's camera path, or that of another scene file")
                          ->expected(0, 1)->type_name("[F.toml]");
  command->add_option("--frames", options->frames, "End after N frames and print the median frame time")
      ->check(CLI::Range(1, kMaxFrames))->type_name("N");
  command->add_option("--radius", options->radius,
                      "How close walls let you come, world units (default: from the scene's size); 0: fly through them")
      ->check(CLI::Range(0.0, 1e30))->type_name("R");
  command->add_flag("--headless", options->headless, "No window; with --path");
  command->callback([options, path, &run] {
    options->path = path->count() > 0;
    run = [options] { return walk(*options); };
  });
}

}  // namespace spanray::demo
