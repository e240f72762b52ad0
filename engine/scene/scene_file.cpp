#include "scene/scene_file.h"

#include <algorithm>
#include <iterator>
#include <set>

#include "catalog/catalog.h"
#include "core/read_file.h"
#include "math/vec.h"
#include "scene/default_view.h"
#include "scene/toml_table.h"

namespace spanray {
namespace {

constexpr Range kRadiance = {0, 1e12};
constexpr Range kUnit = {0, 1};
constexpr double kLeastLength = 1e-12;  // of directions; keeps squares far from underflow
// toml++ 3.3 limits the nesting of values but not that of dotted keys, and walks both by recursion.
constexpr int kMostDotsInALine = 1000;
constexpr const char* kTransparencyWords[] = {"opaque", "mask", "alpha", "screen-door"};  // MaterialTransparency

std::vector<std::string> transparency_words() { return {std::begin(kTransparencyWords), std::end(kTransparencyWords)}; }
std::vector<std::string> reflectance_words() {
  std::vector<std::string> words;
  for (int i = 0; i < catalog_count(CatalogKind::kReflectance); ++i)
    words.emplace_back(catalog_name(CatalogKind::kReflectance, i));
  return words;
}

// The first line with more dots than that; 0 if there is none.
int line_of_dots(std::string_view text) {
  int line = 1, dots = 0;
  for (const char c : text) {
    if (c == '\n') ++line, dots = 0;
    if (c == '.' && ++dots > kMostDotsInALine) return line;
  }
  return 0;
}

void read_view(TomlTable& t, Camera& camera, bool* near_given) {
  constexpr Range kPlace = {-kMaxCameraCoordinate, kMaxCameraCoordinate};
  if (t.require("eye")) t.vector3("eye", kPlace, camera.eye);
  if (t.require("target")) t.vector3("target", kPlace, camera.target);
  t.vector3("up", kAnyNumber, camera.up);
  t.number("fov_y", {kMinFovDegrees, kMaxFovDegrees}, &camera.fov_y_degrees);
  if (t.number("near", {1e-12, 1e12}, &camera.near_plane)) *near_given = true;
  const glm::dvec3 view(camera.target[0] - camera.eye[0], camera.target[1] - camera.eye[1], camera.target[2] - camera.eye[2]);
  const glm::dvec3 direction = normalize3(view, glm::dvec3(0));
  const glm::dvec3 up = normalize3(glm::dvec3(camera.up[0], camera.up[1], camera.up[2]), glm::dvec3(0));
  if (!(length3(view) > kLeastLength))
    t.fail("target", "is where the eye is");
  else if (up == glm::dvec3(0))
    t.fail("up", "has no length");
  else if (!(length3(cross3(direction, up)) > 1e-9))
    t.fail(t.has("up") ? "up" : "target", "gives a view along the up vector");
}

// names: of the cameras above it.
NamedCamera read_camera(const toml::table& table, std::set<std::string>& names, TomlErrors& errors) {
  TomlTable t(table, "camera", {"name", "eye", "target", "up", "fov_y", "near"}, errors);
  NamedCamera camera;
  t.text("name", &camera.name);
  if (camera.name.empty()) camera.name = "camera " + std::to_string(names.size() + 1);
  if (!names.insert(camera.name).second)
    t.fail("name", "'" + camera.name.substr(0, 60) + "' is the name of a camera above, too");
  read_view(t, camera.camera, &camera.near_given);
  return camera;
}

Light read_light(const toml::table& table, TomlErrors& errors) {
  TomlTable t(table, "light", {"kind", "position", "direction", "intensity", "attenuation"}, errors);
  Light light;
  size_t kind = 0;
  if (!t.require("kind") || !t.word("kind", {"point", "directional"}, &kind)) return light;
  light.kind = static_cast<int32_t>(kind);
  if (t.require("intensity")) t.vector3("intensity", kRadiance, light.intensity);
  if (light.kind == static_cast<int32_t>(LightKind::kPoint)) {
    if (t.require("position")) t.vector3("position", kAnyNumber, light.position);
    if (t.has("direction")) t.fail("direction", "is for directional lights");
    if (t.vector3("attenuation", kRadiance, light.attenuation) &&
        light.attenuation[0] + light.attenuation[1] + light.attenuation[2] == 0)
      t.fail("attenuation", "must not be zero throughout");
    return light;
  }
  if (t.has("position")) t.fail("position", "is for point lights");
  if (t.has("attenuation")) t.fail("attenuation", "is for point lights");
  glm::dvec3 d(0);
  if (!t.require("direction") || !t.vector3("direction", kAnyNumber, &d.x)) return light;
  if (!(length3(d) > kLeastLength)) return t.fail("direction", "has no length"), light;
  d = normalize3(d, glm::dvec3(0, -1, 0));
  for (int k = 0; k < 3; ++k) light.direction[k] = static_cast<float>(d[k]) + 0.0f;
  return light;
}

void read_path(TomlTable& root, SceneFile& scene, TomlErrors& errors) {
  for (const toml::table* table : root.tables("path")) {
    TomlTable t(*table, "path", {"time", "eye", "target", "up", "fov_y", "near"}, errors);
    CameraKey key{0, scene.cameras.empty() ? Camera() : scene.cameras.front().camera};
    if (t.require("time")) t.number("time", {-1e9, 1e9}, &key.time);
    read_view(t, key.camera, &scene.path_near_given);
    if (!scene.path.empty() && !(key.time > scene.path.back().time))
      t.fail("time", "must be greater than that of the key before");
    scene.path.push_back(key);
  }
}

void read_technique(TomlTable& root, Settings& s, TomlErrors& errors) {
  const toml::node* node = root.raw().get("technique");
  if (node == nullptr) return;
  if (!node->is_table()) return root.fail("technique", "must be a table, written [technique]");
  TomlTable t(*node->as_table(), "[technique]",
              {"shading", "shadows", "reflections", "visibility", "filter", "transparency", "culling", "max_bounces",
               "samples", "antialiasing", "normals", "powers", "shading_rate", "shadow_terminator", "textures", "bump", "width", "height",
               "time"},
              errors);
  t.word("shading", &s.shading);
  t.word("shadows", &s.shadows);
  t.word("reflections", &s.reflections);
  t.word("visibility", &s.visibility);
  t.word("filter", &s.filter);
  t.word("transparency", &s.transparency);
  t.word("culling", &s.culling);
  t.integer("max_bounces", 0, kMaxBounces, &s.max_bounces);
  if (int samples = 0; t.integer("samples", 1, 16, &samples)) {
    if (sample_count_ok(samples)) s.samples = samples;
    else t.fail("samples", "must be 1, 4, 8 or 16");
  }
  t.word("antialiasing", &s.antialiasing);
  t.word("normals", &s.normals);
  t.word("powers", &s.powers);
  t.word("shading_rate", &s.shading_rate);
  t.word("shadow_terminator", &s.shadow_terminator);
  t.boolean("textures", &s.textures);
  t.boolean("bump", &s.bump);
  t.number("time", {-kMostSeconds, kMostSeconds}, &s.time);
  t.integer("width", 1, kMaxImageSide, &s.width);
  t.integer("height", 1, kMaxImageSide, &s.height);
}

void read_materials(TomlTable& root, SceneFile& scene, TomlErrors& errors) {
  const toml::node* node = root.raw().get("material");
  if (node == nullptr) return;
  if (!node->is_table()) return root.fail("material", "must hold tables, written [material.NAME]");
  for (auto&& [key, value] : *node->as_table()) {
    const std::string name(key.str());
    if (!value.is_table()) {
      errors.add(value.source(), quoted(name) + " must be a table, written [material.NAME]");
      continue;
    }
    const std::string shown = quoted(name).substr(1, quoted(name).size() - 2);
    TomlTable t(*value.as_table(), "[material." + shown + "]",
                {"transparency", "reflectance", "mirror", "opacity"}, errors);
    MaterialOverride o;
    o.name = name;
    o.line = static_cast<int>(key.source().begin.line);
    size_t word = 0;
    double opacity = 1;
    if (t.word("transparency", transparency_words(), &word)) o.transparency = static_cast<MaterialTransparency>(word);
    o.transparency_line = t.line_of("transparency");
    if (t.word("reflectance", reflectance_words(), &word)) o.reflectance = static_cast<int32_t>(word);
    if (t.number("opacity", kUnit, &opacity)) o.opacity = static_cast<float>(opacity);
    o.mirror_given = t.vector3("mirror", kUnit, o.mirror);
    scene.materials.push_back(o);
  }
}

Result<toml::table> parse_toml(std::string_view text, const std::string& file) {
  if (const int line = line_of_dots(text); line > 0)
    return Error{"more than " + std::to_string(kMostDotsInALine) + " dots in one line", file, line};
  toml::parse_result parsed = toml::parse(text, file);
  if (!parsed)
    return Error{std::string(parsed.error().description()), file, static_cast<int>(parsed.error().source().begin.line)};
  return std::move(parsed).table();
}

}  // namespace

Result<Settings> read_settings_file(const std::string& path, const Settings& base) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  const Result<toml::table> parsed = parse_toml(text.value(), path);
  if (!parsed) return parsed.error();
  TomlErrors errors(path);
  TomlTable root(parsed.value(), "", {"technique"}, errors);
  Settings settings = base;
  read_technique(root, settings, errors);
  if (errors.first()) return *errors.first();
  return settings;
}

