// What the window shows over and instead of the picture: panel, help, views, cameras; and loading.
#include <fstream>

#include "support/walk_display.h"

namespace spanray {
namespace {

constexpr int kPanelRight = 8 + 392;  // of panel.cpp: margin and width

bool is_amber(const uint8_t* p) { return p[0] == 240 && p[1] == 176 && p[2] == 82; }

size_t count_amber(const Image& image) {
  size_t count = 0;
  for (size_t i = 0; i < image.rgba.size(); i += 4) count += is_amber(&image.rgba[i]);
  return count;
}

// Rows in the middle of each chosen button, from the top: even those with text in them have a dozen amber pixels.
std::vector<int> amber_rows(const Image& image) {
  std::vector<int> rows;
  int begin = -1;
  for (int y = 0; y <= image.height; ++y) {
    int amber = 0;
    for (int x = 0; y < image.height && x < kPanelRight; ++x) amber += is_amber(&image.rgba[4 * static_cast<size_t>(y * image.width + x)]);
    if (amber >= 12 && begin < 0) begin = y;
    if (amber < 12 && begin >= 0) rows.push_back((begin + y) / 2), begin = -1;
  }
  return rows;
}

// Pixels to the right of the panel that differ; -1 for other sizes.
int differences_beside_panel(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.rgba.empty()) return -1;
  int count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = kPanelRight; x < a.width; ++x) {
      const size_t i = 4 * static_cast<size_t>(y * a.width + x);
      count += !std::equal(&a.rgba[i], &a.rgba[i] + 3, &b.rgba[i]);
    }
  return count;
}

// Where two pictures of one size differ; empty (left > right) where they do not.
struct Box {
  int left = 1 << 30, top = 1 << 30, right = -1, bottom = -1;
};
Box differing(const Image& a, const Image& b) {
  Box box;
  if (a.width != b.width || a.height != b.height) return box;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const size_t i = 4 * static_cast<size_t>(y * a.width + x);
      if (std::equal(&a.rgba[i], &a.rgba[i] + 3, &b.rgba[i])) continue;
      box.left = std::min(box.left, x), box.right = std::max(box.right, x);
      box.top = std::min(box.top, y), box.bottom = std::max(box.bottom, y);
    }
  return box;
}

class WalkPanel : public WalkDisplay {
 protected:
  void SetUp() override {
    WalkDisplay::SetUp();
    size_ = "1000x500";  // the narrowest window with the whole panel
  }
  const std::vector<std::string> camera_ = {"--camera", kSmallSceneCamera};
  std::vector<std::string> with(std::vector<std::string> more) const {
    more.insert(more.end(), camera_.begin(), camera_.end());
    return more;
  }
  // Opens the panel and waits until it is drawn and stays as it is; rows of the chosen buttons.
  std::vector<int> open_panel() {
    key("F2");
    std::vector<int> rows, before;
    EXPECT_TRUE(until([&] {
      before = rows, rows = amber_rows(screen_->grab(window_));
      return rows.size() >= 5 && rows == before;
    }));
    return rows;
  }
};

TEST_F(WalkPanel, CoversThePictureAndChangesNothingElse) {
  const Image picture = rendered(camera_);
  start(camera_);
  ASSERT_TRUE(shows(picture));
  ASSERT_GE(open_panel().size(), 5u);
  const Image covered = screen_->grab(window_);
  EXPECT_EQ(0, differences_beside_panel(picture, covered));
  const std::string before = printed_camera();
  // Dragging over the panel must not turn the view, and the wheel must not leave the panel.
  point(60, 40);
  ASSERT_TRUE(screen_->input({"mousedown", "1", "mousemove_relative", "90", "20", "mouseup", "1", "click", "4"}));
  EXPECT_EQ(before, printed_camera());
  EXPECT_EQ(0, differences_beside_panel(picture, screen_->grab(window_)));
  // Beside it, the same does.
  point(520, 40);
  ASSERT_TRUE(screen_->input({"mousedown", "1", "sleep", "0.1", "mousemove_relative", "30", "20", "sleep", "0.1", "mouseup", "1"}));
  EXPECT_TRUE(until([&] { return printed_camera() != before; }));
  key("F2");
  EXPECT_TRUE(shows(rendered({"--camera", printed_camera()})));
  leave();
}

