#include "reference/texture.h"

#include <algorithm>
#include <cmath>

namespace spanray::reference {
namespace {

int level_size(int size, int level) { return std::max(1, size >> level); }

// Of a step of one pixel, in texels.
double footprint(const Coordinates& at, double width, double height) {
  const double ux = std::fabs(at.du_dx) * width, uy = std::fabs(at.du_dy) * width, vx = std::fabs(at.dv_dx) * height,
               vy = std::fabs(at.dv_dy) * height, mu = std::max(ux, uy), mv = std::max(vx, vy);
  return at.nudge.footprint < 0   ? std::max(mu, mv)
         : at.nudge.footprint > 0 ? mu + mv
                                  : std::max(std::hypot(ux, vx), std::hypot(uy, vy));
}

}  // namespace

Textures::Levels Textures::levels(const TextureUse& use, const Coordinates& at, double last_level) const {
  const Texture& t = texture(use);
  const double longer = footprint(at, std::fabs(t.width * double{use.scale[0]}), std::fabs(t.height * double{use.scale[1]}));
  const double last = std::min<double>(t.levels - 1, last_level);
  const double level = std::clamp(longer > 0 ? std::log2(longer) + at.nudge.levels : 0.0, 0.0, last);  // infinity: the last
  if (filter_ != Filter::kTrilinear) return {static_cast<int>(std::floor(level + 0.5)), 0};
  return {static_cast<int>(level), level - std::floor(level)};
}

glm::dvec4 Textures::texel(const TextureUse& use, int level, int x, int y) const {
  const Texture& t = texture(use);
  const auto wrap = [&](int i, int n) { return use.clamp != 0 ? std::clamp(i, 0, n - 1) : (i % n + n) % n; };
  const int w = level_size(t.width, level), h = level_size(t.height, level);
  const Texel& p = scene_.texels[static_cast<size_t>(t.offset[level]) +
                                 static_cast<size_t>(wrap(y, h)) * static_cast<size_t>(w) + static_cast<size_t>(wrap(x, w))];
  return glm::dvec4(p.r, p.g, p.b, p.a) * (1 / 65535.0);
}

glm::dvec2 Textures::place(const TextureUse& use, const Coordinates& at, int level) const {
  const Texture& t = texture(use);
  double u = at.u * double{use.scale[0]} + double{use.offset[0]}, v = at.v * double{use.scale[1]} + double{use.offset[1]};
  if (use.clamp != 0)
    u = std::clamp(u, 0.0, 1.0), v = std::clamp(v, 0.0, 1.0);
  else
    u -= std::floor(u), v -= std::floor(v);
  return {u * level_size(t.width, level) + at.nudge.x,
          (1 - v) * level_size(t.height, level) + at.nudge.y};  // v = 0 is the bottom row
}

glm::dvec4 Textures::bilinear(const TextureUse& use, int level, const glm::dvec2& place) const {
  const double x = place.x - 0.5, y = place.y - 0.5, fx = x - std::floor(x), fy = y - std::floor(y);
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  return (texel(use, level, i, j) * (1 - fx) + texel(use, level, i + 1, j) * fx) * (1 - fy) +
         (texel(use, level, i, j + 1) * (1 - fx) + texel(use, level, i + 1, j + 1) * fx) * fy;
}

glm::dvec4 Textures::sample(const TextureUse& use, const Coordinates& at, double last_level) const {
  const Levels l = levels(use, at, last_level);
  const glm::dvec2 first = place(use, at, l.first);
  if (filter_ == Filter::kNearest)
    return texel(use, l.first, static_cast<int>(std::floor(first.x)), static_cast<int>(std::floor(first.y)));
  glm::dvec4 value = bilinear(use, l.first, first);
  if (l.weight > 0) value = value * (1 - l.weight) + bilinear(use, l.first + 1, place(use, at, l.first + 1)) * l.weight;
  return value;
}

glm::dvec3 Textures::color(const TextureUse& use, const Coordinates& at) const {
  const glm::dvec4 c = sample(use, at);
  const auto remapped = [&](double v) { return std::max(double{use.base} + double{use.gain} * v, 0.0); };
  return {remapped(c.x), remapped(c.y), remapped(c.z)};
}

double Textures::channel(const TextureUse& use, const glm::dvec4& c) {
  if (use.channel >= 0 && use.channel < 4) return c[use.channel];
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

double Textures::scalar(const TextureUse& use, const Coordinates& at, double last_level) const {
  return double{use.base} + double{use.gain} * channel(use, sample(use, at, last_level));
}

glm::dvec2 Textures::slopes(const TextureUse& use, const Coordinates& at) const {
  const auto on_level = [&](int level) {
    const glm::dvec2 p = place(use, at, level);
    const auto height = [&](double dx, double dy) { return channel(use, bilinear(use, level, p + glm::dvec2(dx, dy))); };
    return glm::dvec2(height(0.5, 0) - height(-0.5, 0), height(0, -0.5) - height(0, 0.5)) *
           std::ldexp(1.0, -level);  // rows go down, t up
  };
  const Levels l = levels(use, at, 1e9);
  glm::dvec2 slope = on_level(l.first);
  if (l.weight > 0) slope = slope * (1 - l.weight) + on_level(l.first + 1) * l.weight;
  return slope * (double{use.gain} * double{use.bump_multiplier});
}

}  // namespace spanray::reference
