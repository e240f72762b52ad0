// The way from a file name to a scene: read, complete, check, hash.
#include <charconv>
#include <cmath>
#include <exception>
#include <limits>
#include <new>

#include "core/fp_env.h"
#include "core/number_text.h"
#include "scene/default_view.h"
#include "scene/obj_loader.h"
#include "scene/path_finder.h"
#include "scene/scene_builder.h"
#include "scene/scene_file.h"
#include "spanray/scene.h"

namespace spanray {
namespace {

constexpr uint64_t kMostSceneFileBytes = uint64_t{1} << 24;

std::string place_text(const double p[3]) {
  std::string text = "(";
  for (int k = 0; k < 3; ++k) {
    char digits[40];
    const auto end = std::to_chars(digits, digits + sizeof digits, p[k], std::chars_format::general, 4).ptr;
    text += (k > 0 ? ", " : "") + std::string(digits, end);
  }
  return text + ")";
}

// Adds the camera and light that the files did not give, and says so.
void complete(SceneData& scene, bool lights_given, const std::string& path, const LoadOptions& options, Messages& messages) {
  if (scene.cameras.empty()) {
    scene.cameras.push_back(fitted_camera(scene));
    scene.camera_names.emplace_back("fitted");
    const Camera& c = scene.cameras.front();
    if (!options.camera_given)
      messages.note(path + ": no camera given; fitted to the bounds: eye " + place_text(c.eye) + ", target " +
                    place_text(c.target) + ", 45 degrees");
  }
  if (lights_given) {
    if (scene.lights.empty()) messages.note(path + ": the list of lights is empty: only ambient and emitted light");
    return;
  }
  scene.lights.push_back(default_light(scene, fitted_camera(scene)));
  scene.light_follows_eye = true;
  messages.note(path + ": no light given; a default point light stays near the eye, without falloff, giving facing white "
                "surfaces a radiance of 0.9");
}

// A near plane that fits large bounds may cut off what a camera looks at.
void say_if_cut_off(const Camera& camera, const std::string& name, const std::string& path, Messages& messages) {
  double square = 0;
  for (int k = 0; k < 3; ++k) square += (camera.target[k] - camera.eye[k]) * (camera.target[k] - camera.eye[k]);
  if (camera.near_plane * camera.near_plane < square) return;
  messages.note(path + ": " + name + ": what it looks at lies before the near plane, which is at " + number_text(camera.near_plane) +
                " (2e-3 of the radius of the scene's bounds) and can be set by `near`");
}

void take_scene_file(const SceneFile& file, const std::string& path, SceneData& scene, Messages& messages) {
  for (int k = 0; k < 3; ++k) scene.background[k] = file.background[k], scene.ambient_radiance[k] = file.ambient[k];
  if (file.lights) scene.lights = *file.lights;
  scene.settings = file.settings;
  const double near_plane = fitted_near_plane(scene);
  for (const NamedCamera& c : file.cameras) {
    scene.cameras.push_back(c.camera);
    if (!c.near_given) {
      scene.cameras.back().near_plane = near_plane;
      say_if_cut_off(scene.cameras.back(), quoted(c.name), path, messages);
    }
    scene.camera_names.push_back(c.name);
  }
  scene.camera_path = file.path;
  if (!file.path_near_given)
    for (CameraKey& key : scene.camera_path)
      key.camera.near_plane = scene.cameras.empty() ? near_plane : scene.cameras.front().near_plane;
}

void say_if_empty(const std::string& obj, const SceneData& scene, Messages& messages) {
  if (scene.triangles.empty() && !scene.has_exact())
    messages.warn(obj, 0, "no triangles: the picture will show the background only");
}

Result<void> load_scene_file(const std::string& path, const LoadOptions& options, SceneData& scene, Messages& messages) {
  const Result<std::string> text = read_text_file(path, kMostSceneFileBytes);
  if (!text) return text.error();
  const Result<SceneFile> file = parse_scene_file(text.value(), path);
  if (!file) return file.error();
  // The OBJ is named by who wrote the scene file and may lie anywhere; what the OBJ names may not.
  PathFinder finder(folder_of(path), true);
  const Result<std::string> obj = finder.find(folder_of(path), file.value().obj);
  if (!obj) return Error{"obj: " + obj.error().message, path, file.value().obj_line};
  if (Result<void> loaded = load_obj(obj.value(), options, file.value().moving, file.value().instances, scene, messages);
      !loaded) return loaded;
  if (Result<void> added = add_exact(file.value().exact, path, scene); !added) return added;
  say_if_empty(obj.value(), scene, messages);
  take_scene_file(file.value(), path, scene, messages);
  if (Result<void> applied = apply_overrides(file.value(), path, scene, messages); !applied) return applied;
  if (Result<void> checked = check_exact_materials(file.value().exact, path, scene); !checked) return checked;
  complete(scene, file.value().lights.has_value(), path, options, messages);
  return {};
}

Result<void> load_any(const std::string& path, const LoadOptions& options, SceneData& scene, Messages& messages) {
  const size_t dot = path.rfind('.');
  const std::string extension = dot == std::string::npos ? "" : lower_case(std::string_view(path).substr(dot));
  if (extension == ".toml") return load_scene_file(path, options, scene, messages);
  if (extension != ".obj") {
    if (Result<std::string> text = read_text_file(path, std::numeric_limits<int64_t>::max()); !text) return text.error();
    return Error{"unknown kind of scene: the name must end in .obj or .toml", path};
  }
  if (Result<void> loaded = load_obj(path, options, {}, {}, scene, messages); !loaded) return loaded;
  say_if_empty(path, scene, messages);
  complete(scene, false, path, options, messages);
  return {};
}

}  // namespace

uint64_t Scene::hash() const { return data_->hash; }
size_t Scene::triangle_count() const { return data_->triangles.size(); }
size_t Scene::sphere_count() const { return data_->spheres.size(); }
size_t Scene::plane_count() const { return data_->planes.size(); }
size_t Scene::material_count() const { return data_->materials.size(); }
size_t Scene::light_count() const { return data_->lights.size(); }
const std::vector<Camera>& Scene::cameras() const { return data_->cameras; }
const std::vector<std::string>& Scene::camera_names() const { return data_->camera_names; }
const Settings& Scene::settings() const { return data_->settings; }

Result<LoadedScene> load_scene(const std::string& path, const LoadOptions& options) {
  const FpEnvGuard guard;  // the host's rounding mode must not reach a vertex
  if (!(options.crease_angle_degrees >= 0 && options.crease_angle_degrees <= 180))
    return Error{"the crease angle must be 0 to 180 degrees"};
  try {
    const auto scene = std::make_shared<SceneData>();
    Messages messages;
    if (const Result<void> loaded = load_any(path, options, *scene, messages); !loaded) return loaded.error();
    hash_scene(*scene);
    const uint64_t warnings = messages.warnings();
    return LoadedScene{Scene(scene), messages.take(), warnings};
  } catch (const std::bad_alloc&) {
    return Error{"not enough memory for this scene", path};
  } catch (const std::exception& e) {
    return Error{std::string("cannot be loaded: ") + e.what(), path};
  }
}

}  // namespace spanray
