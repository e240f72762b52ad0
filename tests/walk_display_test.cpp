// The walkthrough in a real window on a virtual display, driven by real key and mouse events; the window's pixels are compared
// with what `render` gives.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>

#include "support/program.h"
#include "support/small_scene.h"
#include "support/x11_screen.h"

namespace spanray {
namespace {

constexpr int kWidth = 160, kHeight = 120;

bool equal_colors(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.rgba.empty()) return false;
  for (size_t i = 0; i < a.rgba.size(); ++i)
    if (i % 4 != 3 && a.rgba[i] != b.rgba[i]) return false;
  return true;
}

class WalkDisplay : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { screen_ = new XScreen; }
  static void TearDownTestSuite() {
    delete screen_;
    screen_ = nullptr;
  }
  void SetUp() override {
    if (!screen_->ok()) GTEST_SKIP() << "Xvfb is not installed, or does not start";
    ASSERT_TRUE(screen_->input({"version"})) << "xdotool is not installed";
    scene_ = write_small_scene(folder_);
  }

  std::vector<std::string> arguments(const std::string& command, const std::vector<std::string>& more) const {
    std::vector<std::string> list = {command, scene_};
    if (std::find(more.begin(), more.end(), "--size") == more.end())
      list.insert(list.end(), {"--size", std::to_string(kWidth) + "x" + std::to_string(kHeight)});
    list.insert(list.end(), more.begin(), more.end());
    return list;
  }
  void start(const std::vector<std::string>& more) {
    std::vector<std::string> list = arguments("walk", more);
    list.insert(list.begin(), SPANRAY_PROGRAM);
    walk_ = std::make_unique<Process>(list, folder_.path(), std::vector<std::string>{"DISPLAY=" + screen_->name(), "SDL_VIDEODRIVER=x11", "WAYLAND_DISPLAY", "ASAN_OPTIONS=detect_leaks=0"});
    ASSERT_TRUE(until([&] { return (window_ = screen_->find("spanray")) != 0; })) << walk_->error();
    ASSERT_TRUE(until([&] { return screen_->title_of(window_).find(" ms") != std::string::npos; })) << screen_->title_of(window_);
    screen_->focus(window_);
    ASSERT_TRUE(screen_->input({"mousemove", "--window", std::to_string(window_), "60", "60"}));
  }
  // Polls until the condition holds; false after ten seconds or when the walk has ended.
  bool until(const std::function<bool()>& condition) {
    for (int i = 0; i < 500; ++i) {
      if (condition()) return true;
      if (walk_->wait(0)) return condition();
      ::usleep(20000);
    }
    return false;
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

  static XScreen* screen_;
  TempFolder folder_;
  std::string scene_;
  std::unique_ptr<Process> walk_;
  Window window_ = 0;
};
XScreen* WalkDisplay::screen_ = nullptr;

TEST_F(WalkDisplay, TheWindowShowsThePicturesBytesAndKeysSwitchTechniques) {
  const std::vector<std::string> camera = {"--camera", kSmallSceneCamera};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), camera.begin(), camera.end());
    return rendered(more);
  };
  const Image first = with({});
  size_t changes = 0;
  for (size_t i = 4; i < first.rgba.size(); i += 4) changes += std::memcmp(&first.rgba[i], &first.rgba[i - 4], 4) != 0;
  EXPECT_GT(changes, 500u) << "nearly blank";

  start(camera);
  EXPECT_TRUE(shows(first)) << "the first frame";
  for (const char* word : {" ms", "phong", "shadows ray", "reflections ray", "raster"})
    EXPECT_NE(std::string::npos, screen_->title_of(window_).find(word)) << screen_->title_of(window_);

  key("1");
  EXPECT_TRUE(shows(with({"--shading", "flat"}))) << "1: flat";
  key("2");
  EXPECT_TRUE(shows(with({"--shading", "gouraud"}))) << "2: Gouraud";
  key("3");
  EXPECT_TRUE(shows(first)) << "3: Phong";
  key("h");
  EXPECT_TRUE(shows(with({"--shadows", "none"}))) << "H: no shadows";
  EXPECT_FALSE(equal_colors(first, screen_->grab(window_)));
  key("r");
  EXPECT_TRUE(shows(with({"--shadows", "none", "--reflections", "none"}))) << "R: no reflections";
  key("h");
  key("r");
  EXPECT_TRUE(shows(first)) << "H and R again";
  key("v");
  EXPECT_TRUE(shows(with({"--visibility", "ray"}))) << "V: rays";
  EXPECT_TRUE(until([&] { return screen_->title_of(window_).find("phong, shadows ray, reflections ray, ray") != std::string::npos; }))
      << screen_->title_of(window_);
  key("F1");
  EXPECT_TRUE(until([&] { return walk_->error().find("W A S D") != std::string::npos; }));
  key("Escape");
  ASSERT_TRUE(walk_->wait(10));
  EXPECT_EQ(0, walk_->code()) << walk_->error();
}

