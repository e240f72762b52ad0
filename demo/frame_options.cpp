#include "frame_options.h"

#include <charconv>
#include <cmath>
#include <cstdio>

#include "spanray/settings_text.h"

namespace spanray::demo {
namespace {

constexpr int kMaxSide = 16384, kMaxThreads = 1024, kMaxBounces = 64;

// The whole text as one finite number; independent of the locale.
template <class T> bool parse_number(std::string_view text, T& value) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return !text.empty() && error == std::errc() && stop == end && std::isfinite(static_cast<double>(value));
}

void parse_size(const std::string& text, Settings& settings) {
  const size_t x = text.find('x');
  int width = 0, height = 0;
  if (x == std::string::npos || !parse_number(std::string_view(text).substr(0, x), width) ||
      !parse_number(std::string_view(text).substr(x + 1), height))
    throw CLI::ValidationError("--size", text + " is not WIDTHxHEIGHT in pixels, such as 1280x720");
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)
    throw CLI::ValidationError("--size", text + " is out of range: each side must be 1 to " + std::to_string(kMaxSide));
  settings.width = width, settings.height = height;
}

// Seven numbers, or nothing if the text is a name.
std::optional<Camera> parse_camera(const std::string& text) {
  if (text.find(',') == std::string::npos) return std::nullopt;
  double v[7] = {};
  size_t count = 0;
  for (size_t start = 0; start <= text.size(); ++count) {
    const size_t end = std::min(text.find(',', start), text.size());
    if (count == 7 || !parse_number(std::string_view(text).substr(start, end - start), v[count]))
      throw CLI::ValidationError("--camera", text + " is neither seven numbers ex,ey,ez,tx,ty,tz,fovy nor a camera's name");
    start = end + 1;
  }
  if (count != 7) throw CLI::ValidationError("--camera", text + " has " + std::to_string(count) + " numbers, not seven");
  if (!(v[6] > 0 && v[6] < 180)) throw CLI::ValidationError("--camera", "the angle fovy must be above 0 and below 180 degrees");
  if (v[0] == v[3] && v[1] == v[4] && v[2] == v[5]) throw CLI::ValidationError("--camera", "eye and target are the same point");
  Camera camera;
  for (int k = 0; k < 3; ++k) camera.eye[k] = v[k], camera.target[k] = v[k + 3];
  camera.fov_y_degrees = v[6];
  return camera;
}

}  // namespace

// not_yet: a word of the design that this version lacks; it gets a message of its own.
template <class E> void FrameOptions::add_word(CLI::App& command, const std::string& name, E Settings::*field,
                                               const std::string& help, const std::string& not_yet) {
  const auto set = [=, this](const std::string& word) {
    const std::optional<E> value = enum_from_text<E>(word);
    if (!value && !not_yet.empty() && word == not_yet)
      throw CLI::ValidationError(name, "this version has no `" + word + "`; choose " + enum_choices<E>());
    if (!value)
      throw CLI::ValidationError(name, "'" + word + "' is not one of " + enum_choices<E>() + did_you_mean(word, enum_words<E>()));
    changes_.push_back([=](Settings& settings) { settings.*field = *value; });
  };
  command.add_option_function<std::string>(name, set, help)->type_name(enum_choices<E>());
}

void FrameOptions::add_switch(CLI::App& command, const std::string& name, bool Settings::*field, const std::string& help) {
  command.add_flag_callback(name, [=, this] { changes_.push_back([=](Settings& settings) { settings.*field = false; }); }, help);
}

void FrameOptions::add_number(CLI::App& command, const std::string& name, int Settings::*field, int low, int high,
                              const std::string& help) {
  const auto set = [=, this](const std::string& text) {
    int value = 0;
    if (!parse_number(text, value) || value < low || value > high)
      throw CLI::ValidationError(name, "'" + text + "' is not a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    changes_.push_back([=](Settings& settings) { settings.*field = value; });
  };
  command.add_option_function<std::string>(name, set, help)->type_name("N");
}

void FrameOptions::add_to(CLI::App& command) {
  command.add_option("SCENE", scene_path_, "Scene file (.toml) or mesh (.obj)")->required();
  const auto size = [this](const std::string& text) {
    Settings sized;
    parse_size(text, sized);
    changes_.push_back([sized](Settings& settings) { settings.width = sized.width, settings.height = sized.height; });
  };
  command.add_option_function<std::string>("--size", size, "Pixels, each side 1 to 16384")->type_name("WxH");
  const auto camera = [this](const std::string& text) {
    camera_ = parse_camera(text);
    camera_name_ = camera_ ? "" : text;
  };
  command.add_option_function<std::string>("--camera", camera, "Eye, target and vertical angle, or a camera's name in the scene")
      ->type_name("ex,ey,ez,tx,ty,tz,fovy|NAME");
  add_word(command, "--shading", &Settings::shading, "Interpolation of light over a triangle");
  add_word(command, "--shadows", &Settings::shadows, "How shadows are found", "map");
  add_word(command, "--reflections", &Settings::reflections, "How mirrors see", "env");
  add_number(command, "--max-bounces", &Settings::max_bounces, 0, kMaxBounces, "Mirror bounces after the primary hit");
  add_word(command, "--visibility", &Settings::visibility, "Engine that finds what each pixel sees");
  add_word(command, "--filter", &Settings::filter, "Texture filter");
  add_word(command, "--transparency", &Settings::transparency, "How surfaces with opacity below 1 look");
  add_word(command, "--culling", &Settings::culling, "Faces to leave out");
  add_switch(command, "--no-textures", &Settings::textures, "Material colors only");
  add_switch(command, "--no-bump", &Settings::bump, "No bump or normal maps");
  add_number(command, "--threads", &Settings::threads, 0, kMaxThreads, "0: one per processor; changes no pixel");
  add_word(command, "--isa", &Settings::isa, "Instruction set; changes no pixel");
}

Result<Job> FrameOptions::load() const {
  Result<LoadedScene> loaded = load_scene(scene_path_);
  if (!loaded) return loaded.error();
  Job job;
  job.scene = loaded.value().scene;
  job.messages = std::move(loaded.value().messages);
  job.settings = job.scene.settings();
  for (const auto& change : changes_) change(job.settings);
  job.camera = job.scene.cameras()[0];
  if (camera_) {
    for (int k = 0; k < 3; ++k) job.camera.eye[k] = camera_->eye[k], job.camera.target[k] = camera_->target[k];
    job.camera.fov_y_degrees = camera_->fov_y_degrees;
  }
  if (camera_name_.empty()) return job;
  const std::vector<std::string>& names = job.scene.camera_names();
  std::string known;
  for (size_t i = 0; i < names.size(); ++i) {
    if (names[i] == camera_name_) {
      job.camera = job.scene.cameras()[i];
      return job;
    }
    known += (i > 0 ? ", " : "") + names[i];
  }
  throw UsageError("--camera: " + scene_path_ + " has no camera '" + camera_name_ + "'" + did_you_mean(camera_name_, names) +
                   "; it has " + known);
}

std::string camera_text(const Camera& camera) {
  char text[256];
  std::snprintf(text, sizeof text, "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", camera.eye[0], camera.eye[1], camera.eye[2],
                camera.target[0], camera.target[1], camera.target[2], camera.fov_y_degrees);
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
          {"textures", s.textures ? "on" : "off"},
          {"bump", s.bump ? "on" : "off"}};
}

}  // namespace spanray::demo
