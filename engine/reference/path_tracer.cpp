#include "reference/path_tracer.h"

#include <algorithm>
#include <cmath>

namespace spanray::reference {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr uint32_t kSureBounces = 3;  // before Russian roulette begins

// Settings that choose approximations of the fast renderer do not count; screen-door patterns are layers.
// Weight of a direction that one technique found with density a and another might have found with density b.
double power_heuristic(double a, double b) {
  if (!(a > 0)) return 0;
  const double ratio = b / a;
  return 1 / (1 + ratio * ratio);
}

double most(const glm::dvec3& c) { return std::max({c.x, c.y, c.z}); }

Ray ray_along(const glm::dvec3& origin, const glm::dvec3& direction) {
  Ray ray;
  ray.line = {origin, direction};
  return ray;
}

}  // namespace

Settings for_paths(Settings s) {
  s.shading = Shading::kPhong, s.shadows = Shadows::kRay, s.reflections = Reflections::kRay, s.samples = 1;
  s.shadow_terminator = ShadowTerminator::kOff;
  if (s.transparency != Transparency::kNone) s.transparency = Transparency::kAlpha;
  return s;
}

PathTracer::PathTracer(const SceneData& scene, const Camera& camera, const Settings& settings, const PathOptions& options)
    : options_(options),
      view_(camera, settings.width, settings.height),
      world_(scene, camera, for_paths(settings)),
      emitters_(world_),
      background_(to_dvec(scene.background)) {}

Surface PathTracer::meet(const Ray& ray, double t_min, const PathKey& key, uint32_t bounce) const {
  const Met met = world_.opaque.closest(ray.line, t_min, kFar, world_.stop(ray));
  if (!world_.blended.empty()) {
    std::vector<Met> layers = world_.blended.all(ray.line, t_min, met.t, world_.stop(ray));
    std::sort(layers.begin(), layers.end(),
              [](const Met& a, const Met& b) { return a.t != b.t ? a.t < b.t : a.primitive < b.primitive; });
    for (uint32_t i = 0; i < layers.size(); ++i) {
      const Surface s = world_.surfaces.at(ray, layers[i].primitive);
      if (key.draw(bounce, Draw::kLayer, i)[0] < s.opacity) return s;
    }
  }
  return met.primitive == kNoPrimitive ? Surface{} : world_.surfaces.at(ray, met.primitive);
}

double PathTracer::passes(const Ray& ray, double t_max, uint32_t lamp) const {
  const auto in_the_way = [&](uint32_t primitive, double) {
    return primitive != lamp && world_.surfaces.stops(ray, primitive);
  };
  if (world_.opaque.any(ray.line, 0, t_max, in_the_way)) return 0;
  if (world_.blended.empty()) return 1;
  std::vector<Met> layers = world_.blended.all(ray.line, 0, t_max, in_the_way);
  std::sort(layers.begin(), layers.end(), [](const Met& a, const Met& b) { return a.primitive < b.primitive; });
  double through = 1;
  for (const Met& met : layers) through *= std::clamp(1 - world_.surfaces.at(ray, met.primitive).opacity, 0.0, 1.0);
  return through;
}

// All of them, every time: nothing else finds lights without extent.
glm::dvec3 PathTracer::by_lights(const Surface& s, const Scatter& scatter) const {
  glm::dvec3 sum(0);
  for (const Light& light : world_.lights) {
    const Incidence in = incidence(light, s.position);
    const glm::dvec3 value = scatter.value(in.direction);
    if (value == glm::dvec3(0)) continue;
    const Way way = way_to(light, start_above(s));
    sum += value * to_dvec(light.intensity) *
           (in.irradiance * passes(ray_along(way.line.origin, way.line.direction), way.t_max, kNoPrimitive));
  }
  return sum;
}

double PathTracer::emitter_density(const Surface& hit) const {
  return emitters_.density(hit.primitive) * hit.t * hit.t / std::max(dot3(hit.geometric, hit.view), 1e-300);
}

glm::dvec3 PathTracer::by_emitters(const Surface& s, const Scatter& scatter, const PathKey& key, uint32_t bounce) const {
  if (!options_.next_event || emitters_.empty()) return glm::dvec3(0);
  const std::array<double, 4> u = key.draw(bounce, Draw::kEmitter);
  const Emitters::Point lamp = emitters_.pick(u[0], u[1], u[2]);
  const glm::dvec3 origin = start_above(s), way = lamp.position - origin;
  const double distance = length3(way);
  if (!(distance > 0)) return glm::dvec3(0);
  const Ray ray = ray_along(origin, way * (1 / distance));
  const glm::dvec3 value = scatter.value(ray.line.direction);
  if (value == glm::dvec3(0) || !world_.surfaces.stops(ray, lamp.primitive)) return glm::dvec3(0);
  const Surface hit = world_.surfaces.at(ray, lamp.primitive);
  const double density = emitter_density(hit);
  if (!(density > 0) || !(dot3(hit.geometric, hit.view) > 1e-12)) return glm::dvec3(0);  // seen from the edge: nothing to see
  const double opacity = world_.surfaces.role(lamp.primitive) == Role::kBlended ? hit.opacity : 1.0;
  constexpr double kBeforeLamp = 1 - 1e-9;  // its neighbors do not hide its edges
  const double arrives = opacity * passes(ray, distance * kBeforeLamp, lamp.primitive);
  return value * hit.emission * (arrives / density * power_heuristic(density, scatter.density(ray.line.direction)));
}

glm::dvec3 PathTracer::reflected(Surface s, const PathKey& key) const {
  glm::dvec3 sum(0), throughput(1);
  for (uint32_t bounce = 0; bounce < static_cast<uint32_t>(options_.depth); ++bounce) {
    const Scatter scatter(s, world_.surfaces.material(s.primitive).reflectance);
    sum += throughput * (by_lights(s, scatter) + by_emitters(s, scatter, key, bounce));
    const std::array<double, 4> u = key.draw(bounce, Draw::kScatter);
    const Scatter::Sample next = scatter.sample(u);
    throughput *= next.weight;
    if (options_.russian_roulette && bounce >= kSureBounces) {
      const double survives = std::min(1.0, most(throughput));
      if (!(u[3] < survives)) break;
      throughput *= 1 / survives;
    }
    if (throughput == glm::dvec3(0)) break;
    const Surface hit = meet(ray_along(start_above(s), next.direction), 0, key, bounce + 1);
    if (hit.primitive == kNoPrimitive) return sum + throughput * background_;
    if (hit.emission != glm::dvec3(0)) {
      const bool both = options_.next_event && !next.mirror;
      sum += throughput * hit.emission * (both ? power_heuristic(next.density, emitter_density(hit)) : 1.0);
    }
    s = hit;
  }
  return sum;
}

glm::dvec3 PathTracer::radiance(int x, int y, uint32_t path) const {
  PathKey key{options_.seed, static_cast<uint32_t>(y) * kMaxImageSide + static_cast<uint32_t>(x), path, 0};
  const std::array<double, 4> place = key.draw(0, Draw::kPixel);
  Ray eye = ray_along(view_.eye, view_.direction(x + place[0], y + place[1]));
  eye.t_min = view_.near;
  const Surface s = meet(eye, view_.near, key, 0);
  if (s.primitive == kNoPrimitive) return background_;
  glm::dvec3 sum(0);
  for (; key.branch < static_cast<uint32_t>(options_.branching); ++key.branch) sum += reflected(s, key);
  return s.emission + sum * (1.0 / options_.branching);
}

}  // namespace spanray::reference
