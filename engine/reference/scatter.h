// What a surface does with light, as paths ask for it: how much is reflected where, and where to look next.
#pragma once
#include <array>

#include "reference/light.h"

namespace spanray::reference {

// The highlight of the catalog's Blinn-Phong model reflects this share of the light for Ks = 1, at most (seen at a right
// angle): 8 (1 - 2^-(n/2 + 1)) / (n + 2), n the shininess. Above 1 for n < 5.7.
double highlight_albedo(double shininess);
// Kd + Ks * highlight_albedo + mirror, the greatest channel: a surface reflects no more than this share of the light.
double most_reflected(int32_t model, const glm::dvec3& diffuse, const glm::dvec3& specular, const glm::dvec3& mirror,
                      double shininess);

// The reflectance of a surface: that of the model, made smaller as a whole where most_reflected() exceeds 1 (MTL materials may
// ask for that; light between two of them would grow without end).
class Scatter {
 public:
  Scatter(const Surface& surface, int32_t model);

  // Reflectance times cosine toward a unit vector, 1/sr, mirror apart; zero below the surface.
  glm::dvec3 value(const glm::dvec3& l) const;
  // How densely sample() looks there, 1/sr, mirror apart.
  double density(const glm::dvec3& l) const;

  struct Sample {
    glm::dvec3 direction{0};  // unit
    glm::dvec3 weight{0};     // reflectance * cosine / density; mirror: its weight over the probability to choose it
    double density = 0;       // 1/sr
    bool mirror = false;      // one direction of no extent, which density() and value() do not know
  };
  // From three numbers in (0, 1): cosine-weighted about the normal (diffuse), by its half-way vector (highlight; weights stay
  // bounded), or mirrored, each as often as it reflects. A direction of weight zero is none.
  Sample sample(const std::array<double, 4>& u) const;

 private:
  double diffuse_density(const glm::dvec3& l) const;
  double highlight_density(const glm::dvec3& l) const;

  const Surface& s_;
  const int32_t model_;
  glm::dvec3 diffuse_, specular_, mirror_;
  double p_diffuse_ = 0, p_highlight_ = 0, p_mirror_ = 0;  // sum 1, or 0 for a black surface
};

}  // namespace spanray::reference
