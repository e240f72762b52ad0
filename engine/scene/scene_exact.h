// From [[sphere]] and [[plane]] of a scene file to the exact primitives of a scene.
#pragma once
#include <string>
#include <vector>

#include "scene/scene_data.h"
#include "spanray/result.h"

namespace spanray {

class TomlErrors;
class TomlTable;

struct MaterialName {
  std::string name;  // as written
  int line = 0;
};

// Their materials are found by add_exact.
struct SceneSphere {
  Sphere sphere;
  MaterialName material;
};
struct ScenePlane {
  Plane plane;
  MaterialName material;
};

struct SceneExact {
  std::vector<SceneSphere> spheres;
  std::vector<ScenePlane> planes;
};

// Reads all [[sphere]] and [[plane]] of a scene file. Numbers are rounded to float, as those of vertices; normals are scaled by
// a power of two before. Errors: unknown or missing keys, numbers that are not finite, a radius that is not positive (or not,
// once it is rounded), a normal without length, coordinates beyond 1e30.
void read_exact(TomlTable& root, SceneExact& exact, TomlErrors& errors);

// Adds them to a scene whose materials and triangles stand. Error: a material that the scene does not have.
Result<void> add_exact(const SceneExact& exact, const std::string& file, SceneData& scene);

// Error: one whose material is translucent, or has maps: exact primitives have no texture coordinates. Once materials have
// their last word.
Result<void> check_exact_materials(const SceneExact& exact, const std::string& file, const SceneData& scene);

}  // namespace spanray
