// How scene files name parts of a mesh: an object, a group, or several groups as one `g` names them.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "spanray/result.h"

namespace spanray {

// Which faces a name means, told by their object and group.
class PartFilter {
 public:
  // part_names: as in ObjMesh.
  PartFilter(const std::vector<std::string>& part_names, const std::string& part);
  bool has(uint32_t object, uint32_t group) const { return is_object_[object] || is_group_[group]; }

 private:
  std::vector<bool> is_object_, is_group_;
};

struct ObjMesh;

// The error of a name that no face of the mesh has.
Error unknown_part(const ObjMesh& mesh, const std::string& name, const std::string& file, int line);

}  // namespace spanray
