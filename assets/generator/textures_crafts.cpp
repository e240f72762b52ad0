#include <cmath>

#include "math/elementary.h"
#include "noise.h"
#include "textures.h"

namespace spanray::assets {
namespace {

using Color = glm::dvec3;

Color blend(const Color& a, const Color& b, double t) { return a + t * (b - a); }

double distance(double x, double y, double cx, double cy) { return std::sqrt((x - cx) * (x - cx) + (y - cy) * (y - cy)); }

// Distance to the segment from (ax, ay) to (bx, by).
double to_segment(double x, double y, double ax, double ay, double bx, double by) {
  const double dx = bx - ax, dy = by - ay;
  double t = ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy);
  t = t < 0 ? 0 : t > 1 ? 1 : t;
  return distance(x, y, ax + t * dx, ay + t * dy);
}

// A scroll: a spiral of one and a half turns around a center, as chords; `hand` 1 or -1 mirrors it.
struct Scroll {
  static constexpr int kChords = 42;
  double x[kChords + 1], y[kChords + 1], center_x, center_y, radius;
  Scroll(double cx, double cy, double r, double hand) : center_x(cx), center_y(cy), radius(r) {
    for (int k = 0; k <= kChords; ++k) {
      const double t = static_cast<double>(k) / kChords;
      double s, c;
      sin_cos(kPi * (3 * t - 0.5), &s, &c);
      x[k] = cx + hand * r * (1 - 0.82 * t) * c, y[k] = cy + r * (1 - 0.82 * t) * s;
    }
  }
  double distance_to(double px, double py) const {
    double best = distance(px, py, center_x, center_y) - radius;  // far away: a lower bound will do
    if (best > 0.03) return best;
    best = 1e9;
    for (int k = 0; k < kChords; ++k) {
      const double d = to_segment(px, py, x[k], y[k], x[k + 1], y[k + 1]);
      best = d < best ? d : best;
    }
    return best;
  }
};

// Half width of the leaf at height v in [0, 1], serrated.
double leaf_half_width(double v) {
  if (v < 0.10 || v > 0.98) return -1;
  const double t = (v - 0.10) / 0.88;
  const double outline = 0.40 * std::sqrt(t) * (1 - t) * 2.2;
  const double tooth = v * 11 - std::floor(v * 11);
  return outline * (1 - 0.16 * tooth);
}

bool in_leaf(double u, double v) { return std::fabs(u - 0.5) < leaf_half_width(v) || (v < 0.2 && std::fabs(u - 0.5) < 0.02); }

struct Board { double across, tint, shift; };
Board board_at(double v) {
  const double y = v * 4;
  const int64_t i = static_cast<int64_t>(std::floor(y));
  return {y - static_cast<double>(i), random_unit(i, 0, 101), random_unit(i, 1, 102)};
}

double wood_rings(double u, double v, const Board& b) {
  const double shift = std::floor(b.shift * 16);
  const double bend = 0.30 * fractal_noise(u * 2, v * 4 + shift, 2, 4, 3, 103);
  const double rings = (v * 4 + b.shift + bend) * 5;
  const double saw = rings - std::floor(rings);
  return saw * saw * (1 - smooth_step(0.85, 1, saw));
}

}  // namespace

Picture plank_color(int width, int height) {
  return paint_color(width, height, [](double u, double v) {
    const Board b = board_at(v);
    const double fiber = gradient_noise(u * 4, v * 64, 4, 64, 104);
    Color c = blend({0.58, 0.40, 0.25}, {0.72, 0.54, 0.36}, b.tint);
    c = c * (1 - 0.28 * wood_rings(u, v, b)) * (1 + 0.09 * fiber);
    const double joint = b.across < 0.5 ? b.across : 1 - b.across;
    return blend({0.16, 0.10, 0.07}, c, smooth_step(0.012, 0.04, joint));
  });
}

Picture plank_height(int width, int height) {
  return paint_gray(width, height, 8, [](double u, double v) {
    const Board b = board_at(v);
    const double joint = b.across < 0.5 ? b.across : 1 - b.across;
    const double h = 0.8 - 0.10 * wood_rings(u, v, b) + 0.05 * gradient_noise(u * 4, v * 64, 4, 64, 104);
    return mix(0.2, h, smooth_step(0.01, 0.05, joint));
  });
}

Picture ironwork_mask(int size) {
  static const Scroll kScrolls[4] = {{0.125, 0.335, 0.105, 1}, {0.375, 0.335, 0.105, -1}, {0.125, 0.125, 0.085, -1}, {0.375, 0.125, 0.085, 1}};
  return paint_gray(size, size, 8, [size](double u, double v) {
    const double x = std::fabs(u - 0.5), bar = 0.020;
    double d = 1e9;
    const auto add = [&d](double other, double half_width) { d = other - half_width < d ? other - half_width : d; };
    add(0.5 - x, 0.03), add(v < 0.5 ? v : 1 - v, 0.03);            // border
    add(x, bar), add(std::fabs(x - 0.25), bar * 0.8);              // uprights
    add(std::fabs(v - 0.5), bar);                                  // middle rail
    const double y = v < 0.5 ? v : 1 - v;                          // mirrored about the middle rail
    for (const Scroll& scroll : kScrolls) add(scroll.distance_to(x, y), 0.013);
    add(std::fabs(distance(x, v, 0, 0.5) - 0.14), 0.017);          // ring
    const double s = std::fabs(x) + std::fabs(v - 0.5);
    add(s > 0.055 ? s - 0.055 : 0, 0.0);                           // boss
    return 0.5 - d * size;                                         // one texel of soft edge; accept() cuts at one half
  });
}

