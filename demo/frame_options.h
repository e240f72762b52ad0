// The options that say what a frame is: scene, camera, settings. render, info, why and walk share them.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "spanray/camera.h"
#include "spanray/scene.h"
#include "spanray/settings.h"

namespace spanray::demo {

// The scene with what the command line put over its settings.
struct Job {
  Scene scene;
  Camera camera;
  Settings settings;
  std::vector<std::string> messages;  // of the loader
};

class FrameOptions {
 public:
  // Adds SCENE and all options to a command. *this must live until the program ends.
  void add_to(CLI::App& command);

  const std::string& scene_path() const { return scene_path_; }
  // Loads the scene and applies the options. Errors: of the loader. Throws UsageError where the scene lacks the camera named.
  Result<Job> load() const;

 private:
  template <class E> void add_word(CLI::App& command, const std::string& name, E Settings::*field, const std::string& help,
                                   const std::string& not_yet = "");
  void add_switch(CLI::App& command, const std::string& name, bool Settings::*field, const std::string& help);
  void add_number(CLI::App& command, const std::string& name, int Settings::*field, int low, int high, const std::string& help);

  std::string scene_path_, camera_name_;
  std::optional<Camera> camera_;  // numbers of --camera; up and near plane are the scene's
  std::vector<std::function<void(Settings&)>> changes_;
};

// "ex,ey,ez,tx,ty,tz,fovy" with 17 digits, so that --camera gives the very same camera.
std::string camera_text(const Camera& camera);

// Key and value of every setting that can change the picture, in words: for metadata, statistics and messages.
std::vector<std::pair<std::string, std::string>> settings_words(const Settings& settings);

}  // namespace spanray::demo
