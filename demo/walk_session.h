// What a walk is apart from its window: the scene, what keys and panel switch, the frames made so far and their times.
#pragma once
#include <string>
#include <vector>

#include "frame_worker.h"
#include "job.h"
#include "spanray/render.h"

namespace spanray::demo {

class WalkSession {
 public:
  explicit WalkSession(const Job& job);

  struct Key {
    const char* keys;
    const char* meaning;
  };
  static const std::vector<Key>& keys();  // for F1
  static std::string help();              // the same as text
  // Does what a key asks for, by its name. now: the camera that flies. True if the next frame may look different.
  bool press(const std::string& key, const Camera& now);
  void save_picture() const;

  // Frames are made in another thread, one at a time.
  bool busy() const { return worker_.busy(); }
  void start_frame(const Camera& camera) { worker_.order({camera, settings_, view_}); }
  // True if the frame was there within wait_ms: it is shown() now. Errors: of the renderer.
  Result<bool> take_frame(int wait_ms);

  const Scene& scene() const { return scene_; }
  const Camera& start_camera() const { return start_camera_; }
  Settings& settings() { return settings_; }  // of the next frame
  View& view() { return view_; }              // of the next frame
  const ShownFrame& shown() const { return shown_; }
  double& speed() { return speed_; }          // world units a second
  bool& walls() { return walls_; }            // they stop whoever walks
  const std::vector<double>& frame_ms() const { return frame_ms_; }
  const std::vector<StageTimes>& recent() const { return recent_; }  // times of the last frames, kRecentFrames at most
  const std::vector<PlanLine>& plan();                               // of the next frame
  std::string title() const;                                         // frame time, times of the stages that took any, techniques

  static constexpr size_t kRecentFrames = 31;

 private:
  Scene scene_;
  Camera start_camera_;
  Settings settings_;
  View view_ = View::kColor;
  Settings asked_;  // what shadows and reflections come back to
  FrameWorker worker_;
  ShownFrame shown_;
  std::vector<double> frame_ms_;
  std::vector<StageTimes> recent_;
  std::vector<PlanLine> plan_;
  Settings plan_settings_;
  double speed_ = 1;
  bool walls_ = true;
};

}  // namespace spanray::demo
