#include "reference/scatter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spanray::reference {
namespace {

double most(const glm::dvec3& c) { return std::max({c.x, c.y, c.z}); }

// A unit vector at this cosine from n, `turn` in (0, 1) around it.
glm::dvec3 around(const glm::dvec3& n, double cosine, double turn) {
  // A frame without a pole where it turns over (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
  const double sign = std::copysign(1.0, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
  const glm::dvec3 x(1 + sign * n.x * n.x * a, sign * b, -sign * n.x), y(b, sign + n.y * n.y * a, -n.y);
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine)), phi = 2 * std::numbers::pi * turn;
  return x * (sine * std::cos(phi)) + y * (sine * std::sin(phi)) + n * cosine;
}

}  // namespace

double highlight_albedo(double shininess) { return 8 * (1 - std::exp2(-0.5 * shininess - 1)) / (shininess + 2); }

double most_reflected(int32_t model, const glm::dvec3& diffuse, const glm::dvec3& specular, const glm::dvec3& mirror,
                      double shininess) {
  return most(diffuse + (model == kBlinnPhong ? specular * highlight_albedo(shininess) : glm::dvec3(0)) + mirror);
}

Scatter::Scatter(const Surface& s, int32_t model) : s_(s), model_(model) {
  const double scale = 1 / std::max(1.0, most_reflected(model, s.diffuse, s.specular, s.mirror, s.shininess));
  diffuse_ = s.diffuse * scale, specular_ = model == kBlinnPhong ? s.specular * scale : glm::dvec3(0),
  mirror_ = s.mirror * scale;
  p_diffuse_ = most(diffuse_), p_highlight_ = most(specular_) * highlight_albedo(s.shininess), p_mirror_ = most(mirror_);
  const double sum = p_diffuse_ + p_highlight_ + p_mirror_;
  if (sum > 0) p_diffuse_ /= sum, p_highlight_ /= sum, p_mirror_ /= sum;
}

glm::dvec3 Scatter::value(const glm::dvec3& l) const {
  if (!(dot3(s_.geometric, l) > 0) || !(dot3(s_.normal, l) > 0)) return glm::dvec3(0);
  const Reflectance r = reflectance(model_, s_.normal, l, s_.view, s_.shininess);
  return diffuse_ * r.diffuse + specular_ * r.specular;
}

double Scatter::diffuse_density(const glm::dvec3& l) const { return std::max(0.0, dot3(s_.normal, l)) / std::numbers::pi; }

// Half-way vectors h by a power of their cosine, then mirrored about: d(l) = 4 (v.h) d(h).
double Scatter::highlight_density(const glm::dvec3& l) const {
  const glm::dvec3 h = normalize3(l + s_.view, glm::dvec3(0));
  const double cosine = dot3(s_.normal, h), v_h = dot3(s_.view, h);
  if (!(cosine > 0) || !(v_h > 0)) return 0;
  return (s_.shininess + 1) / (2 * std::numbers::pi) * std::pow(std::min(cosine, 1.0), s_.shininess) / (4 * v_h);
}

double Scatter::density(const glm::dvec3& l) const {
  return (p_diffuse_ > 0 ? p_diffuse_ * diffuse_density(l) : 0.0) +
         (p_highlight_ > 0 ? p_highlight_ * highlight_density(l) : 0.0);
}

Scatter::Sample Scatter::sample(const std::array<double, 4>& u) const {
  Sample sample;
  if (u[0] < p_mirror_) {
    sample.direction = normalize3(mirror_direction(s_), s_.geometric);
    sample.weight = mirror_ * (1 / p_mirror_), sample.mirror = true;
    return sample;
  }
  if (p_diffuse_ + p_highlight_ <= 0) return sample;
  if (u[0] < p_mirror_ + p_diffuse_ || p_highlight_ <= 0) {
    sample.direction = around(s_.normal, std::sqrt(u[1]), u[2]);
  } else {
    const glm::dvec3 h = around(s_.normal, std::pow(u[1], 1 / (s_.shininess + 1)), u[2]);
    const double v_h = dot3(s_.view, h);
    if (!(v_h > 0)) return sample;
    sample.direction = normalize3(h * (2 * v_h) - s_.view, s_.geometric);
  }
  sample.density = density(sample.direction);
  if (sample.density > 0) sample.weight = value(sample.direction) * (1 / sample.density);
  return sample;
}

}  // namespace spanray::reference
