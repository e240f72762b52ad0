// Procedural noise that tiles, from integer hashes: the same bits on every machine.
#pragma once
#include <cstdint>

namespace spanray::assets {

// Uniform in [0, 1), a function of its arguments only.
double random_unit(int64_t x, int64_t y, uint32_t seed);

// Gradient noise, about [-1, 1], zero at integer points; repeats every period > 0 in x and y.
// Source: Perlin 2002, "Improving Noise" (quintic fade, fixed gradients).
double gradient_noise(double x, double y, int period_x, int period_y, uint32_t seed);
inline double gradient_noise(double x, double y, int period, uint32_t seed) { return gradient_noise(x, y, period, period, seed); }

// Sum of `octaves` of it, each twice as fine and half as strong; about [-1, 1]; repeats likewise.
double fractal_noise(double x, double y, int period_x, int period_y, int octaves, uint32_t seed);
inline double fractal_noise(double x, double y, int period, int octaves, uint32_t seed) {
  return fractal_noise(x, y, period, period, octaves, seed);
}

// Distances to the nearest and second nearest of one random point a unit cell, and a random number in [0, 1) that belongs to the
// nearest one; repeats every `period`. Source: Worley 1996, "A Cellular Texture Basis Function".
struct Cell { double nearest, second, id; };
Cell cell_noise(double x, double y, int period, uint32_t seed);

// 0 below `low`, 1 above `high`, cubic between.
double smooth_step(double low, double high, double x);
double mix(double a, double b, double t);

}  // namespace spanray::assets