Result<SceneFile> parse_scene_file(std::string_view text, const std::string& file) {
  const Result<toml::table> parsed = parse_toml(text, file);
  if (!parsed) return parsed.error();
  TomlErrors errors(file);
  TomlTable root(parsed.value(), "", {"obj", "background", "ambient", "camera", "light", "path", "technique", "material", "moving",
                  "instance", "template", "sphere", "plane"},
                 errors);
  SceneFile scene;
  const SceneData defaults;
  std::copy(defaults.background, defaults.background + 3, scene.background);
  std::copy(defaults.ambient_radiance, defaults.ambient_radiance + 3, scene.ambient);
  if (root.require("obj") && root.text("obj", &scene.obj) && scene.obj.empty()) root.fail("obj", "is empty");
  scene.obj_line = root.line_of("obj");
  root.vector3("background", kRadiance, scene.background);
  root.vector3("ambient", kRadiance, scene.ambient);
  std::set<std::string> camera_names;
  for (const toml::table* t : root.tables("camera")) scene.cameras.push_back(read_camera(*t, camera_names, errors));
  if (root.has("light")) {
    scene.lights.emplace();
    for (const toml::table* t : root.tables("light")) scene.lights->push_back(read_light(*t, errors));
    if (scene.lights->size() > static_cast<size_t>(kMaxLights))
      root.fail("light", "is given " + std::to_string(scene.lights->size()) + " times; at most " + std::to_string(kMaxLights) +
                             " lights");
  }
  read_path(root, scene, errors);
  read_technique(root, scene.settings, errors);
  read_materials(root, scene, errors);
  scene.moving.file = file;
  read_moving(root, scene.moving, errors);
  scene.instances.file = file;
  read_instances(root, scene.instances, errors);
  read_exact(root, scene.exact, errors);
  if (errors.first()) return *errors.first();
  return scene;
}

