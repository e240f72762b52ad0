// Path tracing against what can be computed on paper. All units as in reference/paths.h.
#include "reference/paths.h"

#include <cstdio>
#include <numbers>

#include "math/vec.h"
#include "reference/random.h"
#include "support/mesh_scene.h"

namespace spanray {
namespace {

constexpr double kPi = std::numbers::pi;

std::string dark(const std::string& more = "") {
  return "ambient = [0.0, 0.0, 0.0]\nbackground = [0.0, 0.0, 0.0]\nlight = []\n" + more;
}
std::string big_floor() { return quad("floor", {-90, 0, -90}, {-90, 0, 90}, {90, 0, 90}, {90, 0, -90}); }

// A sphere of 8 * 4^levels triangles, from an octahedron, its vertices `radius` from the center.
std::string sphere(const std::string& material, const Vec& center, double radius, int levels) {
  std::string text;
  const auto unit = [](const Vec& a, const Vec& b) {
    Vec m{a[0] + b[0], a[1] + b[1], a[2] + b[2]};
    const double n = std::hypot(m[0], m[1], m[2]);
    for (double& x : m) x /= n;
    return m;
  };
  const auto split = [&](const auto& self, const Vec& a, const Vec& b, const Vec& c, int level) -> void {
    if (level > 0) {
      const Vec ab = unit(a, b), bc = unit(b, c), ca = unit(c, a);
      self(self, a, ab, ca, level - 1), self(self, ab, b, bc, level - 1), self(self, ca, bc, c, level - 1),
          self(self, ab, bc, ca, level - 1);
      return;
    }
    for (const Vec& v : {a, b, c})
      text += vertex({center[0] + radius * v[0], center[1] + radius * v[1], center[2] + radius * v[2]});
    text += "f -3 -2 -1\n";
  };
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0}) split(split, {x, 0, 0}, {0, y, 0}, {0, 0, z}, levels);
  return "usemtl " + material + "\ns off\n" + text;
}

