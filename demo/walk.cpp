// spanray walk: fly through a scene, in a window; or play its camera path and measure it.
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>

#include "camera_path.h"
#include "command.h"
#include "fly_camera.h"
#include "frame_options.h"
#include "stats_json.h"
#include "walk_session.h"
#include "window.h"

namespace spanray::demo {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kMaxFrames = 1000000;
constexpr double kPathFramesPerSecond = 30;
constexpr int kIdleWaitMs = 100;
constexpr double kTitleSeconds = 0.25;  // a title is read, not watched

struct WalkOptions {
  FrameOptions frame;
  std::string path_file;
  bool path = false, headless = false;
  int frames = 0;  // 0: until the window is closed
};

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

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

void report(const std::vector<double>& frame_ms) {
  if (frame_ms.empty()) return;
  const double middle = median(frame_ms);
  std::printf("frames %zu  median_ms %.3f  p95_ms %.3f  frames_per_second %.1f\n", frame_ms.size(), middle, percentile_95(frame_ms),
              middle > 0 ? 1000 / middle : 0.0);
}

// All frames of a path without a window.
int play(WalkSession& session, const std::vector<CameraKey>& keys, int frames) {
  for (int i = 0; i < frames; ++i)
    if (auto done = session.render(camera_of_frame(keys, i, frames)); !done) return fail(done.error());
  report(session.frame_ms());
  return kDone;
}

// Moves the camera as held keys and mouse say; true if it moved.
bool fly(FlyCamera& camera, const Input& input, double speed, double seconds) {
  const double step = speed * (input.fast ? 4 : 1) * seconds;
  const bool moves = (input.move_right | input.move_up | input.move_forward) != 0;
  camera.turn(input.mouse_dx, input.mouse_dy);
  camera.move(input.move_right * step, input.move_up * step, input.move_forward * step);
  return moves || input.mouse_dx != 0 || input.mouse_dy != 0;
}

int walk_in_window(WalkSession& session, const WalkOptions& options, const std::vector<CameraKey>& keys, int frames) {
  const auto fits = [](int side) { return side > 16384 ? 16384 : side < 1 ? 1 : side; };
  Result<std::unique_ptr<Window>> opened = Window::open("spanray", session.settings().width, session.settings().height);
  if (!opened) return fail(opened.error());
  Window& window = *opened.value();
  FlyCamera camera(session.camera());
  bool dirty = true, look = false, title_due = false;
  std::optional<Clock::time_point> titled;
  Clock::time_point last = Clock::now();
  for (int shown = 0; frames == 0 || shown < frames;) {
    const Input input = window.wait(dirty || frames > 0 ? 0 : kIdleWaitMs);
    if (input.quit) break;
    bool quit = false;
    for (const std::string& key : input.pressed) {
      if (key == "Escape") quit = true;
      else if (key == "M") window.set_look(look = !look);
      else dirty |= session.press(key);
    }
    if (quit) break;
    // A long frame must not throw the camera out of the scene.
    dirty |= fly(camera, input, session.speed(), std::min(seconds_since(last), 0.1));
    last = Clock::now();
    session.settings().width = fits(window.width()), session.settings().height = fits(window.height());
    dirty |= input.resized;
    if (title_due && (!titled || seconds_since(*titled) > kTitleSeconds)) {
      window.set_title(session.title());
      titled = Clock::now(), title_due = false;
    }
    if (!dirty && frames == 0) {
      if (input.exposed) window.show_again();
      continue;
    }
    dirty = false;
    if (auto done = session.render(options.path ? camera_of_frame(keys, shown, frames) : camera.camera()); !done) return fail(done.error());
    if (auto done = window.show(session.picture()); !done) return fail(done.error());
    ++shown;
    title_due = true;
  }
  if (frames > 0) report(session.frame_ms());
  return kDone;
}

int walk(const WalkOptions& options) {
  if (options.headless && !options.path) throw UsageError("walk: --headless plays a camera path, so it needs --path");
  Result<Job> job = options.frame.load();
  if (!job) return fail(job.error());
  for (const std::string& text : job.value().messages) message(text);
  std::vector<CameraKey> keys;
  int frames = options.frames;
  if (options.path) {
    Result<std::vector<CameraKey>> loaded = load_path(options, job.value().scene);
    if (!loaded) return fail(loaded.error());
    keys = std::move(loaded.value());
    const double wanted = (keys.back().time - keys.front().time) * kPathFramesPerSecond;
    if (frames == 0) frames = wanted > kMaxFrames ? kMaxFrames : wanted < 1 ? 1 : static_cast<int>(wanted);
  }
  WalkSession session(job.value());
  return options.headless ? play(session, keys, frames) : walk_in_window(session, options, keys, frames);
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
  command->add_flag("--headless", options->headless, "No window; with --path");
  command->callback([options, path, &run] {
    options->path = path->count() > 0;
    run = [options] { return walk(*options); };
  });
}

}  // namespace spanray::demo
