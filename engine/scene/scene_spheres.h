// From [[sphere]] of a scene file to the spheres of a scene.
#pragma once
#include <string>
#include <vector>

#include "scene/scene_data.h"
#include "spanray/result.h"

namespace spanray {

class TomlErrors;
class TomlTable;

struct SceneSphere {
  Sphere sphere;         // its material is found by add_spheres
  std::string material;  // as written
  int material_line = 0;
};

// Reads all [[sphere]] of a scene file. Numbers are rounded to float, as those of vertices. Errors: unknown or missing keys,
// numbers that are not finite, a radius that is not positive (or not, once it is rounded), coordinates beyond 1e30.
void read_spheres(TomlTable& root, std::vector<SceneSphere>& spheres, TomlErrors& errors);

// Adds them to a scene whose materials and triangles stand. Error: a material that the scene does not have.
Result<void> add_spheres(const std::vector<SceneSphere>& spheres, const std::string& file, SceneData& scene);

// Error: a sphere whose material is translucent, or has maps: spheres have no texture coordinates. Once materials have their
// last word.
Result<void> check_sphere_materials(const std::vector<SceneSphere>& spheres, const std::string& file, const SceneData& scene);

}  // namespace spanray
