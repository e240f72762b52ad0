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

  const std::string& scene_path() const { return scene_path_; }
  // Loads the scene and applies the options. Errors: of the loader. Throws UsageError where the scene lacks the camera named.
  Result<Job> load() const;

 private:
  template <class E> void add_word(CLI::App& command, const std::string& name, E Settings::*field, const std::string& help,
                                   const std::string& not_yet = "");
  void add_switch(CLI::App& command, const std::string& name, bool Settings::*field, const std::string& help);
  void add_number(CLI::App& command, const std::string& name, int Settings::*field, int low, int high, const std::string& help);

  std::string scene_path_, camera_name_;
  std::optional<CameraNumbers> camera_;  // go over the scene's first camera
  bool strict_ = false, allow_outside_ = false;
  std::vector<std::function<void(Settings&)>> changes_;
};

// "ex,ey,ez,tx,ty,tz,fovy,ux,uy,uz,near": --camera makes the very same camera of it.
std::string camera_text(const Camera& camera);
// The same without up and near, where they are those of the scene's first camera.
std::string short_camera_text(const Camera& camera, const Scene& scene);

// Key and value of every setting that can change the picture, in words: for metadata, statistics and messages.
std::vector<std::pair<std::string, std::string>> settings_words(const Settings& settings);

}  // namespace spanray::demo
