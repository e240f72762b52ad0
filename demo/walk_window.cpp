#include "walk_window.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "camera_path.h"
#include "panel.h"
#include "scene_loading.h"
#include "speak.h"
#include "stage_times.h"
#include "walk_query.h"
#include "window.h"

namespace spanray::demo {
namespace {

using Clock = std::chrono::steady_clock;
using Loading = SceneLoading<Result<WalkJob>>;

constexpr int kQuietMs = 150;           // what loads sooner needs no progress bar
constexpr int kPatienceMs = 300;        // how long an ending walk waits for what its threads are doing
constexpr int kIdleWaitMs = 100, kBusyWaitMs = 2;
constexpr double kTitleSeconds = 0.25;  // a title is read, not watched
constexpr double kDrawSeconds = 0.03;   // between drawings that show no new picture
constexpr double kHintSeconds = 6;
constexpr int kSettleDraws = 3;         // drawings after the last event: a click is pressed, released and seen

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }
int fits(int side) { return std::clamp(side, 1, kMaxImageSide); }

// Without waiting for threads that nobody can stop (a tree being built, a huge texture being decoded).
[[noreturn]] void leave_now() {
  std::fflush(stdout);
  std::_Exit(kDone);
}

bool wants_to_leave(const Input& input) {
  return input.quit || std::find(input.pressed.begin(), input.pressed.end(), "Escape") != input.pressed.end();
}

// False if the user left before the scene was there.
bool wait_for_scene(Window& window, Loading& loading, const std::string& name) {
  const Clock::time_point start = Clock::now();
  window.set_title("spanray, loading " + name);
  while (!loading.done(0)) {
    if (wants_to_leave(window.wait(static_cast<int>(kDrawSeconds * 1000)))) return false;
    const Loading::State state = loading.state();
    // Stages that cannot tell how far they are stay at 0.
    const double fraction = state.fraction > 0 ? state.fraction : -1;
    window.draw([&] { draw_progress(name, state.stage, fraction, seconds_since(start)); });
  }
  return true;
}

class Walk {
 public:
  Walk(Window& window, const WindowOptions& options, const WalkJob& job)
      : window_(window),
        options_(options),
        path_(job.path),
        frames_(options.frames(job)),
        session_(job.job),
        query_(job.job.scene, options.radius > 0 ? options.radius : fitted_radius(job.job.scene, job.job.camera)),
        camera_(job.job.camera),
        hint_(frames_ == 0) {
    session_.walls() = options.radius != 0 && frames_ == 0;  // a measured run builds no tree of its own
  }
  int run();

 private:
  bool handle(const Input& input);
  void fly(const Input& input);
  void play();
  void jump(int camera);
  void follow_path(double seconds);
  void set_time(double seconds);
  bool things_move() const { return !session_.scene().data().motions.empty(); }
  void order_frame();
  Result<void> take_frame();
  void draw();
  void draw_ui();
  void show_help(bool show);
  int wait_ms() const;
  bool first_frame_is_late() const { return shown_ == 0 && seconds_since(start_) * 1000 > kQuietMs; }
  double path_length() const { return path_.empty() ? 0 : path_.back().time - path_.front().time; }

