// `render --view`: what the pixels of each view mean.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstring>
#include <set>
#include <tuple>

#include "simd/isa.h"
#include "spanray/image.h"
#include "support/program.h"
#include "support/small_scene.h"

namespace spanray {
namespace {

constexpr int kWidth = 96, kHeight = 64;

class ProgramView : public ::testing::Test {
 protected:
  void SetUp() override {
    scene_ = write_small_scene(folder_);
    folder_.write("square.mtl", "newmtl paper\nKd 0.8 0.8 0.8\nillum 1\nnewmtl other\nKd 0.1 0.2 0.3\n");
    // Seen from +z, 2 units wide, one texture square a unit; the second triangle is of another material.
    folder_.write("square.obj",
                  "mtllib square.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 2 0\nvt 2 2\nvt 0 2\n"
                  "usemtl paper\nf 1/1 2/2 3/3\nusemtl other\nf 1/1 3/3 4/4\n");
  }
  Image view(const std::string& name, const std::string& scene, const std::string& camera, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"render", scene, "--size", std::to_string(kWidth) + "x" + std::to_string(kHeight), "--camera",
                                          camera, "--view", name, "--out", "view.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Ran ran = run_program(arguments, folder_.path());
    EXPECT_EQ(0, ran.code) << ran.error;
    Result<Image> image = read_png(folder_.file("view.png"));
    return image ? image.value() : Image{kWidth, kHeight, std::vector<uint8_t>(4 * kWidth * kHeight)};
  }
  Image square(const std::string& name) { return view(name, "square.obj", "0,0,4,0,0,0,40"); }
  static const uint8_t* at(const Image& image, int x, int y) { return &image.rgba[4 * static_cast<size_t>(y * kWidth + x)]; }
  static uint32_t color(const uint8_t* p) { return static_cast<uint32_t>(p[0]) << 16 | static_cast<uint32_t>(p[1]) << 8 | p[2]; }
  static std::set<uint32_t> colors(const Image& image) {
    std::set<uint32_t> all;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) all.insert(color(at(image, x, y)));
    return all;
  }
  TempFolder folder_;
  std::string scene_;
};

TEST_F(ProgramView, DepthIsHalfWayAtTheTarget) {
  // The square lies at distance 4, the target at 8: 255 * 64 / (64 + 16).
  const Image image = view("depth", "square.obj", "0,0,4,0,0,-4,40");
  EXPECT_EQ((std::set<uint32_t>{0, 204 * 0x10101}), colors(image));
  // And here at 2: 255 * 4 / (4 + 16).
  EXPECT_EQ((std::set<uint32_t>{0, 51 * 0x10101}), colors(view("depth", "square.obj", "0,0,4,0,0,2,40")));
  EXPECT_EQ(0u, color(at(image, 0, 0))) << "background";
}

TEST_F(ProgramView, NormalsAreAxesAsChannels) {
  EXPECT_EQ((std::set<uint32_t>{0, 0x8080ff}), colors(square("normals"))) << "toward +z";
  const Image floor = view("normals", scene_, "0,3,0.1,0,0,0,20");
  EXPECT_EQ(0x80ff80u, color(at(floor, 3, 3))) << "toward +y";
}

TEST_F(ProgramView, UvIsFractionAndParity) {
  const Image image = square("uv");
  // Of the square's 2 x 2 units, 64 pixels are 8 tan(20 degrees) = 2.912 units.
  for (const auto& [x, y] : {std::pair{30, 20}, {60, 20}, {30, 45}, {60, 50}, {50, 33}}) {
    const double unit = 8 * std::tan(20 * 3.14159265358979 / 180) / kHeight;
    const double u = (x + 0.5 - kWidth / 2.0) * unit + 1, v = (kHeight / 2.0 - y - 0.5) * unit + 1;
    const uint8_t* p = at(image, x, y);
    EXPECT_NEAR(255 * (u - std::floor(u)), p[0], 0.6) << x << "," << y;
    EXPECT_NEAR(255 * (v - std::floor(v)), p[1], 0.6) << x << "," << y;
    EXPECT_EQ(std::fmod(std::floor(u) + std::floor(v), 2) != 0 ? 192 : 64, p[2]) << x << "," << y;
  }
}

TEST_F(ProgramView, IdsAndMaterialsHaveAColorEach) {
  EXPECT_EQ(3u, colors(square("ids")).size()) << "two triangles and the background";
  EXPECT_EQ(3u, colors(square("materials")).size()) << "two materials and the background";
  const std::set<uint32_t> ids = colors(view("ids", scene_, kSmallSceneCamera)), materials = colors(view("materials", scene_, kSmallSceneCamera));
  EXPECT_GT(ids.size(), materials.size());
  EXPECT_EQ(4u, materials.size()) << "floor, mirror, red, background; glass is translucent";
  EXPECT_TRUE(ids.count(0) == 1 && materials.count(0) == 1);
}

TEST_F(ProgramView, WhatAViewDoesNotShowIsLeftOut) {
  // A request for radiance has the whole frame made: the view's bytes must be those of the frame that leaves out the rest.
  const std::string gauze = SPANRAY_SOURCE_DIR "/assets/gauze.toml";  // cut-outs, screen-door, bump
  for (const char* name : {"depth", "ids", "normals", "uv", "materials"})
    for (const auto& [scene, camera, visibility] :
         {std::tuple<std::string, std::string, std::string>{scene_, kSmallSceneCamera, "ray"}, {gauze, "gate", "raster"}})
      EXPECT_TRUE(view(name, scene, camera, {"--visibility", visibility, "--radiance", "all.pfm"}).rgba ==
                  view(name, scene, camera, {"--visibility", visibility}).rgba)
          << name << " " << scene;
  const auto needed = [&](const char* name) {
    view(name, gauze, "gate", {"--stats", "s.json"});
    const nlohmann::json stats = nlohmann::json::parse(read_text(folder_.file("s.json")));
    std::set<std::string> stages;
    for (const auto& line : stats["plan"])
      if (line["needed"].get<bool>()) stages.insert(line["stage"].get<std::string>());
    return stages;
  };
  const std::set<std::string> color = needed("color"), ids = needed("ids"), normals = needed("normals");
  for (const char* stage : {"shadow rays", "BVH", "textures", "bump"}) {
    EXPECT_TRUE(color.count(stage)) << stage;
    EXPECT_FALSE(ids.count(stage)) << stage;
    EXPECT_EQ(stage == std::string("bump"), normals.count(stage) == 1) << stage;
  }
}

TEST_F(ProgramView, AreTheSameEverywhereAndColorIsThePicture) {
  for (const char* name : {"depth", "ids", "normals", "uv", "materials"}) {
    const Image expected = view(name, scene_, kSmallSceneCamera);
    for (const Isa isa : {Isa::kScalar, Isa::kAvx2}) {
      if (!isa_supported(isa)) continue;
      EXPECT_TRUE(expected.rgba == view(name, scene_, kSmallSceneCamera, {"--isa", std::string(isa_name(isa)), "--threads", "3"}).rgba) << name;
    }
    EXPECT_TRUE(expected.rgba == view(name, scene_, kSmallSceneCamera, {"--shadows", "none", "--reflections", "none"}).rgba) << name;
  }
  const Image color = view("color", scene_, kSmallSceneCamera);
  const Ran plain = run_program({"render", scene_, "--size", "96x64", "--camera", kSmallSceneCamera, "--out", "plain.png"}, folder_.path());
  ASSERT_EQ(0, plain.code);
  EXPECT_TRUE(color.rgba == read_png(folder_.file("plain.png")).value().rgba);
  const Ran wrong = run_program({"render", scene_, "--view", "normls", "--hash"}, folder_.path());
  EXPECT_EQ(2, wrong.code);
  EXPECT_NE(std::string::npos, wrong.error.find("did you mean 'normals'")) << wrong.error;
}

}  // namespace
}  // namespace spanray
