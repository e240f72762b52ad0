// The scene file: TOML beside an OBJ, for what OBJ cannot say (lights, cameras, paths, techniques).
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/instance_list.h"
#include "scene/moving_parts.h"
#include "scene/scene_data.h"
#include "scene/scene_exact.h"
#include "scene/text_input.h"
#include "spanray/result.h"

namespace spanray {

struct NamedCamera {
  std::string name;  // "camera N" where the file gives none; no two are equal
  Camera camera;
  bool near_given = false;
};

// [material.NAME]: goes over what the MTL says.
struct MaterialOverride {
  std::string name;
  int line = 0;
  std::optional<MaterialTransparency> transparency;
  int transparency_line = 0;
  std::optional<int32_t> reflectance;
  std::optional<float> opacity;
  bool mirror_given = false;
  float mirror[3] = {0, 0, 0};
};

struct SceneFile {
  std::string obj;  // as written
  int obj_line = 0;
  std::optional<std::vector<Light>> lights;  // absent: the default light; an empty list: none
  std::vector<NamedCamera> cameras;
  std::vector<CameraKey> path;
  bool path_near_given = false;
  std::vector<MaterialOverride> materials;
  MovingParts moving;
  InstanceList instances;
  SceneExact exact;
  float background[3], ambient[3];
  Settings settings;
};

// Checks every key: unknown ones, wrong types and values out of range are errors with file and line.
Result<SceneFile> parse_scene_file(std::string_view text, const std::string& file);

// A file that holds a [technique] as scene files do, and nothing else: what it names goes over `base`. Errors: unreadable, and those of
// a scene file.
Result<Settings> read_settings_file(const std::string& path, const Settings& base);

// Applies [material.*] to the materials of `scene`. Error: a name that no material has. Warning: a transparency without effect.
Result<void> apply_overrides(const SceneFile& scene_file, const std::string& file, SceneData& scene, Messages& messages);

}  // namespace spanray
