// What a hit is: the ray as every test sees it, and the triangle test that decides. Plain IEEE doubles, one triangle at a time; the
// kernel's lanes only sort out triangles and nodes that this test would refuse.
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace spanray {

inline constexpr float kLargestT = std::numeric_limits<float>::max();

// slab() rounds four times, reciprocals included. The factors 1 -+ 6u make the near side an under- and the far side an
// overestimate (Ize 2013).
inline constexpr float kSlabWidening = 6.0f / (1 << 24);

// One ray, with its direction scaled by a power of two so that the largest component is in [1, 2): exact, and then neither
// reciprocals nor distances leave the range of float. All t below count in units of that direction.
struct TraceRay {
  float origin[3];
  int kx, ky, kz;            // axes; the direction is largest along kz
  double shear_x, shear_y;   // direction[kx] / direction[kz], direction[ky] / direction[kz]
  double direction_z;        // scaled direction along kz, magnitude in [1, 2)
  double t_max;
  float inv_near[3], inv_far[3];  // see slab()
  bool negative[3];          // the far plane of a box is its minimum
};

// False if the ray misses everything: zero or non-finite direction, non-finite origin, t_max negative or NaN.
inline bool prepare_ray(const float origin[3], const float direction[3], float t_max, TraceRay& ray) {
  float largest = 0;
  ray.kz = 0;
  for (int k = 0; k < 3; ++k) {
    const float size = std::fabs(direction[k]);
    if (!(size <= kLargestT) || !(std::fabs(origin[k]) <= kLargestT)) return false;
    if (size > largest) largest = size, ray.kz = k;
    ray.origin[k] = origin[k];
  }
  if (!(largest > 0) || !(t_max >= 0)) return false;
  ray.kx = ray.kz == 2 ? 0 : ray.kz + 1;
  ray.ky = ray.kx == 2 ? 0 : ray.kx + 1;
  // 2^-e, where largest = m * 2^e with m in [1, 2): floats are normal doubles, so this is exact.
  const uint64_t exponent = std::bit_cast<uint64_t>(static_cast<double>(largest)) >> 52;
  const double scale = std::bit_cast<double>((2046 - exponent) << 52);
  ray.t_max = static_cast<double>(t_max) / scale;
  for (int k = 0; k < 3; ++k) {
    const double d = static_cast<double>(direction[k]) * scale;
    ray.negative[k] = std::signbit(direction[k]);
    if (direction[k] == 0.0f) {
      ray.inv_near[k] = ray.inv_far[k] = ray.negative[k] ? -std::numeric_limits<float>::infinity() : std::numeric_limits<float>::infinity();
    } else if (std::fabs(d) < 0x1p-126) {
      ray.inv_near[k] = ray.inv_far[k] = std::numeric_limits<float>::quiet_NaN();  // no reciprocal: the axis never culls
    } else {
      const float inverse = 1.0f / static_cast<float>(d);  // d is a float
      ray.inv_near[k] = inverse * (1.0f - kSlabWidening);
      ray.inv_far[k] = inverse * (1.0f + kSlabWidening);
    }
  }
  ray.direction_z = static_cast<double>(direction[ray.kz]) * scale;
  ray.shear_x = static_cast<double>(direction[ray.kx]) / static_cast<double>(direction[ray.kz]);
  ray.shear_y = static_cast<double>(direction[ray.ky]) / static_cast<double>(direction[ray.kz]);
  return true;
}

// Narrows [near, far] to where the ray is between the planes lo and hi of one axis, not less than exactly. Monotone: a box inside
// another never gets a wider interval. A NaN (0 * inf: the origin lies on a plane that the ray runs along; or an axis
// without a reciprocal) leaves the interval as it is.
inline void slab(const TraceRay& ray, int k, float lo, float hi, float& near, float& far) {
  const float n = ((ray.negative[k] ? hi : lo) - ray.origin[k]) * ray.inv_near[k];
  const float f = ((ray.negative[k] ? lo : hi) - ray.origin[k]) * ray.inv_far[k];
  near = n > near ? n : near;
  far = f < far ? f : far;
}

// The least float that is not below t; t >= 0, at most kLargestT is returned.
inline float round_up(double t) {
  if (!(t < static_cast<double>(kLargestT))) return kLargestT;
  const float f = static_cast<float>(t);
  return static_cast<double>(f) < t ? std::bit_cast<float>(std::bit_cast<uint32_t>(f) + 1) : f;
}

// A float that is no more than t; t >= 0.
inline float round_down(double t) { return static_cast<float>(t) * (1 - 0x1p-23f); }

// Coordinate k of vertex i of a triangle, vertices in canonical order.
struct TriangleView {
  const float* first;
  int vertex_stride, axis_stride;
  [[gnu::always_inline]] float operator()(int vertex, int axis) const { return first[vertex * vertex_stride + axis * axis_stride]; }
};

// Corners along the ray's axes, sheared so that the ray is the z axis, and edge functions: exact opposites for two triangles that share
// the edge; of the right sign or 0.
struct SeenTriangle {
  double x[3], y[3], z[3];
  double u, v, w;
  [[gnu::always_inline]] SeenTriangle(const TraceRay& ray, const TriangleView& vertex) {
    const double ox = ray.origin[ray.kx], oy = ray.origin[ray.ky], oz = ray.origin[ray.kz];
    for (int i = 0; i < 3; ++i) {
      z[i] = static_cast<double>(vertex(i, ray.kz)) - oz;
      x[i] = (static_cast<double>(vertex(i, ray.kx)) - ox) - ray.shear_x * z[i];
      y[i] = (static_cast<double>(vertex(i, ray.ky)) - oy) - ray.shear_y * z[i];
    }
    u = x[2] * y[1] - y[2] * x[1];
    v = x[0] * y[2] - y[0] * x[2];
    w = x[1] * y[0] - y[1] * x[0];
  }
};

// Of the triangles that share an edge or a corner which the ray passes exactly through, some own the hit: those that it would meet if it
// were moved by (e, e^2), e infinitely small and positive, along its axes kx and ky. Of a surface that the ray crosses that is one.
// Source: Edelsbrunner and Muecke 1990, "Simulation of Simplicity"; the top-left rule of rasterizers.
inline bool owns_hit(const TraceRay& ray, const TriangleView& vertex) {
  const SeenTriangle s(ray, vertex);
  const auto side = [&](double edge, int i, int j) {  // of the edge from corner i to corner j
    if (edge != 0) return edge > 0;
    return s.y[j] != s.y[i] ? s.y[j] > s.y[i] : s.x[j] < s.x[i];
  };
  const bool u = side(s.u, 1, 2), v = side(s.v, 2, 0), w = side(s.w, 0, 1);
  return u == v && v == w;
}

// With e = 2^-53 and s the largest |x|, |y| of the corners, rounded edge functions are off by at most 4 e s^2, and the point that they stand
// for by 12 e s^3 / |det| along x and y. Where that may exceed 2^-13 s, the triangle is seen edge-on: its projection is thinner than 2^-36 s.
inline constexpr double kEdgeOn = 0x1p-36, kNearEdge = 0x1p-13;

// Of a triangle that is seen edge-on: does the ray pass within kNearEdge * size of an edge, where that is in front? It does wherever it
// passes inside; but an edge function that was rounded to 0 may put a ray inside that is far from the triangle.
[[gnu::noinline, gnu::cold]] inline bool passes_edge(const SeenTriangle& t, bool forward, double size) {
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1;
    const double za = forward ? t.z[i] : -t.z[i], zb = forward ? t.z[j] : -t.z[j];
    if (za < 0 && zb < 0) continue;
    const double from = za < 0 ? za / (za - zb) : 0, to = zb < 0 ? za / (za - zb) : 1;
    const double dx = t.x[j] - t.x[i], dy = t.y[j] - t.y[i], length2 = dx * dx + dy * dy;
    const double nearest = length2 > 0 ? std::min(std::max(-(t.x[i] * dx + t.y[i] * dy) / length2, from), to) : from;
    const double x = t.x[i] + nearest * dx, y = t.y[i] + nearest * dy;
    if (x * x + y * y <= kNearEdge * kNearEdge * size * size) return true;
  }
  return false;
}

