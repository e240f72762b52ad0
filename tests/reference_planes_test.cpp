// Path tracing between planes, against what can be computed on paper; and where the reference meets planes.
#include <limits>

#include "reference/tree.h"
#include "support/mesh_scene.h"
#include "support/plane_scenes.h"

namespace spanray {
namespace {

class ReferencePlanes : public ::testing::Test {
 protected:
  static std::string plane(const std::string& material, const char* point, const char* normal) {
    return std::string("[[plane]]\npoint = ") + point + "\nnormal = " + normal + "\nmaterial = \"" + material + "\"\n";
  }
  Scene load(const std::string& mtl, const std::string& planes) const {
    return mesh_scene(folder_, mtl, "", "ambient = [0.0, 0.0, 0.0]\nbackground = [0.0, 0.0, 0.0]\nlight = []\n" + planes);
  }
  TempFolder folder_;
};

// Six planes make a box in which every wall glows and reflects alike: e * (1 + a + ... + a^k) after k reflections.
TEST_F(ReferencePlanes, AFurnaceOfPlanesGivesTheGeometricSeries) {
  constexpr double kAlbedo = 0.5, kGlow = 0.25;
  std::string walls;
  for (const char* p :
       {"[1.0, 0.0, 0.0]", "[0.0, 1.0, 0.0]", "[0.0, 0.0, 1.0]", "[-1.0, 0.0, 0.0]", "[0.0, -1.0, 0.0]", "[0.0, 0.0, -1.0]"})
    walls += plane("m", p, p);  // turned outward: both sides reflect
  const Scene scene = load(gray("m", kAlbedo, kGlow), walls);
  for (const int depth : {0, 1, 2, 5}) {
    PathOptions options;
    options.depth = depth, options.russian_roulette = false;
    const Estimate e = estimate(scene, camera_at({0.1, 0.2, -0.3}, {1, 0.3, 0.2}), options, 5000);
    EXPECT_NEAR(e.mean, kGlow * (1 - std::pow(kAlbedo, depth + 1)) / (1 - kAlbedo), 1e-6) << depth;
  }
}

// A floor under a glowing sky of a plane sees nothing else: its radiance is albedo times glow. Of a sky that is tilted by an
// angle b, the floor sees the part (1 + cos b) / 2.
TEST_F(ReferencePlanes, AFloorUnderAGlowingPlane) {
  constexpr double kAlbedo = 0.6, kGlow = 2;
  const std::string mtl = gray("floor", kAlbedo, 0) + gray("sky", 0, kGlow);
  const Camera camera = camera_at({0.1, 0.9, 0.3}, {0.4, 0, 0.2});
  PathOptions options;
  options.depth = 1;
  const Scene level =
      load(mtl, plane("floor", "[5.0, 0.0, 3.0]", "[0.0, 1.0, 0.0]") + plane("sky", "[0.0, 2.0, 0.0]", "[0.0, 1.0, 0.0]"));
  EXPECT_NEAR(estimate(level, camera, options, 2000).mean, kAlbedo * kGlow, 1e-6);
  const Scene tilted =
      load(mtl, plane("floor", "[5.0, 0.0, 3.0]", "[0.0, 1.0, 0.0]") + plane("sky", "[0.0, 1e6, 0.0]", "[1.0, 1.0, 0.0]"));
  const Estimate e = estimate(tilted, camera, options, 200000);
  EXPECT_NEAR(e.mean, kAlbedo * kGlow * (1 + std::sqrt(0.5)) / 2, 4 * e.error);
  EXPECT_LT(e.error, 0.005);
}

TEST_F(ReferencePlanes, WhereALineMeetsAPlane) {
  const Plane p = plane_at({0, 1, 0}, {0, 2, 0});
  const auto at = [&](const glm::dvec3& o, const glm::dvec3& d) {
    double t = std::numeric_limits<double>::quiet_NaN();
    return reference::meets({o, d}, p, t) ? t : std::numeric_limits<double>::quiet_NaN();
  };
  EXPECT_EQ(at({3, 3, 0}, {1, -4, 0}), 0.5);
  EXPECT_EQ(at({3, 3, 0}, {1, 4, 0}), -0.5) << "behind: t of any sign";
  EXPECT_TRUE(std::isnan(at({3, 1, 0}, {1, -4, 0}))) << "starts on it";
  EXPECT_TRUE(std::isnan(at({3, 3, 0}, {1, 0, 0}))) << "along it";
  EXPECT_TRUE(std::isnan(at({3, 3, 0}, {1, -1e-31, 0}))) << "too far away";
  EXPECT_EQ(at({3, 3, 0}, {1, -1e-29, 0}), 2 / 1e-29);
}

}  // namespace
}  // namespace spanray
