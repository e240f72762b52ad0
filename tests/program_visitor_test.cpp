// Who walks: stopped by walls, sliding along them, never through them, however long the step.
#include <gtest/gtest.h>

#include <cmath>

#include "../demo/visitor.h"
#include "support/random.h"
#include "support/temp_folder.h"
#include "support/test_frame.h"

namespace spanray::demo {
namespace {

using glm::dvec3;
constexpr double kRadius = 0.25;

// Quads a, a + u, a + u + v, a + v.
void add_quad(std::vector<SoupTriangle>& soup, const dvec3& a, const dvec3& u, const dvec3& v) {
  soup.push_back(soup_triangle(a, a + u, a + u + v));
  soup.push_back(soup_triangle(a, a + u + v, a + v));
}
void add_box(std::vector<SoupTriangle>& soup, const dvec3& low, const dvec3& high) {
  const dvec3 x(high.x - low.x, 0, 0), y(0, high.y - low.y, 0), z(0, 0, high.z - low.z);
  add_quad(soup, low, x, y), add_quad(soup, low, y, z), add_quad(soup, low, z, x);
  add_quad(soup, high, -x, -y), add_quad(soup, high, -y, -z), add_quad(soup, high, -z, -x);
}

class Room {
 public:
  explicit Room(const std::vector<SoupTriangle>& soup) : query_(Scene(std::make_shared<SceneData>(make_test_scene(soup)))) {}
  const SceneQuery& query() const { return query_; }
  dvec3 go(const dvec3& from, const dvec3& step, double radius = kRadius) {
    const Result<Slide> slid = slide(query_, from, step, radius);
    EXPECT_TRUE(slid);
    stopped = slid && slid.value().stopped;
    return slid ? slid.value().place : from;
  }
  // Whether nothing is nearer than `distance`.
  bool clear(const dvec3& p, double distance) const { return query_.touching({p.x, p.y, p.z}, distance).value().empty(); }
  bool stopped = false;

 private:
  SceneQuery query_;
};

// From -5 to 5, with a thin pillar in it.
std::vector<SoupTriangle> room_with_pillar() {
  std::vector<SoupTriangle> soup;
  add_box(soup, dvec3(-5), dvec3(5));
  add_box(soup, dvec3(1, -5, 1), dvec3(1.3, 5, 1.3));
  return soup;
}

TEST(Visitor, AFreeWayIsGoneToItsEnd) {
  Room room(room_with_pillar());
  const dvec3 from(-1, 0.25, 0.1), step(0.7, -0.3, 0.2);
  EXPECT_EQ(from + step, room.go(from, step));
  EXPECT_FALSE(room.stopped);
  EXPECT_EQ(from, room.go(from, dvec3(0)));
}

TEST(Visitor, StopsBeforeAWallAndSlidesAlongIt) {
  Room room(room_with_pillar());
  dvec3 place = room.go({-2, 0, 0}, {0, -20, 0});
  EXPECT_TRUE(room.stopped);
  EXPECT_NEAR(-5 + kRadius, place.y, 2e-3 * kRadius);
  EXPECT_GT(place.y, -5 + kRadius);
  EXPECT_NEAR(-2, place.x, 1e-9);
  // Obliquely: the part along the wall is gone in full, over the seams between its triangles, again and again.
  for (int i = 0; i < 40; ++i) {
    const dvec3 before = place;
    place = room.go(place, {-0.05, -0.3, i % 2 ? 0.07 : -0.07});
    ASSERT_NEAR(-0.05, place.x - before.x, 1e-9) << i;
    ASSERT_NEAR(i % 2 ? 0.07 : -0.07, place.z - before.z, 1e-9) << i;
    ASSERT_GT(place.y, -5 + kRadius);
  }
  const dvec3 along = room.go(place, {1, 0, 0});
  EXPECT_NEAR(place.x + 1, along.x, 1e-12);
  EXPECT_NEAR(1, room.go(along, {0, 1, 0}).y - along.y, 1e-12) << "and away from it";
}

TEST(Visitor, CornersAndCreasesHoldAndLetGo) {
  Room room(room_with_pillar());
  dvec3 place = room.go({0, 0, 0}, {-30, -31, 2});
  EXPECT_NEAR(-5 + kRadius, place.x, 3e-3 * kRadius);
  EXPECT_NEAR(-5 + kRadius, place.y, 3e-3 * kRadius);
  EXPECT_NEAR(2, place.z, 0.05) << "along the crease";
  for (int i = 0; i < 200; ++i) {
    const dvec3 next = room.go(place, {-0.3, -0.2, -0.3});
    ASSERT_TRUE(room.clear(next, kRadius)) << i;
    place = next;
  }
  EXPECT_NEAR(0, length3(place - dvec3(-5 + kRadius)), 5e-3 * kRadius) << "in the corner";
  const dvec3 out = room.go(place, {0.5, 0.25, 0.5});
  EXPECT_NEAR(0, length3(out - place - dvec3(0.5, 0.25, 0.5)), 1e-12);
}

TEST(Visitor, ThePillarIsPassedOnOneSide) {
  Room room(room_with_pillar());
  dvec3 place(-2, 0, 1.1);
  for (int i = 0; i < 200; ++i) {
    place = room.go(place, {0.1, 0, 0});
    ASSERT_TRUE(room.clear(place, 0.999 * kRadius)) << i;
  }
  EXPECT_LT(place.x, 1) << "straight at its face: it holds";
  place = {-2, 0, 0.95};
  for (int i = 0; i < 200; ++i) place = room.go(place, {0.1, 0, 0});
  EXPECT_GT(place.x, 4) << "at its edge: around it";
}

TEST(Visitor, AWedgeDoesNotSwallowAnybody) {
  std::vector<SoupTriangle> soup;  // two walls that meet at x = 0 under 12 degrees
  add_quad(soup, {0, -5, 0}, {10, 0, 1}, {0, 10, 0});
  add_quad(soup, {0, -5, 0}, {10, 0, -1}, {0, 10, 0});
  Room room(soup);
  dvec3 place(8, 0, 0);
  for (int i = 0; i < 400; ++i) {
    place = room.go(place, {i == 0 ? -1e3 : -0.5, 0.01 * (i % 5 - 2), 0.1 * (i % 3 - 1)});
    ASSERT_TRUE(room.clear(place, 0.99 * kRadius)) << i;
    ASSERT_LT(std::fabs(place.z), place.x / 10) << i << ": through a wall";
  }
  EXPECT_NEAR(kRadius / std::sin(std::atan(0.1)), place.x, 0.2) << "as far as it fits";
  // Pressed into it and moved along it: along the crease in full.
  for (const double way : {1.0, -2.5}) {
    const dvec3 along = room.go(place, {-0.5, way, 0.02});
    EXPECT_NEAR(place.y + way, along.y, 1e-6);
    EXPECT_NEAR(place.x, along.x, 0.02);
    place = along;
  }
}

// A million times the size of the room in one step, and steps of every size, from everywhere.
TEST(Visitor, NoStepIsTooLong) {
  Room room(room_with_pillar());
  TestRandom random(31);
  dvec3 place(-2, 0, 0);
  double far = 0;
  for (int i = 0; i < 3000; ++i) {
    const double length = std::pow(10.0, random.uniform(-4, 7));
    const dvec3 before = place;
    place = room.go(place, dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)) * length);
    for (int k = 0; k < 3; ++k) ASSERT_LT(std::fabs(place[k]), 5 - 0.99 * kRadius) << "step " << i << " of " << length;
    ASSERT_TRUE(room.clear(place, 0.99 * kRadius)) << i;
    far += length3(place - before);
  }
  EXPECT_GT(far, 3000) << "it is not stuck";
}

