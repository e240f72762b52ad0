#include "scene/moving_parts.h"

#include <algorithm>

#include "math/vec.h"
#include "scene/obj_mesh.h"
#include "scene/part_names.h"
#include "scene/toml_table.h"

namespace spanray {
namespace {

constexpr size_t kMostMotions = 4096;
constexpr size_t kMostKeys = 1000000;
constexpr double kLeastLength = 1e-12;
constexpr Range kLength = {-1e12, 1e12};
constexpr Range kDegrees = {-1e9, 1e9};
constexpr Range kSeconds = {-1e9, 1e9};

void read_keys(TomlTable& t, Motion& motion, bool axis_given, TomlErrors& errors) {
  for (const toml::table* table : t.tables("key")) {
    TomlTable k(*table, "key of moving", {"time", "translation", "axis", "degrees"}, errors);
    MotionKey key{0, {0, 0, 0}, {motion.axis[0], motion.axis[1], motion.axis[2]}, 0};
    if (k.require("time")) k.number("time", kSeconds, &key.time);
    k.vector3("translation", kLength, key.translation);
    k.number("degrees", kDegrees, &key.degrees);
    read_axis(k, key.axis);
    if (key.degrees != 0 && !axis_given && !k.has("axis")) k.fail("degrees", "needs an axis, here or beside part");
    if (!motion.keys.empty() && !(key.time > motion.keys.back().time)) k.fail("time", "must be greater than that of the key before");
    motion.keys.push_back(key);
  }
  if (motion.keys.size() > kMostKeys) t.fail("key", "is given too often: at most " + std::to_string(kMostKeys) + " keys");
  if (motion.keys.empty()) t.fail("key", "is empty");
  if (motion.repeat && motion.keys.size() == 1) t.fail("repeat", "needs at least two keys");
}

// above: the motions before this one.
Motion read_motion(const toml::table& table, const std::vector<Motion>& above, TomlErrors& errors) {
  TomlTable t(table, "moving", {"part", "carried_by", "pivot", "axis", "degrees_per_second", "key", "repeat"}, errors);
  Motion motion;
  const auto is = [](const std::string& name) { return [&name](const Motion& m) { return m.part == name; }; };
  if (t.require("part") && t.text("part", &motion.part)) {
    if (motion.part.empty()) t.fail("part", "is empty");
    if (std::any_of(above.begin(), above.end(), is(motion.part))) t.fail("part", "moves already: it stands in a [[moving]] above");
  }
  if (std::string carrier; t.text("carried_by", &carrier)) {
    const auto it = std::find_if(above.begin(), above.end(), is(carrier));
    if (it == above.end()) t.fail("carried_by", "is " + quoted(carrier) + ", which is not the part of a [[moving]] above");
    motion.carrier = static_cast<int32_t>(it - above.begin());
  }
  t.vector3("pivot", kLength, motion.pivot);
  const bool axis_given = read_axis(t, motion.axis);
  const bool spins = t.number("degrees_per_second", kDegrees, &motion.degrees_per_second);
  t.boolean("repeat", &motion.repeat);
  if (t.has("key")) {
    if (t.has("degrees_per_second")) t.fail("degrees_per_second", "and keys exclude each other");
    read_keys(t, motion, axis_given || t.has("axis"), errors);
    return motion;
  }
  if (t.has("repeat")) t.fail("repeat", "is for keys");
  if (spins && !t.has("axis")) t.fail("degrees_per_second", "needs an axis");
  if (!t.has("degrees_per_second")) t.fail("part", "does not move: give keys, or axis and degrees_per_second");
  return motion;
}

}  // namespace

bool read_axis(TomlTable& t, double axis[3]) {
  glm::dvec3 a(0);
  if (!t.vector3("axis", kAnyNumber, &a.x)) return false;
  if (!(length3(a) > kLeastLength)) return t.fail("axis", "has no length"), false;
  a = normalize3(a, glm::dvec3(0, 1, 0));
  for (int k = 0; k < 3; ++k) axis[k] = a[k] + 0.0;
  return true;
}

void read_moving(TomlTable& root, MovingParts& moving, TomlErrors& errors) {
  for (const toml::table* table : root.tables("moving")) {
    if (moving.motions.size() == kMostMotions) return root.fail("moving", "is given too often: at most " + std::to_string(kMostMotions) + " parts");
    moving.motions.push_back(read_motion(*table, moving.motions, errors));
    const toml::node* part = table->get("part");
    moving.lines.push_back(static_cast<int>((part != nullptr ? part->source() : table->source()).begin.line));
  }
}

Result<std::vector<uint32_t>> find_moving_faces(const ObjMesh& mesh, const MovingParts& moving) {
  std::vector<uint32_t> motion_of;
  if (moving.motions.empty()) return motion_of;
  motion_of.assign(mesh.faces.size(), 0);
  for (size_t m = 0; m < moving.motions.size(); ++m) {
    const std::string& part = moving.motions[m].part;
    const PartFilter filter(mesh.part_names, part);
    bool found = false;
    for (size_t f = 0; f < mesh.faces.size(); ++f) {
      if (!filter.has(mesh.faces[f].object, mesh.faces[f].group)) continue;
      found = true;
      if (motion_of[f] != 0)
        return Error{"part " + quoted(part) + " has faces that are in " + quoted(moving.motions[motion_of[f] - 1].part) +
                         ", too; a face moves with one part only (see carried_by)", moving.file, moving.lines[m]};
      motion_of[f] = static_cast<uint32_t>(m) + 1;
    }
    if (!found) return unknown_part(mesh, part, moving.file, moving.lines[m]);
  }
  return motion_of;
}

}  // namespace spanray
