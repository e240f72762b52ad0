#include "scene/instance_list.h"

#include <algorithm>

#include "math/vec.h"
#include "scene/motion.h"
#include "scene/moving_parts.h"
#include "scene/obj_mesh.h"
#include "scene/part_names.h"
#include "scene/toml_table.h"

namespace spanray {
namespace {

constexpr size_t kMostInstances = size_t{1} << 20;
constexpr Range kLength = {-1e12, 1e12};
constexpr Range kDegrees = {-1e9, 1e9};
constexpr double kLeastScale = 1e-9, kMostScale = 1e9;
constexpr Range kScale = {-kMostScale, kMostScale};

// One number or three, none of them 0.
void read_scale(TomlTable& t, double scale[3]) {
  const toml::node* node = t.raw().get("scale");
  if (node == nullptr) return;
  if (node->is_array()) {
    if (!t.vector3("scale", kScale, scale)) return;
  } else {
    if (!t.number("scale", kScale, &scale[0])) return;
    scale[1] = scale[2] = scale[0];
  }
  for (int k = 0; k < 3; ++k)
    if (!(std::fabs(scale[k]) >= kLeastScale)) return t.fail("scale", "is 0 or nearly so; each number must be 1e-9 to 1e9, or negative to mirror");
}

// p -> rotation (scale * (p - pivot)) + pivot + translate
AffineMap make_map(const double axis[3], double degrees, const double scale[3], const double pivot[3], const double translate[3]) {
  Motion turn;
  turn.keys = {{0, {0, 0, 0}, {axis[0], axis[1], axis[2]}, degrees}};
  const RigidPose pose = poses_at({turn}, 0)[0];
  AffineMap map;
  for (int i = 0; i < 3; ++i) {
    double* const row = map.linear[i];
    for (int k = 0; k < 3; ++k) row[k] = pose.rotation[i][k] * scale[k];
    map.offset[i] = (pivot[i] - (row[0] * pivot[0] + row[1] * pivot[1] + row[2] * pivot[2])) + translate[i];
  }
  return map;
}

// A part's name and its line.
bool read_part(TomlTable& t, std::string* part, int* line) {
  if (!t.require("part") || !t.text("part", part)) return false;
  *line = t.line_of("part");
  if (part->empty()) return t.fail("part", "is empty"), false;
  return true;
}

WantedInstance read_instance(const toml::table& table, TomlErrors& errors) {
  TomlTable t(table, "instance", {"part", "translate", "axis", "degrees", "scale", "pivot"}, errors);
  WantedInstance instance;
  read_part(t, &instance.part, &instance.line);
  double translate[3] = {0, 0, 0}, pivot[3] = {0, 0, 0}, axis[3] = {0, 1, 0}, scale[3] = {1, 1, 1}, degrees = 0;
  t.vector3("translate", kLength, translate);
  t.vector3("pivot", kLength, pivot);
  t.number("degrees", kDegrees, &degrees);
  read_axis(t, axis);
  if (t.has("degrees") != t.has("axis")) t.fail(t.has("axis") ? "axis" : "degrees", "needs the other one of axis and degrees");
  read_scale(t, scale);
  instance.world_from_part = make_map(axis, degrees, scale, pivot, translate);
  instance.mirrored = (scale[0] < 0) != ((scale[1] < 0) != (scale[2] < 0));
  return instance;
}

}  // namespace

void read_instances(TomlTable& root, InstanceList& list, TomlErrors& errors) {
  for (const toml::table* table : root.tables("instance")) {
    if (list.instances.size() == kMostInstances) return root.fail("instance", "is given too often: at most " + std::to_string(kMostInstances) + " instances");
    list.instances.push_back(read_instance(*table, errors));
  }
  for (const toml::table* table : root.tables("template")) {
    TomlTable t(*table, "template", {"part"}, errors);
    TemplatePart part;
    if (!read_part(t, &part.part, &part.line)) continue;
    const bool used = std::any_of(list.instances.begin(), list.instances.end(), [&](const WantedInstance& i) { return i.part == part.part; });
    if (!used) t.fail("part", "is " + quoted(part.part) + ", which is not the part of an [[instance]]");
    list.templates.push_back(part);
  }
}

Result<void> check_instances(const ObjMesh& mesh, const std::vector<uint32_t>& motion_of, const InstanceList& list) {
  std::vector<std::string> checked;
  for (const WantedInstance& instance : list.instances) {
    if (std::find(checked.begin(), checked.end(), instance.part) != checked.end()) continue;
    checked.push_back(instance.part);
    const PartFilter filter(mesh.part_names, instance.part);
    bool found = false;
    for (size_t f = 0; f < mesh.faces.size(); ++f) {
      if (!filter.has(mesh.faces[f].object, mesh.faces[f].group)) continue;
      found = true;
      if (!motion_of.empty() && motion_of[f] != 0)
        return Error{"part " + quoted(instance.part) + " has faces that move (see [[moving]]); only parts that stand still can be instanced",
                     list.file, instance.line};
    }
    if (!found) return unknown_part(mesh, instance.part, list.file, instance.line);
  }
  return {};
}

}  // namespace spanray