Picture leaf_color(int size) {
  return paint_color(size, size, [](double u, double v) {
    const double x = std::fabs(u - 0.5);
    const double side = (v - 0.9 * x) * 9, rib = std::fabs(side - std::floor(side) - 0.5);
    Color c = blend({0.16, 0.36, 0.10}, {0.36, 0.56, 0.18}, smooth_step(-0.5, 0.5, gradient_noise(u * 5, v * 5, 5, 111)) * 0.6 + v * 0.3);
    c = blend(c, {0.55, 0.68, 0.32}, 0.5 * smooth_step(0.42, 0.5, rib));
    return blend({0.60, 0.70, 0.38}, c, smooth_step(0.008, 0.022, x));
  });
}

Picture leaf_mask(int size) {
  return paint_gray(size, size, 8, [](double u, double v) { return in_leaf(u, v) ? 1.0 : 0.0; });
}

Picture foliage_color(int size) {
  return paint_color(size, size, [](double u, double v) {
    const Cell c = cell_noise(u * 24, v * 24, 24, 141);
    const Color leaf = blend({0.12, 0.26, 0.07}, {0.38, 0.52, 0.18}, c.id);
    return leaf * (0.45 + 0.55 * smooth_step(0, 0.35, c.second - c.nearest)) * (1 + 0.15 * fractal_noise(u * 4, v * 4, 4, 3, 142));
  });
}

Picture foliage_height(int size) {
  return paint_gray(size, size, 8, [](double u, double v) {
    const Cell c = cell_noise(u * 24, v * 24, 24, 141);
    return 0.3 * c.id + 0.65 * smooth_step(0, 0.6, c.second - c.nearest);
  });
}

Picture ripple_height(int size) {
  return paint_gray(size, size, 16, [](double u, double v) {
    return 0.5 + 0.3 * gradient_noise(u * 3, v * 7, 3, 7, 151) + 0.1 * gradient_noise(u * 7, v * 15, 7, 15, 152);
  });
}

Picture gauze_color(int size) {
  return paint_color(size, size, [size](double u, double v) {
    const double weave = 0.035 * ((static_cast<int>(u * size) ^ static_cast<int>(v * size)) & 1);
    const double band = std::fabs(v - 0.5);
    Color c{0.93, 0.91, 0.85};
    if (band < 0.045) c = {0.72, 0.55, 0.26};
    else if (band > 0.07 && band < 0.085) c = {0.45, 0.52, 0.60};
    return c * (1 - weave);
  });
}

Picture ceramic_color(int width, int height) {
  return paint_color(width, height, [](double u, double v) {
    const Color cream{0.90, 0.85, 0.74}, blue{0.10, 0.20, 0.46}, rust{0.66, 0.27, 0.14};
    const double craze = 0.03 * fractal_noise(u * 16, v * 16, 16, 3, 121);
    Color c = cream;
    const auto band = [&](double low, double high) { return v > low && v < high; };
    if (v < 0.06 || v > 0.94 || band(0.22, 0.245) || band(0.755, 0.78)) c = blue;
    if (band(0.26, 0.275) || band(0.725, 0.74)) c = rust;
    const double lx = std::fabs(u * 8 - std::floor(u * 8) - 0.5), ly = std::fabs(v - 0.5) / 0.21 * 0.5;
    const double lozenge = lx + ly;
    if (band(0.29, 0.71)) c = lozenge < 0.14 ? rust : lozenge < 0.30 ? cream : lozenge < 0.42 ? blue : lozenge < 0.47 ? cream : lozenge < 0.5 ? rust : cream;
    const double tooth = std::fabs(u * 24 - std::floor(u * 24) - 0.5) * 2;
    if (band(0.08, 0.20) && (v - 0.08) / 0.12 < tooth) c = blue;
    if (band(0.80, 0.92) && (0.92 - v) / 0.12 < tooth) c = blue;
    return c * (1 + craze);
  });
}

Picture globe_color(int width, int height) {
  return paint_color(width, height, [](double u, double v) {
    const double land = fractal_noise(u * 6, v * 3, 6, 6, 5, 131) + 0.04;
    const double latitude = std::fabs(v - 0.5) * 2;
    const double grid_u = std::fabs(u * 24 - std::floor(u * 24) - 0.5), grid_v = std::fabs(v * 12 - std::floor(v * 12) - 0.5);
    Color c = blend({0.11, 0.27, 0.40}, {0.27, 0.50, 0.60}, smooth_step(-0.35, 0.02, land));
    if (land > 0.02) c = blend(blend({0.76, 0.66, 0.40}, {0.42, 0.50, 0.24}, smooth_step(0.75, 0.2, latitude)), {0.55, 0.42, 0.28}, smooth_step(0.12, 0.4, land));
    if (std::fabs(land - 0.02) < 0.012) c = {0.20, 0.16, 0.12};
    c = blend(c, {0.93, 0.93, 0.90}, smooth_step(0.80, 0.90, latitude + 0.15 * land));
    if (grid_u > 0.485 || grid_v > 0.485) c = blend(c, {0.15, 0.13, 0.12}, 0.35);
    return c;
  });
}

}  // namespace spanray::assets