TEST_F(WalkPanel, AClickOnASwitchDoesWhatItsKeyDoes) {
  const Image flat = rendered(with({"--shading", "flat"})), unlit = rendered(with({"--shading", "flat", "--shadows", "none"}));
  start(camera_);
  const std::vector<int> rows = open_panel();  // view, shading, shadows, reflections, visibility, ...
  ASSERT_GE(rows.size(), 5u);
  const int first_button = 8 + 104 + 12;  // the leftmost choice of each row: color, flat, none, none, raster
  click(first_button, rows[1]);
  EXPECT_TRUE(until([&] { return differences_beside_panel(flat, screen_->grab(window_)) == 0; })) << "flat";
  EXPECT_TRUE(until([&] { return titled("flat, shadows ray"); })) << screen_->title_of(window_);
  click(first_button, rows[2]);
  EXPECT_TRUE(until([&] { return differences_beside_panel(unlit, screen_->grab(window_)) == 0; })) << "no shadows";
  key("F2");
  EXPECT_TRUE(shows(unlit)) << "the panel is gone";
  key("h");
  EXPECT_TRUE(shows(flat)) << "the key undoes what the click did";
  leave();
}

TEST_F(WalkPanel, TheCameraIsCopiedToTheClipboard) {
  start(camera_);
  const std::vector<int> rows = open_panel();
  ASSERT_GE(rows.size(), 5u);
  click(8 + 60, rows[0] - 24);  // folds the switches, so that the camera comes up
  ASSERT_TRUE(until([&] { return amber_rows(screen_->grab(window_)).empty(); }));
  click(8 + 104 + 40, rows[0] + 96);
  EXPECT_TRUE(until([&] { return screen_->clipboard() == printed_camera(); })) << screen_->clipboard();
  leave();
}

TEST_F(WalkPanel, HelpAppearsInTheWindowAndOnStandardError) {
  const Image picture = rendered(camera_);
  start(camera_);
  ASSERT_TRUE(shows(picture));
  key("F1");
  EXPECT_TRUE(until([&] { return walk_->error().find("W A S D") != std::string::npos; }));
  const std::string said = walk_->error();
  EXPECT_TRUE(until([&] {
    const Image now = screen_->grab(window_);
    const size_t center = 4 * static_cast<size_t>(picture.height / 2 * picture.width + picture.width / 2);
    return now.width == picture.width && !std::equal(&now.rgba[center], &now.rgba[center] + 12, &picture.rgba[center]);
  }));
  key("F1");
  EXPECT_TRUE(shows(picture));
  EXPECT_EQ(said, walk_->error()) << "who closes help does not want to read it";
  leave();
}

TEST_F(WalkPanel, HelpStaysBesideThePanelWhichLeavesThePictureInSight) {
  for (const auto& [width, height] : {std::pair{1280, 720}, {640, 360}}) {
    size_ = std::to_string(width) + "x" + std::to_string(height);
    const Image picture = rendered(camera_);
    start(camera_);
    ASSERT_TRUE(shows(picture)) << size_;
    // Grabs until two in a row are equal and differ from `before`.
    const auto settled = [&](const Image& before) {
      Image now, last;
      EXPECT_TRUE(until([&] {
        last = std::move(now), now = screen_->grab(window_);
        return equal_colors(now, last) && !equal_colors(now, before);
      }));
      return now;
    };
    key("F2");
    const Image panel = settled(picture);
    const Box panel_box = differing(picture, panel);
    EXPECT_LE(panel_box.right, width * 2 / 5) << size_;
    EXPECT_GT(panel_box.right, width / 4) << size_;
    EXPECT_LT(panel_box.bottom, height - 1) << size_;
    key("F1");
    const Box help = differing(panel, settled(panel));
    EXPECT_GT(help.left, panel_box.right) << size_;
    EXPECT_LT(help.right, width - 1) << size_;
    EXPECT_GT(help.top, 0) << size_;
    EXPECT_LT(help.bottom, height - 1) << size_;
    EXPECT_GT(help.bottom - help.top, 16 * 17) << size_ << ": a row a key";
    key("F1");
    EXPECT_TRUE(until([&] { return equal_colors(panel, screen_->grab(window_)); })) << size_;
    // Below its stages the panel has headers that open and scroll.
    if (height == 360) {
      click(60, 338);
      const Image unfolded = settled(panel);
      ASSERT_TRUE(screen_->input({"click", "--repeat", "9", "5"}));
      EXPECT_LE(differing(picture, settled(unfolded)).right, width * 2 / 5);
    }
    leave();
  }
}

TEST_F(WalkPanel, HelpTakesThePlaceOfThePanelWhereBothDoNotFit) {
  size_ = "400x300";
  start(camera_);
  key("F1");
  Image help;
  const Image picture = rendered(camera_);
  ASSERT_TRUE(until([&] { return differing(picture, help = screen_->grab(window_)).right > 300; }));
  key("F2");
  printed_camera();  // F2 was heard
  EXPECT_TRUE(until([&] { return equal_colors(help, screen_->grab(window_)); }));
  key("F1");
  EXPECT_TRUE(until([&] {
    const Box box = differing(picture, screen_->grab(window_));
    return box.right >= 0 && box.right < 210;
  })) << "the panel was only hidden";
  leave();
}

