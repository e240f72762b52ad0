// The reference's tree against asking every triangle.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <numeric>

#include "reference/tree.h"
#include "support/bvh_oracle.h"

namespace spanray {
namespace {

using reference::Line;
using reference::Met;

struct Soup {
  SceneData scene;
  std::vector<uint32_t> all;
  explicit Soup(const std::vector<SoupTriangle>& triangles) {
    scene.materials.resize(1);
    for (const SoupTriangle& t : triangles) {
      Triangle made{};
      for (int k = 0; k < 3; ++k) {
        made.vertex[k] = static_cast<uint32_t>(scene.vertices.size());
        scene.vertices.push_back(
            Vertex{{t.corner[k].position[0], t.corner[k].position[1], t.corner[k].position[2]}, {0, 0, 1}, {0, 0}});
      }
      scene.triangles.push_back(made);
    }
    all.resize(triangles.size());
    std::iota(all.begin(), all.end(), 0u);
  }
  struct Corners { glm::dvec3 v[3]; };
  Corners corners(uint32_t i) const { return {{scene_vertex(scene, i, 0), scene_vertex(scene, i, 1), scene_vertex(scene, i, 2)}}; }
  bool keeps(const Line& line, uint32_t i) const { return reference::keeps(line, corners(i).v); }
  std::vector<Met> ask_all(const Line& line, double t_min, double t_max) const {
    std::vector<Met> found;
    for (const uint32_t i : all) {
      double t;
      if (reference::meets(line, corners(i).v, t) && t > t_min && t <= t_max) found.push_back({t, i});
    }
    return found;
  }
};

bool before(const Met& a, const Met& b) { return a.t != b.t ? a.t < b.t : a.primitive < b.primitive; }
bool same(const Met& a, const Met& b) { return a.t == b.t && a.primitive == b.primitive; }

void expect_same_answers(const Soup& soup, TestRandom& random, int rays, double size) {
  const reference::Tree tree(soup.scene, soup.all);
  const auto yes = [](uint32_t, double) { return true; };
  const auto odd = [](uint32_t primitive, double) { return primitive % 2 == 1; };
  int hits = 0;
  for (int i = 0; i < rays; ++i) {
    Line line{random_point(random, size), random_point(random, 1)};
    if (i % 7 == 0) line.direction[i % 3] = 0;  // along a plane of the axes
    if (i % 11 == 0) line.direction = glm::dvec3(0), line.direction[i % 3] = i % 2 == 0 ? 1 : -1;
    if (i % 5 == 0)
      line.direction =
          scene_vertex(soup.scene, static_cast<uint32_t>(random.below(static_cast<int>(soup.all.size()))), i % 3) - line.origin;
    const double t_min = i % 3 == 0 ? 0.3 : 0, t_max = i % 4 == 0 ? 1.0 : std::numeric_limits<double>::infinity();
    std::vector<Met> want = soup.ask_all(line, t_min, t_max), got = tree.all(line, t_min, t_max, yes), layers;
    std::sort(want.begin(), want.end(), before), std::sort(got.begin(), got.end(), before);
    std::copy_if(want.begin(), want.end(), std::back_inserter(layers), [&](const Met& m) { return soup.keeps(line, m.primitive); });
    ASSERT_TRUE(std::equal(layers.begin(), layers.end(), got.begin(), got.end(), same))
        << i << ": " << layers.size() << " and " << got.size();
    const Met closest = tree.closest(line, t_min, t_max, yes), closest_odd = tree.closest(line, t_min, t_max, odd);
    EXPECT_TRUE(same(closest, want.empty() ? Met{} : want[0])) << i;
    const auto first_odd = std::find_if(want.begin(), want.end(), [](const Met& m) { return m.primitive % 2 == 1; });
    EXPECT_TRUE(same(closest_odd, first_odd == want.end() ? Met{} : *first_odd)) << i;
    EXPECT_EQ(tree.any(line, t_min, t_max, yes), !want.empty());
    EXPECT_EQ(tree.any(line, t_min, t_max, odd), first_odd != want.end());
    hits += !want.empty();
  }
  EXPECT_GT(hits, rays / 10);
}

TEST(ReferenceTree, FindsWhatAskingEveryTriangleFinds) {
  TestRandom random(1);
  for (const double size : {1e-3, 1.0, 1e4}) {
    std::vector<SoupTriangle> triangles;
    add_random_triangles(triangles, random, 300, 0.4);
    add_mesh(triangles, make_sphere(2), 0.8, glm::dvec3(0.2, 0, 0));
    for (SoupTriangle& t : triangles)
      for (auto& corner : t.corner)
        for (float& x : corner.position) x = static_cast<float>(x * size);
    const Soup soup(triangles);
    expect_same_answers(soup, random, 400, 2 * size);
  }
}

// Coincident triangles: equal t, the lowest id. Many of them: the tree cannot separate them.
TEST(ReferenceTree, TiesGoToTheLowestIdAndCoincidentTrianglesEnd) {
  TestRandom random(2);
  std::vector<SoupTriangle> triangles(200, soup_triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}));
  add_random_triangles(triangles, random, 50, 0.5);
  const Soup soup(triangles);
  expect_same_answers(soup, random, 200, 2);
  const reference::Tree tree(soup.scene, soup.all);
  EXPECT_EQ(tree.closest({{0, 0, -3}, {0, 0, 1}}, 2.5, 3.5, [](uint32_t p, double) { return p > 20; }).primitive, 21u);
}

TEST(ReferenceTree, WithoutTrianglesThereIsNothing) {
  const Soup soup({});
  const reference::Tree tree(soup.scene, soup.all);
  EXPECT_TRUE(tree.empty());
  EXPECT_EQ(tree.closest({{0, 0, 0}, {0, 0, 1}}, 0, 9, [](uint32_t, double) { return true; }).primitive, kNoPrimitive);
}

// Rays at edges and vertices of a closed mesh never slip through.
TEST(ReferenceTree, ClosedMeshesHold) {
  TestRandom random(3);
  std::vector<SoupTriangle> triangles;
  add_mesh(triangles, make_sphere(3), 1, glm::dvec3(0.1, 0.2, 0.3));
  const Soup soup(triangles);
  const reference::Tree tree(soup.scene, soup.all);
  for (int i = 0; i < 3000; ++i) {
    const uint32_t p = static_cast<uint32_t>(random.below(static_cast<int>(soup.all.size())));
    const double part = i % 3 == 0 ? 0 : random.uniform();
    const glm::dvec3 on_edge = scene_vertex(soup.scene, p, 0) * (1 - part) + scene_vertex(soup.scene, p, 1) * part;
    const glm::dvec3 inside = glm::dvec3(0.1, 0.2, 0.3) + random_point(random, 0.3);
    const auto yes = [](uint32_t, double) { return true; };
    EXPECT_TRUE(tree.any({inside, on_edge - inside}, 0, 1e9, yes)) << i;
    EXPECT_EQ(tree.all({inside, on_edge - inside}, 0, 1e9, yes).size(), 1u) << i << ": one layer, on edges and corners, too";
  }
}

}  // namespace
}  // namespace spanray
