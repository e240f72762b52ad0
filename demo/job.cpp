#include "job.h"

#include <algorithm>

#include "core/number_text.h"
#include "spanray/settings_text.h"

namespace spanray::demo {

std::string camera_text(const Camera& c) {
  std::string text;
  for (const double value : {c.eye[0], c.eye[1], c.eye[2], c.target[0], c.target[1], c.target[2], c.fov_y_degrees, c.up[0], c.up[1],
                             c.up[2], c.near_plane})
    text += (text.empty() ? "" : ",") + number_text(value);
  return text;
}

std::string short_camera_text(const Camera& camera, const Scene& scene) {
  const Camera& first = scene.cameras()[0];
  std::string text = camera_text(camera);
  if (!std::equal(camera.up, camera.up + 3, first.up) || camera.near_plane != first.near_plane) return text;
  for (int i = 0; i < 4; ++i) text.erase(text.rfind(','));
  return text;
}

std::vector<std::pair<std::string, std::string>> settings_words(const Settings& s) {
  return {{"size", std::to_string(s.width) + "x" + std::to_string(s.height)},
          {"shading", enum_text(s.shading)},
          {"shadows", enum_text(s.shadows)},
          {"reflections", enum_text(s.reflections)},
          {"max_bounces", std::to_string(s.max_bounces)},
          {"visibility", enum_text(s.visibility)},
          {"filter", enum_text(s.filter)},
          {"transparency", enum_text(s.transparency)},
          {"culling", enum_text(s.culling)},
          {"samples", std::to_string(s.samples)},
          {"antialiasing", enum_text(s.antialiasing)},
          {"normals", enum_text(s.normals)},
          {"powers", enum_text(s.powers)},
          {"shading_rate", enum_text(s.shading_rate)},
          {"shadow_terminator", enum_text(s.shadow_terminator)},
          {"time", number_text(s.time)},
          {"textures", s.textures ? "on" : "off"},
          {"bump", s.bump ? "on" : "off"}};
}

}  // namespace spanray::demo
