// From [[instance]] and [[template]] of a scene file to copies of parts.
#pragma once
#include <string>
#include <vector>

#include "scene/instance.h"
#include "scene/scene_builder.h"
#include "spanray/result.h"

namespace spanray {

class TomlErrors;
class TomlTable;
struct ObjMesh;

struct WantedInstance {
  std::string part;         // name of an object or a group of the OBJ
  int line = 0;             // of `part`
  AffineMap world_from_part;
  bool mirrored = false;    // the map turns left hands into right ones
};

// [[template]]: a part that stands in the scene as instances only, not where the OBJ places it.
struct TemplatePart {
  std::string part;
  int line = 0;
};

struct InstanceList {
  std::string file;  // the scene file
  std::vector<WantedInstance> instances;
  std::vector<TemplatePart> templates;
};

// Reads all [[instance]] and [[template]] of a scene file: unknown keys, numbers that are not finite, scales of 0, axes without length,
// templates that no instance uses are errors.
void read_instances(TomlTable& root, InstanceList& list, TomlErrors& errors);

// Errors: a part that no face of the mesh has, or that has faces which move. motion_of: of each face, as of find_moving_faces().
Result<void> check_instances(const ObjMesh& mesh, const std::vector<uint32_t>& motion_of, const InstanceList& list);

// build_geometry() of what stands in the OBJ, without templates, and then of every instance, in the order of the list: vertices go through
// the map in double, normals through its inverse transpose; both are rounded once, and what is mirrored keeps its front. Errors:
// those of build_geometry(), instances that reach beyond 1e30, too many triangles.
Result<BuildReport> build_instanced_geometry(const std::vector<SoupTriangle>& soup, const InstanceList& list,
                                             const std::vector<std::string>& part_names, SceneData& scene);

}  // namespace spanray
