// Random numbers for tests and hard cases, the same with every standard library (std:: distributions are not). Who draws twice in one
// expression gets another order from every compiler, except in braces and one declarator after the other.
#pragma once
#include <cstdint>
#include <random>

#include "math/vec.h"

namespace spanray {

class TestRandom {
 public:
  explicit TestRandom(uint32_t seed) : engine_(seed) {}
  uint32_t bits() { return static_cast<uint32_t>(engine_()); }
  int below(int n) { return static_cast<int>(bits() % static_cast<uint32_t>(n)); }
  int between(int low, int high) { return low + below(high - low + 1); }                       // both included
  double uniform(double low = 0, double high = 1) { return low + (high - low) * (bits() * (1.0 / 4294967296.0)); }

 private:
  std::mt19937 engine_;
};

// In the cube [-size, size]^3.
inline glm::dvec3 random_point(TestRandom& random, double size = 1) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size);
  return {x, y, random.uniform(-size, size)};
}

}  // namespace spanray
