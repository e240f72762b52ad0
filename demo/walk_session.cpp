#include "walk_session.h"

#include <cstdio>
#include <filesystem>

#include "math/vec.h"
#include "picture.h"
#include "scene/scene_data.h"
#include "spanray/settings_text.h"
#include "stats_json.h"

namespace spanray::demo {
namespace {

// A tenth of the scene's diagonal a second.
double speed_of(const SceneData& scene) {
  glm::dvec3 extent;
  for (int k = 0; k < 3; ++k) extent[k] = double{scene.bounds_max[k]} - double{scene.bounds_min[k]};
  const double diagonal = length3(extent);
  return diagonal > 0 ? diagonal / 10 : 1;
}

}  // namespace

WalkSession::WalkSession(const Job& job)
    : scene_(job.scene), settings_(job.settings), shown_(job.settings), asked_(job.settings), camera_(job.camera), speed_(speed_of(job.scene.data())) {
  if (asked_.shadows == Shadows::kNone) asked_.shadows = Shadows::kRay;
  if (asked_.reflections == Reflections::kNone) asked_.reflections = Reflections::kRay;
}

std::string WalkSession::help() {
  return "Keys:\n"
         "  W A S D  move      Q E  down, up      Shift  faster\n"
         "  mouse    look around while a button is held; M holds it\n"
         "  1 2 3    flat, gouraud, phong         V  visibility: raster or ray\n"
         "  H shadows   R reflections   T textures   B bump\n"
         "  P        print the camera, for render --camera\n"
         "  F12      save the picture             F1 these keys      Esc  leave";
}

bool WalkSession::press(const std::string& key) {
  Settings& s = settings_;
  if (key == "1") s.shading = Shading::kFlat;
  else if (key == "2") s.shading = Shading::kGouraud;
  else if (key == "3") s.shading = Shading::kPhong;
  else if (key == "H") s.shadows = s.shadows == Shadows::kNone ? asked_.shadows : Shadows::kNone;
  else if (key == "R") s.reflections = s.reflections == Reflections::kNone ? asked_.reflections : Reflections::kNone;
  else if (key == "V") s.visibility = s.visibility == Visibility::kRaster ? Visibility::kRay : Visibility::kRaster;
  else if (key == "T") s.textures = !s.textures;
  else if (key == "B") s.bump = !s.bump;
  else {
    if (key == "F12") screenshot();
    if (key == "F1") std::fprintf(stderr, "%s\n", help().c_str());
    if (key == "P") std::printf("%s\n", short_camera_text(camera_, scene_).c_str()), std::fflush(stdout);
    return false;
  }
  return true;
}

Result<void> WalkSession::render(const Camera& camera) {
  camera_ = camera, shown_ = settings_;
  Result<FrameStats> stats = renderer_.render(scene_, camera_, shown_, out_);
  if (!stats) return stats.error();
  stats_ = std::move(stats.value());
  frame_ms_.push_back(stats_.ms.frame);
  return {};
}

std::string WalkSession::title() const {
  char text[64];
  std::snprintf(text, sizeof text, "spanray %.1f ms", stats_.ms.frame);
  std::string title = text;
  for (const auto& stage : kStages) {
    const double ms = stats_.ms.*stage.time;
    if (stage.time == &StageTimes::frame || ms < 0.05) continue;
    std::snprintf(text, sizeof text, " | %s %.1f", stage.name, ms);
    title += text;
  }
  title += std::string(" | ") + enum_text(shown_.shading) + ", shadows " + enum_text(shown_.shadows) + ", reflections " +
           enum_text(shown_.reflections) + ", " + enum_text(shown_.visibility);
  return title;
}

void WalkSession::screenshot() {
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
  job.scene = scene_, job.camera = camera_, job.settings = shown_;
  if (auto done = write_png(name, out_.color, picture_text(job)); !done) return message("no screenshot: " + done.error().to_string());
  message("saved " + std::filesystem::absolute(name, ignored).string());
}

}  // namespace spanray::demo
