// [[instance]] and [[template]] of scene files: what they mean, what is refused, and the scene written out.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>

#include "math/vec.h"
#include "scene/scene_data.h"
#include "support/scene_files.h"
#include "support/scene_invariants.h"

namespace spanray {
namespace {

// A tetrahedron with normals in object `tetra`, a square below it in group `floor tiles`.
constexpr const char* kObj = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nv -5 -1 -5\nv 5 -1 -5\nv 5 -1 5\nv -5 -1 5\nvn 0.6 0.8 0\n"
                             "o tetra\nf 1//1 3//1 2//1\nf 1 2 4\nf 1 4 3\nf 2 3 4\no base\ng floor tiles\nf 5 8 7 6\n";

class InstanceTest : public testing::Test {
 protected:
  InstanceTest() { folder_.write("a.obj", kObj); }
  std::string write(const std::string& more) { return folder_.write("s.toml", "obj = \"a.obj\"\n" + more); }
  Loaded load(const std::string& more) {
    Loaded l = must_load(write(more));
    EXPECT_EQ(broken_promise(l.scene()), "") << more;
    return l;
  }
  void expect_error(const std::string& more, int line, std::initializer_list<const char*> parts) {
    const Error e = must_fail(write(more));
    EXPECT_EQ(e.line, line) << e.to_string() << "\n" << more;
    EXPECT_NE(e.file.find("s.toml"), std::string::npos) << e.to_string();
    for (const char* part : parts) EXPECT_NE(e.message.find(part), std::string::npos) << e.to_string() << "\n" << more;
  }
  TempFolder folder_;
};

glm::dvec3 position(const Vertex& v) { return {v.position[0], v.position[1], v.position[2]}; }
glm::dvec3 normal(const Vertex& v) { return {v.normal[0], v.normal[1], v.normal[2]}; }

// Twice the area of a triangle along the normal of its front.
glm::dvec3 front(const SceneData& scene, size_t t) {
  const glm::dvec3 a = position(corner(scene, t, 0));
  return cross3(position(corner(scene, t, 1)) - a, position(corner(scene, t, 2)) - a);
}

TEST_F(InstanceTest, StandsWhereTheMapPutsIt) {
  const Loaded l = load("[[instance]]\npart = \"tetra\"\ntranslate = [10, 20, 30]\naxis = [0, 0, 7]\ndegrees = 90\nscale = [2, 3, 4]\npivot = [1, 0, 0]\n");
  const SceneData& s = l.scene();
  ASSERT_EQ(s.triangles.size(), 6u + 4u);
  ASSERT_EQ(s.instances.size(), 1u);
  EXPECT_EQ(s.instances[0].first, 6u);
  EXPECT_EQ(s.instances[0].count, 4u);
  ASSERT_EQ(s.instanced_parts.size(), 1u);
  ASSERT_EQ(s.instanced_parts[0].triangles(), 4u);
  // p -> turned by 90 degrees about z (scale * (p - pivot)) + pivot + translate
  const auto want = [](const glm::dvec3& p) { return glm::dvec3(11 - 3 * p.y, 20 + 2 * (p.x - 1), 30 + 4 * p.z); };
  for (size_t t = 0; t < 4; ++t)
    for (int v = 0; v < 3; ++v) {
      const glm::dvec3 p = want(position(corner(s, t, v)));
      double least = INFINITY;
      for (int w = 0; w < 3; ++w) least = std::min(least, length3(position(corner(s, 6 + t, w)) - p));
      EXPECT_LT(least, 1e-5) << "triangle " << t;
      const float* c = &s.instanced_parts[0].corners[9 * t + 3 * static_cast<size_t>(v)];
      least = INFINITY;
      for (int w = 0; w < 3; ++w) least = std::min(least, length3(position(corner(s, t, w)) - glm::dvec3(c[0], c[1], c[2])));
      EXPECT_EQ(least, 0) << "a part's corners are those of the file, in the order of its instances";
    }
  // A normal (0.6, 0.8, 0), scaled by its inverse and turned.
  const glm::dvec3 n = normalize3(glm::dvec3(-0.8 / 3, 0.6 / 2, 0), glm::dvec3(0));
  EXPECT_LT(length3(normal(corner(s, 6, 0)) - n), 1e-6);
  EXPECT_EQ(s.bounds_max[2], 42);
  EXPECT_EQ(s.bounds_min[0], -5);
}

TEST_F(InstanceTest, WithoutAMapItIsTheOriginal) {
  const Loaded l = load("[[instance]]\npart = \"tetra\"\n");
  const SceneData& s = l.scene();
  for (size_t t = 0; t < 4; ++t)
    for (int v = 0; v < 3; ++v) {
      EXPECT_EQ(s.triangles[t].bits, s.triangles[6 + t].bits);
      EXPECT_EQ(std::memcmp(&s.vertices[s.triangles[t].vertex[v]], &s.vertices[s.triangles[6 + t].vertex[v]], sizeof(Vertex)), 0);
    }
}

TEST_F(InstanceTest, AMirroredCopyKeepsItsFrontAndItsNormals) {
  const Loaded plain = load("");
  for (const char* scale : {"-1", "[-1, 1, 1]", "[1, -2, 1]", "[0.5, 1, -3]", "[-1, -1, 1]", "[-2, -1, -1]", "[-1e-3, 1e3, 1]"}) {
    const Loaded l = load(std::string("[[instance]]\npart = \"tetra\"\naxis = [1, 2, 3]\ndegrees = 50\nscale = ") + scale + "\n");
    const SceneData& s = l.scene();
    const double (&m)[3][3] = s.instances[0].world_from_part.linear;
    for (size_t t = 0; t < 4; ++t) {
      // What the front saw before, it sees after: a point before the triangle goes to a point before the copy.
      const glm::dvec3 f = front(plain.scene(), t), at = position(corner(plain.scene(), t, 0)) + f;
      glm::dvec3 to;
      for (int k = 0; k < 3; ++k) to[k] = m[k][0] * at.x + m[k][1] * at.y + m[k][2] * at.z;
      const glm::dvec3 copied = front(s, 6 + t);
      EXPECT_GT(dot3(to - position(corner(s, 6 + t, 0)), copied), 0) << scale << " triangle " << t;
      if (t == 0) continue;  // that one's normal is the file's
      EXPECT_GT(dot3(normal(corner(s, 6 + t, 0)), copied) / length3(copied), 0.99) << scale << " triangle " << t;
    }
  }
}

TEST_F(InstanceTest, TrianglesAreInCanonicalOrder) {
  const Loaded l = load("[[instance]]\npart = \"tetra\"\naxis = [1, 2, 3]\ndegrees = 170\nscale = -1.5\n[[instance]]\npart = \"floor\"\nscale = 0.1\naxis = [1, 1, 0]\ndegrees = 20\n");
  const SceneData& s = l.scene();
  ASSERT_EQ(s.triangles.size(), 6u + 4u + 2u);
  for (const Triangle& t : s.triangles)
    for (int v = 0; v < 2; ++v) {
      const float *a = s.vertices[t.vertex[v]].position, *b = s.vertices[t.vertex[v + 1]].position;
      EXPECT_FALSE(std::lexicographical_compare(b, b + 3, a, a + 3));
    }
}

TEST_F(InstanceTest, ATemplateStandsAsInstancesOnly) {
  const Loaded l = load("[[template]]\npart = \"tetra\"\n[[instance]]\npart = \"tetra\"\ntranslate = [0, 0, 100]\n[[instance]]\npart = \"tetra\"\n");
  const SceneData& s = l.scene();
  ASSERT_EQ(s.triangles.size(), 2u + 8u);
  EXPECT_EQ(s.bounds_max[2], 103);
  EXPECT_EQ(s.instances[0].first, 2u);
  EXPECT_EQ(s.instances[1].first, 6u);
  ASSERT_EQ(s.parts.size(), 2u);
  EXPECT_EQ(s.part_names[s.parts[0].object], "base");
  EXPECT_EQ(s.part_names[s.parts[1].object], "tetra");
  EXPECT_EQ(s.parts[1].first, 2u);
}

TEST_F(InstanceTest, EveryPartCanBeATemplate) {
  const Loaded l = load("[[template]]\npart = \"tetra\"\n[[template]]\npart = \"tiles\"\n[[instance]]\npart = \"tetra\"\ntranslate = [7, 7, 7]\n[[instance]]\npart = \"tiles\"\ntranslate = [7, 7, 7]\n");
  EXPECT_EQ(l.scene().triangles.size(), 6u);
  EXPECT_EQ(l.scene().bounds_min[0], 2);
  EXPECT_EQ(l.scene().bounds_max[0], 12);
}

TEST_F(InstanceTest, WhatIsRefused) {
  const std::string of = "[[instance]]\npart = \"tetra\"\n";
  expect_error("[[instance]]\ntranslate = [0, 0, 0]\n", 2, {"part", "missing"});
  expect_error("[[instance]]\npart = \"\"\n", 3, {"empty"});
  expect_error("[[instance]]\npart = \"tetre\"\n", 3, {"'tetre'", "did you mean", "'tetra'", "'floor'"});
  expect_error(of + "turn = 3\n", 4, {"unknown key 'turn'"});
  expect_error(of + "scale = 0\n", 4, {"scale", "0"});
  expect_error(of + "scale = [1, 0, 1]\n", 4, {"scale", "0"});
  expect_error(of + "scale = [1, 1e-10, 1]\n", 4, {"scale"});
  expect_error(of + "scale = 1e10\n", 4, {"scale", "1e+09"});
  expect_error(of + "scale = nan\n", 4, {"scale", "nan"});
  expect_error(of + "scale = [1, -inf, 1]\n", 4, {"scale", "inf"});
  expect_error(of + "scale = [1, 2]\n", 4, {"scale", "3 numbers"});
  expect_error(of + "scale = \"big\"\n", 4, {"scale", "number"});
  expect_error(of + "translate = [0, inf, 0]\n", 4, {"translate", "inf"});
  expect_error(of + "degrees = 3\n", 4, {"degrees", "axis"});
  expect_error(of + "axis = [0, 1, 0]\n", 4, {"axis", "degrees"});
  expect_error(of + "axis = [0, 0, 0]\ndegrees = 3\n", 4, {"axis", "no length"});
  expect_error("instance = 3\n", 2, {"[[instance]]"});
  expect_error("[[template]]\npart = \"tetra\"\n", 3, {"'tetra'", "[[instance]]"});
  expect_error(of + "[[template]]\n", 4, {"part", "missing"});
  expect_error(of + "[[moving]]\npart = \"tetra\"\naxis = [0, 1, 0]\ndegrees_per_second = 1\n", 3, {"move", "'tetra'"});
}

TEST_F(InstanceTest, WhatReachesTooFarOutIsRefused) {
  folder_.write("a.obj", "v 0 0 0\nv 1e29 0 0\nv 0 1e29 0\no far\nf 1 2 3\n");
  expect_error("[[instance]]\npart = \"far\"\n[[instance]]\npart = \"far\"\nscale = 100\n", 5, {"'far'", "1e30"});
}

TEST_F(InstanceTest, TooManyTrianglesAreRefusedBeforeTheyAreMade) {
  std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\no many\n", toml;
  for (int i = 0; i < 70000; ++i) obj += "f 1 2 3\n";
  folder_.write("a.obj", obj);
  for (int i = 0; i < 3840; ++i) toml += "[[instance]]\npart = \"many\"\n";  // 70000 * 3841 > 2^28
  expect_error(toml, 2 * 3834 + 1, {"'many'", "too large", "2^28"});
}

TEST_F(InstanceTest, TheHashKnowsTheInstances) {
  const std::string of = "[[instance]]\npart = \"tetra\"\n";
  std::vector<uint64_t> seen;
  for (const std::string& more : {std::string(), of, of + "scale = 2\n", of + "translate = [0, 1, 0]\n", of + "axis = [1, 0, 0]\ndegrees = 1\n", of + of,
                                  of + "[[template]]\npart = \"tetra\"\n"}) {
    const uint64_t hash = load(more).scene().hash;
    EXPECT_EQ(std::count(seen.begin(), seen.end(), hash), 0) << more;
    seen.push_back(hash);
  }
}

}  // namespace
}  // namespace spanray