  Window& window_;
  const WindowOptions& options_;
  std::vector<CameraKey> path_;
  int frames_;  // 0: until the window is closed
  WalkSession session_;
  WalkQuery query_;
  FlyCamera camera_;
  int camera_index_ = 0;
  bool panel_ = false, help_ = false, hint_, look_ = false;
  bool playing_ = false, moving_ = false;
  bool clock_runs_ = things_move();  // of the scene's moving parts
  double path_time_ = 0;
  bool dirty_ = true;       // the next frame would look different
  bool title_due_ = false;
  int redraws_ = 0;         // drawings that are due though no picture is new
  bool new_picture_ = false, drew_ui_ = false;
  int shown_ = 0;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point first_shown_ = start_, tick_ = start_, drawn_ = start_, titled_ = start_;
};

int Walk::wait_ms() const {
  if (session_.busy()) return 0;  // take_frame() waits
  if (dirty_ || moving_ || playing_ || clock_runs_ || frames_ > 0) return 0;
  return redraws_ > 0 || title_due_ || hint_ ? static_cast<int>(kDrawSeconds * 1000) : kIdleWaitMs;
}

int Walk::run() {
  for (;;) {
    if (!handle(window_.wait(wait_ms()))) break;
    if (!session_.busy() && (dirty_ || frames_ > 0)) order_frame();
    if (auto taken = take_frame(); !taken) return fail(taken.error());
    draw();
    if (title_due_ && (shown_ == 1 || seconds_since(titled_) > kTitleSeconds)) {
      window_.set_title(session_.title());
      titled_ = Clock::now(), title_due_ = false;
    }
    if (frames_ > 0 && shown_ >= frames_) {
      report_frames(session_.frame_ms());
      return kDone;
    }
  }
  if (frames_ > 0) report_frames(session_.frame_ms());
  if (Result<bool> last = session_.take_frame(kPatienceMs); session_.busy() || query_.building()) leave_now();
  return kDone;
}

// False if the walk is over.
bool Walk::handle(const Input& input) {
  if (wants_to_leave(input)) return false;
  query_.point(input);
  for (const std::string& key : input.pressed) {
    if (key == "M") window_.set_look(look_ = !look_);
    else if (key == "F2") panel_ = !panel_;
    else if (key == "C") jump((camera_index_ + 1) % static_cast<int>(session_.scene().cameras().size()));
    else if (key == "L") play();
    else if (key == "Space") clock_runs_ = !clock_runs_ && things_move();
    else if (key == "F1") show_help(!help_);
    else if (key == "I") query_.print_pointed(session_.shown());
    else if (session_.press(key, camera_.camera())) dirty_ = true;
  }
  if (!input.pressed.empty() || input.clicked || (shown_ > 0 && seconds_since(first_shown_) > kHintSeconds)) {
    if (hint_) redraws_ = kSettleDraws;
    hint_ = false;
  }
  if (input.any) redraws_ = kSettleDraws;
  for (int i = 0; i < std::abs(input.wheel); ++i) session_.speed() *= input.wheel > 0 ? 1.25 : 0.8;
  fly(input);
  Settings& s = session_.settings();
  const int width = fits(window_.width()), height = fits(window_.height());
  dirty_ |= width != s.width || height != s.height;
  s.width = width, s.height = height;
  return true;
}

// Moves the camera as held keys and mouse say, or along the path.
void Walk::fly(const Input& input) {
  // A long pause must not throw the camera out of the scene.
  const double seconds = std::min(seconds_since(tick_), 0.1);
  tick_ = Clock::now();
  const double way = session_.speed() * (input.fast ? 4 : 1) * seconds;
  moving_ = (input.move_right | input.move_up | input.move_forward) != 0;
  const bool turns = input.mouse_dx != 0 || input.mouse_dy != 0;
  if (moving_ || turns) playing_ = false;
  camera_.turn(input.mouse_dx, input.mouse_dy);
  if (moving_) query_.step(session_, camera_, input.move_right * way, input.move_up * way, input.move_forward * way);
  dirty_ |= moving_ || turns;
  if (!playing_) {
    if (clock_runs_) set_time(session_.settings().time + seconds);
    return;
  }
  follow_path(path_time_ + seconds);
  playing_ = path_time_ < path_length();
}

void Walk::play() {
  if (path_.empty()) return message("the scene has no camera path");
  playing_ = !playing_;
  if (playing_ && path_time_ >= path_length()) path_time_ = 0;
}

void Walk::jump(int camera) {
  camera_index_ = camera;
  camera_ = FlyCamera(session_.scene().cameras()[static_cast<size_t>(camera)]);
  playing_ = false, dirty_ = true;
}

// The scene moves as its camera path has it.
void Walk::follow_path(double seconds) {
  path_time_ = std::clamp(seconds, 0.0, path_length());
  camera_ = FlyCamera(camera_at(path_, path_.front().time + path_time_));
  if (things_move()) set_time(path_.front().time + path_time_);
  dirty_ = true;
}

void Walk::set_time(double seconds) {
  session_.settings().time = std::clamp(seconds, -kMostSeconds, kMostSeconds);
  dirty_ = true;
}

void Walk::order_frame() {
  dirty_ = false;
  if (!options_.play) return session_.start_frame(camera_.camera());
  const double time = time_of_frame(path_, shown_, frames_);
  set_time(time);
  dirty_ = false;
  session_.start_frame(camera_at(path_, time));
}

Result<void> Walk::take_frame() {
  Result<bool> taken = session_.take_frame(session_.busy() ? kBusyWaitMs : 0);
  if (!taken) return taken.error();
  if (!taken.value()) return {};
  if (shown_++ == 0) {
    first_shown_ = Clock::now();
    if (frames_ == 0) query_.prepare();
  }
  new_picture_ = title_due_ = true;
  return window_.set_picture(session_.shown().picture);
}

void Walk::draw() {
  const bool ui = panel_ || help_ || hint_ || first_frame_is_late();
  const bool wanted = redraws_ > 0 || ui != drew_ui_ || first_frame_is_late();
  if (!new_picture_ && !(wanted && seconds_since(drawn_) > kDrawSeconds)) return;
  if (ui)
    window_.draw([this] { draw_ui(); });
  else
    window_.draw();
  redraws_ = std::max(0, redraws_ - 1);
  drawn_ = Clock::now(), new_picture_ = false, drew_ui_ = ui;
}

// Also on standard error, where it can be read on while walking.
void Walk::show_help(bool show) {
  help_ = show;
  if (help_) std::fprintf(stderr, "%s\n", WalkSession::help().c_str());
}

void Walk::draw_ui() {
  if (first_frame_is_late()) return draw_progress(options_.name, "making the first frame", -1, seconds_since(start_));
  const bool panel = panel_ && !(help_ && !help_fits_beside_panel());
  if (panel) {
    PanelInput input{camera_.camera(), path_, playing_, path_time_};
    input.pointed = query_.pointed(session_.shown(), input.under);
    input.clock_runs = clock_runs_;
    const PanelAction action = draw_panel(session_, input);
    dirty_ |= action.changed;
    if (action.camera >= 0) jump(action.camera);
    if (action.play) play();
    if (action.clock) clock_runs_ = !clock_runs_;
    if (action.time) set_time(*action.time);
    if (action.path_time >= 0) playing_ = false, follow_path(action.path_time);
  }
  if (help_) draw_help(panel);
  if (hint_) draw_hint("F1 keys   F2 panel   Esc leave");
}

}  // namespace

