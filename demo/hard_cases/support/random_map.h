// Maps of instances by chance.
#pragma once
#include <cmath>

#include "math/vec.h"
#include "scene/instance.h"
#include "support/random.h"

namespace spanray {

// A random rotation; scale is along the axes of the part.
inline AffineMap random_map(TestRandom& random, const glm::dvec3& scale, const glm::dvec3& offset) {
  double q[4], length = 0;
  for (double& x : q) x = random.uniform(-1, 1), length += x * x;
  for (double& x : q) x /= std::sqrt(length);
  const auto [w, x, y, z] = q;
  const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                          {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                          {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
  AffineMap map;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) map.linear[i][k] = r[i][k] * scale[k];
    map.offset[i] = offset[i];
  }
  return map;
}

}  // namespace spanray
