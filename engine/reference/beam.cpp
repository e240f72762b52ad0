#include "reference/beam.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "reference/light.h"

namespace spanray::reference {
namespace {

constexpr double kWiden = 1 + 1e-9;  // far above rounding in double, far below all that is asked here

// Two unit vectors that make a right angle with each other and with the unit vector d; the first near `wish`.
void make_frame(const glm::dvec3& d, const glm::dvec3& wish, glm::dvec3& u, glm::dvec3& v) {
  const glm::dvec3 other = std::fabs(d.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 across = normalize3(other - d * dot3(other, d), other), flat = wish - d * dot3(wish, d);
  u = dot3(flat, flat) > 1e-12 * dot3(wish, wish) ? normalize3(flat, across) : across;
  v = cross3(d, u);
}

// What of a polygon lies within the half-space. Source: Sutherland and Hodgman 1974.
std::vector<glm::dvec3> clipped(const std::vector<glm::dvec3>& polygon, const glm::dvec3& origin, const HalfSpace& half) {
  std::vector<glm::dvec3> kept;
  const auto excess = [&](const glm::dvec3& x) { return dot3(half.normal, x - origin) - half.most; };
  for (size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double at_a = excess(a), at_b = excess(b);
    if (at_a <= 0) kept.push_back(a);
    if ((at_a <= 0) != (at_b <= 0)) kept.push_back(a + (b - a) * (at_a / (at_a - at_b)));
  }
  return kept;
}

bool runs_through(const Beam& beam, const glm::dvec3& a, const glm::dvec3& b) {
  double from = 0, to = 1;
  for (const auto* list : {&beam.sides, &beam.ends})
    for (const HalfSpace& half : *list) {
      const double at_a = dot3(half.normal, a - beam.origin) - half.most, at_b = dot3(half.normal, b - beam.origin) - half.most;
      if (at_a > 0 && at_b > 0) return false;
      if (at_a > 0) from = std::max(from, at_a / (at_a - at_b));
      if (at_b > 0) to = std::min(to, at_a / (at_a - at_b));
    }
  return from <= to;
}

// Planes through the polygon's edges and the light. False for a polygon that the light sees edge-on: it has none that mean
// anything.
bool add_prism(Beam& beam, const std::vector<glm::dvec3>& polygon, const std::function<glm::dvec3(const glm::dvec3&)>& to_light,
               double error) {
  double widest = 0;
  for (const glm::dvec3& a : polygon) widest = std::max(widest, length3(a - beam.origin));
  for (size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3 &a = polygon[i], edge = polygon[(i + 1) % polygon.size()] - a;
    if (!(length3(edge) > 1e-6 * widest)) continue;  // a corner that stands twice
    glm::dvec3 out = normalize3(cross3(edge, to_light(a)), glm::dvec3(0));
    double most = dot3(out, a - beam.origin);
    if (most < 0) out = -out, most = -most;
    if (!(most > 1e-4 * widest)) return false;
    beam.sides.push_back({out, most + error});
  }
  return beam.sides.size() >= 3;
}

// Half-spaces of a box around the lines through `polygon` along d, as wide as the polygon and `error`; rays that meet in a
// light stay within.
void add_box(Beam& beam, const std::vector<glm::dvec3>& polygon, const glm::dvec3& d, double error) {
  glm::dvec3 longest(0), u, v;
  for (const glm::dvec3& a : polygon)
    if (const glm::dvec3 from = a - beam.origin; dot3(from, from) > dot3(longest, longest)) longest = from;
  make_frame(d, longest, u, v);
  for (const glm::dvec3& side : {u, -u, v, -v}) {
    double most = 0;
    for (const glm::dvec3& a : polygon) most = std::max(most, dot3(side, a - beam.origin));
    beam.sides.push_back({side, most + error});
  }
}

}  // namespace

bool Beam::misses(const glm::dvec3& low, const glm::dvec3& high) const {
  for (const auto* list : {&sides, &ends})
    for (const HalfSpace& half : *list) {
      double least = 0;
      for (int k = 0; k < 3; ++k) least += half.normal[k] * ((half.normal[k] > 0 ? low[k] : high[k]) - origin[k]);
      if (least > half.most) return true;
    }
  return false;
}

Ray Bundle::through(const glm::dvec3& x) const {
  Ray ray = center;
  const glm::dvec3 from = x - center.line.origin;
  const double along = dot3(from, axis);
  const auto part = [&](const glm::dvec3& side, double start, double spread) {
    const double width = start + spread * along;
    return width > 0 ? start * std::clamp(dot3(from, side) / width, -1.0, 1.0) : 0.0;
  };
  ray.line.origin += u * part(u, start_u, spread_u) + v * part(v, start_v, spread_v);
  const glm::dvec3 way = x - ray.line.origin;
  const double length = dot3(way, axis);
  if (length > 0) ray.line.direction = way * (1 / length);
  return ray;
}

Bundle primary_bundle(const View& view, const Ray& center, double reach) {
  Bundle bundle;
  bundle.center = center, bundle.axis = view.forward, bundle.beam.origin = view.eye;
  const double r = reach * kWiden;
  for (const glm::dvec3& step : {view.right, view.down}) {
    const glm::dvec3 per_pixel = step * (1 / dot3(step, step));
    const double at = dot3(per_pixel, center.line.direction);
    bundle.beam.sides.push_back({per_pixel - view.forward * (at + r), 0});
    bundle.beam.sides.push_back({view.forward * (at - r) - per_pixel, 0});
  }
  bundle.beam.ends.push_back({-view.forward, -view.near});
  return bundle;
}

Bundle mirrored_bundle(const std::vector<Ray>& rays, const glm::dvec3& normal, double error) {
  // Between the rays that were computed lie others: their spread is taken a quarter larger.
  constexpr double kBetween = 1.25;
  Bundle bundle;
  bundle.center = rays[0];
  const glm::dvec3 origin = rays[0].line.origin;
  bundle.axis = normalize3(rays[0].line.direction, normal);
  // The frame in which they start from the smallest rectangle, among those along lines between two of them.
  double smallest = std::numeric_limits<double>::infinity();
  const Bundle none = bundle;
  for (size_t i = 0; i < rays.size(); ++i) {
    Bundle tried = none;
    make_frame(bundle.axis, rays[(i + 1) % rays.size()].line.origin - rays[i].line.origin, tried.u, tried.v);
    for (const Ray& ray : rays) {
      const glm::dvec3 from = ray.line.origin - origin;
      const double along = std::max(dot3(ray.line.direction, bundle.axis), 1e-3 * length3(ray.line.direction));
      const auto widen = [&](const glm::dvec3& side, double& start, double& spread) {
        start = std::max(start, std::fabs(dot3(from, side))),
        spread = std::max(spread, std::fabs(dot3(ray.line.direction, side)) / along);
      };
      widen(tried.u, tried.start_u, tried.spread_u), widen(tried.v, tried.start_v, tried.spread_v);
    }
    if (const double size = tried.start_u * tried.start_v; size < smallest) smallest = size, bundle = tried;
  }
  constexpr double kDirection = 0x1p-20;  // of directions in float
  bundle.start_u += error, bundle.start_v += error;
  bundle.spread_u = bundle.spread_u * kBetween + kDirection, bundle.spread_v = bundle.spread_v * kBetween + kDirection;
  bundle.beam.origin = origin;
  for (const double sign : {1.0, -1.0}) {
    bundle.beam.sides.push_back({bundle.u * sign - bundle.axis * bundle.spread_u, bundle.start_u});
    bundle.beam.sides.push_back({bundle.v * sign - bundle.axis * bundle.spread_v, bundle.start_v});
  }
  bundle.beam.ends.push_back({-normal, -error});
  return bundle;
}

Beam shadow_beam(const std::vector<glm::dvec3>& polygon, const glm::dvec3& normal, const Light& light, double error) {
  Beam beam;
  beam.origin = middle(polygon);
  const Way way = way_to(light, beam.origin);
  const glm::dvec3 d = normalize3(way.line.direction, normal);
  const auto to_light = [&](const glm::dvec3& x) { return way_to(light, x).line.direction; };
  if (!add_prism(beam, polygon, to_light, error)) beam.sides.clear(), add_box(beam, polygon, d, error);
  beam.ends.push_back({-normal, -error});
  if (std::isfinite(way.t_max)) beam.ends.push_back({d, length3(way.line.direction) * way.t_max});
  return beam;
}

Piece clip(const Beam& beam, uint32_t primitive, const glm::dvec3 (&v)[3]) {
  Piece piece;
  piece.primitive = primitive;
  std::copy_n(v, 3, piece.v);
  std::vector<glm::dvec3> polygon(v, v + 3);
  for (const HalfSpace& half : beam.sides) {
    polygon = clipped(polygon, beam.origin, half);
    if (polygon.empty()) return piece;
  }
  for (const HalfSpace& half : beam.ends) {
    const auto outside = [&](const glm::dvec3& x) { return dot3(half.normal, x - beam.origin) > half.most; };
    if (std::none_of(polygon.begin(), polygon.end(), outside)) continue;
    piece.cut = true, polygon = clipped(polygon, beam.origin, half);
    if (polygon.empty()) return piece;
  }
  piece.corner = std::move(polygon);
  for (int k = 0; k < 3; ++k) piece.crosses[k] = runs_through(beam, v[k], v[(k + 1) % 3]);
  return piece;
}

glm::dvec3 middle(const std::vector<glm::dvec3>& polygon) {
  glm::dvec3 sum(0);
  for (const glm::dvec3& x : polygon) sum += x;
  return sum * (1 / static_cast<double>(polygon.size()));
}

std::vector<Sheet> make_sheets(const std::vector<Piece>& pieces,
                               const std::function<glm::dvec3(const glm::dvec3&)>& direction) {
  std::vector<size_t> parent(pieces.size());
  std::iota(parent.begin(), parent.end(), size_t{0});
  const auto root = [&](size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::vector<char> open(pieces.size(), 0);
  // Is j the neighbour of i beyond its edge k, on the other side of it?
  const auto continues = [&](const Piece& i, int k, const Piece& j) {
    const glm::dvec3 &a = i.v[k], &b = i.v[(k + 1) % 3], &tip = i.v[(k + 2) % 3];
    for (int l = 0; l < 3; ++l) {
      const glm::dvec3 &c = j.v[l], &e = j.v[(l + 1) % 3];
      if (!((a == c && b == e) || (a == e && b == c))) continue;
      const glm::dvec3 side = cross3(direction((a + b) * 0.5), b - a);
      const double here = dot3(side, tip - a), there = dot3(side, j.v[(l + 2) % 3] - a);
      return (here < 0 && there > 0) || (here > 0 && there < 0);
    }
    return false;
  };
  for (size_t i = 0; i < pieces.size(); ++i) {
    open[i] = pieces[i].cut || !pieces[i].certain;
    for (int k = 0; k < 3; ++k) {
      if (!pieces[i].crosses[k]) continue;
      bool found = false;
      for (size_t j = 0; j < pieces.size(); ++j)
        if (j != i && continues(pieces[i], k, pieces[j])) found = true, parent[root(j)] = root(i);
      open[i] |= !found;
    }
  }
  std::vector<Sheet> sheets;
  std::vector<size_t> sheet_of(pieces.size(), SIZE_MAX);
  for (size_t i = 0; i < pieces.size(); ++i) {
    size_t& at = sheet_of[root(i)];
    if (at == SIZE_MAX) at = sheets.size(), sheets.emplace_back();
    sheets[at].pieces.push_back(i), sheets[at].closed &= !open[i];
  }
  return sheets;
}

}  // namespace spanray::reference
