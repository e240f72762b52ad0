// [[sphere]] of scene files: what it means, and what is refused, with file and line.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "support/scene_files.h"

namespace spanray {
namespace {

class SceneSpheres : public testing::Test {
 protected:
  SceneSpheres() {
    std::filesystem::copy(SPANRAY_SOURCE_DIR "/assets/textures/brick.png", folder_.file("t.png"));
    folder_.write("a.mtl",
                  "newmtl red\nKd 1 0 0\nnewmtl glass\nKd 1 1 1\nd 0.5\nnewmtl wood\nKd 1 1 1\nmap_Kd t.png\n"
                  "newmtl fence\nmap_d t.png\n");
    folder_.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
    folder_.write("none.obj", "mtllib a.mtl\n");
  }
  std::string write(const std::string& spheres, const char* obj = "a.obj") {
    return folder_.write("s.toml", "obj = \"" + std::string(obj) + "\"\n" + spheres);
  }
  void expect_error(const std::string& spheres, int line, std::initializer_list<const char*> parts) {
    const Error e = must_fail(write(spheres));
    EXPECT_EQ(e.line, line) << e.to_string() << "\n" << spheres;
    EXPECT_NE(e.file.find("s.toml"), std::string::npos) << e.to_string();
    for (const char* part : parts) EXPECT_NE(e.message.find(part), std::string::npos) << e.to_string() << "\n" << spheres;
  }
  TempFolder folder_;
};

constexpr const char* kGood = "[[sphere]]\ncenter = [1, 2, -3]\nradius = 0.5\nmaterial = \"red\"\n";

TEST_F(SceneSpheres, AreReadInOrderAndGrowTheBounds) {
  const Loaded loaded =
      must_load(write(std::string(kGood) + "[[sphere]]\ncenter = [0.1, 0, 0]\nradius = 4\nmaterial = \"glass\"\n"
                                           "[material.glass]\nopacity = 1\n"));
  const SceneData& scene = loaded.scene();
  ASSERT_EQ(scene.spheres.size(), 2u);
  EXPECT_EQ(loaded.loaded.scene.sphere_count(), 2u);
  EXPECT_EQ(scene.spheres[0].center[2], -3);
  EXPECT_EQ(scene.spheres[0].radius, 0.5f);
  EXPECT_EQ(scene.material_names[scene.spheres[0].material], "red");
  EXPECT_EQ(scene.spheres[1].center[0], 0.1f);
  EXPECT_EQ(scene.material_names[scene.spheres[1].material], "glass");
  EXPECT_EQ(scene.bounds_min[2], -4);
  EXPECT_EQ(scene.bounds_max[0], 4.1f);
  EXPECT_TRUE(scene.is_sphere(1)) << "after the only triangle";
  EXPECT_FALSE(scene.is_sphere(0));
  EXPECT_EQ(material_of(scene, 2), scene.spheres[1].material);
}

// The ground as a large ball: the near plane that fits the bounds would cut off what stands before the camera.
TEST_F(SceneSpheres, AGroundBallThatMovesTheNearPlaneBeyondTheTargetIsNoted) {
  const std::string ground = std::string(kGood) + "[[sphere]]\ncenter = [0, -1000, 0]\nradius = 1000\nmaterial = \"red\"\n";
  const std::string camera = "[[camera]]\nname = \"front\"\neye = [1, 2, -1]\ntarget = [1, 2, -3]\n";
  const auto noted = [&](const std::string& text) { return must_load(write(text)).count({"front", "before the near plane"}); };
  EXPECT_EQ(noted(ground + camera), 1);
  EXPECT_EQ(noted(ground + camera + "near = 0.01\n"), 0);
  EXPECT_EQ(noted(kGood + camera), 0);
}

TEST_F(SceneSpheres, AnObjWithoutFacesIsNoWarning) {
  const Loaded with = must_load(write(kGood, "none.obj")), without = must_load(write("", "none.obj"));
  EXPECT_EQ(with.count({"no triangles"}), 0) << with.all_messages();
  EXPECT_EQ(without.count({"no triangles"}), 1) << without.all_messages();
  EXPECT_EQ(with.scene().bounds_min[0], 0.5f) << "the bounds are those of the sphere alone";
  EXPECT_EQ(with.scene().bounds_max[1], 2.5f);
}

TEST_F(SceneSpheres, TheHashKnowsThem) {
  const uint64_t none = must_load(write("")).scene().hash, one = must_load(write(kGood)).scene().hash;
  std::string larger = kGood;
  larger.replace(larger.find("0.5"), 3, "0.6");
  EXPECT_NE(none, one);
  EXPECT_NE(one, must_load(write(larger)).scene().hash);
  EXPECT_EQ(none, must_load(folder_.file("a.obj")).scene().hash) << "a scene without spheres keeps its hash";
}

TEST_F(SceneSpheres, WhatIsWrongIsRefused) {
  expect_error("[[sphere]]\nradius = 1\nmaterial = \"red\"\n", 2, {"center"});
  expect_error("[[sphere]]\ncenter = [0, 0, 0]\nmaterial = \"red\"\n", 2, {"radius"});
  expect_error("[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n", 2, {"material"});
  expect_error("[[sphere]]\ncenter = [0, 0]\nradius = 1\nmaterial = \"red\"\n", 3, {"center"});
  expect_error("[[sphere]]\ncenter = [0, nan, 0]\nradius = 1\nmaterial = \"red\"\n", 3, {"center"});
  expect_error("[[sphere]]\ncenter = [0, 0, 0]\nradius = 0\nmaterial = \"red\"\n", 4, {"radius", "greater than 0"});
  expect_error("[[sphere]]\ncenter = [0, 0, 0]\nradius = 1e-60\nmaterial = \"red\"\n", 4, {"radius", "rounds to 0"});
  expect_error("[[sphere]]\ncenter = [0, 0, 0]\nradius = -2\nmaterial = \"red\"\n", 4, {"radius"});
  expect_error("[[sphere]]\ncenter = [0, 0, 0]\nradius = inf\nmaterial = \"red\"\n", 4, {"radius"});
  expect_error("[[sphere]]\ncenter = [9e29, 0, 0]\nradius = 5e29\nmaterial = \"red\"\n", 4, {"radius", "1e30"});
  expect_error("[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\ncolour = 1\nmaterial = \"red\"\n", 5, {"colour"});
  expect_error("[sphere]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"red\"\n", 2, {"sphere"});
  expect_error("[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"rde\"\n", 5, {"'rde'", "red"});
}

TEST_F(SceneSpheres, MaterialsThatSpheresCannotHaveAreRefused) {
  const auto of = [](const char* material) {
    return "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"" + std::string(material) + "\"\n";
  };
  expect_error(of("glass"), 5, {"'glass'", "translucent"});
  expect_error(of("wood"), 5, {"'wood'", "texture"});
  expect_error(of("fence"), 5, {"'fence'", "map_d"});
  expect_error(of("red") + "[material.red]\nopacity = 0.5\n", 5, {"'red'", "translucent"});
}

}  // namespace
}  // namespace spanray
