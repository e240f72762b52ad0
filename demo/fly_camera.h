// A camera that a person flies: turns about its up vector, moves along its own axes.
#pragma once
#include "spanray/camera.h"

namespace spanray::demo {

class FlyCamera {
 public:
  explicit FlyCamera(const Camera& start) : camera_(start) {}
  const Camera& camera() const { return camera_; }  // bit for bit the start until something moves it

  // Pixels of the mouse, x to the right, y down. The view never tips over the up vector.
  void turn(double dx, double dy);
  // World units to the right, up (along Camera::up) and forward (where it looks).
  void move(double right, double up, double forward);
  // Puts the eye there; the view stays as it is.
  void place(const double (&eye)[3]);

 private:
  Camera camera_;
};

}  // namespace spanray::demo
