// A loaded scene: immutable, shared, checked.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "spanray/camera.h"
#include "spanray/result.h"
#include "spanray/settings.h"

namespace spanray {

struct SceneData;  // engine/scene/scene_data.h

class Scene {
 public:
  Scene() = default;
  explicit Scene(std::shared_ptr<const SceneData> data) : data_(std::move(data)) {}
  bool valid() const { return data_ != nullptr; }
  uint64_t hash() const;  // of all that can reach a pixel, taken after loading
  size_t triangle_count() const;
  size_t sphere_count() const;
  size_t plane_count() const;
  size_t material_count() const;
  size_t light_count() const;
  const std::vector<Camera>& cameras() const;           // never empty
  const std::vector<std::string>& camera_names() const; // same size
  const Settings& settings() const;                     // what the scene file asks for
  const SceneData& data() const { return *data_; }

 private:
  std::shared_ptr<const SceneData> data_;
};

// The scene as it stands at Settings::time `seconds`, with nothing moving in it; the scene itself if nothing moves. For questions
// (spanray/query.h), which otherwise see parts where the file puts them; pictures need no more than Settings::time. Its hash is that of the
// scene. |seconds| <= kMostSeconds.
Scene scene_at(const Scene& scene, double seconds);

// Called while a scene loads, from the thread that loads it: what is being done, and how much of that is done (0 to 1). False:
// loading ends with an error as soon as it can.
using LoadProgress = std::function<bool(const char* stage, double fraction)>;

struct LoadOptions {
  double crease_angle_degrees = 60;  // faces meeting at more than this keep a hard edge where the file has no normals
  bool allow_outside = false;        // material libraries and textures may lie outside the OBJ's folder
  bool camera_given = false;         // the caller has a camera of its own: that the files give none is not worth a message
  LoadProgress progress = {};        // may be empty
};

struct LoadedScene {
  Scene scene;
  std::vector<std::string> messages;  // warnings with file and line, and what was chosen for lack of better (default light, ...)
  uint64_t warnings = 0;              // how many warnings there were, those of a flood that was cut short included
};

// .obj or .toml, by extension. Errors name file, line and cause.
Result<LoadedScene> load_scene(const std::string& path, const LoadOptions& options = {});

}  // namespace spanray