Result<void> apply_overrides(const SceneFile& scene_file, const std::string& file, SceneData& scene, Messages& messages) {
  for (const MaterialOverride& o : scene_file.materials) {
    const auto it = std::find(scene.material_names.begin(), scene.material_names.end(), o.name);
    if (it == scene.material_names.end())
      return Error{"no material is named " + quoted(o.name) + did_you_mean(o.name, scene.material_names), file,
                   o.line};
    Material& m = scene.materials[static_cast<size_t>(it - scene.material_names.begin())];
    if (o.reflectance) m.reflectance = *o.reflectance;
    if (o.mirror_given) std::copy(o.mirror, o.mirror + 3, m.mirror);
    const int32_t opaque = static_cast<int32_t>(MaterialTransparency::kOpaque),
                  alpha = static_cast<int32_t>(MaterialTransparency::kAlpha);
    if (o.opacity) {
      m.opacity = *o.opacity;
      if (m.transparency == opaque && m.opacity < 1)
        m.transparency = alpha;
      else if (m.transparency == alpha && m.opacity == 1)
        m.transparency = opaque;
    }
    if (!o.transparency) continue;
    m.transparency = static_cast<int32_t>(*o.transparency);
    if (m.transparency != opaque && m.opacity == 1 && m.map_opacity < 0)
      messages.warn(file, o.transparency_line,
                    "material " + quoted(o.name) + ": transparency \"" + kTransparencyWords[m.transparency] +
                        "\" does nothing: its opacity is 1, and it has no map_d; give it an opacity below 1");
  }
  return {};
}

}  // namespace spanray
