#include "scene/scene_exact.h"

#include <algorithm>
#include <cmath>

#include "math/vec.h"
#include "scene/scene_builder.h"
#include "scene/toml_table.h"

namespace spanray {
namespace {

constexpr size_t kMostSpheres = size_t{1} << 24;
constexpr size_t kMostPlanes = 1024;  // each ray asks all of them

MaterialName read_material(TomlTable& t) {
  MaterialName m;
  if (t.require("material")) t.text("material", &m.name);
  m.line = t.line_of("material");
  return m;
}

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
  s.material = read_material(t);
  return s;
}

ScenePlane read_plane(const toml::table& table, TomlErrors& errors) {
  TomlTable t(table, "plane", {"point", "normal", "material"}, errors);
  ScenePlane p{};
  if (t.require("point")) t.vector3("point", kAnyNumber, p.plane.point);
  glm::dvec3 normal(0);
  if (t.require("normal") && t.vector3("normal", kAnyNumber, &normal.x) && !set_normal(normal, p.plane))
    t.fail("normal", "has no length");
  p.material = read_material(t);
  return p;
}

// What of a material exact primitives do not have; nothing: all is well. which: "spheres", "planes".
std::string unfit(const Material& m, const std::string& which) {
  if (m.map_opacity >= 0) return "has a map_d, and " + which + " have no texture coordinates";
  if (m.opacity < 1) return "is translucent (d below 1, whatever its transparency), and " + which + " are opaque";
  for (const int32_t map :
       {m.map_ambient, m.map_diffuse, m.map_specular, m.map_shininess, m.map_emission, m.map_bump, m.map_normal})
    if (map >= 0) return "has a texture, and " + which + " have no texture coordinates";
  return "";
}

// kind: "sphere", "plane".
Result<uint32_t> find_material(const MaterialName& wanted, const char* kind, const std::string& file, const SceneData& scene) {
  const auto it = std::find(scene.material_names.begin(), scene.material_names.end(), wanted.name);
  if (it != scene.material_names.end()) return static_cast<uint32_t>(it - scene.material_names.begin());
  return Error{
      std::string(kind) + ": no material is named " + quoted(wanted.name) + did_you_mean(wanted.name, scene.material_names),
      file, wanted.line};
}

Result<void> check_material(const MaterialName& name, const Material& material, const std::string& kind,
                            const std::string& file) {
  const std::string fault = unfit(material, kind + "s");
  if (fault.empty()) return {};
  return Error{kind + ": material " + quoted(name.name) + " " + fault, file, name.line};
}

}  // namespace

void read_exact(TomlTable& root, SceneExact& exact, TomlErrors& errors) {
  for (const toml::table* table : root.tables("sphere")) {
    if (exact.spheres.size() == kMostSpheres) return root.fail("sphere", "is given too often: at most 2^24 spheres");
    exact.spheres.push_back(read_sphere(*table, errors));
  }
  for (const toml::table* table : root.tables("plane")) {
    if (exact.planes.size() == kMostPlanes) return root.fail("plane", "is given too often: at most 1024 planes");
    exact.planes.push_back(read_plane(*table, errors));
  }
}

Result<void> add_exact(const SceneExact& exact, const std::string& file, SceneData& scene) {
  for (const SceneSphere& s : exact.spheres) {
    const Result<uint32_t> material = find_material(s.material, "sphere", file, scene);
    if (!material) return material.error();
    Sphere sphere = s.sphere;
    sphere.material = material.value();
    add_sphere(sphere, scene);
  }
  for (const ScenePlane& p : exact.planes) {
    const Result<uint32_t> material = find_material(p.material, "plane", file, scene);
    if (!material) return material.error();
    Plane plane = p.plane;
    plane.material = material.value();
    add_plane(plane, scene);
  }
  return {};
}

Result<void> check_exact_materials(const SceneExact& exact, const std::string& file, const SceneData& scene) {
  for (size_t i = 0; i < exact.spheres.size(); ++i)
    if (Result<void> checked =
            check_material(exact.spheres[i].material, scene.materials[scene.spheres[i].material], "sphere", file);
        !checked)
      return checked;
  for (size_t i = 0; i < exact.planes.size(); ++i)
    if (Result<void> checked =
            check_material(exact.planes[i].material, scene.materials[scene.planes[i].material], "plane", file);
        !checked)
      return checked;
  return {};
}

}  // namespace spanray
