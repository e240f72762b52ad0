// What a walk is apart from its window: scene, settings that keys switch, frames and their times.
#pragma once
#include <string>
#include <vector>

#include "frame_options.h"
#include "spanray/render.h"

namespace spanray::demo {

class WalkSession {
 public:
  explicit WalkSession(const Job& job);

  // Keys and what they do, for F1 and --help.
  static std::string help();
  // Does what a key asks for, by its name. True if the next frame may look different.
  bool press(const std::string& key);
  Result<void> render(const Camera& camera);

  Settings& settings() { return settings_; }
  const Camera& camera() const { return camera_; }  // of the last frame, at first where the walk starts
  const Image& picture() const { return out_.color; }
  double speed() const { return speed_; }           // world units a second
  const std::vector<double>& frame_ms() const { return frame_ms_; }
  // Frame time, times of the stages that took any, techniques.
  std::string title() const;

 private:
  void screenshot();

  Scene scene_;
  Settings settings_;  // of the next frame
  Settings shown_;     // of the last one
  Settings asked_;     // what shadows and reflections come back to
  Camera camera_;
  Renderer renderer_;
  Framebuffer out_;
  FrameStats stats_;
  std::vector<double> frame_ms_;
  double speed_ = 1;
};

}  // namespace spanray::demo
