// A walk in a window on a virtual display, driven by real key and mouse events.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>

#include "support/program.h"
#include "support/small_scene.h"
#include "support/x11_screen.h"

namespace spanray {

inline bool equal_colors(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.rgba.empty()) return false;
  for (size_t i = 0; i < a.rgba.size(); ++i)
    if (i % 4 != 3 && a.rgba[i] != b.rgba[i]) return false;
  return true;
}

class WalkDisplay : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { screen_ = std::make_unique<XScreen>(); }
  static void TearDownTestSuite() { screen_.reset(); }
  void SetUp() override {
    if (!screen_->ok()) GTEST_SKIP() << "Xvfb is not installed, or does not start";
    ASSERT_TRUE(screen_->input({"version"})) << "xdotool is not installed";
    scene_ = write_small_scene(folder_);
  }

  std::vector<std::string> arguments(const std::string& command, const std::vector<std::string>& more) const {
    std::vector<std::string> list = {command, scene_};
    if (std::find(more.begin(), more.end(), "--size") == more.end())
      list.insert(list.end(), {"--size", size_});
    list.insert(list.end(), more.begin(), more.end());
    return list;
  }
  // Starts a walk and waits for its window, not for a picture.
  void launch(const std::vector<std::string>& more) {
    std::vector<std::string> list = arguments("walk", more);
    list.insert(list.begin(), SPANRAY_PROGRAM);
    walk_ = std::make_unique<Process>(list, folder_.path(), environment());
    ASSERT_TRUE(until([&] { return (window_ = screen_->find("spanray")) != 0; })) << walk_->error();
    screen_->focus(window_);
  }
  void start(const std::vector<std::string>& more) {
    ASSERT_NO_FATAL_FAILURE(launch(more));
    ASSERT_TRUE(until([&] { return titled(" ms"); })) << screen_->title_of(window_);
    point(60, 60);
    key("Shift_L");  // any key takes the hint away
  }
  static std::vector<std::string> environment() {
    return {"DISPLAY=" + screen_->name(), "SDL_VIDEODRIVER=x11", "WAYLAND_DISPLAY", "ASAN_OPTIONS=detect_leaks=0"};
  }
  // Polls until the condition holds; false after a minute (machines may be busy) or when the walk has ended.
  bool until(const std::function<bool()>& condition) {
    const auto start = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - start < std::chrono::seconds(60)) {
      if (condition()) return true;
      if (walk_->wait(0)) return condition();
      ::usleep(20000);
    }
    return false;
  }
  bool titled(const std::string& words) const { return screen_->title_of(window_).find(words) != std::string::npos; }
  // The pointer, in pixels of the window.
  void point(int x, int y) {
    ASSERT_TRUE(screen_->input({"mousemove", "--window", std::to_string(window_), std::to_string(x), std::to_string(y)}));
  }
  void click(int x, int y) {
    point(x, y);
    ASSERT_TRUE(screen_->input({"click", "1"}));
  }
  // The line that a key prints next: P the camera, I what is under the pointer.
  std::string printed_camera() { return printed("p"); }
  std::string printed(const std::string& name) {
    const size_t before = walk_->out().size();
    key(name);
    std::string all;
    EXPECT_TRUE(until([&] { return (all = walk_->out()).size() > before && all.back() == '\n'; }));
    return all.empty() ? "" : all.substr(before, all.size() - before - 1);
  }
  void leave() {
    key("Escape");
    ASSERT_TRUE(walk_->wait(60));
    EXPECT_EQ(0, walk_->code()) << walk_->error();
  }
  // What `render` gives for these options.
  Image rendered(const std::vector<std::string>& more) {
    std::vector<std::string> list = arguments("render", more);
    list.insert(list.end(), {"--out", "expected.png"});
    const Ran ran = run_program(list, folder_.path());
    EXPECT_EQ(0, ran.code) << ran.error;
    Result<Image> image = read_png(folder_.file("expected.png"));
    EXPECT_TRUE(image);
    return image ? image.value() : Image{};
  }
  bool shows(const Image& expected) {
    return until([&] { return equal_colors(expected, screen_->grab(window_)); });
  }
  void key(const std::string& name) { ASSERT_TRUE(screen_->input({"key", name})) << name; }

  inline static std::unique_ptr<XScreen> screen_;
  TempFolder folder_;
  std::string scene_, size_ = "160x120";
  std::unique_ptr<Process> walk_;
  Window window_ = 0;
};

}  // namespace spanray
