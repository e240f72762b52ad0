// [[plane]] of scene files: what it means, and what is refused, with file and line.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "support/scene_files.h"

namespace spanray {
namespace {

class ScenePlanes : public testing::Test {
 protected:
  ScenePlanes() {
    std::filesystem::copy(SPANRAY_SOURCE_DIR "/assets/textures/brick.png", folder_.file("t.png"));
    folder_.write("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl glass\nKd 1 1 1\nd 0.5\nnewmtl wood\nKd 1 1 1\nmap_Kd t.png\n");
    folder_.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
    folder_.write("none.obj", "mtllib a.mtl\n");
  }
  std::string write(const std::string& planes, const char* obj = "a.obj") {
    return folder_.write("s.toml", "obj = \"" + std::string(obj) + "\"\n" + planes);
  }
  void expect_error(const std::string& planes, int line, std::initializer_list<const char*> parts) {
    const Error e = must_fail(write(planes));
    EXPECT_EQ(e.line, line) << e.to_string() << "\n" << planes;
    EXPECT_NE(e.file.find("s.toml"), std::string::npos) << e.to_string();
    for (const char* part : parts) EXPECT_NE(e.message.find(part), std::string::npos) << e.to_string() << "\n" << planes;
  }
  TempFolder folder_;
};

constexpr const char* kGood = "[[plane]]\npoint = [1000, 2, -3]\nnormal = [0, 3, 12]\nmaterial = \"red\"\n";
constexpr const char* kBall = "[[sphere]]\ncenter = [1, 2, -3]\nradius = 0.5\nmaterial = \"red\"\n";

TEST_F(ScenePlanes, ComeAfterSpheresAndLeaveTheBounds) {
  const Loaded loaded = must_load(
      write(std::string(kGood) + kBall + "[[plane]]\npoint = [0, 0, 0]\nnormal = [0.1, 1e-3, 0]\nmaterial = \"red\"\n"));
  const SceneData& scene = loaded.scene();
  ASSERT_EQ(scene.planes.size(), 2u);
  EXPECT_EQ(loaded.loaded.scene.plane_count(), 2u);
  EXPECT_EQ(scene.planes[0].point[0], 1000);
  EXPECT_EQ(scene.planes[0].normal[0], 0);
  EXPECT_EQ(scene.planes[0].normal[1], 0.375f) << "scaled by a power of two";
  EXPECT_EQ(scene.planes[0].normal[2], 1.5f);
  EXPECT_EQ(scene.planes[1].normal[0], static_cast<float>(0.1 * 16));
  EXPECT_EQ(scene.planes[1].normal[1], static_cast<float>(1e-3 * 16));
  EXPECT_EQ(scene.material_names[scene.planes[0].material], "red");
  EXPECT_TRUE(scene.is_triangle(0) && !scene.is_triangle(1) && !scene.is_sphere(0) && !scene.is_plane(0));
  EXPECT_TRUE(scene.is_sphere(1) && !scene.is_plane(1));
  EXPECT_TRUE(scene.is_plane(2) && scene.is_plane(3) && !scene.is_sphere(2) && !scene.is_plane(4));
  EXPECT_FALSE(scene.is_triangle(kNoPrimitive) || scene.is_sphere(kNoPrimitive) || scene.is_plane(kNoPrimitive));
  EXPECT_EQ(material_of(scene, 3), scene.planes[1].material);
  EXPECT_EQ(scene.bounds_max[0], 1.5f) << "that of the sphere";
  EXPECT_EQ(scene.bounds_min[2], -3.5f);
}

TEST_F(ScenePlanes, OfPlanesAloneTheBoundsAreTheirPoints) {
  const Loaded loaded = must_load(
      write(std::string(kGood) + "[[plane]]\npoint = [0, 5, 0]\nnormal = [0, 1, 0]\nmaterial = \"red\"\n", "none.obj"));
  EXPECT_EQ(loaded.count({"no triangles"}), 0) << loaded.all_messages();
  EXPECT_EQ(loaded.scene().bounds_min[1], 2);
  EXPECT_EQ(loaded.scene().bounds_max[1], 5);
  EXPECT_EQ(loaded.scene().bounds_max[0], 1000);
  const Loaded ball_too = must_load(write(std::string(kGood) + kBall, "none.obj"));
  EXPECT_EQ(ball_too.scene().bounds_max[0], 1.5f);
}

TEST_F(ScenePlanes, TheHashKnowsThem) {
  const uint64_t none = must_load(write("")).scene().hash, one = must_load(write(kGood)).scene().hash;
  std::string other = kGood;
  other.replace(other.find("12"), 2, "13");
  EXPECT_NE(none, one);
  EXPECT_NE(one, must_load(write(other)).scene().hash);
  std::string longer = kGood;
  longer.replace(longer.find("3, 12"), 5, "6, 24");
  EXPECT_EQ(one, must_load(write(longer)).scene().hash) << "the same plane";
}

TEST_F(ScenePlanes, WhatIsWrongIsRefused) {
  expect_error("[[plane]]\nnormal = [0, 1, 0]\nmaterial = \"red\"\n", 2, {"point"});
  expect_error("[[plane]]\npoint = [0, 0, 0]\nmaterial = \"red\"\n", 2, {"normal"});
  expect_error("[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\n", 2, {"material"});
  expect_error("[[plane]]\npoint = [0, 0]\nnormal = [0, 1, 0]\nmaterial = \"red\"\n", 3, {"point"});
  expect_error("[[plane]]\npoint = [0, inf, 0]\nnormal = [0, 1, 0]\nmaterial = \"red\"\n", 3, {"point"});
  expect_error("[[plane]]\npoint = [0, 1e31, 0]\nnormal = [0, 1, 0]\nmaterial = \"red\"\n", 3, {"point"});
  expect_error("[[plane]]\npoint = [0, 0, 0]\nnormal = [0, nan, 0]\nmaterial = \"red\"\n", 4, {"normal"});
  expect_error("[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 0, 0]\nmaterial = \"red\"\n", 4, {"normal", "no length"});
  expect_error("[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\noffset = 1\nmaterial = \"red\"\n", 5, {"offset"});
  expect_error("[plane]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nmaterial = \"red\"\n", 2, {"plane"});
  expect_error("[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nmaterial = \"rde\"\n", 5, {"plane", "'rde'", "red"});
  std::string many;
  for (int i = 0; i <= 1024; ++i) many += kGood;
  expect_error(many, 2, {"plane", "1024"});
}

TEST_F(ScenePlanes, MaterialsThatPlanesCannotHaveAreRefused) {
  const auto of = [](const char* material) {
    return "[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nmaterial = \"" + std::string(material) + "\"\n";
  };
  expect_error(of("glass"), 5, {"plane", "'glass'", "translucent", "planes are opaque"});
  expect_error(of("wood"), 5, {"plane", "'wood'", "texture"});
  expect_error(of("red") + "[material.red]\nopacity = 0.5\n", 5, {"'red'", "translucent"});
}

}  // namespace
}  // namespace spanray
