// How far loading is, and whether the caller still wants it.
#pragma once
#include "spanray/scene.h"

namespace spanray {

class Progress {
 public:
  Progress() = default;
  explicit Progress(const LoadProgress& report) : report_(report) {}
  // False once the caller has asked to stop: leave, and let the error be stop_error().
  bool operator()(const char* stage, double fraction) const {
    if (!stopped_ && report_) stopped_ = !report_(stage, fraction);
    return !stopped_;
  }
  bool stopped() const { return stopped_; }

 private:
  LoadProgress report_;
  mutable bool stopped_ = false;
};

inline constexpr const char* kStopMessage = "loading was stopped";

}  // namespace spanray
