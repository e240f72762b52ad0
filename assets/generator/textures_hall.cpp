// Stone, brick, reliefs and inlay of the gallery hall.
#include <algorithm>
#include <cmath>

#include "math/elementary.h"
#include "noise.h"
#include "textures.h"

namespace spanray::assets {
namespace {

using Color = glm::dvec3;

Color blend(const Color& a, const Color& b, double t) { return a + t * (b - a); }
double fraction(double x) { return x - std::floor(x); }
double distance(double x, double y, double cx, double cy) { return std::sqrt((x - cx) * (x - cx) + (y - cy) * (y - cy)); }

// Which piece of a running bond, and how far inside its joint, in the unit of a course's height.
struct Piece { double inside, tint, hue; };
Piece bond(double u, double v, int columns, int courses, double aspect, double wobble, uint32_t seed) {
  const double y = v * courses + 3 * wobble;
  const int64_t course = static_cast<int64_t>(std::floor(y));
  const double x = u * columns + wobble + (course & 1 ? 0.5 : 0.0);
  const int64_t column = static_cast<int64_t>(std::floor(x));
  const int64_t c = ((column % columns) + columns) % columns, r = ((course % courses) + courses) % courses;
  const double fx = fraction(x), fy = fraction(y);
  const double dx = (fx < 0.5 ? fx : 1 - fx) * aspect, dy = fy < 0.5 ? fy : 1 - fy;
  return {dx < dy ? dx : dy, random_unit(c, r, seed), random_unit(c, r, seed + 1)};
}

Piece block_at(double u, double v) { return bond(u, v, 3, 6, 2, 0, 301); }
Piece brick_at(double u, double v) { return bond(u, v, 8, 24, 3, 0.012 * gradient_noise(u * 40, v * 40, 40, 311), 312); }

// Thin veins where warped noise crosses zero.
double vein(double u, double v, int period, double thin, uint32_t seed) {
  const double w = 0.25 * fractal_noise(u * period, v * period, period, 4, seed);
  return 1 - smooth_step(0, thin, std::fabs(fractal_noise(u * period + 1.7 * w, v * period - 1.3 * w, period, 4, seed + 5)));
}

}  // namespace

Picture ashlar_color(int size) {
  return paint_color(size, size, [](double u, double v) {
    const Piece b = block_at(u, v);
    const double cloud = fractal_noise(u * 6, v * 9, 6, 9, 5, 321), grain = gradient_noise(u * 90, v * 90, 90, 322);
    Color c = blend({0.74, 0.66, 0.53}, {0.88, 0.82, 0.71}, smooth_step(-0.6, 0.6, cloud + 0.9 * (b.tint - 0.5)));
    c = blend(c, {0.80, 0.66, 0.50}, b.hue > 0.72 ? 0.45 : 0.0) * (1 + 0.035 * grain);
    return blend({0.60, 0.53, 0.43}, c, smooth_step(0.010, 0.028, b.inside));
  });
}

Picture ashlar_height(int size) {
  return paint_gray(size, size, 16, [](double u, double v) {
    const Piece b = block_at(u, v);
    return mix(0.35, 0.78 + 0.06 * fractal_noise(u * 24, v * 24, 24, 3, 323) + 0.02 * (b.tint - 0.5), smooth_step(0.006, 0.045, b.inside));
  });
}

Picture hall_brick_color(int size) {
  return paint_color(size, size, [](double u, double v) {
    const Piece b = brick_at(u, v);
    const double grain = fractal_noise(u * 64, v * 64, 64, 2, 331);
    Color brick = blend({0.50, 0.27, 0.19}, {0.66, 0.41, 0.29}, b.tint);
    brick = blend(brick, {0.64, 0.49, 0.36}, b.hue > 0.75 ? 0.5 : 0.0) * (1 + 0.14 * grain);
    return blend(Color{0.69, 0.63, 0.54} * (1 + 0.08 * grain), brick, smooth_step(0.07, 0.14, b.inside));
  });
}

Picture hall_brick_height(int size) {
  return paint_gray(size, size, 8, [](double u, double v) {
    const Piece b = brick_at(u, v);
    const double grain = fractal_noise(u * 64, v * 64, 64, 2, 331);
    return mix(0.20 + 0.04 * grain, 0.80 + 0.12 * (b.tint - 0.5) + 0.06 * grain, smooth_step(0.05, 0.19, b.inside));
  });
}

namespace {

// Inlay of one bay. u, v in [0, 1), the roundel in the middle, the border along the edges.
enum class Inlay { kWhite, kRose, kVerde, kOchre };
struct Stone { Inlay kind; double edge; };  // edge: distance to the nearest joint
Stone inlay_at(double u, double v) {
  const double x = std::fabs(u - 0.5), y = std::fabs(v - 0.5), far = x > y ? x : y, r = distance(x, y, 0, 0);
  double edge = 1;
  const auto joint = [&edge](double d) { edge = std::fabs(d) < edge ? std::fabs(d) : edge; };
  for (const double line : {0.462, 0.415}) joint(far - line);
  if (far > 0.415) {
    const double along = x > y ? y : x;
    if (far > 0.462) return {Inlay::kOchre, edge};
    if (x > 0.415 && y > 0.415) return {Inlay::kVerde, edge};
    joint(along - 0.415);
    return {Inlay::kRose, edge};
  }
  for (const double line : {0.335, 0.300, 0.165}) joint(r - line);
  if (r < 0.165) return {Inlay::kRose, edge};
  if (r < 0.300) return {Inlay::kWhite, edge};
  if (r < 0.335) return {Inlay::kVerde, edge};
  const double cx = std::fabs(x - 0.335), cy = std::fabs(y - 0.335), diamond = cx + cy;
  joint(diamond - 0.055);
  return {diamond < 0.055 ? Inlay::kRose : Inlay::kWhite, edge};
}

}  // namespace

Picture hall_floor_color(int size) {
  return paint_color(size, size, [](double u, double v) {
    const Stone s = inlay_at(u, v);
    const double cloud = fractal_noise(u * 6, v * 6, 6, 4, 341);
    Color c;
    switch (s.kind) {
      case Inlay::kWhite: c = blend(Color{0.80, 0.76, 0.69} * (1 + 0.05 * cloud), {0.56, 0.53, 0.49}, 0.55 * vein(u, v, 5, 0.07, 342)); break;
      case Inlay::kRose: c = blend(Color{0.50, 0.27, 0.22} * (1 + 0.16 * cloud), {0.76, 0.60, 0.52}, 0.7 * vein(u, v, 7, 0.08, 352)); break;
      case Inlay::kVerde: c = blend(Color{0.12, 0.19, 0.16} * (1 + 0.2 * cloud), {0.42, 0.50, 0.44}, 0.6 * vein(u, v, 9, 0.07, 362)); break;
      case Inlay::kOchre: c = blend(Color{0.66, 0.52, 0.33} * (1 + 0.10 * cloud), {0.82, 0.72, 0.56}, 0.5 * vein(u, v, 6, 0.09, 372)); break;
    }
    return blend(Color{0.34, 0.28, 0.22}, c, smooth_step(0.0004, 0.0016, s.edge));
  });
}

namespace {

// Heights of reliefs, 0 (ground) to 1. The frame of both: a rim and a row of beads.
double rim(double u, double v) {
  const double x = std::min(u, 1 - u), y = std::min(v, 1 - v), edge = std::min(x, y);
  double h = 0.75 * (1 - smooth_step(0.028, 0.045, edge));
  const double along = x < y ? v : u, bead = std::fabs(fraction(along * 24) - 0.5) / 24, across = edge - 0.066;
  const double r2 = (bead * bead + across * across) / (0.017 * 0.017);
  if (r2 < 1) h = std::max(h, 0.62 * std::sqrt(1 - r2));
  return h;
}

double dome(double d, double radius, double high) {
  const double q = 1 - d * d / (radius * radius);
  return q > 0 ? high * std::sqrt(q) : 0;
}

double sun_height(double u, double v) {
  const double x = u - 0.5, y = v - 0.5, r = distance(u, v, 0.5, 0.5);
  const double turn = 0.5 + atan2_(y, x) / (2 * kPi);
  double h = rim(u, v);
  // Two rows of petals, the lower one between the upper.
  for (int row = 0; row < 2; ++row) {
    const double petals = 12, length = row == 0 ? 0.355 : 0.245, phase = std::fabs(fraction(turn * petals + 0.5 * row) - 0.5) * 2;  // 0 on the axis
    const double t = r / length;
    if (t >= 1) continue;
    const double half = std::sqrt(1 - t) * (0.35 + 0.65 * std::min(1.0, 2.5 * t));
    if (phase >= half) continue;
    const double bulge = std::sqrt(1 - (phase / half) * (phase / half));
    h = std::max(h, (row == 0 ? 0.40 : 0.66) * (0.35 + 0.65 * bulge) * (0.55 + 0.45 * t) - 0.05 * (phase < 0.07 ? 1 : 0));
  }
  h = std::max(h, dome(r, 0.085, 0.95));
  h = std::max(h, dome(std::fabs(r - 0.098), 0.014, 0.70));
  h = std::max(h, dome(std::fabs(r - 0.395), 0.020, 0.55));
  for (const double cx : {0.155, 0.845}) {
    for (const double cy : {0.155, 0.845}) {
      const double cr = distance(u, v, cx, cy), ct = 0.5 + atan2_(v - cy, u - cx) / (2 * kPi);
      const double lobe = 0.055 * (1 + 0.30 * (1 - 2 * std::fabs(fraction(ct * 4 + 0.5) - 0.5) * 2));
      h = std::max(h, dome(cr, lobe, 0.6)), h = std::max(h, dome(cr, 0.020, 0.85));
    }
  }
  return h;
}

// A branch that rolls up: center, outer radius, which way; with a leaf of three lobes beside it.
struct Roll { double x, y, radius, hand; };
double roll_height(double x, double y, const Roll& k) {
  const double dx = k.hand * (x - k.x), dy = y - k.y, r = std::sqrt(dx * dx + dy * dy);
  if (r > 1.5 * k.radius) return 0;
  const double turn = 0.5 + atan2_(dy, dx) / (2 * kPi);
  double h = dome(r, 0.24 * k.radius, 0.95);
  for (int n = 0; n < 2; ++n) {  // radius falls by half of itself a turn
    const double line = k.radius * (1 - 0.42 * (turn + n));
    if (line < 0.2 * k.radius) continue;
    h = std::max(h, dome(std::fabs(r - line), 0.17 * k.radius, 0.72));
  }
  for (int lobe = 0; lobe < 5; ++lobe) {
    double s, c;
    sin_cos((0.10 + 0.16 * lobe) * 2 * kPi, &s, &c);
    const double lx = 1.16 * k.radius * c, ly = 1.16 * k.radius * s;
    const double along = (dx - lx) * c + (dy - ly) * s, across = -(dx - lx) * s + (dy - ly) * c;
    const double q = std::sqrt(along * along / 3.2 + across * across);
    h = std::max(h, dome(q, 0.21 * k.radius, 0.55) - (std::fabs(across) < 0.012 * k.radius ? 0.10 : 0));
  }
  return h;
}

double vine_height(double u, double v) {
  static const Roll kRolls[5] = {{0.205, 0.235, 0.125, 1}, {0.225, 0.545, 0.110, -1}, {0.175, 0.790, 0.075, 1}, {0.395, 0.400, 0.060, -1}, {0.385, 0.700, 0.070, 1}};
  const double x = u < 0.5 ? u : 1 - u;
  double h = rim(u, v);
  for (const Roll& k : kRolls) h = std::max(h, roll_height(x, v, k));
  const double stem = 0.5 - x;
  if (v > 0.10 && v < 0.80) h = std::max(h, dome(stem, 0.022 + 0.016 * (0.8 - v), 0.80));
  const double bud = std::sqrt(stem * stem * 3.2 + (v - 0.815) * (v - 0.815));
  h = std::max(h, dome(bud, 0.085, 0.95) - (fraction(stem * 34) < 0.16 ? 0.12 : 0) * (bud < 0.08 ? 1 : 0));
  h = std::max(h, dome(std::sqrt(stem * stem * 0.35 + (v - 0.115) * (v - 0.115)), 0.045, 0.8));
  return h;
}

// Stone that is darker where the chisel went deep and dust lies.
Picture relief_color(int size, double (*height)(double, double)) {
  return paint_color(size, size, [=](double u, double v) {
    const double h = height(u, v), cloud = fractal_noise(u * 4, v * 4, 4, 4, 381);
    const Color c = blend({0.57, 0.48, 0.37}, {0.90, 0.83, 0.71}, smooth_step(-0.15, 0.75, h));
    return c * (1 + 0.08 * cloud);
  });
}

Picture relief_height(int size, double (*height)(double, double)) {
  return paint_gray(size, size, 16, [=](double u, double v) { return 0.08 + 0.85 * height(u, v) + 0.012 * fractal_noise(u * 40, v * 40, 40, 2, 382); });
}

}  // namespace

Picture relief_sun_color(int size) { return relief_color(size, sun_height); }
Picture relief_sun_height(int size) { return relief_height(size, sun_height); }
Picture relief_vine_color(int size) { return relief_color(size, vine_height); }
Picture relief_vine_height(int size) { return relief_height(size, vine_height); }

Picture cut_stone_color(int size) {
  return paint_color(size, size, [](double u, double v) {
    const double cloud = fractal_noise(u * 3, v * 3, 3, 5, 401), fleck = gradient_noise(u * 60, v * 60, 60, 402);
    return blend({0.78, 0.71, 0.60}, {0.90, 0.85, 0.76}, smooth_step(-0.5, 0.5, cloud)) * (1 + 0.03 * fleck);
  });
}

Picture coffer_color(int size) {
  return paint_color(size, size, [](double u, double v) {
    const double cloud = fractal_noise(u * 5, v * 5, 5, 4, 391);
    const Color c = blend({0.13, 0.20, 0.31}, {0.24, 0.33, 0.44}, smooth_step(-0.5, 0.6, cloud));
    return blend(c, {0.55, 0.52, 0.45}, 0.35 * smooth_step(0.25, 0.5, fractal_noise(u * 16, v * 16, 16, 3, 392)));
  });
}

Picture lattice_mask(int size) {
  return paint_gray(size, size, 8, [size](double u, double v) {
    const double x = std::fabs(fraction(u * 4 + 0.5) - 0.5) / 4, y = std::fabs(fraction(v * 4 + 0.5) - 0.5) / 4;  // to the nearest bar
    const double d = std::min(std::min(x, y) - 0.0075, std::max(0.0, x + y - 0.034));
    return 0.5 - d * size;
  });
}

}  // namespace spanray::assets