// A camera may stand closer to a wall than the radius, even on it.
TEST(Visitor, ATightStartIsNoTrapAndNoDoor) {
  for (const double gap : {0.2, 0.01, 1e-6, 0.0}) {
    Room room(room_with_pillar());
    const dvec3 start(-2, -5 + gap, 0);
    const dvec3 up = room.go(start, {0, 1, 0}), along = room.go(start, {3, 0, 0});  // over a seam
    EXPECT_NEAR(start.y + 1, up.y, 1e-9) << gap;
    EXPECT_NEAR(1, along.x, 1e-9) << gap;
    if (gap == 0) continue;
    dvec3 place = start;
    for (int i = 0; i < 50; ++i) place = room.go(place, {0, -0.5, 0});
    EXPECT_GT(place.y, -5) << gap;
  }
}

TEST(Visitor, ErrorsAreTold) {
  EXPECT_FALSE(slide(SceneQuery(Scene()), dvec3(0), dvec3(1), 1));
  Room room(room_with_pillar());
  EXPECT_FALSE(slide(room.query(), dvec3(0), dvec3(1e40), 1));
}

TEST(Visitor, TheRadiusFollowsTheSceneAndTheNearPlane) {
  const Scene scene(std::make_shared<SceneData>(make_test_scene(room_with_pillar())));
  Camera camera;
  EXPECT_NEAR(std::sqrt(300.0) / 200, fitted_radius(scene, camera), 1e-12);
  camera.near_plane = 0.5;
  EXPECT_EQ(1, fitted_radius(scene, camera));
}

TEST(Visitor, HitsInWords) {
  const double eye[3] = {0, 0, 5};
  EXPECT_EQ("background", hit_text(std::nullopt, eye));
  RayHit hit;
  hit.name.triangle = 17, hit.name.material = "stone";
  hit.position[2] = 2;
  EXPECT_EQ("triangle 17, material stone, 3 away", hit_text(hit, eye));
  hit.name.object = "wall", hit.name.group = "north";
  EXPECT_EQ("triangle 17, material stone, object wall, group north, 3 away", hit_text(hit, eye));
}

}  // namespace
}  // namespace spanray::demo
