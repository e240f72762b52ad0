#pragma once
#include <cmath>
#include <vector>

#include "support/random.h"
#include "support/test_frame.h"

namespace spanray {

// Random triangles of all sizes around the origin, some behind a camera at (0, 0, 3).
inline std::vector<SoupTriangle> random_soup(uint32_t seed, int n, int materials = 1) {
  TestRandom random(seed);
  std::vector<SoupTriangle> soup;
  for (int i = 0; i < n; ++i) {
    const glm::dvec3 center = random_point(random) * glm::dvec3(3, 2, 4);
    const double size = std::exp(random.uniform(-5, 2));
    glm::dvec3 p[3];
    for (glm::dvec3& q : p) q = center + random_point(random, size);
    soup.push_back(soup_triangle(p[0], p[1], p[2], static_cast<uint32_t>(random.below(materials))));
  }
  return soup;
}

}  // namespace spanray
