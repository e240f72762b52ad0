// A walk in a window: loading behind a progress bar, then frames from one thread and events in another.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "job.h"
#include "scene/scene_data.h"

namespace spanray::demo {

struct WalkJob {
  Job job;
  std::vector<CameraKey> path;  // of the scene, or of the file that --path names; may be empty
};

struct WindowOptions {
  std::string name;                  // of the scene, for its user
  int width = 1280, height = 720;    // of the window, before the scene says something else
  bool play = false;                 // the frames lie evenly on the path
  double radius = -1;                // of who walks, world units; 0: walls stop nobody until N; less: from the scene's size
  std::function<int(const WalkJob&)> frames;  // how many to show; 0: until the window is closed
};

// Prints the median frame time where the number of frames is given.
void report_frames(const std::vector<double>& frame_ms);

// Exit code. load: runs in another thread. What it throws is thrown here.
int walk_in_window(const WindowOptions& options, std::function<Result<WalkJob>(const LoadProgress&)> load);

}  // namespace spanray::demo
