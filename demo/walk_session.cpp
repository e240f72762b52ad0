#include "walk_session.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "math/vec.h"
#include "picture.h"
#include "scene/scene_data.h"
#include "spanray/settings_text.h"
#include "speak.h"
#include "stage_times.h"

namespace spanray::demo {
namespace {

// A tenth of the scene's diagonal a second.
double speed_of(const SceneData& scene) {
  glm::dvec3 extent;
  for (int k = 0; k < 3; ++k) extent[k] = double{scene.bounds_max[k]} - double{scene.bounds_min[k]};
  const double diagonal = length3(extent);
  return diagonal > 0 ? diagonal / 10 : 1;
}

struct ViewKey {
  const char* key;
  View view;
};
constexpr ViewKey kViewKeys[] = {{"5", View::kColor}, {"6", View::kDepth}, {"7", View::kIds},
                                 {"8", View::kNormals}, {"9", View::kUv}, {"0", View::kMaterials}};

}  // namespace

WalkSession::WalkSession(const Job& job)
    : scene_(job.scene),
      start_camera_(job.camera),
      settings_(job.settings),
      asked_(job.settings),
      worker_(job.scene),
      speed_(speed_of(job.scene.data())) {
  if (asked_.shadows == Shadows::kNone) asked_.shadows = Shadows::kRay;
  if (asked_.reflections == Reflections::kNone) asked_.reflections = Reflections::kRay;
}

const std::vector<WalkSession::Key>& WalkSession::keys() {
  static const std::vector<Key> keys = {{"W A S D", "move"},
                                        {"Q E", "down, up"},
                                        {"Shift", "move faster"},
                                        {"wheel", "walking speed"},
                                        {"mouse", "look around: hold a button, or M"},
                                        {"1 2 3", "shading: flat, gouraud, phong"},
                                        {"H R T B", "shadows, reflections, textures, bump"},
                                        {"V", "visibility: raster or ray"},
                                        {"5", "view: color"},
                                        {"6 7 8 9 0", "depth, ids, normals, uv, materials"},
                                        {"N", "walls stop you, or not"},
                                        {"I", "print what is under the pointer"},
                                        {"C", "the scene's next camera"},
                                        {"L", "play or stop the scene's camera path"},
                                        {"Space", "stop what moves, or let it go on"},
                                        {"P", "print the camera, for render --camera"},
                                        {"F12", "save the picture"},
                                        {"F1 F2", "these keys, the panel"},
                                        {"Esc", "leave"}};
  return keys;
}

std::string WalkSession::help() {
  std::string text = "Keys:";
  for (const Key& key : keys()) {
    const std::string name = key.keys;
    text += "\n  " + name + std::string(12 - name.size(), ' ') + key.meaning;
  }
  return text;
}

bool WalkSession::press(const std::string& key, const Camera& now) {
  Settings& s = settings_;
  for (const ViewKey& entry : kViewKeys)
    if (key == entry.key) return view_ = entry.view, true;
  if (key == "1") s.shading = Shading::kFlat;
  else if (key == "2") s.shading = Shading::kGouraud;
  else if (key == "3") s.shading = Shading::kPhong;
  else if (key == "H") s.shadows = s.shadows == Shadows::kNone ? asked_.shadows : Shadows::kNone;
  else if (key == "R") s.reflections = s.reflections == Reflections::kNone ? asked_.reflections : Reflections::kNone;
  else if (key == "V") s.visibility = s.visibility == Visibility::kRaster ? Visibility::kRay : Visibility::kRaster;
  else if (key == "T") s.textures = !s.textures;
  else if (key == "B") s.bump = !s.bump;
  else {
    if (key == "F12") save_picture();
    if (key == "N") walls_ = !walls_;
    if (key == "P") std::printf("%s\n", short_camera_text(now, scene_).c_str()), std::fflush(stdout);
    return false;
  }
  return true;
}

Result<bool> WalkSession::take_frame(int wait_ms) {
  Result<bool> taken = worker_.take(shown_, wait_ms);
  if (!taken || !taken.value()) return taken;
  frame_ms_.push_back(shown_.stats.ms.frame);
  if (recent_.size() == kRecentFrames) recent_.erase(recent_.begin());
  recent_.push_back(shown_.stats.ms);
  return true;
}

const std::vector<PlanLine>& WalkSession::plan() {
  // Sizes and threads ask for no stage, nor does the time; the words are those of all other settings.
  Settings settings = settings_of_view(view_, settings_);
  settings.time = 0;
  if (plan_.empty() || settings_words(plan_settings_) != settings_words(settings)) {
    plan_ = plan_frame(scene_, settings);
    plan_settings_ = settings;
  }
  return plan_;
}

std::string WalkSession::title() const {
  const FrameOrder& order = shown_.order;
  char text[64];
  std::snprintf(text, sizeof text, "spanray %.1f ms", shown_.stats.ms.frame);
  std::string title = text;
  for (const auto& stage : kStages) {
    const double ms = shown_.stats.ms.*stage.time;
    if (stage.time == &StageTimes::frame || ms < 0.05) continue;
    std::snprintf(text, sizeof text, " | %s %.1f", stage.name, ms);
    title += text;
  }
  title += std::string(" | ") + enum_text(order.settings.shading) + ", shadows " + enum_text(order.settings.shadows) +
           ", reflections " + enum_text(order.settings.reflections) + ", " + enum_text(order.settings.visibility);
  return order.view == View::kColor ? title : title + ", view " + view_text(order.view);
}

void WalkSession::save_picture() const {
  if (shown_.picture.rgba.empty()) return;
  std::string name;
  std::error_code ignored;
  for (int n = 1; n <= 9999; ++n) {
    char text[32];
    std::snprintf(text, sizeof text, "spanray-%04d.png", n);
    if (std::filesystem::exists(text, ignored)) continue;
    name = text;
    break;
  }
  if (name.empty()) return message("no screenshot: spanray-0001.png to spanray-9999.png are all there");
  Job job;
  job.scene = scene_, job.camera = shown_.order.camera, job.settings = settings_of_view(shown_.order.view, shown_.order.settings);
  if (auto done = write_png(name, shown_.picture, picture_text(job, shown_.order.view)); !done)
    return message("no screenshot: " + done.error().to_string());
  message("saved " + std::filesystem::absolute(name, ignored).string());
}

}  // namespace spanray::demo
