// The options that say what a frame is: scene, camera, settings. All commands that take a scene share them.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "job.h"
#include "presets.h"

namespace spanray::demo {

// What --camera gives as numbers: ex,ey,ez,tx,ty,tz,fovy, then perhaps ux,uy,uz, then perhaps near.
struct CameraNumbers {
  double value[11] = {};
  int count = 0;  // 7, 10 or 11
  // Up vector and near plane stay where they are not given.
  void apply(Camera& camera) const;
};
// Nothing if the text is a name. Throws CLI::ValidationError on numbers that are no camera.
std::optional<CameraNumbers> parse_camera(const std::string& text);

class FrameOptions {
 public:
  // Adds SCENE and all options to a command. *this must live until the program ends.
  void add_to(CLI::App& command);

  // The same but for what the command itself turns (knobs.h): techniques that it would overwrite are wrong usage there.
  void add_without_techniques(CLI::App& command);

  const std::string& scene_path() const { return scene_path_; }
  // For commands that turn techniques themselves: says that those of --settings do not count, if there are any.
  void say_what_settings_lose(const std::string& command) const;
  Settings settings_over(Settings settings) const;  // with the options applied
  // The size is somebody's wish: --size, or a file that asks for another than the default. loaded: what load() gave.
  bool size_given(const Settings& loaded) const;
  bool camera_given() const { return camera_.has_value() || !camera_name_.empty(); }
  // Loads the scene and applies the options. Errors: of the loader. Throws UsageError where the scene lacks the camera named.
  Result<Job> load(const LoadProgress& progress = {}) const;
  // The same for pictures: it is an error, too, if the camera is none, as one fitted to bounds that are too large or too small.
  Result<Job> load_to_see(const LoadProgress& progress = {}) const;

 private:
  template <class E> void add_word(CLI::App& command, const std::string& name, E Settings::*field, const std::string& help,
                                   const std::string& not_yet = "");
  void add_switch(CLI::App& command, const std::string& name, bool Settings::*field, const std::string& help);
  void add_number(CLI::App& command, const std::string& name, int Settings::*field, int low, int high, const std::string& help);

  std::string scene_path_, camera_name_, settings_path_;
  std::optional<CameraNumbers> camera_;  // go over the scene's first camera
  bool strict_ = false, allow_outside_ = false;
  const Preset* preset_ = nullptr;  // goes before all changes, wherever it stands
  std::vector<std::function<void(Settings&)>> changes_;
};

}  // namespace spanray::demo
