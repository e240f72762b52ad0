#include "frame_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <CLI/CLI.hpp>

#include "core/counted.h"
#include "core/number_text.h"
#include "render/check_request.h"
#include "scene/scene_file.h"
#include "spanray/settings_text.h"

namespace spanray::demo {
namespace {

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
  if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide)
    throw CLI::ValidationError("--size", text + " is out of range: each side must be 1 to " + std::to_string(kMaxImageSide));
  settings.width = width, settings.height = height;
}

}  // namespace

std::optional<CameraNumbers> parse_camera(const std::string& text) {
  if (text.find(',') == std::string::npos) return std::nullopt;
  const auto wrong = [](const std::string& what) { return CLI::ValidationError("--camera", what); };
  CameraNumbers numbers;
  double (&v)[11] = numbers.value;
  size_t count = 0;
  for (size_t start = 0; start <= text.size(); ++count) {
    const size_t end = std::min(text.find(',', start), text.size());
    if (count == 11 || !parse_number(std::string_view(text).substr(start, end - start), v[count]))
      throw wrong(text + " is neither a camera's name nor numbers ex,ey,ez,tx,ty,tz,fovy, with ux,uy,uz and near after them or not");
    start = end + 1;
  }
  if (count != 7 && count != 10 && count != 11) throw wrong(text + " has " + std::to_string(count) + " numbers, not 7, 10 or 11");
  if (!(v[6] >= kMinFovDegrees && v[6] <= kMaxFovDegrees))
    throw wrong("the angle fovy must be " + number_text(kMinFovDegrees) + " to " + number_text(kMaxFovDegrees) + " degrees");
  if (v[0] == v[3] && v[1] == v[4] && v[2] == v[5]) throw wrong("eye and target are the same point");
  if (count > 7 && v[7] == 0 && v[8] == 0 && v[9] == 0) throw wrong("the up vector ux,uy,uz has no length");
  if (count > 10 && !(v[10] > 0)) throw wrong("the near plane must lie at a distance above 0");
  numbers.count = static_cast<int>(count);
  return numbers;
}

void CameraNumbers::apply(Camera& camera) const {
  for (int k = 0; k < 3; ++k) camera.eye[k] = value[k], camera.target[k] = value[k + 3];
  camera.fov_y_degrees = value[6];
  for (int k = 0; k < 3 && count > 7; ++k) camera.up[k] = value[k + 7];
  if (count > 10) camera.near_plane = value[10];
}

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
  add_without_techniques(command);
  const auto preset = [this](const std::string& word) {
    preset_ = preset_from_text(word);
    if (preset_ != nullptr) return;
    std::vector<std::string> known;
    for (const Preset& p : kPresets) known.emplace_back(p.name);
    throw CLI::ValidationError("--preset", "'" + word + "' is not one of draft|balanced|exact" + did_you_mean(word, known));
  };
  command.add_option_function<std::string>("--preset", preset, "Techniques by one word; the options below go over it")
      ->type_name("draft|balanced|exact")
      ->excludes("--settings");
  add_word(command, "--shading", &Settings::shading, "Interpolation of light over a triangle");
  add_word(command, "--shadows", &Settings::shadows, "How shadows are found", "map");
  add_word(command, "--reflections", &Settings::reflections, "How mirrors see", "env");
  add_word(command, "--visibility", &Settings::visibility, "Engine that finds what each pixel sees");
  add_word(command, "--filter", &Settings::filter, "Texture filter");
  add_word(command, "--transparency", &Settings::transparency, "How surfaces with opacity below 1 look");
  const auto samples = [this](const std::string& text) {
    int count = 0;
    if (!parse_number(text, count) || !sample_count_ok(count))
      throw CLI::ValidationError("--samples", "'" + text + "' is not 1, 4, 8 or 16 samples a pixel");
    changes_.push_back([count](Settings& settings) { settings.samples = count; });
  };
  command.add_option_function<std::string>("--samples", samples, "Anti-aliasing: samples a pixel")->type_name("1|4|8|16");
  add_word(command, "--antialiasing", &Settings::antialiasing, "With more than one sample: shade once a surface, or every sample");
  add_word(command, "--normals", &Settings::normals, "Interpolated normals: made unit vectors again, or not (Phong shading)");
  add_word(command, "--powers", &Settings::powers, "The power in highlights");
  add_word(command, "--shading-rate", &Settings::shading_rate, "Pixels shaded at once where they see one surface");
  add_word(command, "--shadow-terminator", &Settings::shadow_terminator,
           "Shadow edges on coarse meshes with smooth normals: as the flat triangles have them, or by lifted shadow rays as well");
  add_switch(command, "--no-textures", &Settings::textures, "Material colors only");
  add_switch(command, "--no-bump", &Settings::bump, "No bump or normal maps");
}

