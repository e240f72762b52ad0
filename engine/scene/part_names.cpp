#include "scene/part_names.h"

#include <algorithm>
#include <set>

#include "scene/obj_mesh.h"
#include "scene/text_input.h"
#include "spanray/settings_text.h"

namespace spanray {
namespace {

constexpr size_t kMostNamesShown = 12;

// Of `g`: the whole line, or a word of it.
bool names_group(std::string_view line, std::string_view name) {
  if (line == name) return true;
  for (std::string_view word; !(word = next_word(line)).empty();)
    if (word == name) return true;
  return false;
}

}  // namespace

PartFilter::PartFilter(const std::vector<std::string>& part_names, const std::string& part)
    : is_object_(part_names.size()), is_group_(part_names.size()) {
  for (size_t n = 0; n < part_names.size(); ++n) is_object_[n] = part_names[n] == part, is_group_[n] = names_group(part_names[n], part);
}

Error unknown_part(const ObjMesh& mesh, const std::string& name, const std::string& file, int line) {
  std::set<std::string> distinct;
  for (const ObjFace& face : mesh.faces) {
    distinct.insert({mesh.part_names[face.object], mesh.part_names[face.group]});
    std::string_view rest = mesh.part_names[face.group];
    for (std::string_view word; !(word = next_word(rest)).empty();) distinct.emplace(word);
  }
  distinct.erase("");
  const std::vector<std::string> names(distinct.begin(), distinct.end());
  std::string text = "no face of the mesh is in an object or group named " + quoted(name) + did_you_mean(name, names);
  text += names.empty() ? "; the mesh names none" : "; there are ";
  for (size_t i = 0; i < std::min(names.size(), kMostNamesShown); ++i) text += (i > 0 ? ", " : "") + quoted(names[i]);
  if (names.size() > kMostNamesShown) text += " and " + std::to_string(names.size() - kMostNamesShown) + " more";
  return {text, file, line};
}

}  // namespace spanray
