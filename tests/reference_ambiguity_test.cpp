// The ambiguity mask: what may be seen is in it, what may not is not.
#include <gtest/gtest.h>

#include <cstdio>

#include "image/mask.h"
#include "reference/ambiguity.h"
#include "spanray/render.h"
#include "support/mesh_scene.h"

namespace spanray {
namespace {

AmbiguityMask mask_of(const Scene& scene, const Camera& camera, const Settings& settings, const AmbiguityBounds& bounds = {}) {
  AmbiguityMask mask;
  const Result<void> made = make_ambiguity_mask(scene, camera, settings, {}, bounds, mask);
  EXPECT_TRUE(made) << made.error().to_string();
  return mask;
}

// A picture of 16 x 16 pixels in which a pixel is a unit of length: pixel (x, y) has its center at (x - 7.5, 7.5 - y, 0).
constexpr int kSide = 16;
constexpr double kReach = 1.0 / 256;
std::string glowing(const std::string& name, const char* ke) {
  return "newmtl " + name + "\nKd 0 0 0\nKe " + ke + "\nillum 1\n";
}
const std::string kMaterials = glowing("red", "0.5 0 0") + glowing("green", "0 0.5 0") + glowing("blue", "0 0 0.5");
constexpr double kGlow = 187.5;  // the code of 0.5, about

class MaskOfAFewTriangles : public ::testing::Test {
 protected:
  void SetUp() override {
    camera_ = camera_at({0, 0, 8}, {0, 0, 0}, 90);
    camera_.up[0] = 0, camera_.up[1] = 1, camera_.up[2] = 0, camera_.near_plane = 0.1;
  }
  // Corners of pixel (x, y)'s mask, as sRGB codes: least and greatest of red, green and blue.
  struct Colors {
    std::array<float, 3> least, greatest;
  };
  Colors at(const std::string& obj, int x, int y) {
    const Scene scene =
        mesh_scene(folder_, kMaterials + more_, obj, "background = [0.0, 0.0, 0.0]\nambient = [0.0, 0.0, 0.0]\n" + toml_);
    Settings settings = scene.settings();
    settings.width = settings.height = kSide, settings.threads = 1;
    const AmbiguityMask mask = mask_of(scene, camera_, settings);
    Colors colors;
    for (size_t c = 0; c < 3; ++c) {
      const size_t i = 3 * (static_cast<size_t>(y) * kSide + static_cast<size_t>(x)) + c;
      colors.least[c] = mask.least[i], colors.greatest[c] = mask.greatest[i];
    }
    return colors;
  }
  static bool shows(const Colors& c, size_t channel) { return c.greatest[channel] > kGlow - 2; }
  static bool surely(const Colors& c, size_t channel) { return c.least[channel] > kGlow - 2; }
  TempFolder folder_;
  Camera camera_;
  std::string more_, toml_ = "[[light]]\nkind = \"directional\"\ndirection = [0.0, 0.0, -1.0]\nintensity = [0.0, 0.0, 0.0]\n";
};

// A quad in the plane z from x0 to x1 and -6 to 6.
std::string wall(const char* material, double x0, double x1, double z = 0) {
  return quad(material, {x0, -6, z}, {x1, -6, z}, {x1, 6, z}, {x0, 6, z});
}

TEST_F(MaskOfAFewTriangles, AnEdgeWithinReachLeavesBothSidesOpenAndNoOther) {
  // Pixel 8 has its center at x = 0.5.
  for (const double part : {-0.9, -0.2, 0.0, 0.2, 0.9}) {
    const Colors c = at(wall("red", -6, 0.5 + part * kReach), 8, 5);
    EXPECT_TRUE(shows(c, 0) && !surely(c, 0)) << part;
  }
  Colors c = at(wall("red", -6, 0.5 + 1.1 * kReach), 8, 5);
  EXPECT_TRUE(surely(c, 0));
  EXPECT_LE(c.greatest[0] - c.least[0], 2.01) << "a flat color: the step to bytes is all that is open";
  EXPECT_LE(c.greatest[1], 1.01);
  c = at(wall("red", -6, 0.5 - 1.1 * kReach), 8, 5);
  EXPECT_FALSE(shows(c, 0));
}

TEST_F(MaskOfAFewTriangles, AMeshIsTightWhereItsTrianglesShareEdges) {
  const std::string behind = wall("green", -6, 6, -1);
  // Two quads that share an edge right at the pixel's center: whatever its vertices do, nothing behind is seen.
  std::string shared =
      "v -6 -6 0\nv 0.5 -6 0\nv 6 -6 0\nv 6 6 0\nv 0.5 6 0\nv -6 6 0\nusemtl red\nf -6 -5 -2 -1\nf -5 -4 -3 -2\n";
  Colors c = at(behind + shared, 8, 5);
  EXPECT_TRUE(surely(c, 0));
  EXPECT_FALSE(shows(c, 1));
  // The same with vertices of their own, at the same places (a seam of texture coordinates), holds as well.
  c = at(behind + wall("red", -6, 0.5) + wall("red", 0.5, 6), 8, 5);
  EXPECT_TRUE(surely(c, 0) && !shows(c, 1));
  // A T-junction may open: the right side has a vertex of its own on the edge, half way up.
  const std::string t =
      "v 0.5 -6 0\nv 6 -6 0\nv 6 6 0\nv 0.5 6 0\nv 0.5 2.75 0\nusemtl red\nf -5 -4 -1\nf -4 -3 -1\nf -3 -2 -1\n";
  c = at(behind + wall("red", -6, 0.5) + t, 8, 5);
  EXPECT_TRUE(shows(c, 1) && shows(c, 0) && !surely(c, 0));
  // Folded at that edge, the mesh covers one side of it only.
  const std::string fold =
      "v -6 -6 0\nv 0.5 -6 0\nv 0.5 6 0\nv -6 6 0\nv -6 -6 -0.5\nv -6 6 -0.5\nusemtl red\nf -6 -5 -4 -3\nf -5 -2 -1 -4\n";
  c = at(behind + fold, 8, 5);
  EXPECT_TRUE(shows(c, 1) && shows(c, 0));
}

TEST_F(MaskOfAFewTriangles, EqualDepthsAreUndecidedAndOthersAreNot) {
  Colors c = at(wall("red", -6, 6) + wall("green", -6, 6), 8, 5);
  EXPECT_TRUE(shows(c, 0) && shows(c, 1) && !surely(c, 0) && !surely(c, 1));
  c = at(wall("red", -6, 6) + wall("green", -6, 6, -0.001), 8, 5);
  EXPECT_TRUE(surely(c, 0) && !shows(c, 1));
  c = at(wall("red", -6, 6) + wall("green", -6, 6, 0.001), 8, 5);
  EXPECT_TRUE(surely(c, 1) && !shows(c, 0));
  // 2^-20 of the depth, which is 8, for each of the two.
  c = at(wall("red", -6, 6) + wall("green", -6, 6, -1e-5), 8, 5);
  EXPECT_TRUE(shows(c, 0) && shows(c, 1) && !surely(c, 0));
  c = at(wall("red", -6, 6) + wall("green", -6, 6, -2e-5), 8, 5);
  EXPECT_TRUE(surely(c, 0) && !shows(c, 1));
  // Planes that cross at the pixel's center.
  c = at(wall("red", -6, 6) + quad("green", {-5.5, -6, -6}, {6.5, -6, 6}, {6.5, 6, 6}, {-5.5, 6, -6}), 8, 5);
  EXPECT_TRUE(shows(c, 0) && shows(c, 1) && !surely(c, 0) && !surely(c, 1));
}

TEST_F(MaskOfAFewTriangles, SmallTrianglesMayVanishButTheirMeshDoesNot) {
  // One of 1/1000 pixel: it may be seen, anything else at the pixel, too.
  Colors c = at("v 0.5 2.5 0\nv 0.501 2.5 0\nv 0.5 2.501 0\nusemtl red\nf -3 -2 -1\n" + wall("green", -6, 6, -1), 8, 5);
  EXPECT_TRUE(shows(c, 0) && !surely(c, 0) && shows(c, 1));
  // In the middle of a fan of large ones.
  c =
      at("v 0.5 2.5 0\nv 0.501 2.5 0\nv 0.5 2.501 0\nv -6 -6 0\nv 6 -6 0\nv 0 6 0\nusemtl red\nf 1 2 3\nf 1 4 2\nf 4 5 2\nf 5 "
         "6 2\nf 2 6 3\nf 6 4 3\n"
         "f 4 1 3\n" +
             wall("green", -6, 6, -1),
         8, 5);
  EXPECT_TRUE(surely(c, 0) && !shows(c, 1));
}

TEST_F(MaskOfAFewTriangles, AShadowsEdgeIsAsWideAsTheRaysThatAskForIt) {
  more_ = "newmtl white\nKd 1 1 1\nillum 1\n";
  toml_ =
      "[[light]]\nkind = \"point\"\nposition = [0.0, 0.0, 4.0]\nintensity = [20.0, 20.0, 20.0]\n[technique]\nshadows = "
      "\"ray\"\n";
  // A blocker half way up to the light shades x < 2 e from its edge e on. It stands before pixels left of 1.33 e + ..., which
  // are not asked.
  const auto colors = [&](double edge) { return at(wall("white", -8, 8) + wall("red", -6, edge, 2), 8, 7); };  // x = y = 0.5
  const Colors lit = colors(-1), dark = colors(0.3), left = colors(0.25 - 0.9 * kReach / 2),
               right = colors(0.25 + 0.9 * kReach / 2);
  EXPECT_GT(lit.least[0], 100);
  EXPECT_LE(lit.greatest[0] - lit.least[0], 2.5);
  EXPECT_LE(dark.greatest[0], 1.01);
  for (const Colors& c : {left, right}) EXPECT_TRUE(c.least[0] == 0 && c.greatest[0] >= lit.least[0]);
  EXPECT_GT(colors(0.25 - 1.1 * kReach / 2).least[0], 100);
  EXPECT_LE(colors(0.25 + 1.1 * kReach / 2).greatest[0], 1.01);
}

TEST_F(MaskOfAFewTriangles, AMirrorShowsBothSidesOfAnEdgeAsWell) {
  more_ = "newmtl mirror\nKd 0 0 0\nKs 1 1 1\nNs 10\nillum 3\n";
  // The mirror shows what is behind the eye at z = 16: as if it stood at z = -16, where a pixel is three units wide.
  const auto colors = [&](double edge) {
    return at(wall("mirror", -6, 6) + quad("red", {-30, -30, 16}, {edge, -30, 16}, {edge, 30, 16}, {-30, 30, 16}), 8, 5);
  };
  const Colors inside = colors(1.5 + 3 * 1.5 * kReach);
  EXPECT_TRUE(surely(inside, 0)) << inside.least[0] << " " << inside.greatest[0];
  EXPECT_FALSE(shows(colors(1.5 - 3 * 1.5 * kReach), 0));
  for (const double part : {-0.9, 0.9}) {
    const Colors c = colors(1.5 + part * 3 * kReach);
    EXPECT_TRUE(shows(c, 0) && !surely(c, 0)) << part;
  }
}

TEST_F(MaskOfAFewTriangles, APanesEdgeLeavesItsTintOpen) {
  more_ = "newmtl pane\nKd 0 0 0\nKe 0 0.5 0\nd 0.5\nillum 1\n";
  const std::string behind = wall("red", -6, 6, -1);
  const Colors with = at(behind + wall("pane", -6, 2), 8, 5), without = at(behind + wall("pane", -6, -2), 8, 5),
               edge = at(behind + wall("pane", -6, 0.5), 8, 5);
  EXPECT_LE(with.greatest[0] - with.least[0], 2.01);
  EXPECT_GT(with.least[1], 100);
  EXPECT_LT(without.greatest[1], 2);
  EXPECT_TRUE(edge.least[0] <= with.least[0] && edge.greatest[0] >= without.greatest[0] && edge.least[1] == 0 &&
              edge.greatest[1] >= with.greatest[1]);
  // Two panes at one depth may be blended in either order.
  more_ += "newmtl other\nKd 0 0 0\nKe 0 0 0.5\nd 0.5\nillum 1\n";
  const Colors both = at(behind + wall("pane", -6, 2) + wall("other", -6, 2), 8, 5);
  for (const size_t c : {1, 2}) EXPECT_GT(both.greatest[c] - both.least[c], 20) << c;
  EXPECT_LE(both.greatest[0] - both.least[0], 2.01);
}

}  // namespace
}  // namespace spanray
