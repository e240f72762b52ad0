#include <cmath>

#include "math/vec.h"
#include "scene/obj_mesh.h"

namespace spanray {
namespace {

glm::dvec3 position_of(const float* positions, const ObjCorner& c) {
  const float* p = positions + 3 * static_cast<size_t>(c.position);
  return {p[0], p[1], p[2]};
}

// Twice the signed area of a, b, c.
double area2(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The polygon seen along the largest component of its normal, counter-clockwise.
struct FlatPolygon {
  std::vector<glm::dvec2> point;
  std::vector<uint32_t> corner;  // number of the corner in the file
  bool finite = true;
};

FlatPolygon flatten(const float* positions, const ObjCorner* corners, uint32_t count) {
  FlatPolygon flat;
  std::vector<glm::dvec3> points;
  for (uint32_t i = 0; i < count; ++i) {
    const glm::dvec3 p = position_of(positions, corners[i]);
    if (!std::isfinite(p.x + p.y + p.z)) flat.finite = false;
    if (!points.empty() && points.back() == p) continue;
    points.push_back(p);
    flat.corner.push_back(i);
  }
  while (points.size() > 1 && points.front() == points.back()) points.pop_back(), flat.corner.pop_back();
  glm::dvec3 normal(0);  // twice the area vector (Newell)
  for (size_t i = 0; i < points.size(); ++i)
    normal += cross3(points[i] - points[0], points[(i + 1) % points.size()] - points[0]);
  const double x = std::fabs(normal.x), y = std::fabs(normal.y), z = std::fabs(normal.z);
  for (const glm::dvec3& p : points) {
    if (x >= y && x >= z)
      flat.point.push_back(normal.x < 0 ? glm::dvec2(p.z, p.y) : glm::dvec2(p.y, p.z));
    else if (y >= z)
      flat.point.push_back(normal.y < 0 ? glm::dvec2(p.x, p.z) : glm::dvec2(p.z, p.x));
    else
      flat.point.push_back(normal.z < 0 ? glm::dvec2(p.y, p.x) : glm::dvec2(p.x, p.y));
  }
  return flat;
}

// Strict left turns only, and only once around: the x coordinates rise and fall once.
bool is_convex(const std::vector<glm::dvec2>& p) {
  const size_t n = p.size();
  int turns = 0;
  for (size_t i = 0; i < n; ++i) {
    const glm::dvec2 &a = p[i], &b = p[(i + 1) % n], &c = p[(i + 2) % n];
    if (!(area2(a, b, c) > 0)) return false;  // collinear corners go to clip_ears, which leaves no T-junction at them
    const auto less = [](const glm::dvec2& u, const glm::dvec2& v) { return u.x != v.x ? u.x < v.x : u.y < v.y; };
    if (less(a, b) != less(b, c)) ++turns;
  }
  return turns <= 2;
}

void fan(const std::vector<uint32_t>& corner, std::vector<uint32_t>& out) {
  for (size_t i = 1; i + 1 < corner.size(); ++i) out.insert(out.end(), {corner[0], corner[i], corner[i + 1]});
}

bool is_ear(const FlatPolygon& flat, const std::vector<uint32_t>& ring, size_t at) {
  const size_t n = ring.size();
  const glm::dvec2 &a = flat.point[ring[(at + n - 1) % n]], &b = flat.point[ring[at]], &c = flat.point[ring[(at + 1) % n]];
  if (!(area2(a, b, c) > 0)) return false;
  for (size_t i = 2; i + 1 < n; ++i) {
    const glm::dvec2& p = flat.point[ring[(at + i) % n]];
    if (p == a || p == b || p == c) continue;
    if (area2(a, b, p) >= 0 && area2(b, c, p) >= 0 && area2(c, a, p) >= 0) return false;
  }
  return true;
}

// Source: Meisters 1975, "Polygons have ears". A polygon that crosses itself may run out of ears: the rest becomes a fan.
void clip_ears(const FlatPolygon& flat, int64_t& budget, std::vector<uint32_t>& out) {
  std::vector<uint32_t> ring(flat.point.size());
  for (size_t i = 0; i < ring.size(); ++i) ring[i] = static_cast<uint32_t>(i);
  size_t at = 1, missed = 0;
  while (ring.size() > 3 && missed < ring.size() && budget > 0) {
    at %= ring.size();
    budget -= static_cast<int64_t>(ring.size());
    if (!is_ear(flat, ring, at)) {
      ++at, ++missed;
      continue;
    }
    const size_t n = ring.size();
    for (const size_t i : {(at + n - 1) % n, at, (at + 1) % n}) out.push_back(flat.corner[ring[i]]);
    ring.erase(ring.begin() + static_cast<ptrdiff_t>(at));
    missed = 0;
  }
  std::vector<uint32_t> rest;
  for (const uint32_t i : ring) rest.push_back(flat.corner[i]);
  fan(rest, out);
}

}  // namespace

void triangulate(const float* positions, const ObjCorner* corners, uint32_t corner_count, int64_t& budget,
                 std::vector<uint32_t>& out) {
  if (corner_count == 3) {
    out.insert(out.end(), {0, 1, 2});
    return;
  }
  const FlatPolygon flat = flatten(positions, corners, corner_count);
  if (!flat.finite) {
    std::vector<uint32_t> all(corner_count);
    for (uint32_t i = 0; i < corner_count; ++i) all[i] = i;
    fan(all, out);
  } else if (is_convex(flat.point)) {
    fan(flat.corner, out);
  } else {
    clip_ears(flat, budget, out);
  }
}

}  // namespace spanray
