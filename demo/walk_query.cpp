#include "walk_query.h"

#include <cstdio>

#include "speak.h"

namespace spanray::demo {

void WalkQuery::step(WalkSession& session, FlyCamera& camera, double right, double up, double forward) {
  if (!session.walls()) return camera.move(right, up, forward);
  const SceneQuery* scene = surroundings_.query();
  if (scene == nullptr) return;
  FlyCamera moved = camera;
  moved.move(right, up, forward);
  const auto eye = [](const FlyCamera& c) { return glm::dvec3(c.camera().eye[0], c.camera().eye[1], c.camera().eye[2]); };
  const Result<Slide> slid = slide(*scene, eye(camera), eye(moved) - eye(camera), radius_);
  if (!slid) {
    message("walls no longer stop you: " + slid.error().to_string());
    session.walls() = false;
    return;
  }
  camera = moved;
  const glm::dvec3& place = slid.value().place;
  if (slid.value().stopped) camera.place({place.x, place.y, place.z});
}

bool WalkQuery::pointed(const ShownFrame& shown, std::optional<RayHit>& hit) const {
  const SceneQuery* scene = surroundings_.query();
  if (scene == nullptr || x_ < 0 || x_ >= shown.picture.width || y_ >= shown.picture.height) return false;
  Settings settings = shown.order.settings;
  settings.width = shown.picture.width, settings.height = shown.picture.height;
  const auto found = scene->pixel(shown.order.camera, settings, x_, y_);
  if (found) hit = found.value();
  return static_cast<bool>(found);
}

void WalkQuery::print_pointed(const ShownFrame& shown) const {
  std::optional<RayHit> hit;
  if (!pointed(shown, hit)) return message("nothing is known of what is under the pointer");
  std::printf("%d,%d: %s\n", x_, y_, hit_text(hit, shown.order.camera.eye).c_str());
  std::fflush(stdout);
}

}  // namespace spanray::demo