// The known answers of the authors' library (Random123, kat_vectors).
TEST(ReferenceRandom, PhiloxGivesTheKnownAnswers) {
  using Words = std::array<uint32_t, 4>;
  EXPECT_EQ(reference::philox({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  constexpr uint32_t kOnes = 0xffffffff;
  EXPECT_EQ(reference::philox({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(reference::philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

class ReferencePaths : public ::testing::Test {
 protected:
  Scene load(const std::string& mtl, const std::string& obj, const std::string& toml) const {
    return mesh_scene(folder_, mtl, obj, toml);
  }
  TempFolder folder_;
};

// Every wall glows and reflects alike: after k reflections e * (1 + a + ... + a^k) arrives from everywhere.
TEST_F(ReferencePaths, AFurnaceGivesTheGeometricSeries) {
  constexpr double kAlbedo = 0.5, kGlow = 0.25;
  const Camera camera = camera_at({0.1, 0.2, -0.3}, {1, 0.3, 0.2});
  for (const bool next_event : {false, true}) {
    const Scene scene = load(gray("m", kAlbedo, kGlow), box("m", 1), dark());
    for (const int depth : {0, 1, 2, 5}) {
      PathOptions options;
      options.depth = depth, options.next_event = next_event, options.russian_roulette = false;
      expect_estimate(kGlow * (1 - std::pow(kAlbedo, depth + 1)) / (1 - kAlbedo), estimate(scene, camera, options, 20000),
                      "depth " + std::to_string(depth));
    }
    PathOptions options;
    options.next_event = next_event, options.depth = 500;
    expect_estimate(kGlow / (1 - kAlbedo), estimate(scene, camera, options, 50000), "all of them, with Russian roulette");
    // All wavelengths of an albedo near 1: roulette has to keep paths alive.
    expect_estimate(kGlow / (1 - 0.95), estimate(load(gray("m", 0.95, kGlow), box("m", 1), dark()), camera, options, 20000),
                    "albedo 0.95");
  }
}

// A white object in a uniform white surrounding cannot be told from it: every Lambertian path weighs exactly 1.
TEST_F(ReferencePaths, AWhiteObjectInAWhiteSurroundingVanishes) {
  const Scene scene = load(gray("m", 1, 0), sphere("m", {0, 0, 0}, 1, 3) + box("m", 0.7),
                           "ambient = [0.0, 0.0, 0.0]\nlight = []\nbackground = [1.0, 1.0, 1.0]\n");
  Settings settings = scene.settings();
  settings.width = settings.height = 16;
  PathOptions options;
  options.depth = kMostDepth;
  PathSums sums;
  ASSERT_TRUE(trace_paths(scene, camera_at({0, 0, 4}, {0, 0, 0}, 40), settings, options, 16, sums));
  for (const double sum : sums.radiance) EXPECT_NEAR(sum / 16, 1, 1e-6);
}

// Directly opposed and perpendicular unit squares (Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", C-11
// and C-14): the mean of the irradiance over one is F * pi * L. The picture shows just that square.
TEST_F(ReferencePaths, FormFactorsOfSquares) {
  constexpr double kLamp = 2, kAlbedo = 0.6;
  struct Pair {
    const char* name;
    std::string lamp;
    double factor;
  };
  const std::string floor = quad("floor", {-0.5, 0, -0.5}, {-0.5, 0, 0.5}, {0.5, 0, 0.5}, {0.5, 0, -0.5});
  const Pair pairs[] = {
      {"parallel", quad("lamp", {-0.5, 1, -0.5}, {0.5, 1, -0.5}, {0.5, 1, 0.5}, {-0.5, 1, 0.5}), 0.19982489569838746},
      {"perpendicular", quad("lamp", {-0.5, 0, -0.5}, {-0.5, 0, 0.5}, {-0.5, 1, 0.5}, {-0.5, 1, -0.5}), 0.20004377607540316}};
  for (const Pair& pair : pairs)
    for (const bool next_event : {false, true}) {
      const Scene scene = load(gray("floor", kAlbedo, 0) + gray("lamp", 0, kLamp), floor + pair.lamp, dark());
      Camera camera = camera_at({0, 0.999, 0}, {0, 0, 0}, 2 * std::atan(0.5 / 0.999) * 180 / kPi);
      camera.up[0] = camera.up[1] = 0, camera.up[2] = -1;
      PathOptions options;
      options.next_event = next_event;
      expect_estimate(kAlbedo * kLamp * pair.factor, estimate(scene, camera, options, 400000), pair.name);
    }
}

// Irradiance of a polygon of uniform radiance (Lambert 1760; Arvo 1995): half the sum over its edges of the angle that each
// subtends times the cosine of the normal of its plane through the point, times L.
double polygon_irradiance(const std::vector<Vec>& corners, const Vec& p, const Vec& n, double radiance) {
  double sum = 0;
  for (size_t i = 0; i < corners.size(); ++i) {
    const Vec &c = corners[i], &d = corners[(i + 1) % corners.size()];
    glm::dvec3 a(c[0] - p[0], c[1] - p[1], c[2] - p[2]), b(d[0] - p[0], d[1] - p[1], d[2] - p[2]);
    const glm::dvec3 across = cross3(a, b);
    sum += std::atan2(length3(across), dot3(a, b)) * dot3(normalize3(across, glm::dvec3(0)), glm::dvec3(n[0], n[1], n[2]));
  }
  return 0.5 * radiance * std::fabs(sum);
}

TEST_F(ReferencePaths, LambertsPolygonIrradiance) {
  constexpr double kLamp = 3, kAlbedo = 0.7;
  const std::vector<Vec> corners = {{-0.4, 0.5, 0.2}, {1.1, 0.8, 0.2}, {0.9, 1.7, -0.9}, {-0.6, 1.4, -0.9}};  // of a plane
  const std::string lamp = quad("lamp", corners[0], corners[1], corners[2], corners[3]);
  const Scene scene = load(gray("floor", kAlbedo, 0) + gray("lamp", 0, kLamp), big_floor() + lamp, dark());
  for (const Vec& p : {Vec{0, 0, 0}, Vec{1.5, 0, 0.4}, Vec{-2, 0, -3}})
    for (const bool next_event : {false, true}) {
      PathOptions options;
      options.next_event = next_event;
      const double want = kAlbedo / kPi * polygon_irradiance(corners, p, {0, 1, 0}, kLamp);
      const Estimate got = estimate(scene, camera_at({p[0] + 0.1, 0.2, p[2] + 0.1}, p), options, 200000);
      expect_estimate(want, got, std::to_string(p[0]) + (next_event ? " next event" : ""));
      EXPECT_LT(got.error, want * 0.05);
    }
}

// A sphere of radiance L wholly above the horizon: E = pi L (r/d)^2 cos. Of 8 * 4^4 triangles, vertices on the sphere, it is
// a little too small: 0.17 % in area by its volume, and 0.5 % are allowed for it.
TEST_F(ReferencePaths, SphereLightIrradiance) {
  constexpr double kLamp = 5, kAlbedo = 0.5, kRadius = 0.5, kTessellation = 0.005;
  const Scene scene =
      load(gray("floor", kAlbedo, 0) + gray("lamp", 0, kLamp), big_floor() + sphere("lamp", {0, 1, 0}, kRadius, 4), dark());
  for (const double x : {0.0, 1.0, 2.5}) {
    const double d = std::hypot(x, 1.0), want = kAlbedo * kLamp * (kRadius / d) * (kRadius / d) / d;
    const Estimate got = estimate(scene, camera_at({x + 0.3, 0.3, 0.2}, {x, 0, 0}), {}, 200000);
    std::printf("sphere light at %.1f m: %.5f, exactly %.5f, standard error %.1e\n", x, got.mean, want, got.error);
    expect_estimate(want, got, std::to_string(x), 4.7, kTessellation);
  }
}

// Exact, since nothing but the lamp shines: every path gathers the same.
TEST_F(ReferencePaths, PointLightsFallOffWithTheInverseSquare) {
  for (const double height : {0.5, 1.0, 2.0, 4.0}) {
    const Scene scene =
        load(gray("floor", 0.6, 0), big_floor(),
             "ambient = [0.0, 0.0, 0.0]\nbackground = [0.0, 0.0, 0.0]\n[[light]]\nkind = \"point\"\nposition = [0.0, " +
                 std::to_string(height) + ", 0.0]\nintensity = [3.0, 3.0, 3.0]\n");
    for (const double x : {0.0, 0.7, 3.0}) {
      const double d = std::hypot(x, height), want = 0.6 / kPi * 3 / (d * d) * (height / d);
      for (const bool next_event : {false, true}) {
        PathOptions options;
        options.next_event = next_event;
        EXPECT_NEAR(estimate(scene, camera_at({x + 0.1, 0.2, 0.1}, {x, 0, 0}, 1e-5), options, 4).mean, want, 1e-5 * want);
      }
    }
  }
}

// A black pane of d = 0.4 before the lamp lets 0.6 through, and as much to the eye. A mirror shows what it shows.
TEST_F(ReferencePaths, PanesDimAndMirrorsShow) {
  const std::string lamp =
      "ambient = [0.0, 0.0, 0.0]\nbackground = [0.0, 0.0, 0.0]\n[[light]]\nkind = \"point\"\nposition = [0.0, 2.0, "
      "0.0]\nintensity = [3.0, 3.0, 3.0]\n";
  const std::string pane = quad("pane", {-9, 1, -9}, {-9, 1, 9}, {9, 1, 9}, {9, 1, -9});
  const Scene scene = load(gray("floor", 0.5, 0) + gray("pane", 0, 0, "d 0.4\n"), big_floor() + pane, lamp);
  const double lit = 0.5 / kPi * 3 / 4 * 0.6;
  for (const double x : {0.0, 1.0}) EXPECT_GT(estimate(scene, camera_at({x + 0.1, 0.2, 0.1}, {x, 0, 0}), {}, 4).mean, 0);
  EXPECT_NEAR(estimate(scene, camera_at({0.1, 0.2, 0.1}, {0, 0, 0}, 1e-5), {}, 4).mean, lit, 1e-5 * lit);
  expect_estimate(lit * 0.6, estimate(scene, camera_at({0.01, 1.5, 0.01}, {0, 0, 0}), {}, 20000), "through the pane", 4.7,
                  1e-4);
  for (const bool next_event : {false, true}) {
    PathOptions options;
    options.next_event = next_event;
    const std::string wall = quad("glow", {5, -9, -9}, {5, 9, -9}, {5, 9, 9}, {5, -9, 9});
    const Scene mirror =
        load("newmtl floor\nKd 0 0 0\nKs 0.8 0.8 0.8\nNs 10000\nillum 3\n" + gray("glow", 0, 0.5), big_floor() + wall,
             "ambient = [0.0, 0.0, 0.0]\nlight = []\nbackground = [0.125, 0.125, 0.125]\n");
    // The highlight beside the mirror sees some of the wall or the sky, too.
    const double lobe = 0.8 * 8 / 10002 * 0.5;
    EXPECT_NEAR(estimate(mirror, camera_at({-3, 3, 0}, {0, 0, 0}), options, 40000).mean, 0.8 * 0.5, lobe) << "toward (5, 5, 0)";
    EXPECT_NEAR(estimate(mirror, camera_at({3, 3, 0}, {0, 0, 0}), options, 40000).mean, 0.8 * 0.125, lobe)
        << "away from the wall";
  }
}

// Whether a layer stops a path must not tell where the path goes on: seen at d = 0.4, it adds 0.4 of what it shows at d = 1.
TEST_F(ReferencePaths, AGlossyLayerShowsWhatItWouldShowOpaque) {
  const auto seen = [&](const std::string& d) {
    const Scene scene = load("newmtl pane\nKd 0.4 0.4 0.4\nKs 0.5 0.5 0.5\nNs 10\nillum 2\n" + d,
                             quad("pane", {-9, 0, -9}, {-9, 0, 9}, {9, 0, 9}, {9, 0, -9}),
                             "ambient = [0.0, 0.0, 0.0]\nlight = []\nbackground = [1.0, 1.0, 1.0]\n");
    return estimate(scene, camera_at({0, 2, 0.1}, {0, 0, 0}), {}, 200000);
  };
  const Estimate opaque = seen(""), layer = seen("d 0.4\n");
  EXPECT_LT(opaque.mean, 0.8);
  EXPECT_NEAR(layer.mean, 0.4 * opaque.mean + 0.6, 4.7 * std::hypot(layer.error, 0.4 * opaque.error) + 1e-6);
}

}  // namespace
}  // namespace spanray
