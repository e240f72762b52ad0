// What the window shows over the picture, in Dear ImGui: the panel (F2), the keys (F1), how far loading is.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "scene/scene_data.h"
#include "spanray/query.h"
#include "walk_session.h"

namespace spanray::demo {

// What the panel is told besides the session, and what was clicked in it.
struct PanelInput {
  const Camera& camera;                // that flies now
  const std::vector<CameraKey>& path;  // empty: none
  bool playing = false;
  double path_time = 0;                // seconds since the path's first key
  bool pointed = false;                // the next is known: the pointer was over the picture, and the tree is there
  std::optional<RayHit> under = {};    // what it pointed at
  bool clock_runs = false;             // of the scene's moving parts
};
struct PanelAction {
  bool changed = false;     // settings or view of the session
  int camera = -1;          // jump to this one of the scene's cameras
  bool play = false;        // start or stop the path
  double path_time = -1;    // go to this second of the path
  bool clock = false;       // start or stop the moving parts
  std::optional<double> time;  // put them where they stand at this second
};

PanelAction draw_panel(WalkSession& session, const PanelInput& input);
// panel: it is open, and help stays beside it.
void draw_help(bool panel);
bool help_fits_beside_panel();
// One line at the lower left. It takes no clicks.
void draw_hint(const std::string& text);
// In the middle: what is done, how far it is (0 to 1, below 0 if nobody knows), for how many seconds.
void draw_progress(const std::string& scene, const std::string& stage, double fraction, double seconds);

}  // namespace spanray::demo
