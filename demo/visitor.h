// Who walks through a scene: a sphere around the eye that walls stop and that slides along them.
#pragma once
#include <atomic>
#include <optional>
#include <string>
#include <thread>

#include "math/vec.h"
#include "spanray/query.h"

namespace spanray::demo {

struct Slide {
  glm::dvec3 place;      // of the center, at the end
  bool stopped = false;  // something was in the way: place is not simply from + step
};

// Moves a sphere by `step`; where it meets something, it goes on along it, in creases of two walls along the crease. It never passes
// through anything and keeps radius / 1000 away from what it meets. A start closer to a wall than the radius is no trap: the sphere is
// as small as there is room, and grows again as it gets away. Errors: of SceneQuery.
// Source: Nettle 2000, "Generic Collision Detection for Games Using Ellipsoids" (sliding planes); creases as in Quake's SV_FlyMove.
Result<Slide> slide(const SceneQuery& scene, const glm::dvec3& from, const glm::dvec3& step, double radius);

// A 200th of the scene's diagonal, and at least twice the near plane, whose corners then stay inside of the sphere up to 80 degrees at 16:9.
double fitted_radius(const Scene& scene, const Camera& camera);

// The scene as the visitor feels it: its tree is built in a thread of its own.
class Surroundings {
 public:
  explicit Surroundings(const Scene& scene) : query_(scene) {}
  ~Surroundings();  // waits for the tree
  Surroundings(const Surroundings&) = delete;
  Surroundings& operator=(const Surroundings&) = delete;

  void prepare();                              // begins to build; later calls do nothing
  bool building() const { return thread_.joinable() && !ready_; }
  // The scene, once its tree is there; errors of questions then.
  const SceneQuery* query() const { return ready_ ? &query_ : nullptr; }

 private:
  SceneQuery query_;
  std::atomic<bool> ready_{false};
  std::thread thread_;
};

// What a pixel shows, for people: "triangle 17, material stone, object wall, 3.20 away"; "background" for no hit. eye: of the camera.
std::string hit_text(const std::optional<RayHit>& hit, const double (&eye)[3]);
// From the eye to a hit, world units.
double distance_from(const double (&eye)[3], const RayHit& hit);

}  // namespace spanray::demo
