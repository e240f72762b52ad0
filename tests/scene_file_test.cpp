// Scene files (TOML), and what is chosen where a scene names no camera or light.
#include <gtest/gtest.h>

#include <cmath>

#include "math/elementary.h"
#include "math/vec.h"
#include "scene/default_view.h"
#include "support/encode_fixture.h"
#include "support/scene_files.h"

namespace spanray {
namespace {

constexpr const char* kTriangleObj = "mtllib a.mtl\nv -1 0 0\nv 1 0 0\nv 0 2 0\nusemtl red\nf 1 2 3\n";
constexpr const char* kTwoMaterials = "newmtl red\nKd 1 0 0\nnewmtl glass pane\nd 0.25\n";

class SceneFileTest : public ::testing::Test {
 protected:
  SceneFileTest() { folder_.write("a.obj", kTriangleObj), folder_.write("a.mtl", kTwoMaterials); }
  Loaded load(const std::string& text, const LoadOptions& options = {}) { return must_load(folder_.write("s.toml", text), options); }
  Error error(const std::string& text) { return must_fail(folder_.write("s.toml", text)); }
  TempFolder folder_;
};

TEST_F(SceneFileTest, EverythingAtOnce) {
  const Loaded l = load(R"(obj = "a.obj"
background = [0.25, 0.5, 1]
ambient = [0.125, 0, 0.5]
[[camera]]
name = "front"
eye = [0, 1, 3]
target = [0, 1, 0]
up = [0, 1, 0]
fov_y = 30.5
near = 0.25
[[camera]]
eye = [3, 1, 0]
target = [0, 1, 0]
[[light]]
kind = "point"
position = [0, 1.5, 0]
intensity = [10, 9, 8]
attenuation = [0.5, 0.25, 1]
[[light]]
kind = "directional"
direction = [0, -3, 4]
intensity = [1, 2, 3]
[[path]]
time = 0
eye = [0, 0, 5]
target = [0, 0, 0]
[[path]]
time = 1.5
eye = [5, 0, 0]
target = [0, 0, 0]
fov_y = 60
[technique]
shading = "gouraud"
shadows = "none"
reflections = "none"
visibility = "ray"
filter = "bilinear"
normals = "interpolated"
powers = "fast"
shading_rate = "2x2"
shadow_terminator = "lifted"
transparency = "screen-door"
culling = "back"
max_bounces = 7
textures = false
bump = false
width = 64
height = 48
[material.red]
transparency = "screen-door"
reflectance = "blinn_phong"
mirror = [0.5, 0.25, 0]
opacity = 0.75
[material."glass pane"]
opacity = 1
)");
  const SceneData& s = l.scene();
  EXPECT_TRUE(l.loaded.messages.empty()) << l.all_messages();
  EXPECT_EQ(s.background[1], 0.5f);
  EXPECT_EQ(s.ambient_radiance[0], 0.125f);
  ASSERT_EQ(s.cameras.size(), 2u);
  EXPECT_EQ(s.camera_names[0], "front");
  EXPECT_EQ(s.camera_names[1], "camera 2");
  EXPECT_EQ(s.cameras[0].fov_y_degrees, 30.5);
  EXPECT_EQ(s.cameras[0].near_plane, 0.25);
  EXPECT_EQ(s.cameras[1].near_plane, fitted_near_plane(s));
  EXPECT_EQ(s.cameras[1].eye[0], 3.0);
  ASSERT_EQ(s.lights.size(), 2u);
  EXPECT_EQ(s.lights[0].position[1], 1.5f);
  EXPECT_EQ(s.lights[0].attenuation[1], 0.25f);
  EXPECT_EQ(s.lights[0].intensity[2], 8.0f);
  EXPECT_EQ(s.lights[1].kind, static_cast<int32_t>(LightKind::kDirectional));
  EXPECT_EQ(s.lights[1].direction[1], -0.6f);
  EXPECT_EQ(s.lights[1].direction[2], 0.8f);
  ASSERT_EQ(s.camera_path.size(), 2u);
  EXPECT_EQ(s.camera_path[1].time, 1.5);
  EXPECT_EQ(s.camera_path[0].camera.fov_y_degrees, 30.5);  // of the first camera
  EXPECT_EQ(s.camera_path[1].camera.fov_y_degrees, 60.0);
  EXPECT_EQ(s.camera_path[1].camera.near_plane, 0.25);
  EXPECT_EQ(s.settings.shading, Shading::kGouraud);
  EXPECT_EQ(s.settings.shadows, Shadows::kNone);
  EXPECT_EQ(s.settings.reflections, Reflections::kNone);
  EXPECT_EQ(s.settings.visibility, Visibility::kRay);
  EXPECT_EQ(s.settings.filter, Filter::kBilinear);
  EXPECT_EQ(s.settings.transparency, Transparency::kScreenDoor);
  EXPECT_EQ(s.settings.culling, Culling::kBack);
  EXPECT_EQ(s.settings.normals, Normals::kInterpolated);
  EXPECT_EQ(s.settings.powers, Powers::kFast);
  EXPECT_EQ(s.settings.shading_rate, ShadingRate::k2x2);
  EXPECT_EQ(s.settings.shadow_terminator, ShadowTerminator::kLifted);
  EXPECT_EQ(s.settings.max_bounces, 7);
  EXPECT_FALSE(s.settings.textures || s.settings.bump);
  EXPECT_EQ(s.settings.width * 1000 + s.settings.height, 64048);
  EXPECT_EQ(s.materials[0].transparency, static_cast<int32_t>(MaterialTransparency::kScreenDoor));
  EXPECT_EQ(s.materials[0].mirror[0], 0.5f);
  EXPECT_EQ(s.materials[0].opacity, 0.75f);
  EXPECT_EQ(s.materials[1].transparency, static_cast<int32_t>(MaterialTransparency::kOpaque));
}

TEST_F(SceneFileTest, EveryMistakeIsNamedWithItsLine) {
  const std::string obj = "obj = \"a.obj\"\n", camera = "[[camera]]\neye = [0,0,5]\ntarget = [0,0,0]\n",
                    light = "[[light]]\nkind = \"point\"\nposition = [0,0,0]\nintensity = [1,1,1]\n";
  const struct {
    std::string text;
    int line;
    const char* cause;
  } cases[] = {
      {"", 0, "empty"},
      {"# nothing\n", 1, "'obj' is missing"},
      {"obj = 5\n", 1, "must be a string"},
      {"obj = \"\"\n", 1, "is empty"},
      {"\nobj = \"none.obj\"\n", 2, "not found"},
      {"obj = \"a.obj\"\nbackgruond = [0,0,0]\n", 2, "did you mean 'background'"},
      {obj + "background = [0,0]\n", 2, "it has 2"},
      {obj + "background = [0,0,-1]\n", 2, "'background' is -1"},
      {obj + "ambient = [0,0,nan]\n", 2, "'ambient' is nan"},
      {obj + "ambient = 1\n", 2, "array of 3 numbers"},
      {obj + "ambient = [1, \"x\", 1]\n", 2, "must be a number"},
      {obj + "camera = 3\n", 2, "[[camera]]"},
      {obj + "[camera]\neye = [0,0,0]\n", 2, "[[camera]]"},
      {obj + "[[camera]]\ntarget = [0,0,0]\n", 2, "'eye' of camera is missing"},
      {obj + "[[camera]]\neye = [0,0,5]\n", 2, "'target' of camera is missing"},
      {obj + camera + "fov = 45\n", 5, "did you mean 'fov_y'"},
      {obj + camera + "fov_y = 180\n", 5, "'fov_y' of camera is 180"},
      {obj + camera + "fov_y = 0.009\n", 5, "'fov_y' of camera is 0.009"},
      {obj + camera + "fov_y = \"wide\"\n", 5, "must be a number"},
      {obj + camera + "name = \"a\"\n" + camera + "name = \"a\"\n", 9, "'a' is the name of a camera above"},
      {obj + camera + "name = \"camera 2\"\n" + camera, 6, "'camera 2' is the name of a camera above"},
      {obj + camera + "near = 0\n", 5, "'near'"},
      {obj + camera + "near = -1\n", 5, "'near'"},
      {obj + camera + "up = [0,0,1]\n", 5, "along the up vector"},
      {obj + camera + "up = [0,0,0]\n", 5, "no length"},
      {obj + camera + "name = 1\n", 5, "must be a string"},
      {obj + "[[camera]]\neye = [1,1,1]\ntarget = [1,1,1]\n", 4, "where the eye is"},
      {obj + "[[camera]]\neye = [inf,1,1]\ntarget = [1,1,1]\n", 3, "'eye' of camera is inf"},
      {obj + "[[camera]]\neye = [1e300,1,1]\ntarget = [1,1,1]\n", 3, "1e+300"},
      {obj + "[[light]]\nposition = [0,0,0]\n", 2, "'kind' of light is missing"},
      {obj + "[[light]]\nkind = \"pont\"\n", 3, "did you mean 'point'"},
      {obj + "[[light]]\nkind = \"spot\"\n", 3, "point, directional"},
      {obj + light + "direction = [0,1,0]\n", 6, "for directional lights"},
      {obj + light + "attenuation = [0,0,0]\n", 6, "zero throughout"},
      {obj + light + "attenuation = [0,0,-1]\n", 6, "is -1"},
      {obj + "[[light]]\nkind = \"directional\"\nintensity = [1,1,1]\ndirection = [0,0,0]\n", 5, "no length"},
      {obj + "[[light]]\nkind = \"directional\"\nintensity = [1,1,1]\n", 2, "'direction' of light is missing"},
      {obj + "[[light]]\nkind = \"directional\"\ndirection = [0,-1,0]\nposition = [0,0,0]\nintensity = [1,1,1]\n", 5,
       "for point lights"},
      {obj + "[[path]]\neye = [0,0,5]\ntarget = [0,0,0]\n", 2, "'time' of path is missing"},
      {obj + "[[path]]\ntime = 1\neye = [0,0,5]\ntarget = [0,0,0]\n[[path]]\ntime = 1.0\neye = [0,0,5]\ntarget = [0,0,0]\n", 7,
       "greater"},
      {obj + "[technique]\nshading = \"pohng\"\n", 3, "did you mean 'phong'"},
      {obj + "[technique]\nnormals = \"renormalised\"\n", 3, "did you mean 'renormalized'"},
      {obj + "[technique]\npowers = \"quick\"\n", 3, "fast, exact"},
      {obj + "[technique]\nshading_rate = 2\n", 3, "must be a string, not an integer"},
      {obj + "[technique]\nshading_rate = \"4x4\"\n", 3, "2x2, 1x1"},
      {obj + "[technique]\nshadow_terminator = false\n", 3, "must be a string, not a boolean"},
      {obj + "[technique]\nshadows = true\n", 3, "must be a string, not a boolean"},
      {obj + "[technique]\nmax_bounces = 65\n", 3, "0 to 64"},
      {obj + "[technique]\nmax_bounces = 1.5\n", 3, "must be an integer, not a number"},
      {obj + "[technique]\nmax_bounces = 9223372036854775807\n", 3, "0 to 64"},
      {obj + "[technique]\nwidth = 16385\n", 3, "1 to 16384"},
      {obj + "[technique]\nheight = 0\n", 3, "1 to 16384"},
      {obj + "[technique]\ntextures = 1\n", 3, "true or false"},
      {obj + "[technique]\nthreads = 4\n", 3, "unknown key 'threads'"},
      {obj + "[[technique]]\nshading = \"flat\"\n", 2, "[technique]"},
      {obj + "[material.rde]\nopacity = 1\n", 2, "did you mean 'red'"},
      {obj + "[material.red]\nopacity = 2\n", 3, "0 to 1"},
      {obj + "[material.red]\ntransparency = \"glass\"\n", 3, "opaque, mask, alpha, screen-door"},
      {obj + "[material.red]\nreflectance = \"cook_torrance\"\n", 3, "blinn_phong"},
      {obj + "[material.red]\nmirror = [1,1,2]\n", 3, "0 to 1"},
      {obj + "[material.red]\ncolor = [1,1,1]\n", 3, "unknown key 'color'"},
      {obj + "[material]\nred = 1\n", 3, "[material.NAME]"},
      {obj + "\n[camera\n", 3, ""},
      {obj + "obj = \"b.obj\"\n", 2, ""},
      {obj + "x = 1979-05-27\n", 2, "unknown key 'x'"},
      {obj + "camera = 1979-05-27\n", 2, "[[camera]]"},
      {"obj = \"\xff\xfe\"\n", 1, ""},
  };
  for (const auto& c : cases) {
    const Error e = error(c.text);
    EXPECT_EQ(e.line, c.line) << c.text << "\n" << e.to_string();
    EXPECT_NE(e.message.find(c.cause), std::string::npos) << c.text << "\n" << e.to_string();
    EXPECT_NE(e.file.find("s.toml"), std::string::npos) << e.to_string();
  }
}

TEST_F(SceneFileTest, TheFirstMistakeIsReported) {
  EXPECT_EQ(error("obj = \"a.obj\"\n[technique]\nwidth = 0\n[[camera]]\neye = 1\n").line, 3);
}

TEST_F(SceneFileTest, ErrorsOfTheObjNameTheObj) {
  folder_.write("bad.obj", "v 0 0 0\nf 1 2 3\n");
  const Error e = error("obj = \"bad.obj\"\n");
  EXPECT_NE(e.file.find("bad.obj"), std::string::npos);
  EXPECT_EQ(e.line, 2);
}

TEST_F(SceneFileTest, LightsAreLimited) {
  std::string text = "obj = \"a.obj\"\n";
  for (int i = 0; i < kMaxLights; ++i) text += "[[light]]\nkind = \"point\"\nposition = [0,0,0]\nintensity = [1,1,1]\n";
  EXPECT_EQ(load(text).scene().lights.size(), static_cast<size_t>(kMaxLights));
  EXPECT_NE(error(text + "[[light]]\nkind = \"point\"\nposition = [0,0,0]\nintensity = [1,1,1]\n").message.find("at most 64"),
            std::string::npos);
}

TEST_F(SceneFileTest, WithoutLightOrCameraDefaultsAreChosenAndSaid) {
  const Loaded both = load("obj = \"a.obj\"\n");
  EXPECT_EQ(both.count({"no camera given"}), 1);
  EXPECT_EQ(both.count({"no light given"}), 1);
  EXPECT_EQ(both.scene().lights.size(), 1u);
  const Loaded none = load("obj = \"a.obj\"\nlight = []\n");
  EXPECT_EQ(none.scene().lights.size(), 0u);
  EXPECT_EQ(none.count({"no light given"}), 0);
  EXPECT_EQ(none.count({"list of lights is empty"}), 1);
  const Loaded camera = load("obj = \"A.OBJ\"\n[[camera]]\neye = [0,1,3]\ntarget = [0,1,0]\n");
  EXPECT_EQ(camera.count({"no camera given"}), 0);
  LoadOptions own;
  own.camera_given = true;
  EXPECT_EQ(load("obj = \"a.obj\"\n", own).count({"no camera given"}), 0);
  EXPECT_EQ(camera.count({"no light given"}), 1);
}

TEST_F(SceneFileTest, HashCoversWhatReachesAPixelAndNotTheCamera) {
  const auto hash = [&](const std::string& text) { return load("obj = \"a.obj\"\nlight = []\n" + text).scene().hash; };
  const uint64_t plain = hash("");
  EXPECT_EQ(plain, hash("[[camera]]\neye = [0,1,3]\ntarget = [0,1,0]\n"));
  EXPECT_EQ(plain, hash("[technique]\nshading = \"flat\"\n"));
  EXPECT_NE(plain, hash("background = [1,0,0]\n"));
  EXPECT_NE(plain, hash("ambient = [1,0,0]\n"));
  EXPECT_NE(plain, hash("[material.red]\nopacity = 0.5\n"));
}

TEST_F(SceneFileTest, ATransparencyWithoutEffectIsAWarning) {
  const std::string obj = "obj = \"a.obj\"\nlight = []\n[[camera]]\neye = [0, 1, 3]\ntarget = [0, 1, 0]\n";  // lines 1 to 5
  const auto warnings = [&](const std::string& text) { return load(obj + text).loaded.warnings; };
  for (const char* word : {"mask", "alpha", "screen-door"}) {
    const Loaded l = load(obj + "[material.red]\nreflectance = \"blinn_phong\"\ntransparency = \"" + word + "\"\n");
    EXPECT_EQ(l.loaded.warnings, 1u);
    EXPECT_EQ(l.count({"s.toml:8: warning: material 'red': transparency \"", word, "does nothing", "opacity is 1", "map_d"}), 1)
        << l.all_messages();
  }
  EXPECT_EQ(warnings("[material.\"glass pane\"]\nopacity = 1\ntransparency = \"alpha\"\n"), 1u) << "the scene file's own opacity";
  EXPECT_EQ(warnings("[material.red]\ntransparency = \"opaque\"\n"), 0u);
  EXPECT_EQ(warnings("[material.red]\nopacity = 0.5\ntransparency = \"screen-door\"\n"), 0u);
  EXPECT_EQ(warnings("[material.\"glass pane\"]\ntransparency = \"screen-door\"\n"), 0u);
  folder_.write("a.mtl", "newmtl red\nmap_d holes.png\nnewmtl glass pane\nd 0.25\n");
  PngFixture holes;
  holes.width = 2;
  folder_.write("holes.png", encode_png_fixture(holes, {std::string("\x10\x20\x30\x40\x50\x60", 6)}));
  EXPECT_EQ(warnings("[material.red]\ntransparency = \"screen-door\"\n"), 0u) << "a map_d may be anything";
}

// Eight corners of the bounds and the poles of the sphere project into the picture.
TEST(DefaultView, BoundingSphereIsInView) {
  for (const double scale : {1e-30, 1e-3, 1.0, 1e6, 1e30})
    for (const double shift : {0.0, 1e3}) {
      SceneData s;
      const double size[3] = {1, 2, 0.5};
      for (int k = 0; k < 3; ++k) {
        s.bounds_min[k] = static_cast<float>((shift - size[k]) * scale);
        s.bounds_max[k] = static_cast<float>((shift + size[k]) * scale);
      }
      const Camera c = fitted_camera(s);
      glm::dvec3 eye, target, center, half;
      for (int k = 0; k < 3; ++k) {
        eye[k] = c.eye[k], target[k] = c.target[k];
        center[k] = (static_cast<double>(s.bounds_min[k]) + s.bounds_max[k]) / 2,
        half[k] = (static_cast<double>(s.bounds_max[k]) - s.bounds_min[k]) / 2;
      }
      EXPECT_EQ(target, center);
      EXPECT_GT(eye.z, center.z);
      EXPECT_GT(eye.y, center.y);
      EXPECT_LT(eye.y - center.y, eye.z - center.z);
      const double radius = length3(half), distance = length3(eye - center);
      EXPECT_NEAR(radius / distance, std::sin(22.5 * kPi / 180), 1e-12);  // the cone of view touches the sphere
      EXPECT_GT(distance - radius, c.near_plane);
      EXPECT_NEAR(c.near_plane, 2e-3 * radius, 1e-12 * radius);
    }
}

TEST(DefaultView, LightGivesWhiteSurfacesTheStatedRadiance) {
  const SceneData s;
  const Camera c = fitted_camera(s);
  const Light light = default_light(s, c);
  EXPECT_NEAR(light.intensity[0] / light.attenuation[0] / kPi, kDefaultLightRadiance, 1e-6);  // Kd / pi * E
  EXPECT_EQ(light.attenuation[1] + light.attenuation[2], 0.0f);
  double to_light = 0, to_target = 0;
  for (int k = 0; k < 3; ++k) {
    to_light += (light.position[k] - c.eye[k]) * (light.position[k] - c.eye[k]);
    to_target += (c.target[k] - c.eye[k]) * (c.target[k] - c.eye[k]);
  }
  EXPECT_GT(to_light, 0);
  EXPECT_LT(to_light, 0.01 * to_target);  // within a tenth of the distance
}

TEST(DefaultView, EmptySceneHasACameraAndALight) {
  const TempFolder folder;
  const Loaded l = must_load(folder.write("a.obj", "# nothing here\nv 0 0 0\n"));
  EXPECT_EQ(l.scene().triangles.size(), 0u);
  EXPECT_EQ(l.scene().cameras.size(), 1u);
  EXPECT_EQ(l.scene().lights.size(), 1u);
  EXPECT_EQ(l.scene().materials.size(), 1u);
  EXPECT_EQ(l.count({"a.obj", "no triangles"}), 1);
  EXPECT_GT(l.scene().cameras[0].near_plane, 0);
  EXPECT_EQ(l.loaded.scene.triangle_count() + l.loaded.scene.light_count(), 1u);
  EXPECT_EQ(l.loaded.scene.cameras().size(), l.loaded.scene.camera_names().size());
}

}  // namespace
}  // namespace spanray