void report_frames(const std::vector<double>& frame_ms) {
  if (frame_ms.empty()) return;
  const double middle = median(frame_ms);
  std::printf("frames %zu  median_ms %.3f  p95_ms %.3f  frames_per_second %.1f\n", frame_ms.size(), middle, percentile_95(frame_ms),
              middle > 0 ? 1000 / middle : 0.0);
}

int walk_in_window(const WindowOptions& options, std::function<Result<WalkJob>(const LoadProgress&)> load) {
  Loading loading(std::move(load));
  std::unique_ptr<Window> window;
  const auto open = [&](int width, int height) -> Result<void> {
    Result<std::unique_ptr<Window>> opened = Window::open("spanray", fits(width), fits(height));
    if (!opened) return opened.error();
    window = std::move(opened.value());
    return {};
  };
  if (!loading.done(kQuietMs)) {
    if (auto opened = open(options.width, options.height); !opened) return fail(opened.error());
    if (!wait_for_scene(*window, loading, options.name)) {
      loading.stop();
      window.reset();
      if (!loading.done(kPatienceMs)) leave_now();
      return kDone;
    }
  }
  Result<WalkJob> job = loading.take();
  if (!job) return fail(job.error());
  for (const std::string& text : job.value().job.messages) message(text);
  const Settings& s = job.value().job.settings;
  if (!window) {
    if (auto opened = open(s.width, s.height); !opened) return fail(opened.error());
  } else if (window->width() == options.width && window->height() == options.height) {
    window->resize(fits(s.width), fits(s.height));  // the user has not chosen another size meanwhile
  }
  return Walk(*window, options, job.value()).run();
}

}  // namespace spanray::demo