TEST_F(WalkPanel, ViewKeysShowWhatRenderViewWrites) {
  size_ = "160x120";
  start(camera_);
  const std::pair<const char*, const char*> keys[] = {{"6", "depth"}, {"7", "ids"}, {"8", "normals"}, {"9", "uv"}, {"0", "materials"}, {"5", "color"}};
  for (const auto& [name, view] : keys) {
    key(name);
    EXPECT_TRUE(shows(rendered(with({"--view", view})))) << view;
  }
  EXPECT_TRUE(shows(rendered(camera_)));
  leave();
}

TEST_F(WalkPanel, CamerasAndPathOfTheScene) {
  size_ = "160x120";
  scene_ = folder_.write("two.toml",
                         "obj = \"room.obj\"\n[[camera]]\nname = \"one\"\neye = [0.5, 1.5, 4.5]\ntarget = [0.0, 0.6, 0.0]\n"
                         "[[camera]]\nname = \"two\"\neye = [2.5, 1.0, 3.5]\ntarget = [0.0, 0.6, 0.0]\n"
                         "[[path]]\ntime = 0.0\neye = [0.5, 1.5, 4.5]\ntarget = [0.0, 0.6, 0.0]\n"
                         "[[path]]\ntime = 0.5\neye = [1.5, 1.5, 3.5]\ntarget = [0.0, 0.6, 0.0]\n");
  start({});
  ASSERT_TRUE(shows(rendered({"--camera", "one"})));
  key("c");
  EXPECT_TRUE(shows(rendered({"--camera", "two"})));
  key("c");
  EXPECT_TRUE(shows(rendered({"--camera", "one"})));
  key("l");
  EXPECT_TRUE(shows(rendered({"--camera", "1.5,1.5,3.5,0,0.6,0,45"}))) << "the path's end";
  leave();
}

TEST_F(WalkPanel, ResizingWhileFramesAreMade) {
  start(with({"--isa", "scalar", "--threads", "1", "--max-bounces", "64"}));  // slow
  for (const auto& [width, height] : {std::pair{700, 520}, {300, 400}, {777, 333}, {512, 380}}) {
    ASSERT_TRUE(screen_->input({"keydown", "w", "sleep", "0.05", "keyup", "w"}));
    screen_->resize(window_, width, height);
  }
  const std::string camera = printed_camera();
  EXPECT_TRUE(shows(rendered({"--camera", camera, "--size", "512x380"})));
  leave();
}

TEST_F(WalkPanel, LeavesAtOnceThoughAFrameTakesLong) {
  size_ = "4000x4000";
  launch(with({"--isa", "scalar", "--threads", "1"}));  // ten seconds
  const auto closed = std::chrono::steady_clock::now();
  key("Escape");
  ASSERT_TRUE(walk_->wait(60));
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - closed).count(), 5);
  EXPECT_EQ(0, walk_->code()) << walk_->error();
}

class WalkLoading : public WalkPanel {
 protected:
  void SetUp() override {
    WalkPanel::SetUp();
    scene_ = folder_.file("long.obj");  // seconds on any machine
    std::ofstream file(scene_, std::ios::binary);
    std::string lines;
    for (int i = 0; i < 20000; ++i) lines += "v 0.25 1.5 " + std::to_string(i) + "\nvn 0 1 0\nvt 0.5 0.5\n";
    for (int i = 0; i < 200; ++i) file << lines;
    file << "f 1 2 3\n";
  }
};

TEST_F(WalkLoading, ShowsProgressAndCanBeClosed) {
  for (const bool by_key : {false, true}) {
    launch({});
    ASSERT_TRUE(until([&] { return titled("loading long.obj"); })) << screen_->title_of(window_);
    size_t first = 0;
    ASSERT_TRUE(until([&] { return (first = count_amber(screen_->grab(window_))) > 100; })) << "a bar";
    EXPECT_TRUE(until([&] { return count_amber(screen_->grab(window_)) > first; })) << "it grows";
    EXPECT_TRUE(titled("loading")) << "it was still loading";
    const auto closed = std::chrono::steady_clock::now();
    by_key ? key("Escape") : screen_->close(window_);
    ASSERT_TRUE(walk_->wait(60));
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - closed).count(), 10) << "does not load to the end";
    EXPECT_EQ(0, walk_->code()) << walk_->error();
    EXPECT_EQ("", walk_->error());
  }
}

}  // namespace
}  // namespace spanray
