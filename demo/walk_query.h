// What a walk asks its scene: how far the visitor can go, and what is under the pointer.
#pragma once
#include <optional>

#include "fly_camera.h"
#include "visitor.h"
#include "walk_session.h"
#include "window.h"

namespace spanray::demo {

class WalkQuery {
 public:
  // radius: of the visitor.
  WalkQuery(const Scene& scene, double radius) : surroundings_(scene), radius_(radius) {}
  void prepare() { surroundings_.prepare(); }
  bool building() const { return surroundings_.building(); }

  // Moves the camera as far as walls let it; not at all before the tree is there, lest it go through one. Walls that cannot be asked stop
  // nobody any more, and a message says so.
  void step(WalkSession& session, FlyCamera& camera, double right, double up, double forward);

  // Where the pointer was over the picture last.
  void point(const Input& input) {
    if (input.pointer_x >= 0) x_ = input.pointer_x, y_ = input.pointer_y;
  }
  // What the shown picture has there; false if that is not known.
  bool pointed(const ShownFrame& shown, std::optional<RayHit>& hit) const;
  void print_pointed(const ShownFrame& shown) const;

 private:
  Surroundings surroundings_;
  double radius_;
  int x_ = -1, y_ = -1;
};

}  // namespace spanray::demo
