// A triangle as a light sees it: which cells of a face it touches, which it covers, how near to the light it is there. In double.
// Source:   Olano and Greer 1997, "Triangle Scan Conversion using 2D Homogeneous Coordinates": edge functions without clipping;
//           Akenine-Moeller and Aila 2005, "Conservative and Tiled Rasterization Using a Modified Triangle Set-up" (corners of cells).
// Contract: cells are taken kMargin larger on all sides, which is more than all roundings here, of rays and of the way from a
//           place to its cell.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "math/vec.h"
#include "ray/light_grid.h"

namespace spanray::light_grid {

inline constexpr double kMargin = 0x1p-12;         // of u and v
inline constexpr double kNearnessSlack = 0x1p-13;  // of what is nearer than a place
inline constexpr double kEdgeError = 0x1p-19;      // of u and v, where the way of a ray is exact
inline constexpr double kDirectionError = 0x1p-22;  // of u and v, by the direction of a ray, times its length over the distance from the light
inline constexpr double kPlaneError = 0x1p-20;     // of a plane of nearness, times its coefficients
inline constexpr double kCoverSlack = 0x1p-10;     // of what hides others

// Columns [first, last] of a row; none if first > last.
struct Span { int first, last; double from, to; };

// A face in homogeneous coordinates: a point is at (u, v) = (x, y) / z; orthographic faces have z = 1.
struct FaceTriangle {
  glm::dvec3 edge[3];    // >= 0 inside: edge . (u, v, 1)
  double tolerance[3];   // of edge functions
  glm::dvec3 nearness;   // the plane of it: nearness . (u, v, 1)
  double greatest;       // nearness of a corner
  double error;          // of the plane
  double low[2], high[2];  // box of the corners, in u and v
  bool crosses = false;  // the plane z = 0: then box and `greatest` say nothing
  bool sound = false;    // seen at such an angle that the plane says something
  bool seen = false;

  // corner: homogeneous; value: nearness of the corners of an orthographic face, nullptr for a perspective one.
  FaceTriangle(const glm::dvec3 (&corner)[3], const double* value) {
    if (outside(corner)) return;
    seen = true;
    double length[3];
    for (int i = 0; i < 3; ++i) length[i] = std::fabs(corner[i].x) + std::fabs(corner[i].y) + std::fabs(corner[i].z), crosses = crosses || !(corner[i].z > 0);
    for (int i = 0; i < 3; ++i) edge[i] = cross3(corner[(i + 1) % 3], corner[(i + 2) % 3]), tolerance[i] = 0x1p-48 * length[(i + 1) % 3] * length[(i + 2) % 3];
    const double det = dot3(corner[0], edge[0]);
    const double size = length[0] * length[1] * length[2];
    sound = std::fabs(det) > 0x1p-30 * size;
    nearness = glm::dvec3(0), error = 0;
    if (sound)
      for (int i = 0; i < 3; ++i) {
        const double weight = (value != nullptr ? value[i] : 1.0) / det;
        nearness += edge[i] * weight, error += tolerance[i] * std::fabs(weight);
      }
    if (!(std::fabs(det) > 0x1p-44 * size)) {  // rounding may have the sign: then only the box says where it is
      for (glm::dvec3& e : edge) e = glm::dvec3(0);
    } else if (det < 0) {
      for (glm::dvec3& e : edge) e = -e;
    }
    find_box(corner, value);
  }

  // The part of row [v0, v1] that the triangle may touch, of `side` columns.
  Span touched(double v0, double v1, int side) const {
    double from = crosses ? -2 : low[0] - kMargin, to = crosses ? 2 : high[0] + kMargin;
    for (int i = 0; i < 3; ++i) {
      const double rest = edge[i].z + std::max(edge[i].y * (v0 - kMargin), edge[i].y * (v1 + kMargin)) + tolerance[i] + std::fabs(edge[i].x) * kMargin;
      if (edge[i].x > 0) from = std::max(from, -rest / edge[i].x);
      else if (edge[i].x < 0) to = std::min(to, -rest / edge[i].x);
      else if (rest < 0) return {1, 0, 0, 0};
    }
    return columns(from, to, side);
  }

  // The part of row [v0, v1] that the triangle covers whole, and more than that.
  Span covered(double v0, double v1, int side) const {
    if (crosses || !sound) return {1, 0, 0, 0};
    double from = -2, to = 2;
    for (int i = 0; i < 3; ++i) {
      const double rest = edge[i].z + std::min(edge[i].y * (v0 - 2 * kMargin), edge[i].y * (v1 + 2 * kMargin)) - tolerance[i] - std::fabs(edge[i].x) * 2 * kMargin;
      if (edge[i].x > 0) from = std::max(from, -rest / edge[i].x);
      else if (edge[i].x < 0) to = std::min(to, -rest / edge[i].x);
      else if (rest <= 0) return {1, 0, 0, 0};
    }
    const double half = side / 2.0;
    const double first = std::max(0.0, std::ceil((from + 1) * half)), last = std::min(side - 1.0, std::floor((to + 1) * half) - 1);
    return first <= last ? Span{static_cast<int>(first), static_cast<int>(last), from, to} : Span{1, 0, 0, 0};
  }

