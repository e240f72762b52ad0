// Scenes of one mesh in words: material text, faces, and the rest of a scene file; and what paths see of them.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "reference/paths.h"
#include "support/scene_files.h"
#include "support/temp_folder.h"

namespace spanray {

using Vec = std::array<double, 3>;

// A gray material: reflectance, radiance in W/(m^2 sr), more lines.
inline std::string gray(const std::string& name, double kd, double ke, const std::string& more = "") {
  const auto three = [](double v) { return (" " + std::to_string(v)) + " " + std::to_string(v) + " " + std::to_string(v); };
  return "newmtl " + name + "\nKd" + three(kd) + "\nKe" + three(ke) + "\nillum 1\n" + more;
}
inline std::string vertex(const Vec& v) {
  return "v " + std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]) + "\n";
}
inline std::string quad(const std::string& material, const Vec& a, const Vec& b, const Vec& c, const Vec& d) {
  return vertex(a) + vertex(b) + vertex(c) + vertex(d) + "usemtl " + material + "\nf -4 -3 -2 -1\n";
}
// A cube about the origin, its sides 2 r long.
inline std::string box(const std::string& material, double r) {
  return quad(material, {-r, -r, -r}, {r, -r, -r}, {r, r, -r}, {-r, r, -r}) +
         quad(material, {-r, -r, r}, {-r, r, r}, {r, r, r}, {r, -r, r}) +
         quad(material, {-r, -r, -r}, {-r, -r, r}, {r, -r, r}, {r, -r, -r}) +
         quad(material, {-r, r, -r}, {r, r, -r}, {r, r, r}, {-r, r, r}) +
         quad(material, {-r, -r, -r}, {-r, r, -r}, {-r, r, r}, {-r, -r, r}) +
         quad(material, {r, -r, -r}, {r, -r, r}, {r, r, r}, {r, r, -r});
}

inline Scene mesh_scene(const TempFolder& folder, const std::string& mtl, const std::string& obj, const std::string& toml) {
  folder.write("a.mtl", mtl), folder.write("a.obj", "mtllib a.mtl\n" + obj);
  return must_load(folder.write("a.toml", "obj = \"a.obj\"\n" + toml)).loaded.scene;
}

inline Camera camera_at(const Vec& eye, const Vec& target, double fov_y_degrees = 0.01) {
  Camera camera;
  std::copy(eye.begin(), eye.end(), camera.eye), std::copy(target.begin(), target.end(), camera.target);
  camera.up[0] = 0.1, camera.up[1] = 1, camera.up[2] = 0.3;
  camera.fov_y_degrees = fov_y_degrees, camera.near_plane = 1e-4;
  return camera;
}

// What many paths through one narrow pixel say: mean luminance and its standard error, W/(m^2 sr).
struct Estimate {
  double mean = 0, error = 0;
};
inline Estimate estimate(const Scene& scene, const Camera& camera, const PathOptions& options, uint32_t paths) {
  Settings settings = scene.settings();
  settings.width = settings.height = 1;
  PathSums sums;
  const Result<void> done = trace_paths(scene, camera, settings, options, paths, sums);
  EXPECT_TRUE(done) << done.error().to_string();
  return {sums.luminance(0), sums.standard_error(0)};
}

// As many standard errors as chance hardly ever makes (one in 400 thousand), and rounding of the scene's floats.
inline void expect_estimate(double want, const Estimate& got, const std::string& what, double within = 4.7,
                            double rounding = 2e-6) {
  EXPECT_NEAR(got.mean, want, within * got.error + rounding * std::fabs(want)) << what << ": standard error " << got.error;
}

}  // namespace spanray
