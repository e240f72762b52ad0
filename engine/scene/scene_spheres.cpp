#include "scene/scene_spheres.h"

#include <algorithm>

#include "scene/scene_builder.h"
#include "scene/toml_table.h"

namespace spanray {
namespace {

constexpr size_t kMostSpheres = size_t{1} << 24;

SceneSphere read_sphere(const toml::table& table, TomlErrors& errors) {
  TomlTable t(table, "sphere", {"center", "radius", "material"}, errors);
  SceneSphere s{};
  bool good = t.require("center") && t.vector3("center", kAnyNumber, s.sphere.center);
  if (double radius = 0; t.require("radius") && t.number("radius", {0, 1e30}, &radius)) {
    s.sphere.radius = static_cast<float>(radius);
    if (!(s.sphere.radius > 0))
      t.fail("radius", radius > 0 ? "is too small: it rounds to 0" : "must be greater than 0"), good = false;
  } else {
    good = false;
  }
  if (good && !usable_sphere(s.sphere)) t.fail("radius", "takes the sphere beyond coordinates of 1e30");
  if (t.require("material")) t.text("material", &s.material);
  s.material_line = t.line_of("material");
  return s;
}

// What of a material spheres do not have; null: all is well.
const char* unfit(const Material& m) {
  if (m.map_opacity >= 0) return "has a map_d, and spheres have no texture coordinates";
  if (m.opacity < 1) return "is translucent (d below 1, whatever its transparency), and spheres are opaque";
  for (const int32_t map :
       {m.map_ambient, m.map_diffuse, m.map_specular, m.map_shininess, m.map_emission, m.map_bump, m.map_normal})
    if (map >= 0) return "has a texture, and spheres have no texture coordinates";
  return nullptr;
}

}  // namespace

void read_spheres(TomlTable& root, std::vector<SceneSphere>& spheres, TomlErrors& errors) {
  for (const toml::table* table : root.tables("sphere")) {
    if (spheres.size() == kMostSpheres) return root.fail("sphere", "is given too often: at most 2^24 spheres");
    spheres.push_back(read_sphere(*table, errors));
  }
}

Result<void> add_spheres(const std::vector<SceneSphere>& spheres, const std::string& file, SceneData& scene) {
  for (const SceneSphere& s : spheres) {
    const auto it = std::find(scene.material_names.begin(), scene.material_names.end(), s.material);
    if (it == scene.material_names.end())
      return Error{"sphere: no material is named " + quoted(s.material) + did_you_mean(s.material, scene.material_names), file,
                   s.material_line};
    Sphere sphere = s.sphere;
    sphere.material = static_cast<uint32_t>(it - scene.material_names.begin());
    add_sphere(sphere, scene);
  }
  return {};
}

Result<void> check_sphere_materials(const std::vector<SceneSphere>& spheres, const std::string& file, const SceneData& scene) {
  for (size_t i = 0; i < spheres.size(); ++i)
    if (const char* fault = unfit(scene.materials[scene.spheres[i].material]); fault != nullptr)
      return Error{"sphere: material " + quoted(spheres[i].material) + " " + fault, file, spheres[i].material_line};
  return {};
}

}  // namespace spanray
