// From [[moving]] of a scene file to the parts of a mesh that move.
#pragma once
#include <string>
#include <vector>

#include "scene/motion.h"
#include "spanray/result.h"

namespace spanray {

class TomlErrors;
class TomlTable;
struct ObjMesh;

struct MovingParts {
  std::string file;             // the scene file
  std::vector<Motion> motions;
  std::vector<int> lines;       // of each one's `part`
};

// The key `axis`, made unit length; false where it is absent or wrong.
bool read_axis(TomlTable& t, double axis[3]);

// Reads all [[moving]] of a scene file: unknown keys, numbers that are not finite, times that do not increase, axes without length, a
// part named twice, a carrier that is not above are errors.
void read_moving(TomlTable& root, MovingParts& moving, TomlErrors& errors);

// For each face of the mesh 0, or 1 + the motion that moves it; nothing without motions. A part is an object, a group, or several groups
// as one `g` names them. Errors: a name that no face has, faces in two moving parts.
Result<std::vector<uint32_t>> find_moving_faces(const ObjMesh& mesh, const MovingParts& moving);

}  // namespace spanray
