// The reference against what can be computed on paper.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "reference/reference.h"
#include "support/scene_files.h"
#include "support/temp_folder.h"

namespace spanray {
namespace {

constexpr double kPi = std::numbers::pi;

// A scene of one mesh: material text, faces, lights and all that the scene file holds; and one pixel of it.
class ReferenceAnalytic : public ::testing::Test {
 protected:
  void load(const std::string& mtl, const std::string& obj, const std::string& toml) {
    folder_.write("a.mtl", mtl), folder_.write("a.obj", "mtllib a.mtl\n" + obj);
    const Loaded loaded = must_load(folder_.write("a.toml", "obj = \"a.obj\"\n" + toml));
    scene_ = loaded.loaded.scene, settings_ = scene_.settings();
    settings_.width = settings_.height = 1;
  }
  // Red, in linear light, along the view axis.
  double look(double ex, double ey, double ez, double tx, double ty, double tz) {
    Camera camera;
    camera.eye[0] = ex, camera.eye[1] = ey, camera.eye[2] = ez;
    camera.target[0] = tx, camera.target[1] = ty, camera.target[2] = tz;
    camera.up[0] = 0.1, camera.up[1] = 1, camera.up[2] = 0.3;
    camera.fov_y_degrees = 1;
    Framebuffer out;
    const Result<void> done = render_reference(scene_, camera, settings_, {}, out);
    EXPECT_TRUE(done) << done.error().to_string();
    return out.radiance[0];
  }
  TempFolder folder_;
  Scene scene_;
  Settings settings_;
};

const char* const kFloor = "v -9 0 -9\nv 9 0 -9\nv 9 0 9\nv -9 0 9\nvn 0 1 0\nusemtl m\nf 1//1 4//1 3//1 2//1\n";
std::string lamp(double y, const std::string& attenuation = "[0.0, 0.0, 1.0]") {
  return "ambient = [0.0, 0.0, 0.0]\n[[light]]\nkind = \"point\"\nposition = [0.0, " + std::to_string(y) +
         ", 0.0]\nintensity = [3.0, 3.0, 3.0]\nattenuation = " + attenuation + "\n";
}

TEST_F(ReferenceAnalytic, LambertAndTheInverseSquare) {
  for (const double height : {0.5, 1.0, 2.0, 4.0}) {
    load("newmtl m\nKd 0.6 0.6 0.6\nillum 1\n", kFloor, lamp(height));
    for (const double x : {0.0, 0.7, 3.0}) {
      const double d = std::hypot(x, height), want = 0.6 / kPi * 3 / (d * d) * (height / d);
      EXPECT_NEAR(look(x + 1, 2, 1, x, 0, 0), want, 1e-6 * want) << height << " " << x;
      settings_.shading = Shading::kFlat;
      EXPECT_LT(look(x + 1, -2, 1, x, 0, 0), 1e-30) << "light from above does not reach what is seen from below";
      settings_.shading = Shading::kPhong;
    }
  }
}

TEST_F(ReferenceAnalytic, DirectionalLightAndAttenuationByItsPolynomial) {
  load("newmtl m\nKd 0.5 0.5 0.5\nillum 1\n", kFloor,
       "ambient = [0.0, 0.0, 0.0]\n[[light]]\nkind = \"directional\"\ndirection = [3.0, -4.0, 0.0]\nintensity = [2.0, 2.0, "
       "2.0]\n");
  EXPECT_NEAR(look(1, 3, 1, 0, 0, 0), 0.5 / kPi * 2 * 0.8, 1e-6);
  load("newmtl m\nKd 0.5 0.5 0.5\nillum 1\n", kFloor, lamp(2, "[0.5, 0.25, 0.125]"));
  EXPECT_NEAR(look(1, 3, 1, 0, 0, 0), 0.5 / kPi * 3 / (0.5 + 0.25 * 2 + 0.125 * 4), 1e-6);
}

TEST_F(ReferenceAnalytic, HighlightIsTheCosineOfTheHalfVectorToItsPower) {
  load("newmtl m\nKd 0 0 0\nKs 0.4 0.4 0.4\nNs 30\nillum 2\n", kFloor, lamp(2));
  settings_.reflections = Reflections::kNone;
  EXPECT_NEAR(look(0, 5, 0, 0, 0, 0), 0.4 / kPi * 3 / 4, 1e-6) << "eye and light in one line";
  const double angle = std::atan2(1.5, 3.0);  // of the view from the normal; the half vector lies half as far
  EXPECT_NEAR(look(1.5, 3, 0, 0, 0, 0), 0.4 / kPi * 3 / 4 * std::pow(std::cos(angle / 2), 30), 1e-6);
}

TEST_F(ReferenceAnalytic, AShadowIsAllOrNothing) {
  const std::string lid = "v -1 1 -1\nv 1 1 -1\nv 1 1 1\nv -1 1 1\nf 5 8 7 6\n";
  load("newmtl m\nKd 0.6 0.6 0.6\nillum 1\n", kFloor + lid, lamp(2));  // its shadow reaches from -2 to 2
  for (const double x : {1.0, 1.99, 1.9999}) EXPECT_EQ(look(x + 3, 0.5, 0.1, x, 0, 0), 0) << x;
  for (const double x : {2.0001, 2.01, 4.0}) {
    const double d = std::hypot(x, 2);
    EXPECT_NEAR(look(x + 3, 0.5, 0.1, x, 0, 0), 0.6 / kPi * 3 * 2 / (d * d * d), 1e-6) << x;
  }
  settings_.shadows = Shadows::kNone;
  EXPECT_GT(look(4, 0.5, 0.1, 1, 0, 0), 0.05);
}

const char* const kBox =
    "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\nusemtl m\n"
    "f 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 4 3 7 8\nf 1 4 8 5\nf 2 6 7 3\n";

// A furnace: in a closed box of glowing mirrors every ray gathers a geometric series, whatever way it takes. The lamp is
// outside.
TEST_F(ReferenceAnalytic, AFurnaceOfMirrorsGivesTheGeometricSeries) {
  load("newmtl m\nKd 0 0 0\nKa 0 0 0\nKs 0.5 0.5 0.5\nKe 0.25 0.25 0.25\nillum 3\n", kBox,
       "background = [9.0, 9.0, 9.0]\n" + lamp(3));
  for (const int bounces : {0, 1, 2, 5, 20}) {
    settings_.max_bounces = bounces;
    const double want = 0.25 * (1 - std::pow(0.5, bounces + 1)) / 0.5;
    for (const auto& [x, y, z] : {std::array{1.0, 0.3, 0.2}, {-0.7, 1.0, 0.4}, {0.999, 0.998, 1.0}, {-1.0, -0.01, 0.02}})
      EXPECT_NEAR(look(0.1, 0.2, -0.3, x, y, z), want, 1e-6) << bounces;
  }
  settings_.reflections = Reflections::kNone;
  EXPECT_NEAR(look(0.1, 0.2, -0.3, 1, 0.3, 0.2), 0.25, 1e-7);
}

// A lamp outside of the closed box: only ambient light is left inside.
TEST_F(ReferenceAnalytic, AmbientLightIsReflectedAsItIs) {
  load("newmtl m\nKd 0.3 0.3 0.3\nKa 0.5 0.5 0.5\nillum 1\n", kBox, lamp(3));
  EXPECT_EQ(look(0, 0, 0, 1, 0.2, 0.1), 0);
  std::string toml = lamp(3);
  load("newmtl m\nKd 0.3 0.3 0.3\nKa 0.5 0.5 0.5\nillum 1\n", kBox,
       toml.replace(toml.find("0.0, 0.0, 0.0"), 13, "0.8, 0.8, 0.8"));
  EXPECT_NEAR(look(0, 0, 0, 1, 0.2, 0.1), 0.4, 1e-7);
}

TEST_F(ReferenceAnalytic, AMirrorSeesWhatStandsBeforeIt) {
  const std::string wall = "v 5 -9 -9\nv 5 9 -9\nv 5 9 9\nv 5 -9 9\nusemtl glow\nf 5 6 7 8\n";
  load("newmtl m\nKd 0 0 0\nKa 0 0 0\nKs 0.8 0.8 0.8\nillum 3\nnewmtl glow\nKd 0 0 0\nKa 0 0 0\nKe 0.5 0.5 0.5\nillum 1\n",
       kFloor + wall,
       "ambient = [0.0, 0.0, 0.0]\nbackground = [0.125, 0.125, 0.125]\n[[light]]\nkind = \"point\"\nposition = [0.0, -5.0, "
       "0.0]\nintensity = [1.0, 1.0, 1.0]\n");
  EXPECT_NEAR(look(-3, 3, 0, 0, 0, 0), 0.8 * 0.5, 1e-6) << "reflected to (5, 5, 0)";
  EXPECT_NEAR(look(3, 3, 0, 0, 0, 0), 0.8 * 0.125, 1e-6) << "reflected away from the wall";
}

TEST_F(ReferenceAnalytic, LayersBlendInOrderOfDepth) {
  const std::string panes =
      "v -9 -9 1\nv 9 -9 1\nv 0 9 1\nv -9 -9 2\nv 9 -9 2\nv 0 9 2\nusemtl near\nf 1 2 3\nusemtl far\nf 4 5 6\n";
  load(
      "newmtl near\nKd 0 0 0\nKa 0 0 0\nKe 1 1 1\nd 0.25\nillum 2\nnewmtl far\nKd 0 0 0\nKa 0 0 0\nKe 0.5 0.5 0.5\nd "
      "0.5\nillum 2\n",
      panes, "ambient = [0.0, 0.0, 0.0]\nbackground = [0.125, 0.125, 0.125]\n");
  EXPECT_NEAR(look(0, 0, 0, 0, 0, 3), 0.25 * 1 + 0.75 * (0.5 * 0.5 + 0.5 * 0.125), 1e-6);
  EXPECT_NEAR(look(0, 0, 3, 0, 0, 0), 0.5 * 0.5 + 0.5 * (0.25 * 1 + 0.75 * 0.125), 1e-6) << "from the other side";
  settings_.transparency = Transparency::kNone;
  EXPECT_NEAR(look(0, 0, 0, 0, 0, 3), 1, 1e-6);
}

// An edge, sampled finely, covers what geometry says: here a half plane that fills 0.3 of the pixel.
TEST_F(ReferenceAnalytic, AGridOfSamplesMeasuresCoverage) {
  load("newmtl m\nKd 0 0 0\nKa 0 0 0\nKe 1 1 1\nillum 1\n", "v 0 -9 0\nv 9 -9 0\nv 9 9 0\nv 0 9 0\nusemtl m\nf 1 2 3 4\n",
       "ambient = [0.0, 0.0, 0.0]\nbackground = [0.0, 0.0, 0.0]\n");
  Camera camera;
  camera.eye[0] = camera.target[0] = -0.2 * 2 * std::tan(0.5 * kPi / 180), camera.eye[2] = 1, camera.fov_y_degrees = 1;
  Framebuffer out;
  for (const int grid : {2, 10, 40}) {
    ReferenceOptions options;
    options.grid = grid;
    ASSERT_TRUE(render_reference(scene_, camera, settings_, options, out));
    EXPECT_NEAR(out.radiance[0], 0.3, 0.51 / (grid * grid)) << grid << ": each sample has a column of its own";
  }
}

TEST_F(ReferenceAnalytic, WhatItCannotDoIsAnError) {
  load("newmtl m\nKd 0.5 0.5 0.5\n", kFloor, "");
  const auto data = std::make_shared<SceneData>();
  data->materials.resize(1), data->material_names = {"toon"};
  data->materials[0].reflectance = 7;
  Framebuffer out;
  const Result<void> done = render_reference(Scene(data), scene_.cameras()[0], settings_, {}, out);
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("material toon has a reflectance that the reference does not model"), std::string::npos);
  settings_.width = 0;
  EXPECT_FALSE(render_reference(scene_, scene_.cameras()[0], settings_, {}, out));
}

}  // namespace
}  // namespace spanray
