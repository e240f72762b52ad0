#include <cmath>

#include "noise.h"
#include "textures.h"

namespace spanray::assets {
namespace {

using Color = glm::dvec3;

Color blend(const Color& a, const Color& b, double t) { return a + t * (b - a); }

// Distance from a point in a cell of width x height to its border, in the units of both.
double to_border(double x, double y, double width, double height) {
  const double dx = x < width - x ? x : width - x, dy = y < height - y ? y : height - y;
  return dx < dy ? dx : dy;
}

double pits(double u, double v) {
  const double where = smooth_step(-0.1, 0.35, fractal_noise(u * 5, v * 5, 5, 3, 61));
  const Cell cell = cell_noise(u * 26, v * 26, 26, 62);
  const double depth = cell.id > 0.45 ? 1 - smooth_step(0.10, 0.34, cell.nearest) : 0;
  return where * depth;
}

// Bricks in running bond: which one, and how far inside it (in units of a course's height).
struct Brick { double inside, tint, hue; };
Brick brick_at(double u, double v) {
  constexpr int kColumns = 4, kCourses = 12;
  const double wobble = 0.012 * gradient_noise(u * 24, v * 24, 24, 31);
  const double y = v * kCourses + wobble * 3;
  const int64_t course = static_cast<int64_t>(std::floor(y));
  const double x = u * kColumns + wobble + (course & 1 ? 0.5 : 0.0);
  const int64_t column = static_cast<int64_t>(std::floor(x));
  const int64_t c = (column % kColumns + kColumns) % kColumns, r = (course % kCourses + kCourses) % kCourses;
  const double fx = (x - static_cast<double>(column)) * 3, fy = y - static_cast<double>(course);
  return {to_border(fx, fy, 3, 1), random_unit(c, r, 33), random_unit(c, r, 34)};
}

struct Slab { double inside, tint; int64_t x, y; };
Slab slab_at(double u, double v) {
  const double x = u * 2, y = v * 2;
  const int64_t i = static_cast<int64_t>(std::floor(x)), j = static_cast<int64_t>(std::floor(y));
  const double wear = 0.004 * gradient_noise(u * 20, v * 20, 20, 51);
  return {to_border(x - static_cast<double>(i), y - static_cast<double>(j), 1, 1) + wear, random_unit(i, j, 58), i, j};
}

// Veins: thin where warped noise crosses zero.
double veins(double u, double v, uint32_t seed) {
  const double wx = 0.22 * fractal_noise(u * 3, v * 3, 3, 4, seed), wy = 0.22 * fractal_noise(u * 3, v * 3, 3, 4, seed + 1);
  const double wide = std::fabs(fractal_noise((u + wx) * 3, (v + wy) * 3, 3, 3, seed + 2));
  const double thin = std::fabs(fractal_noise((u + wy) * 6, (v + wx) * 6, 6, 3, seed + 3));
  const double broken = smooth_step(-0.25, 0.4, gradient_noise(u * 4, v * 4, 4, seed + 4));
  return (1 - smooth_step(0, 0.10, wide)) * (0.35 + 0.65 * broken) + 0.4 * (1 - smooth_step(0, 0.05, thin)) * broken;
}

}  // namespace

Picture limestone_color(int size) {
  return paint_color(size, size, [](double u, double v) {
    const double cloud = fractal_noise(u * 4, v * 4, 4, 5, 60), bed = gradient_noise(u * 2, v * 14, 2, 14, 64);
    Color c = blend({0.80, 0.74, 0.62}, {0.90, 0.86, 0.77}, smooth_step(-0.5, 0.5, cloud + 0.3 * bed));
    c = blend(c, {0.72, 0.60, 0.44}, 0.35 * smooth_step(0.2, 0.6, gradient_noise(u * 6, v * 6, 6, 66)));
    return c * (1 - 0.35 * pits(u, v) + 0.05 * fractal_noise(u * 37 + 0.4 * cloud, v * 41, 37, 41, 2, 65));
  });
}

Picture limestone_height(int size) {
  return paint_gray(size, size, 16, [](double u, double v) {
    return 0.70 + 0.10 * fractal_noise(u * 4, v * 4, 4, 5, 60) + 0.05 * fractal_noise(u * 32, v * 32, 32, 2, 67) - 0.55 * pits(u, v);
  });
}

Picture brick_color(int size) {
  return paint_color(size, size, [](double u, double v) {
    const Brick b = brick_at(u, v);
    const double grain = fractal_noise(u * 48, v * 48, 48, 2, 36), stain = fractal_noise(u * 3, v * 3, 3, 3, 37);
    Color brick = blend({0.47, 0.23, 0.16}, {0.70, 0.40, 0.28}, b.tint);
    brick = blend(brick, {0.62, 0.46, 0.33}, b.hue > 0.7 ? 0.6 : 0.15 * b.hue);
    if (b.hue < 0.08) brick = {0.30, 0.19, 0.17};
    const Color mortar = Color{0.72, 0.68, 0.60} * (1 + 0.10 * grain);
    return blend(mortar, brick * (1 + 0.16 * grain), smooth_step(0.055, 0.12, b.inside)) * (1 + 0.10 * stain);
  });
}

Picture brick_height(int size) {
  return paint_gray(size, size, 8, [](double u, double v) {
    const Brick b = brick_at(u, v);
    const double grain = fractal_noise(u * 48, v * 48, 48, 2, 36);
    return mix(0.22 + 0.05 * grain, 0.80 + 0.14 * (b.tint - 0.5) + 0.07 * grain, smooth_step(0.04, 0.16, b.inside));
  });
}

Picture slab_color(int size) {
  return paint_color(size, size, [](double u, double v) {
    const Slab s = slab_at(u, v);
    const double shift = 0.37 * static_cast<double>(s.x + 2 * s.y);
    const double cloud = fractal_noise(u * 6 + shift, v * 6 + 3 * shift, 6, 4, 53), grain = gradient_noise(u * 80, v * 80, 80, 54);
    Color c = blend({0.55, 0.49, 0.42}, {0.74, 0.69, 0.60}, smooth_step(-0.6, 0.6, cloud)) * (0.86 + 0.24 * s.tint);
    c = blend(c, {0.60, 0.45, 0.36}, s.tint > 0.75 ? 0.45 : 0.0);
    return blend({0.30, 0.27, 0.24}, c * (1 + 0.05 * grain), smooth_step(0.008, 0.022, s.inside));
  });
}

Picture slab_height(int size) {
  return paint_gray(size, size, 16, [](double u, double v) {
    const Slab s = slab_at(u, v);
    const double worn = 0.06 * fractal_noise(u * 8, v * 8, 8, 4, 55);
    return mix(0.30, 0.80 + worn, smooth_step(0.006, 0.030, s.inside));
  });
}

Picture marble_color(int size, Color ground, Color vein, uint32_t seed) {
  return paint_color(size, size, [=](double u, double v) {
    const double cloud = 0.06 * fractal_noise(u * 3, v * 3, 3, 4, seed + 9);
    return blend(ground * (1 + cloud), vein, 0.85 * veins(u, v, seed));
  });
}

Picture chessboard_color(int size) {
  return paint_color(size, size, [](double u, double v) {
    const bool dark = (u < 0.5) != (v < 0.5);
    const double vein = veins(u, v, dark ? 71u : 81u), cloud = 0.05 * fractal_noise(u * 4, v * 4, 4, 3, 90);
    if (dark) return blend(Color{0.11, 0.11, 0.13} * (1 + 2 * cloud), {0.42, 0.40, 0.40}, 0.55 * vein);
    return blend(Color{0.88, 0.85, 0.79} * (1 + cloud), {0.62, 0.58, 0.54}, 0.5 * vein);
  });
}

Picture terrazzo_color(int size) {
  return paint_color(size, size, [](double u, double v) {
    static constexpr double kChips[5][3] = {{0.90, 0.88, 0.84}, {0.66, 0.64, 0.61}, {0.76, 0.68, 0.59}, {0.55, 0.55, 0.57}, {0.83, 0.80, 0.75}};
    const Cell c = cell_noise(u * 26, v * 26, 26, 95);
    const double* chip = kChips[static_cast<int>(c.id * 5)];
    const double edge = smooth_step(0.06, 0.14, c.second - c.nearest) * smooth_step(0.25, 0.4, c.id < 0.15 ? 0.0 : 1.0);
    return blend({0.80, 0.78, 0.74}, {chip[0], chip[1], chip[2]}, edge);
  });
}

}  // namespace spanray::assets
