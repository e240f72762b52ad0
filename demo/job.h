// What is to be rendered, and how that is written down.
#pragma once
#include <string>
#include <utility>
#include <vector>

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

// "ex,ey,ez,tx,ty,tz,fovy,ux,uy,uz,near": --camera makes the very same camera of it.
std::string camera_text(const Camera& camera);
// The same without up and near, where they are those of the scene's first camera.
std::string short_camera_text(const Camera& camera, const Scene& scene);

// Key and value of every setting that can change the picture, in words: for metadata, statistics and messages.
std::vector<std::pair<std::string, std::string>> settings_words(const Settings& settings);

}  // namespace spanray::demo
