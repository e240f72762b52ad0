#include "reference/shade_range.h"

#include <cmath>

#include "reference/light.h"
#include "reference/rays.h"

namespace spanray::reference {
namespace {

constexpr double kMoreInMirrors = 1.5;  // how much wider than its samples a highlight is taken there
constexpr double kGrazing = 0x1p-16;    // cosines as small as this may be of either sign

bool finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool any(const glm::dvec3& v) { return v.x > 0 || v.y > 0 || v.z > 0; }

}  // namespace

struct RangeShader::Sums {
  Spread base, mirror, alpha;
  std::vector<Spread> lights;
  std::vector<char> lifted;  // a light: some lifted shadow ray may find it
  std::vector<Ray> mirrored;
};

// Derivatives of texture coordinates on a triangle whose vertices moved: those of a triangle that is so much higher or lower.
Range RangeShader::moved_levels(const Bundle& bundle, const Piece& piece) const {
  constexpr double kAllLevels = kMaxMipLevels;
  const glm::dvec3 &dx = bundle.center.direction_dx, &dy = bundle.center.direction_dy;
  if (bundle.center.origin_dx != glm::dvec3(0) || dot3(dx, dx) == 0 || dot3(dy, dy) == 0) return {};
  glm::dvec2 p[3];
  for (int k = 0; k < 3; ++k) {
    const double depth = bundle.depth(piece.v[k]);
    if (!(depth > 0)) return {};  // it reaches behind the eye: it is large
    const glm::dvec3 from = (piece.v[k] - bundle.center.line.origin) * (1 / depth);
    p[k] = {dot3(from, dx) / dot3(dx, dx), dot3(from, dy) / dot3(dy, dy)};
  }
  double longest = 0;
  for (int k = 0; k < 3; ++k) longest = std::max(longest, std::hypot(p[k].x - p[(k + 1) % 3].x, p[k].y - p[(k + 1) % 3].y));
  const glm::dvec2 a = p[1] - p[0], b = p[2] - p[0];
  const double height = std::fabs(a.x * b.y - a.y * b.x) / longest, moved = 2 * std::sqrt(2.0) * bounds_.pixels;
  if (!(height > moved)) return {-kAllLevels, kAllLevels};
  return {-std::log2((height + moved) / height), std::log2(height / (height - moved))};
}

std::vector<Nudge> RangeShader::nudges(const Material& m, const Range& levels) const {
  std::vector<Nudge> list;
  for (const int32_t map :
       {m.map_ambient, m.map_diffuse, m.map_specular, m.map_shininess, m.map_emission, m.map_opacity, m.map_bump, m.map_normal})
    if (map >= 0) {
      const double low = levels.low - bounds_.levels, high = levels.high + bounds_.levels;
      const int steps = 1 + static_cast<int>(std::ceil(high - low)), footprint = bounds_.any_opengl_footprint ? 1 : 0;
      for (int step = 0; step <= steps; ++step)
        for (const double x : {-bounds_.texels, bounds_.texels})
          for (const double y : {-bounds_.texels, bounds_.texels})
            list.push_back({x, y, low + (high - low) * step / steps, step == 0 ? -footprint : step == steps ? footprint : 0});
      return list;
    }
  return list;
}

Range RangeShader::stop_opacity(const Piece& piece, const std::function<Ray(const glm::dvec3&)>& ray_to) const {
  const Surfaces& surfaces = world_.surfaces;
  const Ray ray = ray_to(middle(piece.corner));
  const auto gray = [](double v) { return glm::dvec3(std::isfinite(v) ? v : 0.5); };
  Spread spread;
  spread.middle(gray(surfaces.stop_opacity(ray, piece.primitive)));
  for (const glm::dvec3& x : piece.corner) spread.corner(gray(surfaces.stop_opacity(ray_to(x), piece.primitive)));
  for (const Nudge& nudge : nudges(surfaces.material(piece.primitive), {}))
    spread.nudge(gray(surfaces.stop_opacity(ray, piece.primitive, nudge)));
  const ColorRange range = spread.range();
  return {range.low.x, range.high.x};
}

bool RangeShader::add(const Bundle& bundle, const Piece& piece, const glm::dvec3& at, const Nudge& nudge,
                      void (Spread::*how)(const glm::dvec3&), Sums& sums) const {
  const Ray ray = bundle.through(at);
  const Surface s = world_.surfaces.at(ray, piece.primitive, nudge);
  const glm::dvec3 base = ambient_radiance(world_.scene, s);
  if (!finite(base) || !finite(s.normal) || !finite(s.position) || !finite(s.diffuse) || !finite(s.mirror)) return false;
  (sums.base.*how)(base), (sums.mirror.*how)(s.mirror), (sums.alpha.*how)(glm::dvec3(std::clamp(s.opacity, 0.0, 1.0)));
  for (size_t i = 0; i < world_.lights.size(); ++i) {
    const Light& light = world_.lights[i];
    const glm::dvec3 way = incidence(light, s.position).direction,
                     sum = reflected(world_.scene, settings_.shading, s, light, ray.line.origin);
    const double side = dot3(s.geometric, way), cosine = settings_.shading == Shading::kPhong ? dot3(s.normal, way) : side;
    const bool lifted = faces_lifted(s, light);
    sums.lifted[i] |= lifted;
    (sums.lights[i].*how)((side > 0 || lifted) && finite(sum) ? sum : glm::dvec3(0));
    // Highlights begin with a step where the light passes the horizon; so does all light that lifted rays find.
    const bool begins = s.lift != glm::dvec3(0) && std::fabs(dot3(s.smooth, way)) < kGrazing;
    if (std::fabs(side) < kGrazing || std::fabs(cosine) < kGrazing || begins)
      sums.lights[i].corner(glm::dvec3(0)), sums.lights[i].corner(finite(sum) ? sum : glm::dvec3(0));
  }
  if (settings_.reflections != Reflections::kNone && any(s.mirror)) sums.mirrored.push_back(mirrored_ray(ray, s));
  return true;
}

RangeShader::Lit RangeShader::lit(const Bundle& bundle, const Piece& piece, const Seen& seen, const Light& light) const {
  if (settings_.shadows == Shadows::kNone) return Lit::kYes;
  const Beam beam = shadow_beam(piece.corner, seen.normal, light, seen.error);
  const auto to_light = [&](const glm::dvec3& x) { return way_to(light, x).line.direction; };
  const auto ray_to = [&](const glm::dvec3& x) {  // a point: cut-outs are read at full detail
    Ray ray;
    const glm::dvec3 way = to_light(x);
    ray.line = {x - way * (dot3(x - beam.origin, way) / dot3(way, way)), way};
    ray.x = bundle.center.x, ray.y = bundle.center.y;
    return ray;
  };
  constexpr size_t kMostBlockers = 200;
  std::vector<Piece> pieces;
  bool stopped = false;
  world_.opaque.visit_region([&](const glm::dvec3& low, const glm::dvec3& high) { return beam.misses(low, high); },
                             [&](uint32_t primitive, const glm::dvec3(&v)[3]) {
                               if (primitive == piece.primitive || !gather(For::kShadow, beam, primitive, v, ray_to, pieces))
                                 return false;
                               const Piece& p = pieces.back();
                               stopped = p.certain && !p.cut && !p.crosses[0] && !p.crosses[1] && !p.crosses[2];
                               return stopped || pieces.size() > kMostBlockers;
                             });
  if (stopped) return Lit::kNo;
  if (pieces.empty()) return Lit::kYes;
  if (pieces.size() > kMostBlockers) return Lit::kMaybe;
  for (const Sheet& sheet : make_sheets(pieces, to_light))
    if (sheet.closed) return Lit::kNo;
  return Lit::kMaybe;
}

Seen RangeShader::see(const Bundle& bundle, const Piece& piece) const {
  Sums sums;
  sums.lights.resize(world_.lights.size()), sums.lifted.resize(world_.lights.size());
  const glm::dvec3 at = middle(piece.corner);
  Seen seen;
  if (!add(bundle, piece, at, {}, &Spread::middle, sums)) {  // seen edge-on to the last bit: nothing is known
    seen.color = {glm::dvec3(0), glm::dvec3(kAnything)}, seen.alpha = {0, 1};
    return seen;
  }
  for (size_t i = 0; i < piece.corner.size(); ++i) {
    const glm::dvec3 &x = piece.corner[i], &next = piece.corner[(i + 1) % piece.corner.size()];
    add(bundle, piece, x, {}, &Spread::corner, sums);
    if (!bundle.bends()) continue;  // in mirrors a piece may be large, and light far from linear on it
    add(bundle, piece, (x + next) * 0.5, {}, &Spread::corner, sums),
        add(bundle, piece, (x + at) * 0.5, {}, &Spread::corner, sums);
  }
  for (const Nudge& nudge : nudges(world_.surfaces.material(piece.primitive), moved_levels(bundle, piece)))
    add(bundle, piece, at, nudge, &Spread::nudge, sums);
  const Surface s = world_.surfaces.at(bundle.through(at), piece.primitive);
  seen.normal = s.geometric, seen.error = s.clearance * 0x1p42 * bounds_.position;
  seen.mirror = sums.mirror.range(), seen.mirrored = std::move(sums.mirrored);
  const ColorRange alpha = sums.alpha.range();
  seen.alpha = {std::min(alpha.low.x, 1.0), std::min(alpha.high.x, 1.0)};
  seen.color = sums.base.range();
  for (size_t i = 0; i < world_.lights.size(); ++i) {
    ColorRange light = sums.lights[i].range(bundle.bends() ? kMoreInMirrors : 1.25);
    if (!any(light.high)) continue;
    // Beams know no lifted rays.
    const Lit how = sums.lifted[i] && settings_.shadows == Shadows::kRay ? Lit::kMaybe : lit(bundle, piece, seen, world_.lights[i]);
    if (how == Lit::kNo) continue;
    if (how == Lit::kMaybe) light.low = glm::dvec3(0);
    seen.color = seen.color + light;
  }
  return seen;
}

}  // namespace spanray::reference