TEST_F(WalkDisplay, MovingGivesTheCameraThatRenderRepeats) {
  start({"--camera", kSmallSceneCamera});
  const Image first = rendered({"--camera", kSmallSceneCamera});
  ASSERT_TRUE(shows(first));
  Image last = first;
  std::string printed;
  const auto expect_moved = [&](const char* what) {
    ASSERT_TRUE(until([&] { return !equal_colors(last, screen_->grab(window_)); })) << what;
    key("p");
    ASSERT_TRUE(until([&] { return walk_->out().size() > printed.size(); })) << what;
    const std::string all = walk_->out(), camera = all.substr(printed.size(), all.size() - printed.size() - 1);
    printed = all;
    last = rendered({"--camera", camera});
    EXPECT_TRUE(shows(last)) << what << " " << camera;
  };
  for (const char* name : {"w", "a", "s", "d", "q", "e"}) {
    ASSERT_TRUE(screen_->input({"keydown", name, "sleep", "0.15", "keyup", name}));
    expect_moved(name);
  }
  ASSERT_TRUE(screen_->input({"mousedown", "1", "sleep", "0.1", "mousemove_relative", "25", "10", "sleep", "0.1", "mouseup", "1"}));
  expect_moved("mouse with a button held");
  key("m");
  ASSERT_TRUE(screen_->input({"mousemove_relative", "--", "-15", "5"}));
  expect_moved("mouse after M");
  key("m");
  key("F12");
  ASSERT_TRUE(until([&] { return walk_->error().find("spanray-0001.png") != std::string::npos; })) << walk_->error();
  Result<Image> shot = read_png(folder_.file("spanray-0001.png"));
  ASSERT_TRUE(shot);
  EXPECT_TRUE(equal_colors(last, shot.value()));
  screen_->close(window_);
  ASSERT_TRUE(walk_->wait(10)) << "closing the window ends the walk";
  EXPECT_EQ(0, walk_->code()) << walk_->error();
}

TEST_F(WalkDisplay, ANewSizeIsRenderedAnew) {
  start({"--camera", kSmallSceneCamera});
  screen_->resize(window_, 200, 90);
  EXPECT_TRUE(shows(rendered({"--camera", kSmallSceneCamera, "--size", "200x90"}))) << screen_->title_of(window_);
  screen_->resize(window_, 33, 61);
  EXPECT_TRUE(shows(rendered({"--camera", kSmallSceneCamera, "--size", "33x61"}))) << screen_->title_of(window_);
  key("Escape");
  ASSERT_TRUE(walk_->wait(10));
  EXPECT_EQ(0, walk_->code());
}

TEST_F(WalkDisplay, FramesEndsTheWalkAndPrintsTheMedian) {
  std::vector<std::string> list = arguments("walk", {"--frames", "5"});
  const Ran ran = run_program(list, folder_.path(), {"DISPLAY=" + screen_->name(), "SDL_VIDEODRIVER=x11", "WAYLAND_DISPLAY", "ASAN_OPTIONS=detect_leaks=0"});
  EXPECT_EQ(0, ran.code) << ran.error;
  EXPECT_EQ(0u, ran.out.find("frames 5  median_ms ")) << ran.out;
}

}  // namespace
}  // namespace spanray