// Of the extent of a triangle (the largest side of its box): twice what a ray that hits it passes it by at most.
inline constexpr double kPartMargin = 0x1p-10;

// Watertight ray-triangle test. On a hit sets t, in units of the scaled direction; 0 < t <= kLargestT, t may exceed ray.t_max.
// Source:   Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection"; Pharr, Jakob, Humphreys, PBR 4th ed., 6.8.7.
// Contract: unfused, so edge functions of a shared edge are exact opposites; their signs are right or the value is 0, and 0 counts as
//           inside, so no ray passes between two triangles. Hits not provably in front of the origin are refused.
//           No hit is lost to boxes. Of the triangle's own: the ray meets it, and t is no less than where it enters. Of boxes that hold parts
//           of it, each with kPartMargin more on all sides: the ray meets one of them, and enters it at no more than t. For it passes
//           within 2^-11 of the triangle's extent of one of its points, at t; or, where the triangle is seen edge-on, at no more than t,
//           which there is that of the farthest corner. (What rounding adds for far origins is less than slab() widens boxes by.)
[[gnu::always_inline]] inline bool hit_triangle(const TraceRay& ray, const TriangleView& vertex, double& t) {
  const SeenTriangle seen(ray, vertex);
  const auto &[x, y, z, u, v, w] = seen;
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
  const double det = u + v + w;
  if (det == 0) return false;
  double s = 0;
  for (int i = 0; i < 3; ++i) s = std::max(s, std::max(std::fabs(x[i]), std::fabs(y[i])));
  const bool edge_on = !(std::fabs(det) > kEdgeOn * s * s);

  const double z_min = std::min(std::min(z[0], z[1]), z[2]), z_max = std::max(std::max(z[0], z[1]), z[2]);
  const double z_hit = std::clamp((u * z[0] + v * z[1] + w * z[2]) / det, z_min, z_max);
  const bool forward = ray.direction_z > 0;
  if (forward ? z_min <= 0 : z_max >= 0) {
    // Not wholly in front: is z_hit beyond its own error? Each x, y is off by at most 6 e M, each edge function by 40 e M (s + 8 e M).
    constexpr double e = 0x1p-53;
    const double reach = std::max(std::fabs(z_min), std::fabs(z_max)), m = s + reach;
    const double edge_error = 40 * e * m * (s + 8 * e * m);
    if (!((forward ? z_hit : -z_hit) * std::fabs(det) > 3 * edge_error * reach + 8 * e * std::fabs(det) * reach)) return false;
  }

  float near = 0, far = kLargestT;
  for (int k = 0; k < 3; ++k) {
    const float a = vertex(0, k), b = vertex(1, k), c = vertex(2, k);
    slab(ray, k, std::min(std::min(a, b), c), std::max(std::max(a, b), c), near, far);
  }
  if (near > far || (edge_on && !passes_edge(seen, forward, s))) return false;
  const double z_t = !edge_on ? z_hit : forward ? z_max : z_min;
  t = std::clamp(z_t / ray.direction_z, static_cast<double>(near), static_cast<double>(kLargestT));
  return true;
}

// hit_triangle() of a ray as it is given: t in units of its direction. corners: X, Y, Z of each vertex, in canonical order.
inline bool meet_triangle(const float (&origin)[3], const float (&direction)[3], float t_max, const float (&corners)[9], double& t) {
  TraceRay ray;
  if (!prepare_ray(origin, direction, t_max, ray) || !hit_triangle(ray, TriangleView{corners, 3, 1}, t)) return false;
  t *= ray.direction_z / static_cast<double>(direction[ray.kz]);  // a power of two
  return true;
}

}  // namespace spanray
