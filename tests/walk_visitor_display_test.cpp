// Walking into walls, and naming what is under the pointer, in a real window.
#include "spanray/query.h"
#include "support/walk_display.h"

#include <cmath>
#include <cstdio>
#include <set>

namespace spanray {
namespace {

class WalkVisitor : public WalkDisplay {
 protected:
  // Holds a key for a while; where the eye is then.
  double eye_z_after(const std::string& name, const char* seconds) {
    EXPECT_TRUE(screen_->input({"keydown", name, "sleep", seconds, "keyup", name}));
    double x = 0, y = 0, z = 1e9;
    const std::string camera = printed_camera();
    EXPECT_EQ(3, std::sscanf(camera.c_str(), "%lf,%lf,%lf", &x, &y, &z)) << camera;
    return z;
  }
};

// The mirror is a wall at z = -2.
TEST_F(WalkVisitor, AWallStopsWhoWalksUntilNIsPressed) {
  start({"--camera", "0,1,-1.5,0,1,-2,50", "--radius", "0.125"});
  double z = -1.5;
  for (int i = 0; i < 40 && !(z < -1.8749); ++i) {
    const double before = z;
    z = eye_z_after("w", "0.3");
    ASSERT_LE(z, before);
    ASSERT_GT(z, -1.875) << "nearer than the radius";
  }
  EXPECT_NEAR(-1.875, z, 2e-4);
  EXPECT_NEAR(z, eye_z_after("w", "0.5"), 2e-4) << "it holds";
  EXPECT_LT(z, eye_z_after("s", "0.2")) << "and lets go";
  key("n");
  for (int i = 0; i < 40 && z > -2.2; ++i) z = eye_z_after("w", "0.3");
  EXPECT_LT(z, -2.2) << "through it";
  key("n");
  const double behind = eye_z_after("s", "0.1");
  for (int i = 0; i < 12; ++i) z = eye_z_after("s", "0.3");
  EXPECT_GE(z, behind);
  EXPECT_LT(z, -2.125) << "from behind, too";
  EXPECT_TRUE(shows(rendered({"--camera", printed_camera()})));
  leave();
}

TEST_F(WalkVisitor, RadiusZeroFliesThrough) {
  start({"--camera", "0,1,-1.5,0,1,-2,50", "--radius", "0"});
  double z = -1.5;
  for (int i = 0; i < 40 && z > -2.2; ++i) z = eye_z_after("w", "0.3");
  EXPECT_LT(z, -2.2);
  leave();
}

TEST_F(WalkVisitor, NamesWhatIsUnderThePointer) {
  size_ = "1000x500";
  scene_ = folder_.file("named.obj");
  std::string text = read_text(folder_.file("room.obj"));
  text.replace(text.find("usemtl red"), 0, "o pyramid\ng red things\n");
  folder_.write("named.obj", text);
  start({"--camera", kSmallSceneCamera});
  Result<LoadedScene> loaded = load_scene(scene_);
  ASSERT_TRUE(loaded);
  Camera camera = loaded.value().scene.cameras()[0];
  const double eye[3] = {0.5, 1.5, 4.5}, target[3] = {0, 0.6, 0};
  std::copy_n(eye, 3, camera.eye), std::copy_n(target, 3, camera.target), camera.fov_y_degrees = 50;
  const SceneQuery query(loaded.value().scene);
  Settings shown;
  shown.width = 1000, shown.height = 500;
  std::set<std::string> seen;
  for (const auto& [x, y] : {std::pair{440, 330}, {560, 200}, {560, 280}, {500, 420}, {480, 150}, {900, 20}}) {
    point(x, y);
    const std::string line = printed("i"), place = std::to_string(x) + "," + std::to_string(y) + ": ";
    const auto hit = query.pixel(camera, shown, x, y);
    ASSERT_TRUE(hit);
    EXPECT_EQ(0u, line.find(place)) << line;
    if (!hit.value()) {
      EXPECT_EQ(place + "background", line);
      seen.insert("background");
      continue;
    }
    const TriangleName& name = hit.value()->name;
    std::string want = place + "triangle " + std::to_string(name.triangle) + ", material " + std::string(name.material);
    if (name.material == "red") want += ", object pyramid, group red things";
    EXPECT_EQ(0u, line.find(want + ", ")) << line << " instead of " << want;
    double away = 0;
    EXPECT_EQ(1, std::sscanf(line.c_str() + std::min(line.size(), want.size() + 2), "%lf away", &away)) << line;
    const double* p = hit.value()->position;
    EXPECT_NEAR(std::sqrt(std::pow(p[0] - eye[0], 2) + std::pow(p[1] - eye[1], 2) + std::pow(p[2] - eye[2], 2)), away, 1e-3 * away);
    seen.insert(std::string(name.material));
  }
  EXPECT_GE(seen.size(), 4u);
  EXPECT_EQ(1u, seen.count("red"));
  // The panel says the same while the pointer moves, and keeps it while the pointer is over the panel. What the window shows follows what
  // it has heard: pictures are compared again until they are all of the same moment.
  key("F2");
  const auto panel_at = [&](int x, int y) {
    point(x, y);
    (void)printed("i");  // it has heard of the pointer
    Image now, last;
    int equal = 0;
    EXPECT_TRUE(until([&] {
      ::usleep(80000);
      last = std::move(now), now = screen_->grab(window_);
      equal = equal_colors(now, last) ? equal + 1 : 0;
      return equal >= 2;
    }));
    return now;
  };
  Image floor, pyramid;
  EXPECT_TRUE(until([&] {
    floor = panel_at(500, 470), pyramid = panel_at(560, 280);
    return !equal_colors(floor, pyramid) && equal_colors(floor, panel_at(500, 470)) && equal_colors(pyramid, panel_at(560, 280));
  })) << "other names, and back";
  EXPECT_TRUE(until([&] {
    pyramid = panel_at(560, 280);
    return !equal_colors(floor, pyramid) && equal_colors(pyramid, panel_at(60, 60));
  })) << "over the panel";
  leave();
}

}  // namespace
}  // namespace spanray
