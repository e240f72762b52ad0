// The hall at other levels of detail, and its walk.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <sstream>

#include "core/hash.h"
#include "scenes.h"

namespace spanray::assets {
namespace {

// Each face has three distinct corners at least, all of them written before.
void expect_valid(const SceneFiles& hall) {
  std::istringstream text(hall.mesh.text());
  size_t positions = 0, uvs = 0, normals = 0, triangles = 0;
  for (std::string line; std::getline(text, line);) {
    std::istringstream fields(line);
    std::string keyword;
    fields >> keyword;
    positions += keyword == "v", uvs += keyword == "vt", normals += keyword == "vn";
    if (keyword == "v" || keyword == "vn" || keyword == "vt") {
      const int values = keyword == "vt" ? 2 : 3;
      double value = 0;
      for (int k = 0; k < values; ++k) ASSERT_TRUE(fields >> value && std::isfinite(value) && std::fabs(value) < 200) << line;
    }
    if (keyword != "f") continue;
    std::set<size_t> corners;
    size_t p, t, n, count = 0;
    for (char slash; fields >> p >> slash >> t >> slash >> n; ++count) {
      ASSERT_TRUE(p >= 1 && p <= positions && t >= 1 && t <= uvs && n >= 1 && n <= normals) << line;
      corners.insert(p);
    }
    ASSERT_GE(corners.size(), 3u) << line;
    ASSERT_EQ(corners.size(), count) << line;
    triangles += count - 2;
  }
  EXPECT_EQ(triangles, hall.mesh.triangle_count());
}

TEST(AssetsHall, ManyLevelsHaveTheTrianglesAskedForAndTheSameBytesAgain) {
  for (const double wanted : {10e3, 40e3}) {
    const SceneFiles hall = make_hall(wanted);
    const double ratio = static_cast<double>(hall.mesh.triangle_count()) / wanted;
    EXPECT_GE(ratio, 0.8) << wanted;
    EXPECT_LE(ratio, 1.2) << wanted;
    expect_valid(hall);
    const SceneFiles again = make_hall(wanted);
    EXPECT_EQ(Hash().add(again.mesh.text()).value(), Hash().add(hall.mesh.text()).value()) << wanted;
    EXPECT_EQ(again.toml, hall.toml);
  }
}

double clearance(const glm::dvec3& eye, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  // To the nearest point of the triangle, by regions: Ericson, "Real-Time Collision Detection", 5.1.5.
  const glm::dvec3 ab = b - a, ac = c - a, ap = eye - a, bp = eye - b, cp = eye - c;
  const double d1 = dot3(ab, ap), d2 = dot3(ac, ap), d3 = dot3(ab, bp), d4 = dot3(ac, bp), d5 = dot3(ab, cp), d6 = dot3(ac, cp);
  if (d1 <= 0 && d2 <= 0) return length3(ap);
  if (d3 >= 0 && d4 <= d3) return length3(bp);
  if (d6 >= 0 && d5 <= d6) return length3(cp);
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return length3(ap - (d1 / (d1 - d3)) * ab);
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return length3(ap - (d2 / (d2 - d6)) * ac);
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return length3(bp - ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b));
  const double sum = va + vb + vc;
  return sum > 0 ? length3(ap - (vb / sum) * ab - (vc / sum) * ac) : length3(ap);
}

// The walk and the cameras: nothing comes nearer to the eye than 30 cm. The keys are closer together than that allows to jump.
TEST(AssetsHall, TheWalkKeepsClearOfEverything) {
  const SceneFiles hall = make_hall();
  std::vector<glm::dvec3> path, eyes;
  std::istringstream text(hall.toml);
  bool on_path = false;
  for (std::string line; std::getline(text, line);) {
    if (line.rfind("[[", 0) == 0) on_path = line == "[[path]]";
    glm::dvec3 eye;
    if (std::sscanf(line.c_str(), "eye = [%lf, %lf, %lf]", &eye.x, &eye.y, &eye.z) == 3) (on_path ? path : eyes).push_back(eye);
  }
  ASSERT_GE(path.size(), 60u);
  ASSERT_GE(eyes.size(), 3u);
  for (size_t i = 1; i < path.size(); ++i) EXPECT_LT(length3(path[i] - path[i - 1]), 0.75) << "key " << i;
  for (size_t i = 0; i < path.size(); ++i) {
    eyes.push_back(path[i]);
    if (i > 0) eyes.push_back(0.5 * (path[i - 1] + path[i]));
  }
  for (const glm::dvec3& eye : eyes) {
    for (const auto& object : hall.mesh.objects()) {
      double nearest = 1e9;
      for (const auto& face : object.faces()) {
        const glm::dvec3 a = hall.mesh.position(face[0]);
        if (std::fabs(a.x - eye.x) > 4 || std::fabs(a.z - eye.z) > 4) continue;  // no face is as long as that
        for (size_t i = 1; i + 1 < face.size(); ++i)
          nearest = std::min(nearest, clearance(eye, a, hall.mesh.position(face[i]), hall.mesh.position(face[i + 1])));
      }
      ASSERT_GT(nearest, 0.30) << object.name << " at " << eye.x << " " << eye.y << " " << eye.z;
    }
  }
}

}  // namespace
}  // namespace spanray::assets