  // What lanes ask about it. error_uv: of u and v, more than those of rays near the triangle. hides: rays may be known to hit it. has_plane: its
  // plane says who is in front.
  LightGrid::Seen record(double error_uv, bool hides, bool has_plane) const {
    LightGrid::Seen r{};
    double most = error_uv;
    for (int i = 0; i < 3; ++i) {
      const double size = std::fabs(edge[i].x) + std::fabs(edge[i].y);
      if (size > 0) most = std::max(most, 2 * tolerance[i] / size);
    }
    for (int i = 0; i < 3; ++i) {
      const double size = std::fabs(edge[i].x) + std::fabs(edge[i].y), z = std::fabs(edge[i].z);
      // Outside the face, an edge has everything on one side.
      const bool beside = z > 2 * size;
      const double scale = beside ? 1 / z : 1 / size;
      const glm::dvec3 e = z + size > 0 ? (beside ? glm::dvec3(0, 0, edge[i].z * scale) : edge[i] * scale) : glm::dvec3(0, 0, 1);
      r.at_u[i] = static_cast<float>(e.x), r.at_v[i] = static_cast<float>(e.y), r.at_1[i] = static_cast<float>(e.z + most);
    }
    const double size = std::fabs(nearness.x) + std::fabs(nearness.y) + std::fabs(nearness.z);
    const bool flat = sound && has_plane && size < 1e30;
    const double slack = size * kPlaneError + error;
    r.at_u[3] = flat ? static_cast<float>(nearness.x) : 0, r.at_v[3] = flat ? static_cast<float>(nearness.y) : 0;
    r.at_1[3] = flat ? static_cast<float>(nearness.z + slack) : std::numeric_limits<float>::infinity();
    r.slack = static_cast<float>(2 * slack);
    r.sure = flat && hides ? static_cast<float>(2 * most) : std::numeric_limits<float>::infinity();
    return r;
  }

  // The greatest and the least nearness in the cell [u0, u1] x [v0, v1].
  double nearest_in(double u0, double u1, double v0, double v1) const {
    const double at = nearness.z + std::max(nearness.x * (u0 - kMargin), nearness.x * (u1 + kMargin)) +
                      std::max(nearness.y * (v0 - kMargin), nearness.y * (v1 + kMargin)) + error;
    return !sound ? greatest : crosses ? at : std::min(at, greatest);
  }
  double farthest_in(double u0, double u1, double v0, double v1) const {
    return nearness.z + std::min(nearness.x * (u0 - 2 * kMargin), nearness.x * (u1 + 2 * kMargin)) +
           std::min(nearness.y * (v0 - 2 * kMargin), nearness.y * (v1 + 2 * kMargin)) - error;
  }

 private:
  static Span columns(double from, double to, int side) {
    const double half = side / 2.0;
    const double first = std::max(0.0, std::floor((from + 1) * half)), last = std::min(side - 1.0, std::floor((to + 1) * half));
    return first <= last ? Span{static_cast<int>(first), static_cast<int>(last), from, to} : Span{1, 0, 0, 0};
  }

  static bool outside(const glm::dvec3 (&corner)[3]) {
    constexpr double kEdge = 1 + 2 * kMargin;
    const auto all = [&](auto beyond) { return beyond(corner[0]) && beyond(corner[1]) && beyond(corner[2]); };
    return all([](const glm::dvec3& p) { return p.z <= 0; }) || all([](const glm::dvec3& p) { return p.x > kEdge * p.z; }) ||
           all([](const glm::dvec3& p) { return -p.x > kEdge * p.z; }) || all([](const glm::dvec3& p) { return p.y > kEdge * p.z; }) ||
           all([](const glm::dvec3& p) { return -p.y > kEdge * p.z; });
  }

  void find_box(const glm::dvec3 (&corner)[3], const double* value) {
    low[0] = low[1] = -1, high[0] = high[1] = 1, greatest = INFINITY;
    if (crosses) return;
    for (int i = 0; i < 3; ++i) {
      const double at[2] = {corner[i].x / corner[i].z, corner[i].y / corner[i].z}, near = value != nullptr ? value[i] : 1 / corner[i].z;
      for (int k = 0; k < 2; ++k) low[k] = i == 0 ? at[k] : std::min(low[k], at[k]), high[k] = i == 0 ? at[k] : std::max(high[k], at[k]);
      greatest = i == 0 ? near : std::max(greatest, near);
    }
    // hit_triangle() grants hits within 2^-13 of the size of a triangle that is seen edge-on.
    for (int k = 0; k < 2 && !sound; ++k) {
      const double aside = 0x1p-11 * (high[0] - low[0] + high[1] - low[1]);
      low[k] -= aside, high[k] += aside;
    }
  }
};

}  // namespace spanray::light_grid
