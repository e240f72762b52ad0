// A moving sphere against one triangle, in plain IEEE doubles: when does it touch first?
#pragma once
#include <algorithm>
#include <cmath>

#include "math/vec.h"

namespace spanray {

// Three corners as seen from the sphere's first center: differences of doubles, rounded once, so nearby triangles of worlds far from
// the origin keep their digits.
struct SphereTriangle {
  glm::dvec3 corner[3], edge[3];  // edge[i] leads from corner i to the next one
  glm::dvec3 normal;              // unit; zero for a triangle without area
  double reach;                   // the largest coordinate of a corner

  SphereTriangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) : corner{a, b, c}, edge{b - a, c - b, a - c} {
    normal = normalize3(cross3(edge[0], edge[1]), glm::dvec3(0));
    reach = 0;
    for (const glm::dvec3& p : corner) reach = std::max({reach, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  }
};

// The way from the nearest point of a triangle to a place: away * distance. away is a unit vector, or zero where distance is 0.
struct NearestPoint {
  glm::dvec3 away;
  double distance;
};

// The nearest point of the edges is always one of the candidates, so a normal that lost its digits (needles) cannot push a
// triangle away.
inline NearestPoint nearest_point(const SphereTriangle& t, const glm::dvec3& place) {
  glm::dvec3 from_edge(0);
  double least = INFINITY;
  bool inside = true;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 from_corner = place - t.corner[i];
    const double length2 = dot3(t.edge[i], t.edge[i]);
    const double part = length2 > 0 ? std::clamp(dot3(from_corner, t.edge[i]) / length2, 0.0, 1.0) : 0.0;
    const glm::dvec3 d = from_corner - t.edge[i] * part;
    const double square = dot3(d, d);
    if (square < least) least = square, from_edge = d;
    inside = inside && dot3(cross3(t.edge[i], from_corner), t.normal) > 0;
  }
  if (inside) {
    const double height = dot3(t.normal, from_edge);
    return height < 0 ? NearestPoint{-t.normal, -height} : NearestPoint{t.normal, height};
  }
  return {normalize3(from_edge, glm::dvec3(0)), std::sqrt(least)};
}

struct SphereContact {
  double time = 0;         // part of the motion, 0 to 1
  glm::dvec3 point{0};     // of the triangle, seen from the first center
  glm::dvec3 normal{0};    // unit, from there to the sphere's center
};

// When a sphere, moved along `motion` from the origin, first touches the triangle; false if that is never, or after `latest`.
// A triangle that it touches at the start stops it at time 0 if the motion leads towards it, and never else: what sticks can leave.
// Source:   the distance to a convex set along a line is convex, so Newton's method from the near side never passes the first
//           contact (conservative advancement: Mirtich 1996, "Impulse-based Dynamic Simulation of Rigid Body Systems").
// Input:    |coordinates| and radius at most 1e30, length = |motion| > 0, radius > 0.
// Contract: no later than the true contact. A sphere passes only triangles that stay farther away than its radius; one whose distance is
//           less than 2^-45 (reach + radius) more than that, with reach the largest coordinate, may stop it. At the start, directions
//           towards the triangle are told from those along it up to a sine of 2^-48 reach / distance. Does not depend on `latest`.
inline bool first_contact(const SphereTriangle& t, const glm::dvec3& motion, double length, double radius, double latest,
                          SphereContact& out) {
  constexpr double kRounding = 0x1p-49;  // of distances, in units of the largest coordinate
  constexpr int kMostSteps = 100;        // a grazing sphere takes some 30
  double time = 0;
  for (int step = 0;; ++step) {
    const glm::dvec3 center = motion * time;
    const NearestPoint nearest = nearest_point(t, center);
    const double error = kRounding * (std::max(t.reach, length * time) + radius);
    const double gap = nearest.distance - radius;
    const double change = dot3(nearest.away, motion);
    const double change_error = length * (kRounding + error / nearest.distance);
    if (gap <= 8 * error || step == kMostSteps) {
      if (time == 0 && !(change < -change_error)) return false;
      out = {time, center - nearest.away * nearest.distance, nearest.away};
      return true;
    }
    const double approach = change_error - change;
    if (!(approach > 0)) return false;
    time += (gap - 4 * error) / approach;
    if (!(time <= latest)) return false;
  }
}

}  // namespace spanray
