#include "visitor.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "scene/scene_data.h"

namespace spanray::demo {
namespace {

using glm::dvec3;

constexpr double kClearance = 1e-3;  // of the radius
constexpr int kMostContacts = 8;     // of one step; then it rests where it is

dvec3 vector(const double (&v)[3]) { return {v[0], v[1], v[2]}; }
void store(const dvec3& v, double (&out)[3]) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }

// What is left of a way that may not lead towards any of the planes: along the last one, else along its crease with another one.
dvec3 along_planes(const dvec3& way, const dvec3* normal, int count) {
  const auto free = [&](const dvec3& v) {
    for (int i = 0; i < count; ++i)
      if (dot3(v, normal[i]) < -1e-9 * length3(v)) return false;
    return true;
  };
  const dvec3& last = normal[count - 1];
  const dvec3 flat = way - last * dot3(way, last);
  if (free(flat)) return flat;
  for (int i = 0; i < count - 1; ++i) {
    const dvec3 crease = normalize3(cross3(last, normal[i]), dvec3(0));
    const dvec3 along = crease * dot3(way, crease);
    if (crease != dvec3(0) && free(along)) return along;
  }
  return dvec3(0);
}

// The radius that there is room for.
Result<double> fitting_radius(const SceneQuery& scene, const dvec3& center, double radius) {
  double place[3];
  store(center, place);
  const auto touching = scene.touching(place, radius);
  if (!touching) return touching.error();
  if (touching.value().empty()) return radius;
  const double room = touching.value().front().distance;
  return std::max(room - kClearance * radius, 0.5 * room);
}

}  // namespace

Result<Slide> slide(const SceneQuery& scene, const dvec3& from, const dvec3& step, double radius) {
  Slide result{from};
  dvec3 rest = step, normal[kMostContacts];
  const double least = 1e-9 * length3(step);
  for (int contacts = 0; contacts < kMostContacts; ++contacts) {
    const double length = length3(rest);
    if (!(length > least)) return result;
    const Result<double> room = fitting_radius(scene, result.place, radius);
    if (!room) return room.error();
    SphereSweep sphere;
    sphere.radius = room.value();
    store(result.place, sphere.start), store(result.place + rest, sphere.end);
    if (vector(sphere.start) == vector(sphere.end)) return result;
    const auto met = scene.sweep(sphere);
    if (!met) return met.error();
    if (!met.value()) {
      result.place = result.place + rest;
      return result;
    }
    result.stopped = true;
    normal[contacts] = vector(met.value()->normal);
    // Back to where the wall is a clearance away: the way there is free.
    const double towards = -dot3(rest, normal[contacts]);
    const double part = towards > 0 ? met.value()->time - kClearance * radius / towards : 0;
    result.place = result.place + rest * std::max(0.0, part);
    rest = along_planes(rest * (1 - std::max(0.0, part)), normal, contacts + 1);
  }
  return result;
}

double fitted_radius(const Scene& scene, const Camera& camera) {
  const SceneData& data = scene.data();
  dvec3 extent;
  for (int k = 0; k < 3; ++k) extent[k] = double{data.bounds_max[k]} - double{data.bounds_min[k]};
  return std::max(length3(extent) / 200, 2 * camera.near_plane);
}

Surroundings::~Surroundings() {
  if (thread_.joinable()) thread_.join();
}

void Surroundings::prepare() {
  if (thread_.joinable()) return;
  thread_ = std::thread([this] {
    (void)query_.prepare();  // an error is told again by the first question
    ready_ = true;
  });
}

double distance_from(const double (&eye)[3], const RayHit& hit) { return length3(vector(hit.position) - vector(eye)); }

std::string hit_text(const std::optional<RayHit>& hit, const double (&eye)[3]) {
  if (!hit) return "background";
  const char* kind = hit->name.sphere ? "sphere, id " : hit->name.plane ? "plane, id " : "triangle ";
  std::string text = kind + std::to_string(hit->name.triangle) + ", material " + std::string(hit->name.material);
  if (!hit->name.object.empty()) text += ", object " + std::string(hit->name.object);
  if (!hit->name.group.empty()) text += ", group " + std::string(hit->name.group);
  char away[40];
  std::snprintf(away, sizeof away, ", %.4g away", distance_from(eye, *hit));
  return text + away;
}

}  // namespace spanray::demo