void FrameOptions::add_without_techniques(CLI::App& command) {
  command.add_option("SCENE", scene_path_, "Scene file (.toml) or mesh (.obj)")->required();
  command.add_flag("--allow-outside", allow_outside_, "Let the OBJ's material libraries and textures lie outside its folder");
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
  command.add_option_function<std::string>("--camera", camera, "A camera's name in the scene, or eye, target, vertical angle, then, if not those of the scene's first camera, "
                                                   "up vector and near plane")
      ->type_name("ex,ey,ez,tx,ty,tz,fovy[,ux,uy,uz[,near]]|NAME");
  add_number(command, "--max-bounces", &Settings::max_bounces, 0, kMaxBounces, "Mirror bounces after the primary hit");
  add_word(command, "--culling", &Settings::culling, "Faces to leave out");
  const auto time = [this](const std::string& text) {
    double seconds = 0;
    if (!parse_number(text, seconds) || std::fabs(seconds) > kMostSeconds)
      throw CLI::ValidationError("--time", "'" + text + "' is not a number of seconds from -1e6 to 1e6");
    changes_.push_back([seconds](Settings& settings) { settings.time = seconds; });
  };
  command.add_option_function<std::string>("--time", time, "Seconds: where moving parts stand")->type_name("S");
  add_number(command, "--threads", &Settings::threads, 0, kMaxThreads, "0: one per processor; changes no pixel");
  add_word(command, "--tree", &Settings::tree, "Trees for rays: built fast, or slowly and traced faster; changes no pixel");
  add_word(command, "--light-grids", &Settings::light_grids, "What shadow rays may meet, found once for each light: from the second frame on, or always; changes no pixel");
  add_word(command, "--isa", &Settings::isa, "Instruction set; changes no pixel");
  command.add_option("--settings", settings_path_, "A file with a [technique], as `tune` writes it; "
                     "it goes over the scene's, other options go over it")
      ->type_name("F.toml");
  command.add_flag("--strict", strict_, "Warnings of the scene's files (a missing texture, ...) are errors");
}

void FrameOptions::say_what_settings_lose(const std::string& command) const {
  if (!settings_path_.empty())
    message(command + " turns every technique itself: of " + settings_path_ + " only size, max_bounces, culling and time count");
}

Settings FrameOptions::settings_over(Settings settings) const {
  if (preset_ != nullptr) preset_->set(settings);
  for (const auto& change : changes_) change(settings);
  return settings;
}

bool FrameOptions::size_given(const Settings& loaded) const {
  const Settings defaults;
  Settings probe;
  probe.width = -1;
  return settings_over(probe).width != -1 || loaded.width != defaults.width || loaded.height != defaults.height;
}

Result<Job> FrameOptions::load(const LoadProgress& progress) const {
  LoadOptions options;
  options.progress = progress;
  options.camera_given = camera_.has_value();
  options.allow_outside = allow_outside_;
  Result<LoadedScene> loaded = load_scene(scene_path_, options);
  if (!loaded) return loaded.error();
  if (const uint64_t warnings = loaded.value().warnings; strict_ && warnings > 0) {
    for (const std::string& text : loaded.value().messages) message(text);
    return Error{"--strict: " + counted(warnings, "warning", "warnings"), scene_path_};
  }
  Job job;
  job.scene = loaded.value().scene;
  job.messages = std::move(loaded.value().messages);
  job.settings = job.scene.settings();
  if (!settings_path_.empty()) {
    const Result<Settings> settings = read_settings_file(settings_path_, job.settings);
    if (!settings) return settings.error();
    job.settings = settings.value();
  }
  job.settings = settings_over(job.settings);
  job.camera = job.scene.cameras()[0];
  if (camera_) camera_->apply(job.camera);
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

Result<Job> FrameOptions::load_to_see(const LoadProgress& progress) const {
  Result<Job> job = load(progress);
  if (!job) return job;
  if (const Result<void> checked = check_camera(job.value().camera); !checked)
    return Error{"no camera for this scene: " + checked.error().message, scene_path_};
  return job;
}

}  // namespace spanray::demo
