// [[moving]] of scene files: what it means, what is refused, and scenes posed at a time.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "math/elementary.h"
#include "math/vec.h"
#include "scene/pose.h"
#include "support/moving_scene.h"
#include "support/scene_files.h"
#include "support/scene_invariants.h"

namespace spanray {
namespace {

// Two squares in objects and groups; vertices 3 and 4 are shared by both in the file.
constexpr const char* kObj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 2 0\nv 0 2 0\n"
                             "o low\nf 1 2 3 4\no high\ng lid brass\nf 4 3 5 6\no rest\ng\nf 1 2 6\n";

class MotionTest : public testing::Test {
 protected:
  MotionTest() { folder_.write("a.obj", kObj); }
  std::string write(const std::string& moving) { return folder_.write("s.toml", "obj = \"a.obj\"\n" + moving); }
  Loaded load(const std::string& moving) { return must_load(write(moving)); }
  std::vector<Motion> motions(const std::string& moving) { return load(moving).scene().motions; }
  void expect_error(const std::string& moving, int line, std::initializer_list<const char*> parts) {
    const Error e = must_fail(write(moving));
    EXPECT_EQ(e.line, line) << e.to_string() << "\n" << moving;
    EXPECT_NE(e.file.find("s.toml"), std::string::npos) << e.to_string();
    for (const char* part : parts) EXPECT_NE(e.message.find(part), std::string::npos) << e.to_string() << "\n" << moving;
  }
  TempFolder folder_;
};

glm::dvec3 moved(const RigidPose& pose, const glm::dvec3& p) {
  glm::dvec3 q;
  for (int k = 0; k < 3; ++k) q[k] = pose.rotation[k][0] * p.x + pose.rotation[k][1] * p.y + pose.rotation[k][2] * p.z + pose.offset[k];
  return q;
}

void expect_at(const std::vector<Motion>& motions, size_t which, double time, const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 p = moved(poses_at(motions, time)[which], from);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(p[k], to[k], 1e-12) << "time " << time << ", axis " << k;
}

TEST_F(MotionTest, ASpinTurnsCounterClockwiseAboutItsPivot) {
  const auto m = motions("[[moving]]\npart = \"lid\"\npivot = [1, 0, 0]\naxis = [0, 0, 2]\ndegrees_per_second = 30\n");
  expect_at(m, 0, 3, {2, 0, 5}, {1, 1, 5});
  expect_at(m, 0, -3, {2, 0, 5}, {1, -1, 5});
  expect_at(m, 0, 12000, {2, 0, 5}, {2, 0, 5});
  EXPECT_EQ(poses_at(m, 0)[0], RigidPose());
  EXPECT_EQ(poses_at(m, 12)[0], RigidPose());  // a full turn is none, exactly
}

TEST_F(MotionTest, KeysAreInterpolatedAndHeld) {
  const auto m = motions("[[moving]]\npart = \"lid\"\naxis = [0, 1, 0]\n"
                         "key = [{time = 1}, {time = 3, translation = [4, 0, 0], degrees = 180}, {time = 4, translation = [4, 1, 0], degrees = 180}]\n");
  expect_at(m, 0, -7, {0, 0, 1}, {0, 0, 1});
  expect_at(m, 0, 1, {0, 0, 1}, {0, 0, 1});
  expect_at(m, 0, 2, {0, 0, 1}, {3, 0, 0});
  expect_at(m, 0, 3, {0, 0, 1}, {4, 0, -1});
  expect_at(m, 0, 3.25, {0, 0, 1}, {4, 0.25, -1});
  expect_at(m, 0, 99, {0, 0, 1}, {4, 1, -1});
}

TEST_F(MotionTest, TurnsOfOneAxisCountFully) {  // 720 degrees are two turns, not none
  const auto m = motions("[[moving]]\npart = \"lid\"\nkey = [{time = 0}, {time = 8, axis = [0, 0, 1], degrees = 720}]\n");
  expect_at(m, 0, 1, {1, 0, 0}, {0, 1, 0});
  expect_at(m, 0, 2, {1, 0, 0}, {-1, 0, 0});
}

TEST_F(MotionTest, BetweenAxesTheShortestWay) {
  const auto m = motions("[[moving]]\npart = \"lid\"\n"
                         "key = [{time = 0, axis = [1, 0, 0], degrees = 90}, {time = 1, axis = [0, 1, 0], degrees = 90}]\n");
  expect_at(m, 0, 0, {0, 1, 0}, {0, 0, 1});
  expect_at(m, 0, 1, {0, 0, 1}, {1, 0, 0});
  // Half way from quaternion (s, s, 0, 0) to (s, 0, s, 0): (2, 1, 1, 0) / sqrt 6.
  expect_at(m, 0, 0.5, {1, 0, 0}, {2 / 3.0, 1 / 3.0, -2 / 3.0});
  // A constant speed: a quarter of the way twice is half of it. The angle between the ends is 120 degrees.
  const auto axis_of = [&](double t) { return moved(poses_at(m, t)[0], {0, 0, 1}); };
  const double quarter = std::acos(dot3(axis_of(0), axis_of(0.25))), next = std::acos(dot3(axis_of(0.25), axis_of(0.5)));
  EXPECT_GT(quarter, 0.1);
  EXPECT_GT(next, 0.1);
  for (const double t : {0.0, 0.1, 0.37, 0.5, 0.99, 1.0}) {
    const RigidPose p = poses_at(m, t)[0];
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) {
        double dot = 0;
        for (int c = 0; c < 3; ++c) dot += p.rotation[i][c] * p.rotation[k][c];
        EXPECT_NEAR(dot, i == k, 1e-14);
      }
  }
}

TEST_F(MotionTest, RepeatedKeysBeginAgain) {
  const auto m = motions("[[moving]]\npart = \"lid\"\nrepeat = true\nkey = [{time = 1}, {time = 3, translation = [2, 0, 0]}, {time = 5}]\n");
  for (const double t : {2.0, 6.0, -2.0, 4002.0}) expect_at(m, 0, t, {0, 0, 0}, {1, 0, 0});
  for (const double t : {3.0, 7.0, -1.0}) expect_at(m, 0, t, {0, 0, 0}, {2, 0, 0});
}

TEST_F(MotionTest, APartIsCarriedByAnother) {
  const auto m = motions("[[moving]]\npart = \"low\"\naxis = [0, 1, 0]\ndegrees_per_second = 90\n"
                         "[[moving]]\npart = \"lid\"\ncarried_by = \"low\"\npivot = [1, 0, 0]\naxis = [0, 1, 0]\ndegrees_per_second = 90\n");
  // Its own quarter turn about (1, 0, 0) takes (2, 0, 0) to (1, 0, -1); the carrier's takes that to (-1, 0, -1).
  expect_at(m, 1, 1, {2, 0, 0}, {-1, 0, -1});
  expect_at(m, 0, 1, {2, 0, 0}, {0, 0, -2});
}

TEST_F(MotionTest, PartsAreObjectsGroupsAndWholeLines) {
  for (const char* name : {"lid", "brass", "lid brass", "high"}) {
    const Loaded l = load(std::string("[[moving]]\npart = \"") + name + "\"\naxis = [0, 0, 1]\ndegrees_per_second = 1\n");
    ASSERT_EQ(l.scene().moving_triangles.size(), 1u) << name;
    EXPECT_EQ(l.scene().moving_triangles[0].first, 2u);
    EXPECT_EQ(l.scene().moving_triangles[0].count, 2u);
  }
}

TEST_F(MotionTest, APartSharesNoVertexWithWhatStands) {
  const Loaded still = load(""), l = load("[[moving]]\npart = \"lid\"\naxis = [0, 0, 1]\ndegrees_per_second = 1\n");
  EXPECT_EQ(l.scene().vertices.size(), still.scene().vertices.size() + 3);  // the two it shared, and one with `rest`
  EXPECT_EQ(l.scene().moving_vertices.size(), 1u);
  EXPECT_EQ(l.scene().moving_vertices[0].count, 4u);
  std::vector<bool> moves(l.scene().vertices.size());
  for (const MovingRun& run : l.scene().moving_vertices)
    for (uint32_t i = run.first; i < run.first + run.count; ++i) moves[i] = true;
  for (size_t t = 0; t < l.scene().triangles.size(); ++t)
    for (const uint32_t v : l.scene().triangles[t].vertex) EXPECT_EQ(moves[v], t == 2 || t == 3);
}

TEST_F(MotionTest, ATechniqueMayNameTheTime) {
  EXPECT_EQ(load("[technique]\ntime = -2.5\n").scene().settings.time, -2.5);
  expect_error("[technique]\ntime = 2e6\n", 3, {"'time'", "1e+06"});
}

TEST_F(MotionTest, TheHashKnowsTheMotion) {
  const std::string spin = "[[moving]]\npart = \"lid\"\naxis = [0, 0, 1]\ndegrees_per_second = 1\n";
  const std::vector<std::string> all = {"", spin, "[[moving]]\npart = \"low\"\naxis = [0, 0, 1]\ndegrees_per_second = 1\n",
      "[[moving]]\npart = \"lid\"\naxis = [0, 0, 1]\ndegrees_per_second = 2\n", "[[moving]]\npart = \"lid\"\naxis = [0, 1, 1]\ndegrees_per_second = 1\n",
      "[[moving]]\npart = \"lid\"\npivot = [0, 0, 1]\naxis = [0, 0, 1]\ndegrees_per_second = 1\n",
      "[[moving]]\npart = \"lid\"\nkey = [{time = 0}, {time = 1, translation = [1, 0, 0]}]\n",
      "[[moving]]\npart = \"lid\"\nkey = [{time = 0}, {time = 2, translation = [1, 0, 0]}]\n",
      "[[moving]]\npart = \"lid\"\nrepeat = true\nkey = [{time = 0}, {time = 2, translation = [1, 0, 0]}]\n"};
  for (size_t i = 0; i < all.size(); ++i)
    for (size_t j = 0; j < i; ++j) EXPECT_NE(load(all[i]).loaded.scene.hash(), load(all[j]).loaded.scene.hash()) << all[i] << all[j];
  EXPECT_EQ(load(spin).loaded.scene.hash(), load(spin).loaded.scene.hash());
}

TEST_F(MotionTest, WhatIsWrongIsSaid) {
  const std::string lid = "[[moving]]\npart = \"lid\"\n";  // lines 2 and 3
  expect_error("[[moving]]\npart = \"lit\"\naxis = [0, 1, 0]\ndegrees_per_second = 1\n", 3,
               {"'lit'", "did you mean", "'brass', 'high', 'lid', 'lid brass', 'low', 'rest'"});
  expect_error("[[moving]]\naxis = [0, 1, 0]\n", 2, {"'part'", "missing"});
  expect_error("moving = 3\n", 2, {"list of tables"});
  expect_error(lid, 3, {"does not move"});
  expect_error(lid + "speed = 3\nkey = [{time = 0}]\n", 4, {"unknown key 'speed'"});
  expect_error(lid + "degrees_per_second = 3\n", 4, {"needs an axis"});
  expect_error(lid + "axis = [0, 0, 0]\ndegrees_per_second = 3\n", 4, {"no length"});
  expect_error(lid + "axis = [0, nan, 0]\ndegrees_per_second = 3\n", 4, {"'axis'"});
  expect_error(lid + "axis = [0, 1, 0]\ndegrees_per_second = inf\n", 5, {"'degrees_per_second'"});
  expect_error(lid + "pivot = [1e13, 1, 0]\nkey = [{time = 0}]\n", 4, {"'pivot'"});
  expect_error(lid + "key = [{time = 0}]\ndegrees_per_second = 3\n", 5, {"exclude"});
  expect_error(lid + "key = []\n", 4, {"is empty"});
  expect_error(lid + "key = [{time = 0}, {time = 0}]\n", 4, {"'time'", "greater"});
  expect_error(lid + "[[moving.key]]\ntime = 1\n[[moving.key]]\ntime = 0.5\n", 7, {"'time'", "greater"});
  expect_error(lid + "key = [{time = nan}]\n", 4, {"'time'"});
  expect_error(lid + "key = [{translation = [1, 0, 0]}]\n", 4, {"'time'", "missing"});
  expect_error(lid + "key = [{time = 0, translation = [1, 0]}]\n", 4, {"'translation'"});
  expect_error(lid + "key = [{time = 0, degrees = 3}]\n", 4, {"'degrees'", "needs an axis"});
  expect_error(lid + "key = [{time = 0, degrees = 3, axis = [0, 0, 0]}]\n", 4, {"'axis'", "no length"});
  expect_error(lid + "repeat = true\nkey = [{time = 0}]\n", 4, {"two keys"});
  expect_error(lid + "repeat = true\naxis = [0, 1, 0]\ndegrees_per_second = 1\n", 4, {"is for keys"});
  expect_error(lid + "key = [{time = 0}]\n" + lid + "key = [{time = 0}]\n", 6, {"moves already"});
  expect_error(lid + "key = [{time = 0}]\n[[moving]]\npart = \"high\"\nkey = [{time = 0}]\n", 6, {"'high'", "'lid'", "one part only"});
  expect_error(lid + "carried_by = \"low\"\nkey = [{time = 0}]\n", 4, {"'low'", "above"});
  expect_error(lid + "carried_by = \"lid\"\nkey = [{time = 0}]\n", 4, {"'lid'", "above"});
}

TEST(PosedScene, KeepsThePromisesOfASceneAndForgetsThePast) {
  const TempFolder folder;
  const Loaded l = must_load(write_moving_scene(folder, 2000));
  TestRandom random(9);
  Parallel one(1), many(7);
  PosedScene walked(l.scene());
  EXPECT_EQ(walked.data().texels.data(), l.scene().texels.data());
  for (int i = 0; i < 40; ++i) {
    const double time = i % 10 == 9 ? 0 : random.uniform(-100, 100);
    walked.pose(time, i % 2 == 0 ? one : many);
    const SceneData& data = walked.data();
    ASSERT_EQ(broken_promise(data), "") << time;
    for (const Triangle& t : data.triangles)
      for (int k = 0; k < 2; ++k) {
        const float *a = data.vertices[t.vertex[k]].position, *b = data.vertices[t.vertex[k + 1]].position;
        ASSERT_FALSE(std::lexicographical_compare(b, b + 3, a, a + 3));
      }
    const Scene fresh = scene_at(l.loaded.scene, time);
    const auto same = [](const auto& a, const auto& b) {
      return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
    };
    ASSERT_TRUE(same(fresh.data().vertices, data.vertices)) << time;
    ASSERT_TRUE(same(fresh.data().triangles, data.triangles)) << time;
    ASSERT_EQ(std::memcmp(fresh.data().bounds_min, data.bounds_min, sizeof data.bounds_min), 0);
    EXPECT_FALSE(walked.pose(time, one));
    if (time == 0) {
      EXPECT_TRUE(same(l.scene().vertices, data.vertices));
      EXPECT_TRUE(same(l.scene().triangles, data.triangles));
    }
  }
}

// Each coordinate is the float nearest to the motion's in long double, but for a double's error before rounding; windings stay.
TEST(PosedScene, VerticesAreRoundedOnce) {
  const TempFolder folder;
  const Loaded l = must_load(write_moving_scene(folder, 2000));
  const double time = 3.75;
  const Scene at = scene_at(l.loaded.scene, time);
  const MovingRun& wheel = l.scene().moving_vertices.front();
  ASSERT_EQ(wheel.motion, 0u);
  long double axis[3] = {0.1L, 0.2L, 1.0L};
  const long double length = std::sqrt(0.01L + 0.04L + 1), angle = 40 * static_cast<long double>(time) * 3.14159265358979323846264338L / 180;
  for (long double& a : axis) a /= length;
  for (uint32_t i = wheel.first; i < wheel.first + wheel.count; ++i) {
    const float* p = l.scene().vertices[i].position;
    const long double v[3] = {p[0], p[1] - 1.0L, p[2]}, s = std::sin(angle), c = std::cos(angle);
    const long double dot = axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2];
    for (int k = 0; k < 3; ++k) {
      const int x = (k + 1) % 3, y = (k + 2) % 3;
      const long double turned = v[k] * c + (axis[x] * v[y] - axis[y] * v[x]) * s + axis[k] * dot * (1 - c) + (k == 1 ? 1 : 0);
      const float got = at.data().vertices[i].position[k];
      const long double half_step = (static_cast<long double>(std::nextafter(std::fabs(got), 10.0f)) - std::fabs(got)) / 2;
      ASSERT_LE(std::fabs(static_cast<long double>(got) - turned), half_step + 1e-15L) << i << " " << k;
    }
  }
  for (size_t t = 0; t < l.scene().triangles.size(); ++t) {  // the front stays the front
    glm::dvec3 before[3], after[3];
    for (int c = 0; c < 3; ++c) {
      const float *a = corner(l.scene(), t, c).position, *b = corner(at.data(), t, c).position;
      before[c] = {a[0], a[1], a[2]}, after[c] = {b[0], b[1], b[2]};
    }
    const glm::dvec3 n = cross3(before[1] - before[0], before[2] - before[0]), m = cross3(after[1] - after[0], after[2] - after[0]);
    EXPECT_NEAR(length3(m) / length3(n), 1, 1e-3);
    const float* v = corner(at.data(), t, 0).normal;
    EXPECT_GT(dot3(glm::dvec3(v[0], v[1], v[2]), m), 0) << t;
  }
}

}  // namespace
}  // namespace spanray
