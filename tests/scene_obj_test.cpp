// OBJ files: polygons, indices, normals, line ends, numbers.
#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <set>

#include "core/parallel.h"
#include "math/vec.h"
#include "scene/obj_mesh.h"
#include "support/scene_files.h"

namespace spanray {
namespace {

constexpr const char* kQuad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

glm::dvec3 vec(const float* p) { return {p[0], p[1], p[2]}; }

double signed_area_xy(const SceneData& scene) {
  double area = 0;
  for (size_t i = 0; i < scene.triangles.size(); ++i) {
    const glm::dvec3 a = vec(corner(scene, i, 0).position), b = vec(corner(scene, i, 1).position),
                     c = vec(corner(scene, i, 2).position);
    area += cross3(b - a, c - a).z / 2;
  }
  return area;
}

TEST(ObjPolygons, ConvexPolygonBecomesAFanWithItsArea) {
  const TempFolder folder;
  const Loaded quad = must_load(folder.write("quad.obj", std::string(kQuad) + "f 1 2 3 4\n"));
  ASSERT_EQ(quad.scene().triangles.size(), 2u);
  EXPECT_EQ(quad.scene().vertices.size(), 4u);
  EXPECT_EQ(signed_area_xy(quad.scene()), 1.0);
}

// Any simple polygon: as many triangles as corners less two, all counter-clockwise, the areas summing to its own.
TEST(ObjPolygons, ConcavePolygonsAreCoveredExactlyOnce) {
  const TempFolder folder;
  std::mt19937 rng(7);
  for (int round = 0; round < 50; ++round) {
    const int n = 4 + round;
    std::string text;
    double want = 0;
    std::vector<glm::dvec2> points;
    for (int i = 0; i < n; ++i) {  // a star-shaped polygon around the origin, corners at increasing slope around it
      const double radius = 1 + static_cast<double>(rng() % 8), angle = 6.283185307179586 * i / n;
      points.push_back({static_cast<float>(radius * std::cos(angle)), static_cast<float>(radius * std::sin(angle))});
      char line[100];
      std::snprintf(line, sizeof line, "v %.9g %.9g 5\n", points.back().x, points.back().y);
      text += line;
    }
    text += "f";
    for (int i = 0; i < n; ++i) {
      const glm::dvec2 &a = points[static_cast<size_t>(i)], &b = points[static_cast<size_t>((i + 1) % n)];
      want += (a.x * b.y - a.y * b.x) / 2;
      text += " " + std::to_string(i + 1);
    }
    const Loaded star = must_load(folder.write("star.obj", text + "\n"));
    ASSERT_EQ(star.scene().triangles.size(), static_cast<size_t>(n - 2));
    EXPECT_NEAR(signed_area_xy(star.scene()), want, 1e-9 * want);
    for (size_t i = 0; i < star.scene().triangles.size(); ++i) {
      const glm::dvec3 a = vec(corner(star.scene(), i, 0).position), b = vec(corner(star.scene(), i, 1).position),
                       c = vec(corner(star.scene(), i, 2).position);
      EXPECT_GE(cross3(b - a, c - a).z, 0) << "round " << round << " triangle " << i;
    }
  }
}

TEST(ObjPolygons, CollinearCornersLeaveNoTJunction) {
  const TempFolder folder;
  const Loaded l = must_load(folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4 5\n"));
  ASSERT_EQ(l.scene().triangles.size(), 3u);
  EXPECT_EQ(signed_area_xy(l.scene()), 4.0);
  EXPECT_EQ(l.count({"no area"}), 0) << l.all_messages();
  std::set<const float*> used;
  for (size_t i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) used.insert(corner(l.scene(), i, k).position);
  EXPECT_EQ(used.size(), 5u);
}

TEST(ObjPolygons, RepeatedAndCrossingCornersGiveSomethingFinite) {
  const TempFolder folder;
  for (const char* face :
       {"f 1 1 2 3 4\n", "f 1 2 3 4 4 1\n", "f 1 3 2 4\n", "f 1 1 1 1\n", "f 1 2 1 2\n", "f 1 2 1 3 1 4\n"}) {
    const Loaded l = must_load(folder.write("a.obj", std::string(kQuad) + face));
    for (const Vertex& v : l.scene().vertices)
      for (int k = 0; k < 3; ++k) EXPECT_TRUE(std::isfinite(v.normal[k])) << face;
  }
  EXPECT_EQ(must_load(folder.write("b.obj", std::string(kQuad) + "f 1 1 2 3 3 4\n")).scene().triangles.size(), 2u);
}

TEST(ObjPolygons, NoInputMakesTriangulationSlow) {
  std::string text;
  for (int i = 0; i < 20000; ++i) text += "v " + std::to_string(i) + " " + std::to_string(i % 2 * (i + 7) % 13) + " 0\n";
  text += "f";
  for (int i = 1; i <= 20000; ++i) text += " " + std::to_string(i);
  const TempFolder folder;
  const Loaded l = must_load(folder.write("comb.obj", text + "\n"));
  EXPECT_GT(l.scene().triangles.size(), 10000u);
}

TEST(ObjIndices, NegativeOnesCountFromTheLastVertex) {
  const TempFolder folder;
  const Loaded positive = must_load(folder.write("p.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nv 5 5 5\n"));
  const Loaded negative = must_load(folder.write("n.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\n"));
  EXPECT_EQ(positive.scene().hash, negative.scene().hash);
}

TEST(ObjIndices, PositiveOnesMayPointAhead) {
  const TempFolder folder;
  EXPECT_EQ(must_load(folder.write("a.obj", "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n")).scene().triangles.size(), 1u);
}

TEST(ObjIndices, AllFormsOfCorners) {
  const TempFolder folder;
  const std::string head = std::string(kQuad) + "vt 0.25 0.5\nvn 0 0 -1\n";
  for (const char* face : {"f 1/1/1 2/1/1 3/1/1\n", "f 1/1 2/1 3/1\n", "f 1//1 2//1 3//1\n", "f 1 2 3\n", "f 1/ 2/1/ 3//\n",
                           "f\t1/1  2/-1/-1 \t 3/1/1   # last\n"}) {
    const Loaded l = must_load(folder.write("a.obj", head + face));
    ASSERT_EQ(l.scene().triangles.size(), 1u) << face;
    EXPECT_EQ(l.scene().vertices.size(), 3u);
  }
  const Loaded l = must_load(folder.write("b.obj", head + "f 1/1/1 2/1/1 3/1/1\n"));
  EXPECT_EQ(l.scene().vertices[0].uv[0], 0.25f);
  EXPECT_EQ(l.scene().vertices[0].normal[2], -1.0f);
}

TEST(ObjText, LineEndsCommentsContinuationsAndMarksMeanNothing) {
  const TempFolder folder;
  const Loaded lf = must_load(folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  for (const char* same :
       {"v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n", "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3",
        "\xef\xbb\xbfv 0 0 0 # origin\n\n\t v 1 0 0\n  v 0 1 0\nf 1 2 3 #1 2",
        "v 0 0 \\\n0\nv 1 \\\r\n 0 0\nv 0 1 0\nf 1 \\\n2 \\\n3", "v -0 0 -0.0\nv +1 0e5 0.\nv 0 10e-1 .0\nf 1 2 3",
        "v 0 0 0 1 0.5 0.5 0.5\nv 1 0 0 1\nv 0 1 0 0 0 0\ng a b c\no x\ns 1\nf 1 2 3"}) {
    const Loaded other = must_load(folder.write("b.obj", same));
    EXPECT_EQ(lf.scene().hash, other.scene().hash) << same;
  }
}

TEST(ObjText, ErrorsNameTheLineAfterContinuationsToo) {
  const TempFolder folder;
  EXPECT_EQ(must_fail(folder.write("a.obj", "v 0 0 \\\n0\nv 1 0 0\nv 0 1 0\nf 1 2 \\\n3\nf 1 2 9\n")).line, 7);
  EXPECT_EQ(must_fail(folder.write("b.obj", "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\n\r\nf 1 2 4\r\n")).line, 5);
  EXPECT_EQ(must_fail(folder.write("c.obj", "v 0 0 0\rv 1 0 0\rv 0 1 0\r\rf 1 2 x")).line, 5);
}

TEST(ObjNumbers, DecimalsAreRoundedCorrectlyAndInAnyLocale) {
  const char* const words[] = {"0.1",
                               "16777217",
                               "16777219",
                               "1.000000059604644775390625",
                               "3.4028235e38",
                               "1e-45",
                               "7.0064923216240862e-46",
                               "123456789.123456789",
                               "-1.17549435e-38",
                               "0.30000001192092896"};
  std::string text;
  for (const char* w : words) text += std::string("v ") + w + " 0 0\n";
  Messages messages;
  const bool comma = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
  const Result<ObjMesh> mesh = read_obj(text, "a.obj", messages);
  std::setlocale(LC_ALL, "C");
  if (!comma) std::printf("no German locale on this machine: only the C locale tested\n");
  ASSERT_TRUE(mesh);
  for (size_t i = 0; i < std::size(words); ++i)
    EXPECT_EQ(mesh.value().positions[3 * i], std::strtof(words[i], nullptr)) << words[i];
}

TEST(ObjNumbers, R14_OnlyTrianglesOfNotFiniteVerticesAreLostAndCounted) {
  const TempFolder folder;
  for (const char* bad :
       {"nan", "inf", "-inf", "1e39", "-1e999", "NaN", "infinity", "99999999999999999999999999999999999999999999"}) {
    const std::string text = std::string(kQuad) + "v " + bad + " 0 0\nf 1 2 3\nf 1 2 5\nf 1 3 4\nf 1 2 3 5\n";
    const Loaded l = must_load(folder.write("a.obj", text));
    EXPECT_EQ(l.scene().triangles.size(), 3u) << bad;  // the quad keeps the one triangle without the bad vertex
    EXPECT_EQ(l.count({"a.obj:7:", "2 triangles dropped"}), 1) << l.all_messages();
    for (const Vertex& v : l.scene().vertices)
      for (int k = 0; k < 3; ++k) EXPECT_TRUE(std::isfinite(v.position[k]) && std::isfinite(v.normal[k]));
  }
}

TEST(ObjNumbers, NotFiniteNormalsAndCoordinatesAreRepairedAndCounted) {
  const TempFolder folder;
  const Loaded l =
      must_load(folder.write("a.obj", std::string(kQuad) + "vn nan 0 1\nvn 0 0 0\nvt inf 0\nf 1/1/1 2/1/2 3/1/1\n"));
  EXPECT_EQ(l.count({"3 corners", "normal"}), 1) << l.all_messages();
  EXPECT_EQ(l.count({"3 corners", "texture coordinates"}), 1) << l.all_messages();
  EXPECT_EQ(l.scene().vertices[0].normal[2], 1.0f);
}

// A cube whose faces are given as quads without normals.
std::string cube(const char* smoothing) {
  return std::string("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n") + smoothing +
         "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";
}

TEST(ObjNormals, CreaseAngleDecidesBetweenHardAndSmoothEdges) {
  const TempFolder folder;
  const std::string path = folder.write("cube.obj", cube(""));
  LoadOptions smooth;
  smooth.crease_angle_degrees = 100;
  const Loaded hard = must_load(path), soft = must_load(path, smooth);
  EXPECT_EQ(hard.scene().vertices.size(), 24u);  // a vertex a face
  EXPECT_EQ(soft.scene().vertices.size(), 8u);   // one normal a corner of the cube
  for (const Vertex& v : soft.scene().vertices)  // weighted by angle: along the diagonal, however the quads are cut
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(v.normal[k], (v.position[k] - 0.5f) * 2 / std::sqrt(3.0), 1e-6);
}

TEST(ObjNormals, SmoothingOffIsFlatAndGroupsDoNotMix) {
  const TempFolder folder;
  LoadOptions smooth;
  smooth.crease_angle_degrees = 180;
  EXPECT_EQ(must_load(folder.write("off.obj", cube("s off\n")), smooth).scene().vertices.size(), 24u);
  EXPECT_EQ(must_load(folder.write("zero.obj", cube("s 0\n")), smooth).scene().vertices.size(), 24u);
  EXPECT_EQ(must_load(folder.write("one.obj", cube("s 1\n")), smooth).scene().vertices.size(), 8u);
  const std::string roof = "v 0 0 0\nv 0 0 1\nv 1 0.1 0\nv -1 0.1 0\ns 1\nf 1 2 3\ns 2\nf 1 4 2\n";
  EXPECT_EQ(must_load(folder.write("two.obj", roof), smooth).scene().vertices.size(), 6u);
}

TEST(ObjNormals, SeamsInIndicesAreSmoothedByPosition) {
  const TempFolder folder;
  // The same fold twice: once with shared, once with repeated positions (one of them written with -0).
  const Loaded shared = must_load(folder.write("a.obj", "v 0 0 0\nv 0 0 1\nv 1 0.1 0\nv -1 0.1 0\nf 1 2 3\nf 1 4 2\n"));
  const Loaded seam =
      must_load(folder.write("b.obj", "v 0 0 0\nv 0 0 1\nv 1 0.1 0\nv -1 0.1 0\nv -0 0 0\nv 0 -0 1\nf 1 2 3\nf 5 4 6\n"));
  EXPECT_EQ(shared.scene().vertices.size(), 4u);
  EXPECT_EQ(shared.scene().hash, seam.scene().hash);
}

TEST(ObjNormals, SphereNormalsAreRadial) {
  std::string text;
  const int rings = 16, slices = 32;
  for (int r = 0; r <= rings; ++r)
    for (int s = 0; s < slices; ++s) {
      const double theta = 3.141592653589793 * r / rings, phi = 6.283185307179586 * s / slices;
      char line[100];
      std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", std::sin(theta) * std::cos(phi), std::cos(theta),
                    -std::sin(theta) * std::sin(phi));
      text += line;
    }
  for (int r = 0; r < rings; ++r)
    for (int s = 0; s < slices; ++s) {
      const int a = r * slices + s + 1, b = r * slices + (s + 1) % slices + 1;
      text += "f " + std::to_string(a) + " " + std::to_string(a + slices) + " " + std::to_string(b + slices) + " " +
              std::to_string(b) + "\n";
    }
  const TempFolder folder;
  const Loaded l = must_load(folder.write("sphere.obj", text));
  double worst = 1;
  for (const Vertex& v : l.scene().vertices)
    worst = std::min(worst, dot3(vec(v.normal), normalize3(vec(v.position), glm::dvec3(0))));
  EXPECT_GT(worst, 0.995);
}

TEST(ObjNormals, CrowdedPointsStayFast) {
  std::string text = "v 0 0 0\n";
  for (int i = 0; i < 30000; ++i) text += "v 1 " + std::to_string(i) + " " + std::to_string(i % 7) + "\n";
  for (int i = 2; i < 30000; ++i) text += "f 1 " + std::to_string(i) + " " + std::to_string(i + 1) + "\n";
  const TempFolder folder;
  const Loaded l = must_load(folder.write("fan.obj", text));
  EXPECT_EQ(l.scene().triangles.size(), 29998u);
  EXPECT_EQ(l.count({"own normal"}), 1);
}

TEST(SceneInvariants, CanonicalOrderKeepsTheWinding) {
  const TempFolder folder;
  for (const char* face : {"f 1 2 3\n", "f 2 3 1\n", "f 3 1 2\n"}) {
    const Loaded l = must_load(folder.write("a.obj", std::string(kQuad) + face));
    EXPECT_EQ(signed_area_xy(l.scene()), 0.5) << face;
  }
  for (const char* face : {"f 3 2 1\n", "f 2 1 3\n", "f 1 3 2\n"}) {
    const Loaded l = must_load(folder.write("a.obj", std::string(kQuad) + face));
    EXPECT_EQ(signed_area_xy(l.scene()), -0.5) << face;
    const Triangle& t = l.scene().triangles[0];
    for (int k = 0; k < 2; ++k) {
      const float *p = l.scene().vertices[t.vertex[k]].position, *q = l.scene().vertices[t.vertex[k + 1]].position;
      EXPECT_TRUE(std::lexicographical_compare(p, p + 3, q, q + 3));
    }
  }
}

TEST(SceneInvariants, HashIsTheSameTwiceAndOnAnyThread) {
  const TempFolder folder;
  const std::string path = folder.write("cube.obj", cube("s 1\n"));
  const uint64_t want = must_load(path).scene().hash;
  std::vector<uint64_t> hashes(32);
  Parallel(7).for_each(hashes.size(), [&](size_t i, int) { hashes[i] = load_scene(path).value().scene.hash(); });
  for (const uint64_t h : hashes) EXPECT_EQ(h, want);
  EXPECT_NE(want, must_load(folder.write("other.obj", cube("s 1\nv 2 2 2\n") + "f 1 2 9\n")).scene().hash);
}

}  // namespace
}  // namespace spanray
