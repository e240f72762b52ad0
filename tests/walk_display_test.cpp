// The walkthrough in a real window: its pixels are compared with what `render` gives.
#include <cstring>

#include "support/walk_display.h"

namespace spanray {
namespace {

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
  EXPECT_TRUE(until([&] { return titled("phong, shadows ray, reflections ray, ray"); })) << screen_->title_of(window_);
  leave();
}

TEST_F(WalkDisplay, MovingGivesTheCameraThatRenderRepeats) {
  start({"--camera", kSmallSceneCamera});
  const Image first = rendered({"--camera", kSmallSceneCamera});
  ASSERT_TRUE(shows(first));
  Image last = first;
  const auto expect_moved = [&](const char* what) {
    ASSERT_TRUE(until([&] { return !equal_colors(last, screen_->grab(window_)); })) << what;
    const std::string camera = printed_camera();
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
  ASSERT_TRUE(walk_->wait(60)) << "closing the window ends the walk";
  EXPECT_EQ(0, walk_->code()) << walk_->error();
}

TEST_F(WalkDisplay, ANewSizeIsRenderedAnew) {
  start({"--camera", kSmallSceneCamera});
  screen_->resize(window_, 200, 90);
  EXPECT_TRUE(shows(rendered({"--camera", kSmallSceneCamera, "--size", "200x90"}))) << screen_->title_of(window_);
  screen_->resize(window_, 33, 61);
  EXPECT_TRUE(shows(rendered({"--camera", kSmallSceneCamera, "--size", "33x61"}))) << screen_->title_of(window_);
  leave();
}

TEST_F(WalkDisplay, FramesEndsTheWalkAndPrintsTheMedian) {
  std::vector<std::string> list = arguments("walk", {"--frames", "5"});
  const Ran ran = run_program(list, folder_.path(), environment());
  EXPECT_EQ(0, ran.code) << ran.error;
  EXPECT_EQ(0u, ran.out.find("frames 5  median_ms ")) << ran.out;
}

}  // namespace
}  // namespace spanray
